"""The place at which a press loses its stability to waves around the axis, between two states of its path."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from pneutouch.mechanics.solid.banded import softest
from pneutouch.mechanics.solid.continuation import PlateState
from pneutouch.mechanics.solid.newton import NewtonFailure, SolverState, minimise
from pneutouch.mechanics.solid.second_variation import HarmonicSolid, unstable_waves

#: Accuracy of the height of a loss, in R0.
_WITHIN = 5.0e-4
_SETTLED = 6.0
_MOST_SOLVES = 12


def onset(harmonic: HarmonicSolid, path: list[PlateState], n: int) -> float:
    """Plate height (R0) at which a part of a path, whose last state is unstable to n waves, loses its stability."""
    stable, unstable = 0, len(path) - 1
    if unstable_waves(harmonic, path[0].state, (n,)):
        return path[0].height
    while unstable - stable > 1:
        middle = (stable + unstable) // 2
        if unstable_waves(harmonic, path[middle].state, (n,)):
            unstable = middle
        else:
            stable = middle
    return _located(harmonic, n, path[max(0, unstable - 2) : unstable + 1])


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
