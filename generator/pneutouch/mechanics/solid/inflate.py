"""Free inflation of the solid by volume, through and beyond the limit point, and its state at a driving pressure.

Also the first contact of a plate or another rigid object with an inflated dome.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.elements import Liquid, Regulator
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import (
    NewtonFailure,
    NewtonResult,
    NoConvergenceError,
    SolidScene,
    SolverState,
    UnreachableLoadError,
    full_tangent,
    minimise,
    rank_one,
)
from pneutouch.mechanics.solid.object_contact import Indenter, Plate, first_contact, flat_radius, rim_radius

if TYPE_CHECKING:
    from pneutouch.mechanics.solid.indenter import RigidObject

#: Stiffness of volume control, in mu/R0^3: far above -dp/dV of any dome, so that the total tangent is definite.
_LIQUID = 30.0
_FIRST_GROWTH, _LARGEST_GROWTH, _SMALLEST_GROWTH = 0.10, 0.25, 1.0e-4
_EMPTYING = 0.02
_HEMISPHERE = 2.0 / 3.0 * np.pi
_MAX_STATES = 400


@dataclass(frozen=True)
class FreeState:
    """An inflated state without contact. positions: (n_nodes, 2), mm. pressure: gauge, MPa. volume: cavity, mm^3.

    stiffness: dp/dV, MPa/mm^3 (zero at the limit point). stable: True if stable under a regulated pressure. inner_apex,
    outer_apex: heights, mm. unit: the solver's state; by_volume: dx/dV (n_nodes, 2); both nondimensional.
    """

    positions: Array
    pressure: float
    volume: float
    stiffness: float
    stable: bool
    inner_apex: float
    outer_apex: float
    unit: SolverState
    by_volume: Array


@dataclass(frozen=True)
class Inflation:
    """States in order of volume, and the ``limit``: the state of largest pressure or, if the wall buckles before, the
    last stable one; None if neither was reached."""

    states: list[FreeState]
    limit: FreeState | None
    why_no_limit: str

    @cached_property
    def pressure(self) -> Array:
        """Gauge pressures in MPa, (n_states,)."""
        return np.array([s.pressure for s in self.states])

    @cached_property
    def volume(self) -> Array:
        """Cavity volumes in mm^3, (n_states,)."""
        return np.array([s.volume for s in self.states])


def free_state(solid: SolidModel, scene: SolidScene, outcome: NewtonResult) -> FreeState:
    """Record of a converged state, with dp/dV = 1/(g' K^-1 g) and the stability of K: K stiffness, g gradient of V."""
    state = outcome.state
    tangent = rank_one(state, full_tangent(scene, state), state.residual)
    compliance = float(state.by_volume @ tangent.soft)
    x = state.x * solid.length
    return FreeState(
        positions=x,
        pressure=state.filling.pressure * solid.mu,
        volume=state.volume * solid.length**3,
        stiffness=solid.mu / solid.length**3 / compliance,
        stable=tangent.wall_stable,
        inner_apex=float(x[solid.mesh.inner_apex, 1]),
        outer_apex=float(x[solid.mesh.outer_apex, 1]),
        unit=state,
        by_volume=solid.expand(tangent.soft) / compliance,
    )


def rest_state(solid: SolidModel) -> FreeState:
    """The unloaded dome, with its initial slope dp/dV. Raises NoConvergenceError."""
    scene = SolidScene(solid, Liquid(solid.cavity.volume(solid.rest), _LIQUID), None)
    outcome = minimise(scene, solid.rest)
    if isinstance(outcome, NewtonFailure):
        raise NoConvergenceError("0 kPa", outcome.why, "a mesh without distorted cells")
    return free_state(solid, scene, outcome)


def _guess(solid: SolidModel, path: list[FreeState], volume: float) -> Array:
    """Positions extrapolated to a volume (R0^3), by the last state's tangent or the last two's Hermite cubic."""
    last = path[-1].unit
    ahead = volume - last.volume
    if len(path) < 2:
        return last.x + ahead * path[-1].by_volume
    return between(path[-2], path[-1], volume)


def between(a: FreeState, b: FreeState, volume: float) -> Array:
    """Positions at a volume (R0^3) by the Hermite cubic in V through x and dx/dV of two states; may extrapolate."""
    span = b.unit.volume - a.unit.volume
    s = (volume - a.unit.volume) / span
    bend = b.unit.x - a.unit.x
    first, last = span * a.by_volume - bend, bend - span * b.by_volume
    return np.asarray(a.unit.x + s * bend + s * (1.0 - s) * ((1.0 - s) * first + s * last))


def pressure_between(a: FreeState, b: FreeState, share: float) -> float:
    """Pressure (MPa) on the Hermite cubic p(V) of two states; ``share`` of the volume between them: 0 at a, 1 at b."""
    span = b.volume - a.volume
    rise, first, last = b.pressure - a.pressure, a.stiffness * span, b.stiffness * span
    bow = (1.0 - share) * (first - rise) + share * (rise - last)
    return a.pressure + share * rise + share * (1.0 - share) * bow


def at_volume(
    solid: SolidModel, path: list[FreeState], volume: float, guess: Array | None = None
) -> FreeState | NewtonFailure:
    """State at a volume (R0^3), or the failure; ``guess``: positions (n_nodes, 2), None: extrapolated from ``path``."""
    last = path[-1]
    slope = last.stiffness * solid.length**3 / solid.mu
    pressure = last.unit.filling.pressure + slope * (volume - last.unit.volume)
    scene = SolidScene(solid, Liquid(volume + pressure / _LIQUID, _LIQUID), None)
    outcome = minimise(scene, _guess(solid, path, volume) if guess is None else guess)
    return outcome if isinstance(outcome, NewtonFailure) else free_state(solid, scene, outcome)


def inflate(
    solid: SolidModel,
    to_pressure: float | None = None,
    past_limit: float = 1.3,
    largest: float = 30.0,
    enough: Callable[[FreeState], bool] = lambda state: False,
) -> Inflation:
    """Fill (or, for a negative pressure, empty) the cavity by volume from rest.

    to_pressure: stop once this gauge pressure (MPa) or the limit point is reached; None: go on to ``past_limit`` times
    the limit point's volume. The path ends in any case at ``largest`` times the volume at rest, or a hemisphere's if
    that is more, and at the first state that is ``enough``. Raises NoConvergenceError where volume steps become too
    small before a limit point."""
    path = [rest_state(solid)]
    # The cavity behind a flat wall may be next to nothing: multiples of it say nothing of the wall.
    rest = max(path[0].unit.volume, _HEMISPHERE)
    sign = -1.0 if to_pressure is not None and to_pressure < 0.0 else 1.0
    growth, limit = _FIRST_GROWTH if sign > 0.0 else _EMPTYING, None
    while len(path) < _MAX_STATES:
        last = path[-1]
        ended = "" if enough(last) else _ended(path, limit, to_pressure, past_limit, largest * rest)
        if ended is not None:
            return Inflation(path, limit, ended)
        step = at_volume(solid, path, last.unit.volume * (1.0 + sign * growth))
        if isinstance(step, NewtonFailure) or (sign < 0.0 and _jumped(last, step)):
            growth *= 0.4
            if growth < _SMALLEST_GROWTH and sign < 0.0:
                return Inflation(path, last, "the wall snaps inwards: it buckles")
            if growth < _SMALLEST_GROWTH:
                why = step.why if isinstance(step, NewtonFailure) else ""
                if limit is not None:
                    return Inflation(path, limit, f"no equilibrium past {last.volume:.4g} mm3: {why}")
                raise NoConvergenceError(f"volume {last.volume:.4g} mm3", why, "a finer mesh")
            continue
        path.append(step)
        growth = min(1.3 * growth, _LARGEST_GROWTH if sign > 0.0 else _EMPTYING)
        if limit is None and last.stiffness > 0.0 >= step.stiffness:
            limit = find_limit(solid, last, step)
            path.insert(-1, limit)
        elif limit is None and last.stable and not step.stable:
            return Inflation(path, last, "another mode than the volume goes soft first: the wall buckles")
    return Inflation(path, limit, "too many volume steps")


def _jumped(a: FreeState, b: FreeState) -> bool:
    """True if a state lies on another branch than the one before: the mean slope of the pressure is below both ends'.
    The solver finds the dented dome where it steps over the buckling of the round one."""
    mean = (b.pressure - a.pressure) / (b.volume - a.volume)
    return mean < min(a.stiffness, b.stiffness) - 0.2 * abs(a.stiffness)


def _ended(
    path: list[FreeState], limit: FreeState | None, goal: float | None, past: float, largest: float
) -> str | None:
    """Reason why a volume path is finished, empty at or beyond its limit point as wanted; None: it goes on."""
    last = path[-1]
    if goal is not None and abs(last.pressure) >= abs(goal) and len(path) > 1:
        return "the driving pressure came first"
    if limit is not None and (goal is not None or last.unit.volume >= past * limit.unit.volume):
        return ""
    if last.unit.volume > largest:
        return f"the pressure still rises at {last.unit.volume / path[0].unit.volume:.3g} times the unloaded volume"
    return None


def find_limit(solid: SolidModel, before: FreeState, after: FreeState, tolerance: float = 1.0e-7) -> FreeState:
    """State with dp/dV = 0 between two states with slopes of opposite sign; volume to a relative ``tolerance``."""
    middle = before
    for _ in range(30):
        a, b = before.unit.volume, after.unit.volume
        middle = towards(solid, before, after, _slope_root(before, after))
        moved = abs(middle.stiffness) * abs(b - a) <= tolerance * (abs(before.stiffness) + abs(after.stiffness)) * a
        if moved or abs(b - a) < tolerance * a:
            return middle
        before, after = (middle, after) if middle.stiffness > 0.0 else (before, middle)
    return middle


def towards(solid: SolidModel, before: FreeState, after: FreeState, volume: float) -> FreeState:
    """State at a volume (R0^3) between two states, or nearer to ``before`` if that does not converge."""
    start, share = before.unit.volume, 1.0
    while True:
        at = start + share * (volume - start)
        solved = at_volume(solid, [before], at, between(before, after, at))
        if not isinstance(solved, NewtonFailure):
            return solved
        share *= 0.4
        if share * (volume - start) < _SMALLEST_GROWTH * start:
            raise NoConvergenceError("the limit point", solved.why, "a finer mesh")


def _slope_root(before: FreeState, after: FreeState) -> float:
    """Volume (R0^3) at which the Hermite cubic p(V) through two states has its maximum."""
    a, b = before.unit.volume, after.unit.volume
    scale = after.volume - before.volume
    rise, first, last = after.pressure - before.pressure, before.stiffness * scale, after.stiffness * scale
    roots = np.roots([3.0 * (first + last - 2.0 * rise), 2.0 * (3.0 * rise - 2.0 * first - last), first])
    inside = [float(r.real) for r in roots if abs(r.imag) < 1e-12 and 0.0 < r.real < 1.0]
    share = inside[0] if inside else first / (first - last)
    # A larger share would creep towards a limit next to one end.
    return a + (b - a) * float(np.clip(share, 1.0e-4, 1.0 - 1.0e-4))


def state_at(solid: SolidModel, pressure: float, inflation: Inflation | None = None) -> FreeState:
    """The first state at a driving pressure (gauge, MPa) on the rising branch; ``inflation`` is reused, if given.

    Raises UnreachableLoadError at or beyond the limit point, or where the inflation ends before.
    """
    if pressure == 0.0:
        return inflation.states[0] if inflation else rest_state(solid)
    done = inflation or inflate(solid, to_pressure=pressure)
    beyond = done.limit is not None and abs(pressure) >= abs(done.limit.pressure)
    for a, b in zip(done.states, done.states[1:], strict=False):
        if beyond or a.stiffness <= 0.0:
            break
        if min(a.pressure, b.pressure) <= pressure <= max(a.pressure, b.pressure):
            return _between(solid, a, b, pressure)
    limit = done.limit or max(done.states, key=lambda s: abs(s.pressure))
    why = done.why_no_limit or "it lies beyond the limit point"
    raise UnreachableLoadError(pressure, limit.pressure, why)


def _between(solid: SolidModel, a: FreeState, b: FreeState, pressure: float) -> FreeState:
    """State at a regulated pressure (MPa) by Newton's method, from the Hermite cubic between two states around it."""
    share = np.linspace(0.0, 1.0, 201)
    curve = np.array([pressure_between(a, b, float(s)) for s in share])
    up = 1.0 if b.pressure > a.pressure else -1.0
    near = float(np.interp(up * pressure, up * curve, share))
    guess = between(a, b, a.unit.volume + near * (b.unit.volume - a.unit.volume))
    scene = SolidScene(solid, Regulator(pressure / solid.mu), None)
    outcome = minimise(scene, guess)
    if isinstance(outcome, NewtonFailure):
        raise NoConvergenceError(
            f"driving pressure {1e3 * pressure:.4f} kPa", outcome.why, "a pressure further below the limit"
        )
    return free_state(solid, scene, outcome)


class FirstTouch(NamedTuple):
    """An object at its first contact with the free dome, and the ``radius`` of that contact, 0 for a plate; in R0."""

    body: Indenter
    radius: float = 0.0


def first_touch(
    solid: SolidModel,
    free: FreeState,
    body: "RigidObject | None",
    plate_diameter: float | None,
    plate_rim: float | None = None,
) -> FirstTouch:
    """First contact of ``body`` (None: a plate) with a free state; lengths in mm as in `indent.PressSettings`."""
    length, longest = solid.length, np.array(solid.contact.longest)
    if body is None:
        radius = np.array(np.inf if plate_diameter is None else 0.5 * plate_diameter / length)
        apex = float(free.positions[solid.mesh.outer, 1].max()) / length
        rim = rim_radius(radius, longest, None if plate_rim is None else plate_rim / length)
        return FirstTouch(Plate(apex, float(flat_radius(radius, rim)), float(rim)))
    scaled = body.scaled(1.0 / length)
    r, z = solid.contact.outline(free.positions / length)
    height, at = first_contact(scaled, r, z)
    return FirstTouch(scaled.at(height), at)
