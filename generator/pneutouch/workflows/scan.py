"""A texture scanned by a sensor, and domes that separate two textures.

A sensor's scan over a specimen: both loaded, scanned at each driving pressure, patterns looked for, all written.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.catalogue import DesignSource, Library, ResolvedDesign, load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import sensor_of
from pneutouch.evaluation.gauge import reading_of
from pneutouch.mechanics import Sensor
from pneutouch.parts import assemble
from pneutouch.parts.specimen.bars import places
from pneutouch.spec.options import ScanOptions
from pneutouch.spec.read import Changes
from pneutouch.spec.specimen import Bars
from pneutouch.texture.contact import PreloadContact, touch
from pneutouch.texture.detect import Detection, detect, least_duration
from pneutouch.texture.signal import Signal, read_signal
from pneutouch.texture.sliding import NOISE, Recorder, ScanPath, TextureScan, scan
from pneutouch.texture.substrate import BarRow, MatrixLayer, Substrate
from pneutouch.units import KPA
from pneutouch.workflows.specimen import ResolvedSpecimen, draw, load_specimen

KEPT = 20.0
"""Highest frequency of signals in CSV files, Hz, or twice the highest pattern's; with five times as many samples."""


@dataclass(frozen=True)
class AnalysedSignal:
    """One signal, simulated or measured, with its detections; touch, substrate and scan of a simulated one."""

    label: str
    signal: Signal
    detections: tuple[Detection, ...]
    touch: PreloadContact | None = None
    substrate: Substrate | None = None
    scan: TextureScan | None = None


@dataclass(frozen=True)
class ScanRun:
    """A whole run; ``frequencies`` are the patterns' at the speed of the scan, Hz, by name; ``noise`` in MPa rms."""

    specimen: ResolvedSpecimen
    design: ResolvedDesign
    sensor: Sensor
    matrix: MatrixLayer
    bars: tuple[BarRow, ...]
    options: ScanOptions
    noise: float
    path: ScanPath
    frequencies: dict[str, float]
    seen: tuple[AnalysedSignal, ...]

    @property
    def name(self) -> str:
        """Name of the output folder."""
        return f"{self.specimen.name}-{self.design.name}-scan"

    @property
    def kept(self) -> float:
        """Highest frequency that the signals are written for, Hz."""
        return max(KEPT, 2 * max(self.frequencies.values(), default=0.0))


def run_scan(
    specimen: str,
    design: str | DesignSource,
    options: ScanOptions = ScanOptions(),  # noqa: B008 - immutable
    changes: Changes | None = None,
    library: Library | None = None,
) -> ScanRun:
    """Scan a specimen with a sensor, both by name or path; ``changes`` are of the design.

    Raises InputError if that is impossible: see `texture.contact`, `texture.sliding`, `texture.detect`.
    """
    library = library or Library.default()
    context, scene, sensor = load_both(specimen, design, changes, library)
    if options.speed_mm_per_s is not None:
        context = replace(context, specimen=_at_speed(context, options.speed_mm_per_s))
    reading = reading_of(scene)
    noise = noise_of(options, reading.noise if scene.gauge is not None else None)
    recorder = Recorder(noise=noise, step=reading.step or 0.0, limit=reading.limit, seed=options.seed)
    speed = context.specimen.scan.speed_mm_per_s
    bars, matrix = bars_of(context), matrix_of(context)
    states = [touch(sensor, at_kPa * KPA, options.preload_N) for at_kPa in options.driving_pressures_kPa]
    margin = max((state.contact_radius for state in states), default=0.0)
    length = context.specimen.block.length_mm
    scan_path = ScanPath(margin, length - margin, speed, options.control)
    frequencies = {row.name: speed / row.pitch for row in bars}
    _check_length(context, scan_path, frequencies)
    simulated = [
        _simulated(state, Substrate(matrix, bars, length, state.contact_radius), scan_path, recorder, frequencies)
        for state in states
    ]
    measured = [_measured(path, frequencies) for path in options.data]
    return ScanRun(
        context, scene, sensor, matrix, bars, options, noise, scan_path, frequencies, (*simulated, *measured)
    )


def load_both(
    specimen: str, design: str | DesignSource, changes: Changes | None, library: Library, scanned: bool = True
) -> tuple[ResolvedSpecimen, ResolvedDesign, Sensor]:
    """A specimen and a sensor; one that is ``scanned`` is checked as it is for printing.

    Raises InputError, also where one is the other.
    """
    context = load_specimen(specimen, None, library)
    if isinstance(design, str) and library.specimen_file(design) is not None:
        raise InputError(
            "is a specimen", key="design", value=design, remedy="give the name or path of a sensor's design"
        )
    matrix_of(context)
    if scanned:
        bars_of(context)
        draw(context)
    scene = load_scene(design, changes, library)
    # The specimen is flat: what presses the sensor elsewhere does not count here.
    return (
        context,
        scene,
        sensor_of(assemble(scene)).replace(body=None, plate_rim=None, friction=0.0, offset=0.0, tilt=0.0, shear=0.0),
    )


def bars_of(context: ResolvedSpecimen) -> tuple[BarRow, ...]:
    """The specimen's rows of bars. Raises InputError for layers of another kind: the scan model does not cover them."""
    rows = []
    for number, layer in enumerate(context.specimen.layer):
        if not isinstance(layer, Bars):
            problem, remedy = (
                "the scan model covers bars alone",
                (
                    "with `data`, measured signals of any specimen can be read against a specimen of bars with the "
                    "same pitches"
                ),
            )
            raise InputError(problem, file=context.where, key=f"layer[{number}].kind", value=layer.kind, remedy=remedy)
        left = places(layer, context.context)
        edges = np.stack([left, left + layer.width_mm], axis=1)
        pitch = layer.pitch(context.specimen.scan.speed_mm_per_s)
        name = layer.name or f"layer {number + 1}"
        rows.append(BarRow(name, pitch, layer.width_mm, layer.height_mm, layer.depth_mm, edges))
    names = [row.name for row in rows]
    if len(set(names)) < len(names):
        raise InputError("layer: two patterns have one name", file=context.where, remedy="give each its own")
    return tuple(rows)


def matrix_of(context: ResolvedSpecimen) -> MatrixLayer:
    """The block's matrix. Raises InputError for one without a shear modulus."""
    modulus, poisson = context.matrix.shear_modulus_MPa, context.matrix.poisson_ratio
    if modulus is None or poisson is None:
        raise InputError(
            "has no shear modulus",
            file=context.where,
            key="block.matrix",
            value=context.specimen.block.matrix,
            remedy="the scan model takes a soft matrix with stiff bars",
        )
    return MatrixLayer(context.specimen.block.height_mm, modulus.nominal, poisson.nominal)


def _at_speed(context: ResolvedSpecimen, speed: float) -> Any:
    """The specimen at another speed; the bars stay where the file's own speed put them."""
    given = context.specimen.scan.speed_mm_per_s
    layers = [
        layer.model_copy(update={"pitch_mm": layer.pitch(given), "target_frequency_Hz": None})
        if isinstance(layer, Bars)
        else layer
        for layer in context.specimen.layer
    ]
    update = {"scan": context.specimen.scan.model_copy(update={"speed_mm_per_s": speed}), "layer": layers}
    return context.specimen.model_copy(update=update)


def noise_of(options: ScanOptions, gauge: float | None = None) -> float:
    """Noise of a sample, MPa rms: as stated, else the ``gauge``'s, else a step of the recorder."""
    if options.noise_kPa is not None:
        return options.noise_kPa * KPA
    return NOISE if gauge is None else gauge


def _check_length(context: ResolvedSpecimen, scan_path: ScanPath, frequencies: dict[str, float]) -> None:
    """Refuse a path too short to resolve a pattern's frequency, in terms of the specimen."""
    lasts = (scan_path.end - scan_path.start) / scan_path.speed
    for name, frequency in frequencies.items():
        needed = least_duration(frequency)
        if lasts < needed:
            raise InputError(
                f"{name}: {frequency:.4g} Hz at {scan_path.speed:g} mm/s: the path of "
                f"{max(scan_path.end - scan_path.start, 0):.4g} mm between the block's ends lasts "
                f"{max(lasts, 0):.4g} s and must last {needed:.4g} s",
                file=context.where,
                remedy=f"block.length_mm must be at least {needed * scan_path.speed + 2 * scan_path.start:.4g}",
            )


def _detected(signal: Signal, frequencies: dict[str, float], where: str) -> tuple[Detection, ...]:
    """One detection for each pattern; patterns of one pitch are one line in a spectrum."""
    sought = sorted(set(frequencies.values()))
    if np.ptp(signal.pressure) == 0:
        return ()
    by = dict(zip(sought, detect(signal, sought, where=where), strict=True))
    return tuple(by[frequency] for frequency in frequencies.values())


def _simulated(
    state: PreloadContact, substrate: Substrate, scan_path: ScanPath, recorder: Recorder, frequencies: dict[str, float]
) -> AnalysedSignal:
    simulated = scan(state, substrate, scan_path, recorder)
    label = f"{state.driving_pressure / KPA:g} kPa"
    return AnalysedSignal(
        label, simulated.signal, _detected(simulated.signal, frequencies, label), state, substrate, simulated
    )


def _measured(path: Path, frequencies: dict[str, float]) -> AnalysedSignal:
    signal = read_signal(path)
    return AnalysedSignal(path.name, signal, _detected(signal, frequencies, str(path)))
