"""The pressed curve of one specimen, as the simulator and the test plan read it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.mechanics import Sensor, SensorState, predict
from pneutouch.mechanics.limits import Limits
from pneutouch.mechanics.prediction import InflationCurve
from pneutouch.units import KPA

STEPS = 56
"""Equal plate steps of the fine grid: the solid's contact advances in cells, 56 steps follow it to 0.1 % of force."""

OFF_AXIS_STEPS = 14
"""Plate steps off the axis, where a step costs as much as a central press: with the cubics between them force and rise
are within 1 % of full scale of those of 56 steps (docs/background/off-axis.md)."""

_ROUNDING = 1e-9
_LEAST_POINTS = 3

_SHORT = 1e-4
"""Share of the travel by which a press stops before the event that ends its range."""


@dataclass(frozen=True, slots=True)
class PressCurve:
    """Force and pressure rise over plate travel, (n,) mm, N, MPa, from first contact to the end of the range.

    Attributes:
        driving: Driving pressure.
        indentation, force, rise: The curve; the first point is the origin.
        ends: Event that ends the range before the depth, and its place (mm); None without one.
    """

    driving: float
    indentation: Array
    force: Array
    rise: Array
    ends: tuple[str, float] | None = None

    @property
    def reach(self) -> float:
        """Greatest plate travel of the curve."""
        return float(self.indentation[-1])

    def covers(self, depth: float) -> bool:
        """True if a plate travel lies within the range."""
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
    """Press a sensor to ``depth`` mm at ascending driving pressures (MPa). The gauge ends no range: the rig clips. A
    shear after the press is left out, and an object off the axis makes at most `OFF_AXIS_STEPS`.

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
    """The curve of a state to the end of its range; where that comes early, pressed again so that points reach it."""
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
