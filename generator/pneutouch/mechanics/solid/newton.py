"""Newton's method on the total energy of wall, filling and contact, with an energy line search.

The line search also serves Newton's method with friction.

A solve that fails returns a `NewtonFailure`; its callers try again or raise the ComputationErrors defined here.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol, TypeVar

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.errors import BeyondLimitError, ComputationError
from pneutouch.mechanics.solid.banded import negative_pivots, solve, solve_definite
from pneutouch.mechanics.solid.elements import EnergyTerm, FillingState, Supply, TermState
from pneutouch.mechanics.solid.model import PointFields, SolidModel
from pneutouch.mechanics.solid.object_contact import ContactEvaluation, Indenter

_ARMIJO = 1.0e-4
_SHORTEST = 1.0e-6


class _Balanced(Protocol):
    """A state with the gradient of its energy."""

    @property
    def residual(self) -> Array:
        """Gradient (size,)."""
        ...


State = TypeVar("State", bound=_Balanced)


def line_search(
    trial: Callable[[float], tuple[float, Callable[[], State]] | None], step: Array, slope: float, noise: float
) -> State | None:
    """Backtrack from the full step until the energy satisfies Armijo's condition; returns the state, or None.

    trial(share): change of the energy at a share of the step and a function that returns the state there; None if that
    state is impossible. slope: derivative of the energy along ``step`` (size,), negative. Where the change is below the
    rounding error ``noise``, near convergence, a step that lowers the slope is accepted too."""
    share = 1.0
    while share > _SHORTEST:
        tried = trial(share)
        if tried is None:
            share *= 0.4
            continue
        drop, completed = tried
        if drop <= _ARMIJO * share * slope:
            return completed()
        if abs(drop) <= noise:
            after = completed()
            if abs(float(step @ after.residual)) <= 0.9 * abs(slope):
                return after
        curve = 2.0 * (drop - share * slope)
        share = float(np.clip(-slope * share * share / curve, 0.1 * share, 0.5 * share)) if curve > 0.0 else 0.3 * share
    return None


#: Converged if the unbalanced force is below this share of the forces that balance (wall, gas, plate)
RESIDUAL = 1.0e-9
#: and the energy still to be gained, estimated from the last step, is below this share of the energy scale.
GAIN = 1.0e-14
STALLED = 0.1  #: A residual of which a step leaves more than this share may be rounding alone.
MAX_ITERATIONS = 40
#: Number of rounds in which the set of touching points is settled inside one quadratic model.
SETTLING = 10


@dataclass(frozen=True)
class SolidScene:
    """A body, its filling, the plate above it (None without plate) and further energy terms; nondimensional."""

    solid: SolidModel
    supply: Supply
    plate: Indenter | None
    terms: tuple[EnergyTerm, ...] = ()


@dataclass(frozen=True)
class SolverState:
    """Positions x (n_nodes, 2) with all quantities evaluated there; nondimensional.

    residual: gradient of the total energy (size,); inner: its part without the plate; scale: magnitude of the balancing
    forces; by_volume: gradient of the cavity volume (size,); touch: None without plate; terms: those of the supports,
    then of the scene.
    """

    x: Array
    energy: float
    residual: Array
    inner: Array
    scale: float
    local: PointFields
    volume: float
    by_volume: Array
    filling: FillingState
    touch: ContactEvaluation | None
    terms: tuple[TermState, ...] = ()


@dataclass(frozen=True)
class NewtonDirection:
    """Solution of one tangent system K + c g g', g the gradient of the volume and c the stiffness of the filling.

    step: the solution (size,); soft: K^-1 g; denominator: 1 + c g'K^-1 g; stable: K + c g g' is positive definite;
    wall_stable: K is; lift: amount added to the diagonal of K for a descent direction.
    """

    step: Array
    soft: Array
    denominator: float
    stable: bool
    wall_stable: bool
    lift: float = 0.0


@dataclass(frozen=True)
class NewtonResult:
    """A converged state, and the number of iterations."""

    state: SolverState
    iterations: int


@dataclass(frozen=True)
class NewtonFailure:
    """Failure of Newton's method to converge: the reason in words, and the number of steps, 0 if not counted."""

    why: str
    iterations: int = 0


def evaluate(scene: SolidScene, x: Array) -> SolverState | None:
    """State with energy and residual at x; None if a point of the wall is inverted or the volume is impossible."""
    solid = scene.solid
    local = solid.local(x)
    if not np.isfinite(local.energy):
        return None
    volume, edge_gradient = solid.cavity.gradient(x)
    filling = scene.supply.at(volume)
    if filling is None:
        return None
    touch = None if scene.plate is None else solid.contact.touch(x, scene.plate)
    by_volume = solid.faces.inner.vector([edge_gradient])
    inner = solid.pattern.vector([solid.forces(local), -filling.pressure * edge_gradient])
    push = 0.0 * inner if touch is None else solid.faces.push(solid.contact.force(touch.traction, touch.slope))
    load = abs(filling.pressure) * float(np.linalg.norm(by_volume)) + float(np.linalg.norm(push))
    noise = solid.noise if touch is None else solid.noise + solid.contact.noise
    acting = (*solid.supports, *scene.terms)
    terms = tuple(term.at(x) for term in acting)
    for term, there in zip(acting, terms, strict=True):
        inner = inner + there.gradient
        load += float(np.linalg.norm(there.gradient))
        noise += term.noise
    scale = load + 1.0e-3 * solid.wall + 10.0 * noise / RESIDUAL
    energy = local.energy + filling.energy + (0.0 if touch is None else touch.energy) + sum(t.energy for t in terms)
    return SolverState(x, energy, inner + push, inner, scale, local, volume, by_volume, filling, touch, terms)


def tangent(scene: SolidScene, state: SolverState) -> Array:
    """Lower band of the stiffness of wall, follower pressure and terms, without plate and the filling's stiffness."""
    solid = scene.solid
    load = -state.filling.pressure * solid.cavity.hessian(state.x)
    band = solid.pattern.matrix([solid.stiffness(state.local), load])
    for term in state.terms:
        faces, all_blocks = solid.faces, (term.blocks, term.inner_blocks, term.fold_blocks)
        for pattern, blocks in zip((faces.outer, faces.inner, faces.fold), all_blocks, strict=True):
            if blocks is not None and pattern is not None:
                band = pattern.added(band, [blocks])
    return band


def full_tangent(scene: SolidScene, state: SolverState) -> Array:
    """`tangent` with the plate's contact stiffness at the state's touching points."""
    band = tangent(scene, state)
    return band if state.touch is None else with_contact(scene, band, state.touch, state.touch.traction > 0.0)


def with_contact(scene: SolidScene, band: Array, touch: ContactEvaluation, active: Flags) -> Array:
    """Copy of ``band`` with the plate's contact stiffness added at the ``active`` points (n_edges, n_points)."""
    return scene.solid.faces.outer.added(band, [scene.solid.contact.hessian(touch, active)])


def direction(scene: SolidScene, state: SolverState) -> NewtonDirection:
    """Newton step: minimum of the quadratic model of wall and filling, with the contact of the plate settled in it.

    The touching points are settled inside the model, where a change costs one banded solve and no assembly; the outer
    steps then converge as without contact, and full steps pass the line search. The model is convex, with a kink in the
    slope where a point comes or goes: each round goes to the minimum for one set of touching points or, if another set
    holds there, only to the minimum of the model on the way, so that no two sets alternate for ever.
    """
    band = tangent(scene, state)
    if state.touch is None:
        return downhill(state, band, state.residual)
    touch, contact, push = state.touch, scene.solid.contact, scene.solid.faces.push
    linear = start = contact.linear(touch, np.zeros_like(state.x))
    step, pull = np.zeros_like(state.residual), state.inner
    for _ in range(SETTLING):
        active = linear > 0.0
        load = state.inner + push(contact.force(np.where(active, start, 0.0), touch.slope))
        newton = downhill(state, with_contact(scene, band, touch, active), load)
        if newton.lift:
            # The lift that made this tangent definite is kept for the other rounds: fewer failed factorisations.
            band = band.copy(order="F")
            band[0] += newton.lift
            pull = pull + newton.lift * step
        ahead = contact.linear(touch, scene.solid.expand(newton.step))
        if ((ahead > 0.0) == active).all():
            return newton
        # At the solution the tractions of the touching points balance the forces of wall and filling.
        pull_ahead = -push(contact.force(np.where(active, ahead, 0.0), touch.slope))
        move = newton.step - step
        share = contact.least_share(linear, ahead, float(move @ pull), float(move @ pull_ahead))
        step, pull = step + share * move, pull + share * (pull_ahead - pull)
        linear = linear + share * (ahead - linear)
    return replace(newton, step=step)


DirectionFinder = Callable[[SolidScene, SolverState], NewtonDirection]


def stability(
    scene: SolidScene, state: SolverState, load: Array | None = None, band: Array | None = None
) -> NewtonDirection:
    """Step -(K + c g g')^-1 `load` at a converged state, and its stability; `load` (size,), None: the residual.

    ``band``: the full tangent K, None: computed. K can be indefinite and K + c g g' definite, since the filling
    stiffens one mode: negatives(K + c g g') = negatives(K) - [1 + c g'K^-1 g < 0], from the inertia of the bordered
    matrix.
    """
    band = full_tangent(scene, state) if band is None else band
    newton = rank_one(state, band, state.residual if load is None else load)
    if newton.wall_stable or not newton.stable:
        return newton
    return replace(newton, stable=negative_pivots(band) == 1)


def rank_one(state: SolverState, band: Array, load: Array) -> NewtonDirection:
    """Step -(band + c g g')^-1 load by Sherman-Morrison; an indefinite band is taken to have one negative pivot."""
    solved = solve(band, np.stack([-load, state.by_volume], axis=1))
    plain, soft = solved.x[:, 0], solved.x[:, 1]
    rate = state.filling.rate
    denominator = 1.0 + rate * float(state.by_volume @ soft)
    step = plain - soft * (rate * float(state.by_volume @ plain) / denominator)
    stable = solved.definite or (denominator < 0.0 and bool(np.isfinite(step).all()))
    return NewtonDirection(step, soft, denominator, stable, solved.definite)


def downhill(state: SolverState, band: Array, residual: Array) -> NewtonDirection:
    """The Newton step if the tangent is positive definite, else a descent step of a tangent with raised diagonal."""
    newton = rank_one(state, band, residual)
    if newton.stable and float(newton.step @ residual) <= 0.0:
        return newton
    step, lift = _safe_step(state, band, residual)
    return replace(newton, step=step, stable=False, lift=lift)


def _safe_step(state: SolverState, band: Array, residual: Array) -> tuple[Array, float]:
    """Descent step and the lift of the diagonal that makes the tangent definite; -residual and 0 if no lift does."""
    lift = float(np.abs(band[0]).mean()) * 1.0e-4
    rhs = np.stack([-residual, state.by_volume], axis=1)
    for _ in range(12):
        raised = band.copy(order="F")
        raised[0] += lift
        solution = solve_definite(raised, rhs)
        if solution is not None:
            plain, soft = solution.T
            rate = state.filling.rate
            share = rate * float(state.by_volume @ plain) / (1.0 + rate * float(state.by_volume @ soft))
            return np.asarray(plain - soft * share), lift
        lift *= 8.0
    return -residual, 0.0


def minimise(
    scene: SolidScene, x: Array, max_iterations: int = MAX_ITERATIONS, find: DirectionFinder = direction
) -> NewtonResult | NewtonFailure:
    """Minimum of the total energy near x (n_nodes, 2): the converged state, or the failure with its reason.

    ``find`` computes the Newton step at a state.
    """
    state = evaluate(scene, x)
    if state is None:
        return NewtonFailure("the starting guess turns the wall inside out")
    left, share, before, size = np.inf, 0.0, None, float(np.linalg.norm(state.residual))
    for iteration in range(max_iterations):
        if left <= GAIN * (state.local.energy + state.scale * scene.solid.wall) and (
            size <= RESIDUAL * state.scale or (share > STALLED and size <= rounding(scene, state))
        ):
            return NewtonResult(state, iteration)
        if before is not None:
            mixed = scene.solid.mixed(before.local, state.local, state.x - before.x)
        newton = find(scene, state if before is None else replace(state, local=mixed))
        slope = float(newton.step @ state.residual)
        if slope >= 0.0 and scene.plate is not None:
            newton = downhill(state, full_tangent(scene, state), state.residual)
            slope = float(newton.step @ state.residual)
        if not np.isfinite(slope) or slope >= 0.0:
            return NewtonFailure(f"the Newton step does not go downhill (slope {slope:.2e})")
        moved = _search(scene, state, newton.step, slope)
        if moved is None:
            return NewtonFailure("no step along the Newton direction lowers the energy")
        # The gain of a Newton step is proportional to the square of the residual at its start.
        last, size = size, float(np.linalg.norm(moved.residual))
        share = size / max(last, 1.0e-300)
        before, state, left = state, moved, -slope * share**2
    return NewtonFailure(f"residual {size / state.scale:.1e} after {max_iterations} iterations")


def rounding(scene: SolidScene, state: SolverState) -> float:
    """Norm of the residual that rounded positions leave: of the stiffness times the rounding error of each of them.
    Newton's method stalls at 0.2 to 0.5 of it, whatever shape, wall and Poisson's ratio are."""
    band, dofs = tangent(scene, state), scene.solid.dofs
    place = np.zeros(band.shape[1])
    place[dofs[dofs >= 0]] = state.x[dofs >= 0]
    square = band[0] ** 2 + 2.0 * (band[1:] ** 2).sum(axis=0)
    return float(np.finfo(np.float64).eps * np.sqrt(square @ place**2))


def _search(scene: SolidScene, state: SolverState, step: Array, slope: float) -> SolverState | None:
    """State at the end of a line search along ``step`` (size,); None if no share of it lowers the energy."""
    move = scene.solid.expand(step)
    noise = 1.0e-13 * (abs(state.energy) + state.local.energy + scene.solid.wall)

    def trial(share: float) -> tuple[float, Callable[[], SolverState]] | None:
        there = evaluate(scene, state.x + share * move)
        return None if there is None else (there.energy - state.energy, lambda: there)

    return line_search(trial, step, slope, noise)


class NoConvergenceError(ComputationError):
    """No equilibrium met the tolerances, even after every cutback.

    load:   the load that could not be reached, in words with its unit.
    why:    behaviour of the last attempt.
    advice: advised change.
    """

    def __init__(self, load: str, why: str, advice: str) -> None:
        super().__init__(f"no equilibrium at {load}: {why}", remedy=f"try {advice}")
        self.load, self.why, self.advice = load, why, advice


class UnreachableLoadError(BeyondLimitError):
    """A driving pressure beyond the pressure that the dome can carry.

    pressure: the requested pressure.  limit: the largest pressure with an equilibrium; both gauge, MPa.
    """

    def __init__(self, pressure: float, limit: float, why: str) -> None:
        text = f"a driving pressure of {1e3 * pressure:.4f} kPa cannot be carried: {why} (limit {1e3 * limit:.4f} kPa)"
        super().__init__(pressure, limit, text)
