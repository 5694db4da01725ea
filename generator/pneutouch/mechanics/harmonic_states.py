"""The model ``harmonic``: the solid with Fourier sums around its axis, for objects off the axis and leaning plates."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError, InputError
from pneutouch.mechanics.events import range_end
from pneutouch.mechanics.harmonic.press import OffAxisPath, OffAxisPress
from pneutouch.mechanics.harmonic.surface import PlacedObject
from pneutouch.mechanics.models import HARMONICS_SETTLED
from pneutouch.mechanics.prediction import ModelResult, OffAxisCurve, SensorState
from pneutouch.mechanics.response import Figures, figures
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.solid.first_touch import first_touch
from pneutouch.mechanics.solid.inflate import FreeState, Inflation, state_at
from pneutouch.mechanics.solid.stress import StrainProbe
from pneutouch.mechanics.solid_states import curve_between, press_settings, reported_events, solid_result
from pneutouch.units import KPA

ORDERS = (4, 6, 8, 12)
"""Orders of the harmonics, raised until the figures settle."""


def harmonic_result(sensor: Sensor, driving_pressures: Array) -> ModelResult:
    """Inflate as the solid does, then press at every driving pressure (MPa, ascending) off the axis.

    Raises ComputationError where no equilibrium is found, or where the figures do not settle.
    """
    return solid_result(sensor, driving_pressures, pressed_state=_state)


def _state(sensor: Sensor, probe: StrainProbe, run: Inflation, pressure: float) -> SensorState:
    free = state_at(probe.solid, pressure, run)
    _check_clearance(sensor, probe, free)
    press = _press(sensor, probe, free)
    if sensor.protocol.off_axis is None:
        return _record(sensor, pressure, free, press.run(0), 0.0)
    guide = press.run(ORDERS[0])
    before, changes = _record(sensor, pressure, free, guide, np.inf), []
    for order in ORDERS[1:]:
        guide = press.run(order)
        after = _record(sensor, pressure, free, guide, np.inf)
        changes.append(change(before, after))
        if changes[-1] <= HARMONICS_SETTLED:
            return _record(sensor, pressure, free, guide, changes[-1])
        before = after
    steps = ", ".join(f"{c:.1%} from {a} to {b}" for c, (a, b) in zip(changes, pairwise(ORDERS), strict=True))
    raise ComputationError(
        f"at {pressure / KPA:g} kPa the figures do not settle with {ORDERS[-1]} harmonics around the axis: "
        f"sensitivity, force or pressure change by {steps}",
        remedy="try a smaller depth, offset or tilt",
    )


def _check_clearance(sensor: Sensor, probe: StrainProbe, free: FreeState) -> None:
    """Raise InputError for an object that would come down to the connector within the depth."""
    test = sensor.protocol
    travel = _free_travel(sensor, probe, free)
    if test.off_axis is None or travel > test.depth:
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
    """Travel after first contact at which the lowest point of the object is at the connector, mm."""
    test, base = sensor.protocol, sensor.dome.base
    leaning = test.plate_radius * np.sin(test.tilt) if test.body is None else 0.0
    top = base.ring_height if base is not None and test.body is None else 0.0
    return float(_press(sensor, probe, free).surface.height * probe.solid.length - leaning - top)


def change(before: SensorState, after: SensorState) -> float:
    """Greatest relative change of sensitivity, and of force and pressure rise at the end of the common range."""
    end = min(before.range_end, after.range_end)
    pairs = [
        tuple(float(np.interp(end, state.indentation, getattr(state, name))) for state in (before, after))
        for name in ("force", "pressure_rise")
    ]
    if before.figures is not None and after.figures is not None:
        pairs.append((before.figures.sensitivity_kPa_per_N, after.figures.sensitivity_kPa_per_N))
    return max((abs(old / new - 1.0) for old, new in pairs if new), default=0.0)


def _press(sensor: Sensor, probe: StrainProbe, free: FreeState) -> OffAxisPress:
    """The sensor's test with its object in place."""
    press, test, solid = press_settings(sensor), sensor.protocol, probe.solid
    body = first_touch(solid, free, press.body, press.plate_diameter, press.plate_rim).body
    placed = PlacedObject(body, test.offset / solid.length, test.tilt)
    return OffAxisPress(solid, free, press, placed, probe)


def _record(sensor: Sensor, pressure: float, free: FreeState, pressed: OffAxisPath, last_change: float) -> SensorState:
    """The state of a sensor as a prediction has it."""
    test, happened = sensor.protocol, reported_events(pressed.events)
    end = min(range_end(happened, test.depth), pressed.path[-1].indentation)
    return SensorState(
        driving_pressure=pressure,
        apex_inner=free.inner_apex,
        apex_outer=free.outer_apex,
        cavity_volume=free.volume,
        range_end=end,
        figures=_figures(pressed, end, test.steps),
        indentation=pressed.column("indentation"),
        force=pressed.column("force"),
        pressure_rise=pressed.column("rise"),
        contact_radius=pressed.column("contact_radius"),
        max_stretch=pressed.column("stretch"),
        events=tuple(happened),
        beyond_axis=OffAxisCurve(pressed.order, last_change, pressed.column("sideways"), pressed.column("moment")),
    )


def _figures(pressed: OffAxisPath, end: float, steps: int) -> Figures | None:
    """Figures of the range, on the same equal steps of it as the solid's."""
    grid = np.linspace(0.0, end, steps + 1)
    force, rise = curve_between(pressed.path, grid)
    return figures(grid, force, rise / KPA)
