"""The model ``membrane``: the paper's theory for a sensor, inflated (state I) and pressed (state II)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, bisected
from pneutouch.errors import InputError
from pneutouch.mechanics.events import Event, range_end
from pneutouch.mechanics.membrane import (
    LIMIT_HEIGHT,
    PressedStates,
    TrappedGas,
    height_errors,
    limit_point,
    limit_point_errors,
    limits,
    press,
    pressure,
    relative_height,
    thickness_stretch,
)
from pneutouch.mechanics.models.interface import Answered, Limitation, ModelAnswer, SensorModel, one_by_one
from pneutouch.mechanics.prediction import Held, InflationCurve, ModelResult, SensorState
from pneutouch.mechanics.response import figures
from pneutouch.mechanics.sensor import Filling, Sensor
from pneutouch.results.prediction import ErrorEstimate
from pneutouch.shape.hemisphere import no_hemisphere
from pneutouch.units import KPA
from pneutouch.wording import data_of

_NEAR_BASE = 0.98
"""Contact radius over R0 at which the contact reaches the base: beyond it no space is left for the free arc."""

_NO_LAW = Limitation("it covers neither other laws, nor a clamped flange", False)


@dataclass(frozen=True)
class MembraneTheory(SensorModel):
    """The paper's theory with one of the closures of `mechanics.membrane`."""

    closure: str = "variational"

    name = "membrane"
    correctable = False

    def covers(self, sensor: Sensor) -> str | None:
        """Reason why the theory does not cover a sensor (other contact or shape, graded wall), or None if it does."""
        graded = None if sensor.wall.grade is None else "the wall is graded along its arc"
        return sensor.protocol.other_contact or no_hemisphere(sensor.dome.shape) or graded

    def answer(self, sensors: Sequence[Sensor], driving_pressures: Sequence[Array]) -> list[Answered]:
        """Answers in closed form; a law and a flange are ignored, which the answer states as its limitation."""
        return one_by_one(self._answer, sensors, driving_pressures)

    def errors(self, sensor: Sensor, driving_pressures: Array) -> ErrorEstimate:
        """Errors of the inflated cap (state I) against the exact membrane."""
        return error_against_exact_membrane(sensor, driving_pressures)

    def assumptions(self, sensor: Sensor) -> tuple[str, ...]:
        """Assumptions of the theory."""
        return tuple(data_of(__file__)["assumptions"])

    def closed(self, closure: str) -> SensorModel:
        """The theory with another closure."""
        return MembraneTheory(closure)

    def filled(self, sensor: Sensor, fillings: Sequence[Filling]) -> tuple[SensorState, ...]:
        """States on the closed form, which goes on to any height. Raises InputError for suction, which it lacks."""
        at_rest = float(cap_volume(np.array(sensor.dome.inner_radius), sensor.dome.inner_radius))
        heights = [_filled_height(sensor, one, at_rest) for one in fillings]
        states = _states(sensor, np.array(heights), self.closure)
        injected = (sensor.gas.injected(s.driving_pressure, s.cavity_volume, at_rest) for s in states)
        return tuple(
            replace(s, held=Held(float(v), x < LIMIT_HEIGHT, _is_sealed(sensor, x)))
            for s, v, x in zip(states, injected, heights, strict=True)
        )

    def _answer(self, sensor: Sensor, driving_pressures: Array) -> ModelAnswer:
        plain = sensor.wall.law is None and sensor.dome.flange is None
        states = membrane_states(sensor, driving_pressures, self.closure)
        result = ModelResult(limit_point(sensor), limits(sensor), inflation_curve(sensor), states)
        return ModelAnswer(result, None if plain else _NO_LAW)


MODEL = MembraneTheory()


def error_against_exact_membrane(sensor: Sensor, driving_pressures: Array) -> ErrorEstimate:
    """Relative errors by constant curvature in state I at driving pressures (MPa); of the heights the greatest."""
    limit_pressure, limit_height = limit_point_errors()
    scale = sensor.dome.inner_radius / (sensor.wall.shear_modulus * sensor.dome.wall_thickness)
    heights = height_errors(driving_pressures * scale)
    greatest = float(heights[np.argmax(np.abs(heights))])
    return ErrorEstimate(
        sensitivity_relative=None,
        limit_pressure_relative=limit_pressure,
        limit_apex_height_relative=limit_height,
        apex_height_relative=greatest,
        summary=(
            f"Against the exact membrane: limit pressure {limit_pressure:+.1%}, apex height there {limit_height:+.1%}, "
            f"apex heights at the driving pressures up to {greatest:+.1%}.",
        ),
    )


_FINE = 8
"""Number of points per step at which events are searched."""


def inflation_curve(sensor: Sensor) -> InflationCurve:
    """Inflation curve on both branches of the closed form, to 1.8 times the height of the limit point."""
    x = np.concatenate([np.linspace(1.0, LIMIT_HEIGHT, 60), np.linspace(LIMIT_HEIGHT, 1.8 * LIMIT_HEIGHT, 60)[1:]])
    apex = x * sensor.dome.inner_radius
    outer = apex + thickness_stretch(x) * sensor.dome.wall_thickness
    driving = pressure(x, sensor.dome.inner_radius, sensor.dome.wall_thickness, sensor.wall.shear_modulus)
    return InflationCurve(apex, outer, cap_volume(apex, sensor.dome.inner_radius), driving)


def cap_volume(apex: Array, radius: float) -> Array:
    """Volume (mm3) of a spherical cap of height ``apex`` (mm) on a base circle of ``radius`` (mm)."""
    return np.asarray(np.pi / 6 * apex * (3 * radius**2 + apex**2))


def membrane_states(sensor: Sensor, driving_pressures: Array, closure: str) -> tuple[SensorState, ...]:
    """States at every driving pressure (MPa, ascending), pressed in ``protocol.steps`` equal steps, by a named closure.

    Figures are fitted on as many equal steps up to the first event that ends the range, so that they do not jump when
    an event passes a step.
    """
    dome, modulus = sensor.dome, sensor.wall.shear_modulus
    x = relative_height(driving_pressures, dome.inner_radius, dome.wall_thickness, modulus)
    return _states(sensor, x, closure, driving_pressures)


def _states(sensor: Sensor, x: Array, closure: str, driving_pressures: Array | None = None) -> tuple[SensorState, ...]:
    """States at relative heights ``x`` = h/R0, whose driving pressures are computed if they are None."""
    radius, thickness = sensor.dome.inner_radius, sensor.dome.wall_thickness
    if driving_pressures is None:
        driving_pressures = pressure(x, radius, thickness, sensor.wall.shear_modulus)
    apex = x * radius
    volume = cap_volume(apex, radius)
    gas = TrappedGas(driving_pressures[:, None], volume[:, None], sensor.gas.dead_volume, sensor.gas.ambient_pressure)

    def pressed(indentation: Array) -> PressedStates:
        return press(sensor, gas, apex[:, None], indentation, closure)

    fine = np.linspace(0.0, sensor.protocol.depth, _FINE * sensor.protocol.steps + 1)
    curve = pressed(fine)
    happened = [_events(sensor, fine, curve.row(k), closure) for k in range(len(apex))]
    ends = np.array([range_end(passed, sensor.protocol.depth) for passed in happened])
    grid = np.linspace(0.0, 1.0, sensor.protocol.steps + 1) * ends[:, None]
    fitted = pressed(grid)
    outer = apex + thickness_stretch(x) * thickness
    return tuple(
        SensorState(
            driving_pressure=float(p),
            apex_inner=float(apex[k]),
            apex_outer=float(outer[k]),
            cavity_volume=float(volume[k]),
            range_end=float(ends[k]),
            figures=figures(grid[k], fitted.force[k], (fitted.pressure[k] - p) / KPA),
            indentation=fine[::_FINE],
            force=curve.force[k, ::_FINE],
            pressure_rise=curve.pressure[k, ::_FINE] - p,
            contact_radius=curve.contact_radius[k, ::_FINE],
            max_stretch=curve.thickness_stretch[k, ::_FINE] ** -0.5,
            events=tuple(happened[k]),
        )
        for k, p in enumerate(driving_pressures)
    )


_HIGHEST = 100.0
"""Greatest height h/R0 at which a filling is looked for: the wall is stretched 70 times its length there."""


def _filled_height(sensor: Sensor, filling: Filling, at_rest: float) -> float:
    """Height h/R0 at a filling, to 1e-12; the first where the gas is not monotone in the height."""
    dome, modulus = sensor.dome, sensor.wall.shear_modulus

    def excess(x: Array) -> Array:
        if filling.kind == "apex":
            return np.asarray(x * dome.inner_radius + thickness_stretch(x) * dome.wall_thickness - filling.value)
        driving = pressure(x, dome.inner_radius, dome.wall_thickness, modulus)
        volume = cap_volume(x * dome.inner_radius, dome.inner_radius)
        return np.asarray(sensor.gas.injected(driving, volume, at_rest) - filling.value)

    x = np.geomspace(1.0, _HIGHEST, 2000)
    over = np.flatnonzero(excess(x) >= -_ROUNDING)
    if not over.size or excess(x[:1])[0] > _ROUNDING:
        problem = "the membrane theory covers neither suction nor such heights"
        raise InputError(problem, key="model", value="membrane", remedy="take `model` solid")
    k = max(int(over[0]), 1)
    return float(bisected(excess, x[k - 1], x[k]))


_ROUNDING = 1e-9
"""Injected gas (mm3) and height (mm) below which the dome is at rest."""


def _is_sealed(sensor: Sensor, x: float) -> bool:
    """True if the amount of gas rises with the height: shut in, it holds the dome at h/R0 = ``x``."""
    near = x * np.array([1 - 1e-6, 1 + 1e-6])
    driving = pressure(near, sensor.dome.inner_radius, sensor.dome.wall_thickness, sensor.wall.shear_modulus)
    volume = cap_volume(near * sensor.dome.inner_radius, sensor.dome.inner_radius)
    return bool(np.diff(sensor.gas.injected(driving, volume, 0.0))[0] > 0.0)


def _events(sensor: Sensor, indentation: Array, pressed: PressedStates, closure: str) -> list[Event]:
    """The events of one pressed curve, in the order of the plate's travel."""
    stretch, radius, gauge = pressed.thickness_stretch**-0.5, pressed.contact_radius, sensor.gas.gauge_limit
    beyond_gauge = f"the cavity pressure leaves the gauge's range of {1e3 * gauge:g} kPa"
    at_base = "the contact reaches the base circle, where a cap of constant curvature ends"
    slack = "the wall is shorter than unloaded: a real membrane wrinkles, this theory does not"
    margins: list[tuple[str, Array, bool, str]] = [
        ("gauge range", pressed.pressure - gauge, True, beyond_gauge),
        ("plate edge", radius - sensor.protocol.plate_radius, True, "the contact reaches the edge of the plate"),
        ("contact at base", radius - _NEAR_BASE * sensor.dome.inner_radius, True, at_base),
        ("slack wall", 1 - 1e-9 - stretch, False, slack),
    ]
    if sensor.wall.break_stretch is not None:
        text = f"the stretch reaches the resin's least elongation at break, {sensor.wall.break_stretch - 1:.0%}"
        margins.append(("break strain", stretch - sensor.wall.break_stretch, True, text))
    if closure == "printed":
        falling = np.concatenate([[-1.0], -np.diff(pressed.contact_radius)])
        text = "the contact radius falls as the plate advances: the printed equations describe no contact"
        margins.append(("contact radius falls", falling, True, text))
    happened = [
        Event(kind, _crossing(indentation, margin), ends, text)
        for kind, margin, ends, text in margins
        if np.any(margin[1:] > 0)
    ]
    return sorted(happened, key=lambda event: event.indentation)


def _crossing(indentation: Array, margin: Array) -> float:
    """Indentation (mm) at which ``margin`` turns positive, by linear interpolation between points (n,)."""
    after = int(np.argmax(margin > 0)) if margin[0] <= 0 else 1 + int(np.argmax(margin[1:] > 0))
    before, here = margin[after - 1], margin[after]
    if before > 0 or here == before:
        return float(indentation[after - 1])
    share = -before / (here - before)
    return float(indentation[after - 1] + share * (indentation[after] - indentation[after - 1]))
