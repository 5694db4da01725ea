"""Press, hold and loop of a sensor at its driving pressures, for each relaxation series of its resin.

For a contact that the atlas does not cover, the press is followed in time by the solid.

The model is that of `runs`: p = p_I + int k(t - s) dP(s), F = int k(t - s) dF(s), with the wall pressure P and the
force F of the elastic dome. At each time the contribution of the past is known, so the elastic dome is filled by a gas
of pressure (p_gas(V) - past)/stiffness. It is one solid along the whole history of the plate: friction sticks, slips
and reverses as it would.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.models.choice import outside
from pneutouch.mechanics.models.solid import press_settings, solid_probe
from pneutouch.mechanics.paper_sensor import young_modulus
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.solid.continuation import LONGEST, PathFollower, PlateState
from pneutouch.mechanics.solid.elements import FillingState, Gas
from pneutouch.mechanics.solid.indent import follower_of, shut_in
from pneutouch.mechanics.solid.inflate import first_touch, inflate, state_at
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure
from pneutouch.mechanics.viscous.prony import Prony, prony_series, relaxed
from pneutouch.mechanics.viscous.runs import HOLD_TIMES, LoopRun, Memory, RelaxationRun, loop, loop_run, relaxation
from pneutouch.spec.material import Material

_RAMP_STEPS, _LOOP_STEPS = 20, 24
"""Numbers of steps of a ramp and of half a loop, at least half of those in `runs`: losses, widths and areas are
accurate to 0.3 percentage points, also with friction (`tests/mechanics/viscous/test_by_solid.py`)."""

_CUTS = 5
"""Number of times that a step without an equilibrium is halved."""


@dataclass(frozen=True)
class RelaxingGas:
    """Trapped gas as the filling of the elastic dome: its pressure minus ``past``, the contribution of the past, over
    ``stiffness``, that of the wall now relative to the relaxed wall."""

    gas: Gas
    past: float
    stiffness: float

    def at(self, volume: float) -> FillingState | None:
        """Potential, pressure and rate of the gas without the contribution of the past, over the stiffness."""
        known = self.gas.at(volume)
        if known is None:
            return None
        energy = known.energy + self.past * (volume - self.gas.start)
        return FillingState(
            energy / self.stiffness, (known.pressure - self.past) / self.stiffness, known.rate / self.stiffness
        )


class _Dome(NamedTuple):
    """A sensor with its relaxed modulus, inflated, with the plate at first contact (``top``); ``start`` is in MPa."""

    solid: SolidModel
    follower: PathFollower
    gas: Gas
    top: float
    start: float


class _Point(NamedTuple):
    """Time since first contact (s), travel (mm), force (N), pressure rise (MPa)."""

    time: float
    travel: float
    force: float
    rise: float


def relaxation_by_solid(
    sensor: Sensor, series: Sequence[Prony], driving_pressures: Sequence[float], depth: float, speed: float
) -> list[list[RelaxationRun]]:
    """Press by the solid to ``depth`` (mm) at ``speed`` (mm/s) and hold, with the object and friction of the sensor.

    Driving pressures in MPa; lists by pressure, then series. `runs.relaxation` does the same by the atlas.
    """
    return [[_relaxed(sensor, one, pressure, depth, speed) for one in series] for pressure in driving_pressures]


def loop_by_solid(
    sensor: Sensor, series: Sequence[Prony], driving_pressures: Sequence[float], depth: float, speed: float
) -> list[list[LoopRun]]:
    """Press and retract by the solid as `runs.loop` by the atlas, with the object and friction of the sensor."""
    return [[_loop_pressed(sensor, one, pressure, depth, speed) for one in series] for pressure in driving_pressures]


def _relaxed(sensor: Sensor, series: Prony, pressure: float, depth: float, speed: float) -> RelaxationRun:
    share = np.linspace(0.0, 1.0, _RAMP_STEPS + 1)[1:]
    clock = np.concatenate([share * depth / speed, depth / speed + HOLD_TIMES])
    travel = np.concatenate([share, np.ones(HOLD_TIMES.size)]) * depth
    points, ended = _Run(sensor, series, pressure).along(clock, travel)
    if ended is not None:
        ended = f"{ended} at {travel[len(points) - 1]:.2f} mm"
    held = points[1 + _RAMP_STEPS :]
    force, rise = (np.array([getattr(point, name) for point in held]) for name in ("force", "rise"))
    return RelaxationRun(HOLD_TIMES[: len(held)], force, rise, ended)


def _loop_pressed(sensor: Sensor, series: Prony, pressure: float, depth: float, speed: float) -> LoopRun:
    share = np.linspace(0.0, 1.0, _LOOP_STEPS + 1)
    travel = np.concatenate([share, share[-2::-1]]) * depth
    clock = np.linspace(0.0, 2.0 * depth / speed, travel.size)
    points, ended = _Run(sensor, series, pressure).along(clock[1:], travel[1:])
    force, rise = (np.array([getattr(point, name) for point in points]) for name in ("force", "rise"))
    whole = np.full((2, travel.size), np.nan)
    whole[:, : len(points)] = force, rise
    return loop_run(travel, whole[0], whole[1], len(points), ended)


class _Run:
    """One dome with memory, followed along a history of the plate."""

    def __init__(self, sensor: Sensor, series: Prony, pressure: float) -> None:
        self._dome = _dome(sensor, pressure)
        self._memory = Memory(series.excess[None, :], np.array([series.times]))
        self._limit = sensor.gas.gauge_limit
        start = self._dome.follower.here
        # At first contact the force is zero: the small value from the contact stiffness is rounding.
        self._before = np.array([[start.state.filling.pressure], [0.0]])
        self._now, self._down = _Point(0.0, 0.0, 0.0, 0.0), True

    def along(self, clock: Array, travel: Array) -> tuple[list[_Point], str | None]:
        """Points at first contact and at times (s) and travels (mm), to where contact is lost or the run ends; and the
        reason why it ended, None if it did not."""
        points = [self._now]
        for time, to in zip(clock.tolist(), travel.tolist(), strict=True):
            ended = self._reach(time, to)
            if ended is not None:
                return points, ended
            points.append(self._now)
            if self._now.force <= 0.0:
                # The plate would pull: contact is lost, and no equilibrium under the plate is searched.
                return points, None
        return points, None

    def _reach(self, time: float, travel: float, cuts: int = 0) -> str | None:
        """Go to a time (s) and travel (mm), in shorter steps if needed; the reason if the run ends there, else None."""
        here, dome = self._now, self._dome
        height = dome.top - travel / dome.solid.length
        if abs(travel - here.travel) > LONGEST * dome.solid.length * (1.0 + 1e-9):
            return self._halved(time, travel, cuts)
        if travel < here.travel and self._down:
            dome = self._dome = dome._replace(follower=dome.follower.turned())
            self._down = False
        decay, weight, stiffer = self._memory.step(np.array([time - here.time]))
        past = self._memory.left(decay) - stiffer * self._before
        stiffness = 1.0 + float(stiffer[0])
        dome.follower.feed(RelaxingGas(dome.gas, float(past[0, 0]), stiffness))
        solved = dome.follower.solve(height)
        if isinstance(solved, NewtonFailure) or not solved.stable:
            return self._halved(time, travel, cuts) if cuts < _CUTS else "no equilibrium found"
        self._keep(solved, time, travel, stiffness, past, (decay, weight))
        return "gauge range" if self._now.rise + dome.start > self._limit else None

    def _halved(self, time: float, travel: float, cuts: int) -> str | None:
        here = self._now
        middle = 0.5 * (here.time + time), 0.5 * (here.travel + travel)
        return self._reach(*middle, cuts + 1) or self._reach(time, travel, cuts + 1)

    def _keep(
        self, solved: PlateState, time: float, travel: float, stiffness: float, past: Array, step: tuple[Array, Array]
    ) -> None:
        dome = self._dome
        dome.follower.path.append(solved)
        now = np.array([[solved.state.filling.pressure], [solved.force]])
        self._memory.add(*step, now - self._before)
        self._before = now
        pressure, force = (stiffness * now + past)[:, 0].tolist()
        solid = dome.solid
        self._now = _Point(time, travel, force * solid.mu * solid.length**2, pressure * solid.mu - dome.start)


def _dome(sensor: Sensor, pressure: float) -> _Dome:
    solid = solid_probe(sensor).solid
    free = state_at(solid, pressure, inflate(solid, to_pressure=pressure))
    press = press_settings(sensor)
    touch = first_touch(solid, free, press.body, press.plate_diameter, press.plate_rim)
    follower = follower_of(solid, free, press, touch)
    return _Dome(solid, follower, shut_in(solid, free, press), touch.body.height, free.pressure)


RAMP_SPEED = 5.0
"""Speed of the press before the hold, mm/s: a choice, the paper gives none."""

LOOP_SPEEDS = (0.5, 5.0)
"""Speeds of the loops, mm/s: a choice, a slow and a fast hand."""

DEPTH_SHARE = 0.5
"""Depth over the inner height of the dome: a choice, the paper's relaxation test gives none. At greater depth, stiff
resins pressed fast buckle."""

_KERNEL = "one relaxation for all stresses of the resin, that of small strain; no temperature dependence"

BASIS = (
    "quasi-linear viscoelasticity on the atlas, gas isothermal and sealed; the inflated dome has relaxed before "
    "contact",
    _KERNEL,
)

SOLID_BASIS = (
    "quasi-linear viscoelasticity on the solid with its contact along the whole run, friction with its history; gas "
    "isothermal and sealed; the inflated dome has relaxed before contact",
    _KERNEL,
)
"""Model, in words, for a contact that the atlas does not cover."""


@dataclass(frozen=True)
class ViscousRuns:
    """Runs of one sensor: ``held[i][j]`` and ``loops[speed][i][j]`` at driving pressure i (MPa) for the series of
    ``sources[j]``; depth in mm, speed in mm/s. ``basis`` describes the model: `BASIS` or `SOLID_BASIS`.
    """

    sources: tuple[str, ...]
    driving_pressures: tuple[float, ...]
    depth: float
    held: list[list[RelaxationRun]]
    loops: dict[float, list[list[LoopRun]]]
    basis: tuple[str, ...] = BASIS


def describe(sensor: Sensor, material: Material, driving_pressures: Sequence[float], depth: float) -> ViscousRuns:
    """Runs of a sensor at driving pressures (MPa) to a depth (mm) for every relaxation series of its resin.

    `prony.unknown` must return None for the sensor and its resin. The solid follows a contact that the atlas does not
    cover; for the others, a series is left out if the atlas does not cover the sensor with that relaxed modulus.
    """
    kept, held, loops = [], [], []
    by_solid = sensor.protocol.other_contact is not None
    hold, cycle = (relaxation_by_solid, loop_by_solid) if by_solid else (relaxation, loop)
    for series in prony_series(material):
        relaxed_sensor = relaxed(sensor, material, series)
        if not by_solid and outside("atlas", relaxed_sensor) is not None:
            continue
        kept.append(series.source)
        held.append(hold(relaxed_sensor, [series], driving_pressures, depth, RAMP_SPEED))
        loops.append({v: cycle(relaxed_sensor, [series], driving_pressures, depth, v) for v in LOOP_SPEEDS})
    states = range(len(driving_pressures))
    return ViscousRuns(
        tuple(kept),
        tuple(driving_pressures),
        depth,
        [[one[i][0] for one in held] for i in states],
        {v: [[one[v][i][0] for one in loops] for i in states] for v in LOOP_SPEEDS},
        (*(SOLID_BASIS if by_solid else BASIS), *_glass(material)),
    )


def _glass(material: Material) -> list[str]:
    """Sentence on a transition to glass near the room's temperature; none for a resin without one that is known."""
    at = material.glass_transition_C
    near = "" if at is None else f"at {at.least:g} to {at.most:g} °C"
    then = "near it hysteresis may be over 30 %, and modulus and times change within a few kelvin"
    return [f"the membrane's resin turns to glass {near}: {then}"] if near else []


def chosen_depth(sensor: Sensor, range_ends: Sequence[float]) -> float:
    """Depth (mm) of the runs: `DEPTH_SHARE` of the dome's height, at most the test's depth and every ``range_ends``."""
    return float(min(DEPTH_SHARE * sensor.dome.shape.height, sensor.protocol.depth, *range_ends))


AGED = (
    "The ratio alone of Gent's relation of Shore A to modulus (Rubber Chem. Technol. 31, 896, 1958) is used, not its "
    "level; above Shore A 80, where the scale is compressed, it grows steep. Hardness is read in seconds and is "
    "applied to the relaxed modulus; what light and air harden may be a skin, and is taken as the whole wall"
)
"""Assumptions of the conversion from hardness to modulus, in words."""


def ageing_unknown(material: Material) -> str | None:
    """Reason why the change of the modulus in a year is not known, or None if it is."""
    if material.shore_a is None or material.shore_a_one_year is None:
        return f"the hardness of {material.title} after a year is not known"
    if material.law is not None:
        return f"{material.title} has a law of its own, whose constants hardness does not give"
    return None


def ageing_ratio(material: Material) -> float:
    """Shear modulus after a year in light and air over the fresh modulus, by hardness; `AGED` states the assumptions.

    Raises InputError for a resin without known ageing.
    """
    why = ageing_unknown(material)
    if why is not None:
        remedy = "give shore_a and shore_a_one_year in its material file, or leave `aged` out"
        raise InputError(f"aged: {why}", remedy=remedy)
    assert material.shore_a is not None and material.shore_a_one_year is not None
    fresh, aged = material.shore_a.nominal, material.shore_a_one_year.nominal
    return young_modulus(aged) / young_modulus(fresh)


def ageing_shift(sensor: Sensor, material: Material, driving_pressures: Sequence[float]) -> tuple[float, Array]:
    """Modulus after a year over the fresh one, by hardness, and the relative change of the sensitivity (n,) by it.

    By the atlas, at n driving pressures (MPa). Raises InputError if the resin's hardness after a year is not known.
    """
    ratio = ageing_ratio(material)
    old = sensor.replace(shear_modulus=ratio * sensor.wall.shear_modulus)
    before_kPa_per_N, after_kPa_per_N = (
        respond(batch_of(one, driving_pressures), one.protocol.steps).lines.sensitivity for one in (sensor, old)
    )
    return ratio, after_kPa_per_N / before_kPa_per_N - 1.0
