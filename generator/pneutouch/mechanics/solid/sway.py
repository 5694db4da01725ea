"""Loss of stability of the axisymmetric path under the plate: sway (one wave around the axis) and lobes (several)."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from pneutouch.mechanics.solid.banded import is_definite, softest
from pneutouch.mechanics.solid.continuation import PlateState
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, SolverState, minimise
from pneutouch.mechanics.solid.second_variation import HarmonicSolid

#: Greatest number of waves around the axis that is checked.
MOST_WAVES = 8
#: Plate travel between checked states, in R0; a loss between two of them is searched in the states between.
_TRAVEL = 0.25
#: Accuracy of the height of a loss, in R0.
_WITHIN = 5.0e-4
_SETTLED = 6.0
_MOST_SOLVES = 12


@dataclass(frozen=True)
class AxisymmetryLoss:
    """Plate height (R0) below which the axisymmetric path is unstable to n ``waves`` around the axis."""

    waves: int
    height: float


@lru_cache(maxsize=1)
def _variation(solid: SolidModel) -> HarmonicSolid:
    """Second variation of a solid; kept, because all presses of one solid check its stability."""
    return HarmonicSolid(solid)


def unstable_waves(harmonic: HarmonicSolid, state: SolverState, numbers: tuple[int, ...]) -> tuple[int, ...]:
    """Numbers of waves, among those given, for which the second variation at a state is not positive definite."""
    return tuple(n for n, band in harmonic.bands(state, numbers).items() if not is_definite(band))


def round_waves(solid: SolidModel, state: SolverState, most: int = MOST_WAVES) -> tuple[int, ...]:
    """Numbers of waves, 1 to ``most``, to which a state without contact is unstable; empty: it stays round."""
    return unstable_waves(_variation(solid), state, tuple(range(1, most + 1))) if most else ()


def axisymmetry_losses(solid: SolidModel, path: list[PlateState], most: int = MOST_WAVES) -> list[AxisymmetryLoss]:
    """Losses of stability of a path from first contact down: the first to one wave, the first to 2 to ``most`` waves.

    States are checked at every quarter of R0 of plate travel, and the last one. A loss between two of these is
    bracketed by bisection over the states in between, and located by solving for states between neighbours.
    """
    harmonic = _variation(solid)
    losses: list[AxisymmetryLoss] = []
    watched, reached = tuple(range(1, most + 1)), 0
    for k, state in enumerate(path):
        if not watched:
            break
        if k < len(path) - 1 and path[reached].height - state.height < _TRAVEL:
            continue
        lost = unstable_waves(harmonic, state.state, watched)
        for kind in ((1,), tuple(n for n in watched if n > 1)):
            onsets = [_onset(harmonic, path[reached : k + 1], n) for n in lost if n in kind]
            if onsets:
                losses.append(max(onsets, key=lambda loss: loss.height))
                watched = tuple(n for n in watched if n not in kind)
        reached = k
    return losses


def _onset(harmonic: HarmonicSolid, path: list[PlateState], n: int) -> AxisymmetryLoss:
    """Loss of stability to n waves in a part of a path whose last state is unstable."""
    stable, unstable = 0, len(path) - 1
    if unstable_waves(harmonic, path[0].state, (n,)):
        return AxisymmetryLoss(n, path[0].height)
    while unstable - stable > 1:
        middle = (stable + unstable) // 2
        if unstable_waves(harmonic, path[middle].state, (n,)):
            unstable = middle
        else:
            stable = middle
    return AxisymmetryLoss(n, _located(harmonic, n, path[max(0, unstable - 2) : unstable + 1]))


def _located(harmonic: HarmonicSolid, n: int, path: list[PlateState]) -> float:
    """Plate height at which the lowest eigenvalue for n waves passes zero between the last two states of a path."""
    before, after = path[-2:]
    span = before.height - after.height
    values = {(before.height - s.height) / span: softest(harmonic.bands(s.state, (n,))[n]).value for s in path}

    def solve(share: float) -> SolverState | None:
        return _between(before, after, before.height - share * span)

    return before.height - span * _root(harmonic, n, values, solve, _WITHIN / span)


def _root(
    harmonic: HarmonicSolid,
    n: int,
    values: dict[float, float],
    solve: Callable[[float], SolverState | None],
    within: float,
) -> float:
    """Share of the path from a stable state (0) to an unstable one (1) at which the lowest eigenvalue is zero.

    By inverse quadratic interpolation of the ``values`` at known shares, or bisection if that leaves the bracket, to
    ``within``. ``solve`` gives the state at a share; if it gives None, the last estimate is returned."""
    known, low, high, guess = len(values), 0.0, 1.0, 1.0
    for _ in range(_MOST_SOLVES):
        last, guess = guess, _zero(values)
        if not low < guess < high:
            guess = 0.5 * (low + high)
        # An interpolation that moves its estimate little has an error that is much smaller still.
        if high - low < within or (len(values) > known and abs(guess - last) < _SETTLED * within):
            break
        state = solve(guess)
        if state is None:
            break
        mode = softest(harmonic.bands(state, (n,))[n])
        values[guess] = mode.value
        low, high = (guess, high) if mode.definite else (low, guess)
    return guess


def _zero(values: dict[float, float]) -> float:
    """Place of a zero, by inverse interpolation of the three ``values`` (by place) nearest 0; nan if two are equal."""
    near = sorted(values.items(), key=lambda pair: abs(pair[1]))[:3]
    places, at = np.array([pair[0] for pair in near]), np.array([pair[1] for pair in near])
    total = 0.0
    for k, place in enumerate(places):
        others = np.delete(at, k)
        if (others == at[k]).any():
            return float("nan")
        total += float(place * np.prod(others / (others - at[k])))
    return total


def _between(before: PlateState, after: PlateState, height: float) -> SolverState | None:
    """State at a plate height (R0) between two neighbours on the path; None if no equilibrium is found."""
    plate = after.scene.plate
    assert plate is not None
    span = before.height - after.height
    share = (before.height - height) / span
    bend = after.state.x - before.state.x
    first, last = -span * before.by_height - bend, bend + span * after.by_height
    guess = before.state.x + share * bend + share * (1.0 - share) * ((1.0 - share) * first + share * last)
    scene = replace(after.scene, plate=plate.at(height))
    for start in (guess, after.state.x, before.state.x):
        solved = minimise(scene, np.asarray(start))
        if not isinstance(solved, NewtonFailure):
            return solved.state
    return None
