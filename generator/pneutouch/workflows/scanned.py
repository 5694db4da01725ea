"""A scan as the record that ``scan`` prints, and as a folder: signals, record, figure and manifest."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from pneutouch.formats import versioned
from pneutouch.output.files import check_writable, json_bytes, with_manifest, write_folder
from pneutouch.report.scalogram import ScannedState, scalogram_chart
from pneutouch.results.record import extended, plain
from pneutouch.results.scan import BarsRecord, ScanRecord, SignalRecord, SimulatedSignal, SoughtPattern
from pneutouch.tables.csv_table import columns_csv
from pneutouch.texture.detect import Detection
from pneutouch.texture.scalogram import scalogram
from pneutouch.texture.separate import noise_amplitude
from pneutouch.texture.signal import Signal, decimated
from pneutouch.texture.sliding import NOISE, RATE, STEP, pressure_amplitude
from pneutouch.texture.substrate import FIRST_ZERO, BarRow, patch_filter
from pneutouch.units import KPA
from pneutouch.wording import data_of, rounded
from pneutouch.workflows.scan import AnalysedSignal, ScanRun
from pneutouch.workflows.specimen import inputs as specimen_inputs

ASSUMPTIONS = tuple(text.format(noise=NOISE / KPA, step=STEP / KPA) for text in data_of(__file__)["assumptions"])

_DIGITS = 7


def scanned(run: ScanRun) -> ScanRecord:
    """Record of a scan."""
    record = ScanRecord(
        specimen=run.specimen.name,
        design=run.design.name,
        control=run.path.control,
        preload_N=run.options.preload_N,
        speed_mm_per_s=run.path.speed,
        path_mm=(run.path.start, run.path.end),
        sampling_Hz=RATE,
        kept_Hz=5 * run.kept,
        noise_kPa=run.noise / KPA,
        seed=run.options.seed,
        range_kPa=run.sensor.gas.gauge_limit / KPA,
        patterns=tuple(_bars(run, row) for row in run.bars),
        states=tuple(_signal(run, number, seen) for number, seen in enumerate(run.seen)),
        assumptions=ASSUMPTIONS,
    )
    return rounded(record, _DIGITS)


def _inputs(run: ScanRun) -> Mapping[str, object]:
    """All that the result depends on, as data; measured signals only by file name."""
    design = run.design
    options = run.options
    return {
        "specimen": specimen_inputs(run.specimen),
        "design": design.design.model_dump(mode="json"),
        "membrane": design.membrane_material.model_dump(mode="json"),
        "dead_volume_mm3": rounded(run.sensor.gas.dead_volume, _DIGITS),
        "pressures_kPa": [rounded(p, _DIGITS) for p in options.driving_pressures_kPa],
        "preload_N": options.preload_N,
        "control": options.control,
        "speed_mm_per_s": run.path.speed,
        "noise_kPa": run.noise / KPA,
        "seed": options.seed,
        "data": [path.name for path in options.data],
    }


def spectra(run: ScanRun) -> str:
    """Chart of the signals, decimated and without their mean, beside their scalograms; SVG."""
    frequencies = sorted(set(run.frequencies.values()))
    low, high = frequencies[0] / 2.0, frequencies[-1] * 2.0
    states = []
    for seen in run.seen:
        kept = decimated(seen.signal, high)
        mean = float(kept.pressure.mean())
        shown = Signal(kept.start, kept.step, kept.pressure - mean)
        states.append(
            ScannedState(f"{seen.label}, about {mean / KPA:.3g} kPa", shown, scalogram(seen.signal, low, high))
        )
    return scalogram_chart(states, {_names(run, frequency): frequency for frequency in frequencies})


def _names(run: ScanRun, frequency: float) -> str:
    names = [name for name, known in run.frequencies.items() if known == frequency]
    return (
        names[0] if len(names) == 1 else " + ".join([names[0], *(name.removeprefix("pattern ") for name in names[1:])])
    )


def _bars(run: ScanRun, row: BarRow) -> BarsRecord:
    frequency = run.frequencies[row.name]
    young = run.specimen.inclusion.young_modulus_MPa
    return BarsRecord(
        name=row.name,
        pitch_mm=row.pitch,
        width_mm=row.width,
        height_mm=row.height,
        depth_mm=row.depth,
        from_mm=float(row.edges.min()),
        to_mm=float(row.edges.max()),
        frequency_Hz=frequency,
        bending_length_mm=None if young is None else row.bending_length(young.nominal, run.matrix.shear_modulus),
        noise_amplitude_kPa=noise_amplitude(frequency, run.noise) / KPA,
    )


def _signal(run: ScanRun, number: int, seen: AnalysedSignal) -> SignalRecord:
    detections: Sequence[Detection | None] = seen.detections or [None] * len(run.bars)
    patterns = tuple(_sought(run, seen, row, one) for row, one in zip(run.bars, detections, strict=True))
    signal = SignalRecord(seen.label, f"signal-{number + 1}.csv", seen.signal.duration, patterns)
    at = seen.touch
    if at is None or seen.substrate is None:
        return signal
    return extended(
        SimulatedSignal,
        signal,
        driving_pressure_kPa=at.driving_pressure / KPA,
        contact_radius_mm=at.contact_radius,
        indentation_mm=at.indentation,
        stiffness_N_per_mm=at.stiffness,
        pressure_slope_kPa_per_mm=at.pressure_slope / KPA,
        pressure_kPa=at.pressure / KPA,
        model=at.model,
        specimen_compliance_mm_per_N=float(seen.substrate.compliance(4096).mean()),
        clipped=bool(abs(seen.signal.pressure).max() >= run.sensor.gas.gauge_limit),
        notes=_notes(run.bars, at.contact_radius),
    )


def _sought(run: ScanRun, seen: AnalysedSignal, row: BarRow, detection: Detection | None) -> SoughtPattern:
    """One pattern in one signal. Patterns of one frequency share a detection: a spectrum does not distinguish them."""
    sought = SoughtPattern(row.name, run.frequencies[row.name], detection is not None and detection.detected)
    if seen.touch is not None and seen.substrate is not None:
        swing = pressure_amplitude(seen.touch, seen.substrate, row, run.path.control)
        relief = abs(seen.substrate.amplitude(row)) * seen.touch.preload
        # Relief goes through the patch alone.
        felt = abs(float(patch_filter(np.asarray(2.0 * math.pi / row.pitch), seen.touch.contact_radius)))
        sought = replace(
            sought,
            model_amplitude_kPa=swing / KPA,
            sinking_amplitude_um=relief * 1e3,
            relief_equivalent_um=1e3 * relief / felt,
        )
    if detection is None:
        return sought
    return replace(
        sought,
        detected_frequency_Hz=detection.frequency,
        amplitude_kPa=detection.amplitude / KPA,
        noise_floor_kPa=detection.floor / KPA,
        detection_figure=detection.ratio,
        threshold=detection.threshold,
        p_value=detection.p_value,
        level=detection.level,
        frequency_error_relative=detection.frequency / detection.target - 1.0,
    )


def _notes(bars: Sequence[BarRow], radius: float) -> tuple[str, ...]:
    """Note on pitches that the patch averages over; none if every pitch is large."""
    near = sorted({row.pitch for row in bars if row.pitch < 4.0 * radius})
    if not near:
        return ()
    blind = 2.0 * math.pi / FIRST_ZERO * radius
    return (
        f"pitches {', '.join(f'{pitch:g}' for pitch in near)} mm are below twice the patch ({4 * radius:.2f} mm), "
        f"which averages over them; of bars at the surface it feels nothing at a pitch of {blind:.2f} mm",
    )


def write_scan(run: ScanRun, record: ScanRecord, out: Path) -> Path:
    """Write signals, record, chart and manifest into ``out/<specimen>-<design>-scan/``; return that folder."""
    folder = out / run.name
    check_writable(folder)
    files = {"scan.json": json_bytes(versioned("scan", plain(record))), "scan.svg": spectra(run).encode()}
    for number, seen in enumerate(run.seen):
        files[f"signal-{number + 1}.csv"] = signal_csv(seen, run.bars, run.kept)
    return write_folder(folder, with_manifest(files, run.name, _inputs(run)))


def signal_csv(seen: AnalysedSignal, bars: Sequence[BarRow], highest: float) -> bytes:
    """CSV of a signal decimated for ``highest`` Hz; a simulated one with place, noiseless pressure and bars passed."""
    kept = decimated(seen.signal, highest)
    columns = {"time_s": kept.time, "pressure_kPa": kept.pressure / KPA}
    if seen.scan is not None:
        every = np.searchsorted(seen.signal.time, kept.time - 0.5 * seen.signal.step)
        columns["place_mm"] = seen.scan.place[every]
        columns["noiseless_kPa"] = seen.scan.clean[every] / KPA
        columns |= {f"bar_{k + 1}": row.covers(seen.scan.place[every]) for k, row in enumerate(bars)}
    return columns_csv(columns)
