"""Response of a sensor, with wall, gas, line and gauge, to a step or a sine of force or of travel.

The slow reading is that of the predicted curve. Wall, gas and line act on it as a linear system about half of the load,
with the compliance that the wall has there, found from a second press of the same model with more gas behind it.
"""

import math
import re
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.evaluation.dynamics import free_compliance, state_dynamics
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.mechanics import SensorState, predict
from pneutouch.mechanics.line.dynamics import SensorDynamics, on_axis
from pneutouch.mechanics.line.transient import BandFigures, band_figures, through
from pneutouch.mechanics.sensor import ResponseCorrection
from pneutouch.mechanics.viscous.prony import Prony, prony_series
from pneutouch.spec.values import plain_number
from pneutouch.units import KPA

_SIZE = re.compile(r"(.+?)\s*(N|mm)$")

_FREQUENCIES = (1e-3, 1e4)
"""Least and greatest frequency of a sine, Hz."""

CYCLES = 10.0
"""Cycles of a sine if no duration is given."""

STEP_SECONDS = 1.0
"""Length of a step's record if no duration is given: our choice, many times the time that a line needs."""

BEFORE = 0.1
"""Share of a step's record before the step."""


@dataclass(frozen=True, slots=True)
class Load:
    """Load on the sensor over time, up to ``peak`` (N, or mm of travel with ``travel``; None: half of the range).

    ``frequency`` in Hz of a sine that goes from no load to the peak and back; None: a step at a tenth of the record.
    ``duration`` in s; None: 1 s for a step, ten cycles for a sine.
    """

    peak: float | None = None
    travel: bool = False
    frequency: float | None = None
    duration: float | None = None

    def __post_init__(self) -> None:
        key = "step" if self.frequency is None else "peak"
        if self.peak is not None and not (math.isfinite(self.peak) and self.peak > 0):
            raise InputError(f"must be above 0 {self.unit}", key=key, value=self.peak)
        low, high = _FREQUENCIES
        if self.frequency is not None and not low <= self.frequency <= high:
            raise InputError(f"must be from {low:g} to {high:g} Hz", key="sine", value=self.frequency)
        if self.duration is not None and not (math.isfinite(self.duration) and self.duration > 0):
            raise InputError("must be above 0 s", key="duration", value=self.duration)

    @property
    def unit(self) -> str:
        """Unit of the load, N or mm."""
        return "mm" if self.travel else "N"

    @property
    def seconds(self) -> float:
        """Length of the record, s."""
        if self.duration is not None:
            return self.duration
        return STEP_SECONDS if self.frequency is None else CYCLES / self.frequency

    def over(self, time: Array) -> Array:
        """Load over its peak at evenly spaced times (s), (n,)."""
        if self.frequency is not None:
            return np.asarray(0.5 - 0.5 * np.cos(2.0 * np.pi * self.frequency * time))
        at = int(BEFORE * time.size)
        share = np.zeros_like(time)
        share[at], share[at + 1 :] = 0.5, 1.0
        return share


def load_size(text: str, key: str) -> tuple[float, bool]:
    """Size of a load from text such as 2N or 3mm, and True if it is a travel. Raises InputError naming ``key``."""
    match = _SIZE.match(text.strip())
    try:
        if match is None:
            raise ValueError(text)
        return plain_number(match[1]), match[2] == "mm"
    except ValueError:
        raise InputError("must be a force or a travel with its unit, such as 2N or 3mm", key=key, value=text) from None


def frequency_Hz(text: str, key: str = "sine") -> float:
    """Frequency from text such as 5Hz or 5. Raises InputError that names ``key``."""
    try:
        return plain_number(text.strip().removesuffix("Hz").strip())
    except ValueError:
        raise InputError("must be a frequency in Hz, such as 5Hz", key=key, value=text) from None


_A_PERIOD = 40.0
"""Samples in a period of the first resonance or of the sine, whichever is shorter."""

_LEAST_RATE, _MOST_RATE = 2e3, 5e4
"""Least and greatest sampling rate of a signal, Hz."""

MOST_SAMPLES = 2**18
"""Greatest number of samples of a signal."""

_MORE_GAS = 0.1
"""Additional gas of the second press, as a share of all gas."""

_SMALL_LOAD = 0.02
"""Share of the range below which half of the load counts as no contact for the wall's compliance."""


@dataclass(frozen=True)
class GaugeSamples:
    """Samples of the gauge: times (s), gauge pressures (MPa), and the number beyond its range."""

    time: Array
    reading: Array
    clipped: int


@dataclass(frozen=True)
class StateSignal:
    """One state's signal, arrays (n,): load (N or mm); pressure rise (MPa) of a slow press, in the cavity and at the
    gauge. ``samples`` is None without a gauge whose rate is known."""

    driving_pressure: float
    source: str | None
    peak: float
    dynamics: SensorDynamics
    band: BandFigures
    time: Array
    load: Array
    slow: Array
    cavity: Array
    gauge: Array
    samples: GaugeSamples | None

    def at_frequency(self, frequency: float) -> tuple[float, float]:
        """Gain and phase lag (degrees) of the reading at a frequency in Hz."""
        gain = self.dynamics.gain(on_axis([frequency]))[0]
        return float(abs(gain)), float(-np.degrees(np.angle(gain)))


@dataclass(frozen=True)
class RespondRun:
    """Simulation of a load: the evaluated design, the load, the seed of the noise, and a signal for each state."""

    evaluation: Evaluation
    load: Load
    seed: int
    signals: tuple[StateSignal, ...]


def run_respond(evaluation: Evaluation, load: Load, seed: int = 0) -> RespondRun:
    """Simulate a load on every state. Raises InputError for a load beyond a range, or a bad length of the record."""
    prediction = evaluation.prediction
    curves = [_curve(state, load) for state in prediction.states]
    peak = load.peak
    if peak is None:
        peak = 0.5 * min(float(x[-1]) for x, _ in curves)
    for state, (x, _) in zip(prediction.states, curves, strict=True):
        if peak > x[-1]:
            raise InputError(
                f"beyond the range at {state.driving_pressure / KPA:g} kPa",
                key="step" if load.frequency is None else "peak",
                value=f"{peak:g}{load.unit}",
                remedy=f"it must be at most {np.floor(1e3 * x[-1]) / 1e3:g} {load.unit}",
            )
    compliances = _compliances(evaluation, load, peak)
    series: tuple[Prony | None, ...] = prony_series(evaluation.scene.membrane_material) or (None,)
    signals = [
        _signal(evaluation, state, one, compliance, curve, load, peak, seed + number)
        for number, (state, compliance, curve) in enumerate(zip(prediction.states, compliances, curves, strict=True))
        for one in series
    ]
    return RespondRun(evaluation, load, seed, tuple(signals))


def _curve(state: SensorState, load: Load) -> tuple[Array, Array]:
    """Load and rise of the slow press, while both rise in the range. Raises InputError for fewer than three points."""
    x = state.indentation if load.travel else state.force
    kept = state.indentation <= state.range_end * (1.0 + 1e-9)
    rising = np.append(True, (np.diff(x) > 0.0) & kept[1:])
    count = int(np.argmin(rising)) if not rising.all() else rising.size
    if count < 3:
        raise InputError(
            f"at {state.driving_pressure / KPA:g} kPa the press has no range to read", remedy="take another pressure"
        )
    return x[:count], state.pressure_rise[:count]


def _compliances(evaluation: Evaluation, load: Load, peak: float) -> list[float]:
    """Compliance of each state's wall at half of the load, mm3/MPa; the free one for a membrane or small load."""
    prediction = evaluation.prediction
    if prediction.model == "membrane":
        return [free_compliance(prediction, state) for state in prediction.states]
    sensor = evaluation.sensor.replace(correction=ResponseCorrection())
    gas = sensor.gas.dead_volume + min(state.cavity_volume for state in prediction.states)
    more = sensor.replace(dead_volume=sensor.gas.dead_volume + _MORE_GAS * gas)
    pressures = [state.driving_pressure for state in prediction.states]
    options = evaluation.options
    again = [
        predict(prediction.design, one, pressures, model=prediction.model, closure=options.closure)
        for one in ((sensor, more) if evaluation.sensor.correction.driving_pressures else (more,))
    ]
    first = prediction if len(again) == 1 else again[0]
    return [
        _compliance((one, sensor.gas.dead_volume), (two, more.gas.dead_volume), sensor.gas.ambient_pressure, load, peak)
        or free_compliance(prediction, one)
        for one, two in zip(first.states, again[-1].states, strict=True)
    ]


def _compliance(
    one: tuple[SensorState, float], two: tuple[SensorState, float], ambient: float, load: Load, peak: float
) -> float | None:
    """Change of volume (Boyle) over change of pressure at a load, from two dead volumes; None if not found."""
    ends, places = [], []
    for state, dead in (one, two):
        x, rise = _curve(state, load)
        ends.append(x[-1])
        at = float(np.interp(0.5 * peak, x, rise))
        content = (state.driving_pressure + ambient) * (state.cavity_volume + dead)
        places.append((at, content / (state.driving_pressure + ambient + at) - dead))
    if 0.5 * peak < _SMALL_LOAD * min(ends):
        return None
    (rise_one, volume_one), (rise_two, volume_two) = places
    if rise_one == rise_two:
        return None
    value = (volume_two - volume_one) / (rise_two - rise_one)
    return float(value) if value > 0.0 else None


def _signal(
    evaluation: Evaluation,
    state: SensorState,
    series: Prony | None,
    compliance: float,
    curve: tuple[Array, Array],
    load: Load,
    peak: float,
    seed: int,
) -> StateSignal:
    from scipy.interpolate import PchipInterpolator

    dynamics = state_dynamics(evaluation.assembly, evaluation.sensor, state, series, compliance)
    band = band_figures(dynamics)
    rate = float(np.clip(_A_PERIOD * max(band.resonance or 0.0, load.frequency or 0.0), _LEAST_RATE, _MOST_RATE))
    count = int(load.seconds * rate)
    if not 64 <= count <= MOST_SAMPLES:
        least, most = 64 / rate, MOST_SAMPLES / rate
        raise InputError(
            f"at {rate:.3g} samples a second, as the first resonance needs, must be from {least:.2g} to {most:.2g} s",
            key="duration",
            value=load.seconds,
        )
    time = np.arange(count) / rate
    along = peak * load.over(time)
    slow = np.asarray(PchipInterpolator(*curve)(along))
    cavity, gauge = through(lambda s: np.stack(dynamics.both(s)), slow, 1.0 / rate, sharp=load.frequency is None)
    samples = _sampled(evaluation, state.driving_pressure, time, gauge, seed)
    source = None if series is None else series.source
    return StateSignal(state.driving_pressure, source, peak, dynamics, band, time, along, slow, cavity, gauge, samples)


def _sampled(evaluation: Evaluation, driving: float, time: Array, rise: Array, seed: int) -> GaugeSamples | None:
    """Readings of the design's gauge, with its rate, and with its noise and steps if they are known; None without a
    gauge whose rate is known."""
    gauge = evaluation.scene.gauge
    if gauge is None or gauge.rate_Hz is None:
        return None
    at = np.arange(0.0, time[-1], 1.0 / gauge.rate_Hz.nominal)
    reading = driving + np.interp(at, time, rise)
    noise_kPa = 0.0 if gauge.noise_kPa is None else gauge.noise_kPa.nominal
    reading = reading + np.random.default_rng(seed).normal(0.0, noise_kPa * KPA, at.size)
    low_kPa, high_kPa = gauge.gauge_pressures_kPa(evaluation.scene.design.pneumatics.ambient_pressure_kPa)
    beyond = (reading < low_kPa * KPA) | (reading > high_kPa * KPA)
    reading = np.clip(reading, low_kPa * KPA, high_kPa * KPA)
    step_kPa = 0.0 if gauge.resolution_kPa is None else gauge.resolution_kPa.nominal
    if step_kPa:
        reading = np.round(reading / (step_kPa * KPA)) * (step_kPa * KPA)
    return GaugeSamples(at, reading, int(beyond.sum()))
