"""Curves of a specimen for the simulator and the test plan: pressed, or filled with air while unpressed.

Their deviations from the model keep a calibration from meeting exactly the model that it fits."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.simulate.rig import parameter
from pneutouch.errors import InputError
from pneutouch.mechanics import Sensor, SensorState, predict
from pneutouch.mechanics.prediction import InflationCurve, Limits
from pneutouch.units import KPA

STEPS = 56
"""Equal plate steps of the fine grid: the solid's contact advances in cells, 56 steps follow it to 0.1 % of force."""

OFF_AXIS_STEPS = 14
"""Plate steps off the axis, where a step costs as much as a central press: with cubics between them force and rise are
within 1 % of full scale of those of 56 steps (docs/background/off-axis.md)."""

_ROUNDING = 1e-9
_LEAST_POINTS = 3

_SHORT = 1e-4
"""Share of the travel by which a press stops before the event that ends its range."""


@dataclass(frozen=True, slots=True)
class PressCurve:
    """Force and pressure rise over plate travel, (n,) mm, N, MPa, from first contact to the end of the range.

    Attributes:
        driving: Driving pressure, MPa.
        indentation, force, rise: The curve; the first point is the origin.
        ends: Event that ends the range before the depth, and its place (mm); None without one."""

    driving: float
    indentation: Array
    force: Array
    rise: Array
    ends: tuple[str, float] | None = None

    @property
    def reach(self) -> float:
        """Greatest plate travel of the curve, mm."""
        return float(self.indentation[-1])

    def covers(self, depth: float) -> bool:
        """True if a plate travel (mm) lies within the range."""
        return depth <= self.reach * (1 + _ROUNDING)

    def at(self, travel: Array) -> tuple[Array, Array]:
        """Force and rise at plate travels (n,) up to the reach; monotone between points (Fritsch and Carlson)."""
        from scipy.interpolate import PchipInterpolator

        values = PchipInterpolator(self.indentation, np.stack([self.force, self.rise], axis=1))(travel)
        return values[..., 0], values[..., 1]


@dataclass(frozen=True, slots=True)
class PressCurves:
    """The curves of one sensor at ascending driving pressures, its free inflation and its limits."""

    sensor: Sensor
    model: str
    curves: tuple[PressCurve, ...]
    inflation: InflationCurve
    limits: Limits


def press_curves(
    sensor: Sensor, pressures: Sequence[float], depth: float, model: str = "solid", steps: int = STEPS
) -> PressCurves:
    """Press a sensor to ``depth`` mm at ascending driving pressures (MPa). The gauge does not end the range, as the
    simulated rig clips its reading. A later shear is left out; off the axis at most `OFF_AXIS_STEPS` are taken.

    Raises what `predict` raises, and InputError where the range ends before the plate has moved.
    """
    free = sensor.replace(depth=depth, steps=steps, gauge_limit=np.inf, shear=0.0)
    if free.protocol.off_axis is not None:
        free = free.replace(steps=min(steps, OFF_AXIS_STEPS))
    prediction = predict("", free, list(pressures), model=model)
    curves = tuple(_curve(free, state, prediction.model) for state in prediction.states)
    limits = replace(prediction.limits, gauge=sensor.gas.gauge_limit)
    return PressCurves(sensor, prediction.model, curves, prediction.inflation, limits)


def _curve(sensor: Sensor, state: SensorState, model: str) -> PressCurve:
    """Curve of a state to the end of its range; a range that ends early is pressed again, up to just before its end."""
    ending = next((event for event in state.events if event.ends_range), None)
    ends = None if ending is None else (ending.kind, state.range_end)
    if state.beyond_axis is not None and state.range_end > 0:
        curve = state.beyond_axis.to_end
        return PressCurve(state.driving_pressure, curve.indentation, curve.force, curve.rise, ends)
    if ends is not None and state.range_end > 0:
        shorter = sensor.replace(depth=state.range_end * (1 - _SHORT))
        state = predict("", shorter, [state.driving_pressure], model=model).states[0]
    keep = (state.indentation <= state.range_end * (1 + _ROUNDING)) & np.isfinite(state.force)
    if keep.sum() < _LEAST_POINTS:
        raise InputError(
            f"driving pressure {state.driving_pressure / KPA:g} kPa: the range ends at {state.range_end:.2f} mm"
            f"{'' if ends is None else f' ({ends[0]})'}; nothing can be pressed"
        )
    return PressCurve(
        state.driving_pressure, state.indentation[keep], state.force[keep], state.pressure_rise[keep], ends
    )


STOPS = 0.9
"""Share of the ranges of the rig's instruments at which its plate stops: our choice. The wall's memory, noise and zeros
then stay below what counts as clipped (`bench.reading.CLIPPED`)."""


def stopped(curves: PressCurves, force: float, pressure: float) -> PressCurves:
    """The curves up to where the rig stops, for ranges of its force, N, and its pressure, MPa."""
    return replace(curves, curves=tuple(_stopped(one, STOPS * force, STOPS * pressure) for one in curves.curves))


def _stopped(curve: PressCurve, force: float, pressure: float) -> PressCurve:
    over = np.flatnonzero((curve.force > force) | (curve.driving + curve.rise > pressure))
    if not over.size:
        return curve
    to = slice(0, max(int(over[0]), _LEAST_POINTS))
    ends = "the end of the rig's range", float(curve.indentation[to][-1])
    return PressCurve(curve.driving, curve.indentation[to], curve.force[to], curve.rise[to], ends)


_WAVES = 3
"""Half waves along the travel that make up a smooth deviation, the k-th 1/k as large: our choice."""

_TURN = 22.0 * KPA
"""Driving pressure, MPa, at which the smooth share is independent of the share at zero: the paper's highest."""


@dataclass(frozen=True, slots=True)
class ModelDeviation:
    """Relative deviations of a specimen's force and pressure rise, drawn independently; none by default."""

    common: float = parameter("common")
    smooth: float = parameter("smooth")

    def deviated(self, curves: PressCurves, rng: "np.random.Generator") -> PressCurves:
        """Curves of one specimen with the deviations that ``rng`` draws for it; unchanged if there are none."""
        if self == ModelDeviation():
            return curves
        common = self.common * rng.standard_normal(2)
        waves = self.smooth * rng.standard_normal((2, 2, _WAVES))
        return replace(curves, curves=tuple(_deviated(curve, common, waves) for curve in curves.curves))


def _deviated(curve: PressCurve, common: Array, waves: Array) -> PressCurve:
    """The curve with shares ``common`` (2,) of force and rise, and ``waves`` (2, 2, `_WAVES`): at zero and at
    `_TURN`."""
    order = np.arange(1, _WAVES + 1)
    shape = np.cos(np.pi * np.outer(curve.indentation / curve.indentation[-1], order))
    shape *= np.sqrt(2.0) / order / np.sqrt((1.0 / order**2).sum())
    turn = 0.5 * np.pi * curve.driving / _TURN
    weights = np.cos(turn) * waves[:, 0] + np.sin(turn) * waves[:, 1]
    force, rise = np.exp(common[:, None] + weights @ shape.T)
    return replace(curve, force=curve.force * force, rise=curve.rise * rise)


_GRID = 4000


def line_pressure(pushed: Array, dead_volume: float, ambient: float) -> Array:
    """Gauge pressure (MPa) after ``pushed`` mm3 of room air into a closed line of ``dead_volume`` mm3 (Boyle)."""
    return np.asarray(ambient * pushed / dead_volume)


def sensor_pressure(pushed: Array, inflation: InflationCurve, dead_volume: float, ambient: float) -> Array:
    """Gauge pressure (MPa) after ``pushed`` mm3 of room air into the closed sensor at rest; NaN past the limit point.

    Boyle with a cavity that swells: (p + pa)(V(p) + Vd) = pa (V0 + Vd + pushed), with V(p) of the free inflation.
    """
    from scipy.interpolate import CubicSpline

    top = int(np.argmax(inflation.pressure))
    volume, start = np.linspace(inflation.volume[0], inflation.volume[top], _GRID), inflation.volume[0]
    _, first = np.unique(inflation.volume[: top + 1], return_index=True)
    pressure = CubicSpline(inflation.volume[first], inflation.pressure[first])(volume)
    pressure = pressure - pressure[0]
    taken = (pressure + ambient) * (volume + dead_volume) / ambient - (start + dead_volume)
    return np.asarray(np.interp(pushed, taken, pressure, right=np.nan))
