"""The presses that the table of contact anywhere is made from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.stored_recipe import StoredRecipe


@dataclass(frozen=True)
class PlaceTableRecipe(StoredRecipe):
    """Nodes of the table, in units of R0 and mu.

    An object of curvature ``R0/a`` (a: its radius; 0: a plate) first touches the unloaded dome where the normal leans
    by an angle whose sine is its ``lean``: that of the tilt of a plate, or for a ball e/(Ro + a) by its offset e and
    the outer radius Ro. A wall ratio, a share of the limit pressure and a gas stiffness state the dome before contact.
    A reading is stated by the travel of the central plate that gives it, over R0: its ``level``.

    Central presses by the solid: every combination of walls, shares, gases and curvatures, default mesh. Presses with a
    lean, by the solid with harmonics to ``order`` on ``cells`` cells along the arc: every combination of leaning_walls,
    leaning_shares, leaning_curvatures and leans, at ``leaning_gas``; of these the table has the difference from the
    central press on the same mesh.

    Presses by the edge of a bar, whose curvature is that of its round nose and whose lean is a ball's, at
    ``leaning_gas`` on ``cells`` cells, with harmonics to ``edge_order``. Across the pole, with even harmonics: every
    combination of leaning_walls, leaning_shares and edge_curvatures; of these the table has the logarithm as a share of
    that of the central ball of half the curvature, which has the same mean curvature, and the highest level as a
    difference from that of the ball of the same. With a lean: every combination of edge_walls, edge_shares,
    edge_curvatures and leans; of these it has what the lean changes, less what it changes under a plate.
    """

    poisson_ratio: float = 0.49
    walls: tuple[float, ...] = (0.06, 0.11, 0.2, 0.35)
    shares: tuple[float, ...] = (0.0, 0.1, 0.25, 0.5, 0.9)
    gases: tuple[float, ...] = (0.01, 0.1, 0.6)
    curvatures: tuple[float, ...] = (0.5, 1.0, 2.0, 10.0 / 3.0)
    levels: tuple[float, ...] = (0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)
    leaning_walls: tuple[float, ...] = (0.06, 0.15, 0.35)
    leaning_shares: tuple[float, ...] = (0.0, 0.25, 0.9)
    leaning_curvatures: tuple[float, ...] = (0.0, 1.0, 10.0 / 3.0)
    leans: tuple[float, ...] = (0.44,)
    leaning_gas: float = 0.1
    order: int = 6
    edge_walls: tuple[float, ...] = (0.06, 0.35)
    edge_shares: tuple[float, ...] = (0.0, 0.9)
    edge_curvatures: tuple[float, ...] = (1.0, 10.0 / 3.0)
    edge_order: int = 8
    cells: int = 16
    depth: float = 0.75
    steps: int = 15


class NodeAxis(NamedTuple):
    """A direction of the table with its nodes (m,), ascending.

    Not by SciPy's `CubicHermiteSpline`, which gives the same: importing it takes 0.8 times the processor time of NumPy
    and `scipy.linalg`, and every datasheet reads the table.
    """

    nodes: Array

    def weights(self, at: Array) -> Array:
        """Weights (n, m) of the nodes for values at (n,): a cubic between two nodes through both, with the slopes that
        a parabola through each node and its neighbours has; a parabola with three nodes. The ends hold beyond."""
        x, size = self.nodes, self.nodes.size
        if size == 1:
            return np.ones((at.size, 1))
        at = np.clip(at, x[0], x[-1])
        slopes = np.gradient(np.eye(size), x, axis=0, edge_order=1 if size == 2 else 2)
        k = np.clip(np.searchsorted(x, at, side="right") - 1, 0, size - 2)
        span = x[k + 1] - x[k]
        t = (at - x[k]) / span
        one = np.eye(size)
        left, right = (t * (1 - t) ** 2 * span)[:, None], (t**2 * (t - 1) * span)[:, None]
        rise = (t**2 * (3 - 2 * t))[:, None]
        return np.asarray((1 - rise) * one[k] + rise * one[k + 1] + left * slopes[k] + right * slopes[k + 1])

    def straight(self, at: Array) -> Array:
        """Weights (n, m) of straight lines between the nodes; the ends hold beyond."""
        return np.asarray(np.stack([np.interp(at, self.nodes, row) for row in np.eye(self.nodes.size)], axis=-1))


RECIPE = PlaceTableRecipe()
