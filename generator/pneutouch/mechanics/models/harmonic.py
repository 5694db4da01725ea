"""The model ``harmonic``: the solid with Fourier sums around its axis, for objects off the axis and leaning plates."""

from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError, InputError
from pneutouch.mechanics.events import range_end
from pneutouch.mechanics.harmonic.friction_path import ShearPath
from pneutouch.mechanics.harmonic.press import OffAxisCurve, OffAxisPath, OffAxisPress, RangeCurve, ShearCurve
from pneutouch.mechanics.harmonic.surface import LyingObject, PlacedObject
from pneutouch.mechanics.models.accuracy import HARMONICS_SETTLED, OBJECT_DISCRETISATION, discretised, solid_assumptions
from pneutouch.mechanics.models.interface import Answered, ModelAnswer, SensorModel, one_by_one
from pneutouch.mechanics.models.solid import (
    curve_between,
    free_figures,
    press_settings,
    pressed_columns,
    reported_events,
    solid_probe,
    solid_result,
)
from pneutouch.mechanics.prediction import ModelResult, SensorState
from pneutouch.mechanics.response import Figures, figures
from pneutouch.mechanics.sensor import Filling, Sensor
from pneutouch.mechanics.solid.inflate import FreeState, first_touch
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.results.prediction import ErrorEstimate
from pneutouch.units import KPA

ORDERS = (4, 6, 8, 12)
"""Orders of the harmonics, raised until the figures settle."""

EVEN_ORDERS = (*ORDERS, 16, 24)
"""Orders if only even harmonics are nonzero, so that there are half as many harmonics."""

_READ = 56
"""Number of equal steps of a range at which its curve is interpolated between the solved states."""

_COMPARED = 3
"""Number of states at which a result is compared with that of fewer harmonics."""

_BODY = (
    "hyperelastic solid with Fourier sums around the axis and the wall's full stiffness; what is not symmetric about "
    "the planes of symmetry of the scene is left out"
)
_SUMMARY = (
    f"Discretisation: sensitivity within {OBJECT_DISCRETISATION:.0%} by the mesh; the last raise of the harmonics "
    f"changed sensitivity, force and pressure by less than {HARMONICS_SETTLED:.0%} (docs/background/off-axis.md)."
)


class HarmonicElements(SensorModel):
    """The solid with as many harmonics around its axis as the contact needs."""

    name = "harmonic"

    def covers(self, sensor: Sensor) -> str | None:
        """Reason why a sensor is not covered (a flange held as printed, a soft object), or None if it is covered."""
        if sensor.protocol.soft is not None:
            return sensor.protocol.other_contact
        held = sensor.dome.flange is not None
        return "the flange is held as printed, and the wall's contact with its top is axisymmetric" if held else None

    def answer(self, sensors: Sequence[Sensor], driving_pressures: Sequence[Array]) -> list[Answered]:
        """Answers of `harmonic_result`, one sensor at a time."""
        return one_by_one(lambda *one: ModelAnswer(harmonic_result(*one)), sensors, driving_pressures)

    def filled(self, sensor: Sensor, fillings: Sequence[Filling]) -> tuple[SensorState, ...]:
        """States given by their fillings, inflated by the solid."""
        from pneutouch.mechanics.models.filling import filled_states

        return filled_states(sensor, solid_probe(sensor), fillings, _state)

    def errors(self, sensor: Sensor, driving_pressures: Array) -> ErrorEstimate:
        """Errors of the mesh and of the Fourier sums."""
        return discretised(_SUMMARY, OBJECT_DISCRETISATION)

    def assumptions(self, sensor: Sensor) -> tuple[str, ...]:
        """Assumptions of the solid and of the sums around the axis."""
        return solid_assumptions(sensor, _BODY)


MODEL = HarmonicElements()


def harmonic_result(sensor: Sensor, driving_pressures: Array) -> ModelResult:
    """Inflate with the solid, then press with harmonics at every driving pressure (MPa, ascending).

    Raises BeyondLimitError beyond the limit point, InputError if the object would reach the connector, and
    ComputationError if no equilibrium is found or the figures do not settle."""
    return solid_result(sensor, driving_pressures, pressed_state=_state)


def _state(sensor: Sensor, probe: StrainProbe, free: FreeState, pressure: float) -> SensorState:
    press = off_axis_press(sensor, probe, free)
    if sensor.protocol.off_axis is None:
        return _record(sensor, pressure, free, press, press.run(0), 0.0)
    changes: list[float] = []
    before: OffAxisPath | None = None
    orders = EVEN_ORDERS if _symmetric(sensor) else ORDERS
    for coarse, order in pairwise(orders):
        pressed = press.run(order)
        if sensor.protocol.friction:
            before = press.run(coarse) if before is None else before
            changes.append(change(_curve(sensor, before), _curve(sensor, pressed)))
            before = pressed
        else:
            changes.append(_change_from(press, coarse, pressed, sensor))
        if changes[-1] <= HARMONICS_SETTLED:
            return _record(sensor, pressure, free, press, pressed, changes[-1])
    steps = ", ".join(f"{c:.1%} from {a} to {b}" for c, (a, b) in zip(changes, pairwise(orders), strict=True))
    raise ComputationError(
        f"at {pressure / KPA:g} kPa the figures do not settle with harmonics to order {orders[-1]} around the axis: "
        f"sensitivity, force, pressure or the sideways force of a shear change by {steps}",
        remedy="try a smaller depth, offset, tilt or shear",
    )


def off_axis_press(sensor: Sensor, probe: StrainProbe, free: FreeState) -> OffAxisPress:
    """Press of the sensor's test from one free state, with its object in place.

    Raises InputError for an object that would reach the connector within the depth.
    """
    _check_clearance(sensor, probe, free)
    return placed_press(sensor, probe, free)


def _check_clearance(sensor: Sensor, probe: StrainProbe, free: FreeState) -> None:
    """Raise InputError if the object would reach the connector within the depth."""
    test = sensor.protocol
    travel = _free_travel(sensor, probe, free)
    if not (test.offset or test.tilt) or travel > test.depth:
        return
    name, value = ("tilt", test.tilt) if test.tilt else ("offset", test.offset)
    low, high = 0.0, value
    for _ in range(30):
        middle = 0.5 * (low + high)
        fits = _free_travel(sensor.replace(**{name: middle}), probe, free) > test.depth
        low, high = (middle, high) if fits else (low, middle)
    unit, scale = ("°", np.degrees(1.0)) if test.tilt else (" mm", 1.0)
    raise InputError(
        f"the object comes down to the connector at {max(travel, 0.0):.2f} mm of indentation, before the depth of "
        f"{test.depth:g} mm",
        key="contact.tilt_deg" if test.tilt else "contact.offset_mm",
        value=float(f"{scale * value:.9g}"),
        remedy=f"give at most {np.floor(100.0 * scale * low) / 100.0:g}{unit}, or a smaller indentation.depth_mm",
    )


def _free_travel(sensor: Sensor, probe: StrainProbe, free: FreeState) -> float:
    """Travel (mm) after first contact at which the lowest point of the object is at the connector's top."""
    test, base = sensor.protocol, sensor.dome.base
    leaning = test.plate_radius * np.sin(test.tilt) if test.body is None else 0.0
    top = base.ring_height if base is not None and test.body is None else 0.0
    return float(placed_press(sensor, probe, free).surface.height * probe.solid.length - leaning - top)


class _Curve(NamedTuple):
    """Force (N) and pressure rise (MPa) at indentations (mm) on equal steps of a range, and the greatest sideways force
    (N) of the sideways motion after it, None without one."""

    indentation: Array
    force: Array
    rise: Array
    peak: float | None = None

    @property
    def sensitivity(self) -> float | None:
        """Sensitivity (kPa/N) of the range; None if it is undetermined."""
        fit = figures(self.indentation, self.force, self.rise / KPA)
        return None if fit is None else fit.sensitivity


def _curve(sensor: Sensor, pressed: OffAxisPath) -> _Curve:
    """Curve of a press up to the end of its range."""
    grid = np.linspace(0.0, _range_end(sensor, pressed), sensor.protocol.steps + 1)
    return _Curve(grid, *curve_between(pressed.path, grid), None if pressed.shear is None else pressed.shear.peak)


def change(before: _Curve, after: _Curve) -> float:
    """Greatest of the relative changes from ``before`` to ``after`` in sensitivity, in force and pressure rise at the
    end of the common range, and in the greatest sideways force."""
    end = min(before.indentation[-1], after.indentation[-1])
    pairs = [
        (float(np.interp(end, before.indentation, old)), float(np.interp(end, after.indentation, new)))
        for old, new in ((before.force, after.force), (before.rise, after.rise))
    ]
    if before.sensitivity is not None and after.sensitivity is not None:
        pairs.append((before.sensitivity, after.sensitivity))
    if before.peak is not None and after.peak is not None:
        pairs.append((before.peak, after.peak))
    return max((abs(old / new - 1.0) for old, new in pairs if new), default=0.0)


def _change_from(press: OffAxisPress, coarse: int, pressed: OffAxisPath, sensor: Sensor) -> float:
    """`change` from a result with harmonics to order ``coarse``, which is solved only at a few states of the range; the
    difference of the curves is linear between them. Infinite if one of these states has no equilibrium."""
    after = _curve(sensor, pressed)
    inside = [s for s in pressed.path if s.indentation <= after.indentation[-1] * (1.0 + 1e-9)]
    chosen = [inside[round(k * (len(inside) - 1) / _COMPARED)] for k in range(1, _COMPARED + 1)]
    rough = press.coarser(coarse, chosen)
    if rough is None:
        return np.inf
    at = [0.0, *(s.indentation for s in chosen)]
    less = np.array([(f - s.force, p - s.rise) for (f, p), s in zip(rough, chosen, strict=True)])
    force, rise = (np.interp(after.indentation, at, np.append(0.0, part)) for part in less.T)
    return change(_Curve(after.indentation, after.force + force, after.rise + rise), after)


def placed_press(sensor: Sensor, probe: StrainProbe, free: FreeState) -> OffAxisPress:
    """Press of the sensor's test with its object in place, without the check of clearance."""
    press, test, solid = press_settings(sensor), sensor.protocol, probe.solid
    body = first_touch(solid, free, press.body, press.plate_diameter, press.plate_rim).body
    offset = test.offset / solid.length
    lying = test.body is not None and test.body.lying
    placed = LyingObject(body, offset) if lying else PlacedObject(body, offset, test.tilt)
    return OffAxisPress(solid, free, press, placed, probe, test.shear, _symmetric(sensor))


def _symmetric(sensor: Sensor) -> bool:
    """True if the scene has two planes of symmetry: a bar lies across the middle of the dome and stays there."""
    test = sensor.protocol
    return test.body is not None and test.body.lying and not test.offset and not test.shear


def _range_end(sensor: Sensor, pressed: OffAxisPath) -> float:
    """Indentation at which the range of a press ends, mm."""
    return min(range_end(reported_events(pressed.events), sensor.protocol.depth), pressed.path[-1].indentation)


def _record(
    sensor: Sensor, pressure: float, free: FreeState, press: OffAxisPress, pressed: OffAxisPath, last_change: float
) -> SensorState:
    """Record of one press for a prediction; ``last_change``: of the figures when the order was last raised."""
    happened, end = reported_events(pressed.events), _range_end(sensor, pressed)
    return SensorState(
        pressure,
        *free_figures(free),
        end,
        _figures(pressed, end, sensor.protocol.steps),
        *pressed_columns(pressed),
        events=tuple(happened),
        beyond_axis=OffAxisCurve(
            pressed.order,
            last_change,
            pressed.column("sideways"),
            pressed.column("moment"),
            _to_end(pressed, end),
            None if pressed.shear is None else _shear_curve(pressed.shear),
        ),
        face=partial(press.face(pressed, end).scaled, 1.0),
    )


def _to_end(pressed: OffAxisPath, end: float) -> RangeCurve:
    """Curve at `_READ` equal steps to the end of the range (mm), interpolated between the solved states."""
    grid = np.linspace(0.0, end, _READ + 1)
    return RangeCurve(grid, *curve_between(pressed.path, grid))


def _shear_curve(path: ShearPath) -> ShearCurve:
    names = ("travel", "force", "sideways", "moment", "rise", "sliding")
    columns: dict[str, Any] = {name: path.column(name) for name in names}
    return ShearCurve(**columns, stiffness=path.stiffness, peak=path.peak, slips_from=path.slips_from, ended=path.ended)


def _figures(pressed: OffAxisPath, end: float, steps: int) -> Figures[float] | None:
    """Figures on equal steps of the range, as many steps as for the solid."""
    grid = np.linspace(0.0, end, steps + 1)
    force, rise = curve_between(pressed.path, grid)
    return figures(grid, force, rise / KPA)
