"""The plain methods: what one writes first, each correct on paper, each known to fail.

They work on the package's own elements, gas and plate (its energy and its exact tangent), so that what fails is the
method and not the model. Everything is nondimensional: lengths over R0, stresses over mu.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.solid.banded import solve
from pneutouch.mechanics.solid.elements import IntegrationScheme, Regulator, Supply
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene, SolverState, evaluate, full_tangent

Converged = Callable[[SolverState], bool]

#: Plain displacement elements: four-node cells, two by two points, J taken at every point (order=1 in `dome`).
DISPLACEMENT = IntegrationScheme(gauss=2, pressure=4)


@dataclass(frozen=True)
class Fate:
    """How a plain solve ended.

    end: converged, inside out (a point of the wall inverted), unfinished (iterations used up) or cycles (an earlier
    iterate came back). x: the last positions. period: length of the cycle.
    """

    end: str
    iterations: int
    x: Array
    period: int = 0


def balanced(state: SolverState) -> bool:
    """Unbalanced force below 1e-9 of the forces that balance."""
    return float(np.linalg.norm(state.residual)) <= 1e-9 * state.scale


def below(newtons: float, solid: SolidModel) -> Converged:
    """An absolute tolerance in N, as many codes have it."""
    unit = solid.mu * solid.length**2
    return lambda state: float(np.linalg.norm(state.residual)) * unit <= newtons


def newton(scene: SolidScene, x: Array, converged: Converged = balanced, most: int = 40) -> Fate:
    """Full steps with the exact tangent, no line search; x (n_nodes, 2)."""
    for iteration in range(most):
        state = evaluate(scene, x)
        if state is None:
            return Fate("inside out", iteration, x)
        if converged(state):
            return Fate("converged", iteration, x)
        plain, soft = solve(full_tangent(scene, state), np.stack([-state.residual, state.by_volume], axis=1)).x.T
        rate, g = state.filling.rate, state.by_volume
        x = x + scene.solid.expand(plain - soft * (rate * (g @ plain) / (1.0 + rate * (g @ soft))))
    return Fate("unfinished", most, x)


def load_control(solid: SolidModel, first: float, smallest: float) -> list[tuple[float, Array]]:
    """Raise the regulated pressure (in mu) by `first`, halving the step on failure until it is below `smallest`.

    Returns pressures and positions of the converged states.
    """
    path, step = [(0.0, solid.rest)], first
    while abs(step) >= smallest:
        pressure = path[-1][0] + step
        fate = newton(SolidScene(solid, Regulator(pressure), None), path[-1][1])
        if fate.end == "converged":
            path.append((pressure, fate.x))
        else:
            step *= 0.5
    return path


def active_set(solid: SolidModel, supply: Supply, height: float, x: Array, most: int = 60) -> Fate:
    """Node-wise contact with an endless plate at `height`: after every Newton step the set of nodes is corrected.

    A node that passed the plate is put on it, a node that the plate would have to pull is let go. A recurring
    iterate with a set seen before proves that it goes on for ever.
    """
    nodes = np.unique(solid.mesh.outer)
    nodes = nodes[solid.dofs[nodes, 1] >= 0]
    up = solid.dofs[nodes, 1]
    scene, held = SolidScene(solid, supply, None), x[nodes, 1] > height
    seen: list[tuple[Array, Array]] = []
    for iteration in range(most):
        state = evaluate(scene, x)
        if state is None:
            return Fate("inside out", iteration, x)
        x = x + solid.expand(_held_step(scene, state, up[held], height - x[nodes[held], 1]))
        state = evaluate(scene, x)
        if state is None:
            return Fate("inside out", iteration, x)
        update = np.where(held, state.residual[up] < 0.0, x[nodes, 1] > height + 1e-12)
        rest = np.delete(state.residual, up[held])
        if (update == held).all() and float(np.linalg.norm(rest)) <= 1e-9 * state.scale:
            return Fate("converged", iteration, x)
        for back, (old, was) in enumerate(reversed(seen), start=1):
            if (was == update).all() and not (update == held).all() and np.abs(old - x).max() < 1e-9:
                return Fate("cycles", iteration, x, back)
        seen.append((x, update))
        held = update
    return Fate("unfinished", most, x)


def _held_step(scene: SolidScene, state: SolverState, dofs: Array, move: Array) -> Array:
    """Newton step (size,) with the unknowns `dofs` moved by `move`."""
    band = full_tangent(scene, state)
    n = band.shape[1]
    k = state.filling.rate * np.outer(state.by_volume, state.by_volume)
    for offset, row in enumerate(band):
        i = np.arange(n - offset)
        k[i + offset, i] += row[: n - offset]
        if offset:
            k[i, i + offset] += row[: n - offset]
    step = np.zeros(n)
    step[dofs] = move
    free = np.setdiff1d(np.arange(n), dofs)
    step[free] = np.linalg.solve(k[np.ix_(free, free)], (-state.residual - k @ step)[free])
    return step
