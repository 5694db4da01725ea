"""A simulated signal as the record that ``respond`` prints, and as files with a chart."""

from pathlib import Path

import numpy as np

from pneutouch.evaluation.dynamics import BASIS, gauge_rate_Hz
from pneutouch.formats import versioned
from pneutouch.mechanics.line.transient import gain_at, highest_frequency
from pneutouch.output.files import check_writable, json_bytes, with_manifest, write_folder
from pneutouch.output.recipe import BuildRecipe
from pneutouch.report.fit_charts import GainCurve, TimeCurves, response_chart
from pneutouch.results.record import plain
from pneutouch.results.response import LoadResponse, StateResponse
from pneutouch.tables.csv_table import columns_csv
from pneutouch.units import KPA
from pneutouch.wording import data_of, rounded
from pneutouch.workflows.respond import BEFORE, Load, RespondRun, StateSignal

_DIGITS = 6

_MOST_ROWS = 20000
"""Most rows of a signal's CSV file: of a longer signal every second, third ... sample is written."""

_LOWEST = 0.1
"""Lowest frequency in the chart of the gain, Hz."""

CHAIN = tuple(data_of(__file__)["chain"])


def responded(run: RespondRun) -> LoadResponse:
    """Record of a simulated signal."""
    scene, load, peak = run.evaluation.scene, run.load, run.signals[0].peak
    record = LoadResponse(
        design=scene.name,
        model=run.evaluation.prediction.model,
        simulated=True,
        signal="step" if load.frequency is None else "sine",
        sine_Hz=load.frequency,
        duration_s=load.seconds,
        seed=run.seed,
        gauge=scene.design.pneumatics.gauge,
        gauge_rate_Hz=gauge_rate_Hz(scene),
        notes=tuple(_notes(run)),
        states=tuple(_state(run.load, number, signal) for number, signal in enumerate(run.signals)),
        basis=(*CHAIN, *BASIS),
        peak_N=None if load.travel else peak,
        peak_mm=peak if load.travel else None,
    )
    return rounded(record, _DIGITS)


def _notes(run: RespondRun) -> list[str]:
    scene, load = run.evaluation.scene, run.load
    notes = [] if run.evaluation.bandwidth.note is None else [run.evaluation.bandwidth.note]
    rate_Hz = gauge_rate_Hz(run.evaluation.scene)
    if scene.gauge is None:
        notes.append("the design names no gauge (pneumatics.gauge): nothing is sampled")
    elif rate_Hz is None:
        notes.append(f"the rate of the {scene.gauge.title} is not known: nothing is sampled")
    elif load.frequency is not None and load.frequency >= 0.5 * rate_Hz:
        notes.append(f"{load.frequency:g} Hz is not below half of the gauge's rate of {rate_Hz:g} Hz: it aliases")
    clipped = sum(signal.samples.clipped for signal in run.signals if signal.samples is not None)
    return [*notes, *([f"{clipped} samples lie beyond the gauge's range"] if clipped else [])]


def _state(load: Load, number: int, signal: StateSignal) -> StateResponse:
    band = signal.band
    gain, lag = (None, None) if load.frequency is None else signal.at_frequency(load.frequency)
    return StateResponse(
        driving_pressure_kPa=signal.driving_pressure / KPA,
        relaxation_source=signal.source,
        file=f"signal-{number + 1}.csv",
        slow_pressure_rise_kPa=float(signal.slow.max()) / KPA,
        greatest_reading_kPa=float(signal.gauge.max()) / KPA,
        last_reading_kPa=float(signal.gauge[-1]) / KPA,
        first_resonance_Hz=band.resonance,
        resonance_gain=band.resonance_gain,
        bandwidth_3_dB_Hz=band.bandwidth,
        within_5_percent_Hz=band.within_tolerance,
        within_5_percent_limited_by=band.limited_by,
        gain=gain,
        phase_lag_deg=lag,
        samples_file=None if signal.samples is None else f"samples-{number + 1}.csv",
    )


def write_respond(run: RespondRun, record: LoadResponse, out: Path) -> Path:
    """Write signals, samples, record, chart and manifest into ``out/<design>-response/``; return that folder."""
    name = f"{run.evaluation.scene.name}-response"
    folder = out / name
    check_writable(folder)
    files = {"response.json": json_bytes(versioned("response", plain(record))), "response.svg": _chart(run).encode()}
    for number, signal in enumerate(run.signals):
        files[f"signal-{number + 1}.csv"] = _signal_csv(run, signal)
        if signal.samples is not None:
            columns = {"time_s": signal.samples.time, "gauge_pressure_kPa": signal.samples.reading / KPA}
            files[f"samples-{number + 1}.csv"] = columns_csv(columns)
    load = run.load
    requested = {"peak": load.peak, "unit": load.unit, "sine_Hz": load.frequency, "duration_s": load.duration}
    inputs = {**BuildRecipe.of(run.evaluation).inputs(), "load": requested, "seed": run.seed}
    return write_folder(folder, with_manifest(files, name, inputs))


def _signal_csv(run: RespondRun, signal: StateSignal) -> bytes:
    every = slice(None, None, -(-signal.time.size // _MOST_ROWS))
    loaded = "indentation_mm" if run.load.travel else "contact_force_N"
    rises = {"slow": signal.slow, "cavity": signal.cavity, "gauge": signal.gauge}
    columns = {f"{name}_pressure_rise_kPa": values[every] / KPA for name, values in rises.items()}
    return columns_csv({"time_s": signal.time[every], loaded: signal.load[every], **columns})


def _chart(run: RespondRun) -> str:
    """Chart of the last signal, for a step only the time around it, and of the gain of every state; SVG."""
    shown = run.signals[-1]
    part = slice(None)
    if run.load.frequency is None:
        first = int(BEFORE * shown.time.size)
        part = slice(max(0, first - first // 4), min(shown.time.size, first + first))
    time = shown.time[part]
    samples = None
    if shown.samples is not None:
        inside = (shown.samples.time >= time[0]) & (shown.samples.time <= time[-1])
        samples = shown.samples.time[inside], shown.samples.reading[inside] - shown.driving_pressure
    curves = TimeCurves(time, shown.slow[part], shown.gauge[part], samples)
    return response_chart(curves, [_gain(signal, run) for signal in run.signals])


def _gain(signal: StateSignal, run: RespondRun) -> GainCurve:
    frequency = np.geomspace(_LOWEST, highest_frequency(signal.dynamics), 400)
    sources = list(dict.fromkeys(one.source for one in run.signals))
    data = "" if signal.source is None else f", data {chr(ord('A') + sources.index(signal.source))}"
    label = f"{signal.driving_pressure / KPA:g} kPa{data}"
    return GainCurve(label, frequency, gain_at(signal.dynamics, frequency))
