"""Balance of a wall, by finite elements, and a soft object, by the influence functions of its surface.

Unknown are the wall's positions and the forces at its points of contact. Newton's method takes the points that touch
from the step before: a point whose force would pull leaves, one that would pass through the surface touches (the
primal-dual active set strategy: Hintermueller, Ito & Kunisch 2002, SIAM J. Optim. 13, 865,
doi:10.1137/S1052623401383558).
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.soft.body import RingCompliance, SoftBody
from pneutouch.mechanics.solid.banded import solve
from pneutouch.mechanics.solid.elements import Supply
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene, SolverState, evaluate, tangent
from pneutouch.mechanics.solid.object_contact import FacePoints, Indenter

_ITERATIONS, _SMALL = 30, 1e-8
"""Most Newton steps, and the last one's displacement over R0."""

_LARGEST = 0.15
"""Greatest displacement in one Newton step, R0: longer ones turn the wall inside out."""

_AROUND, _LEAST_REACH = 1.6, 4.0
"""Factor from one reach, the radius up to which points may touch, to the next; the first over the longest edge."""

_CLOSE = 0.85
"""Radius of a contact over the reach from which on the reach grows."""


@dataclass(frozen=True)
class SoftState:
    """Wall and object in balance at a ``travel`` of the object since first contact; nondimensional (R0, mu).

    forces, radii: on the wall's points of contact, and of these, (n_edges, n_points).  by_travel: dx/dtravel (n_nodes,
    2).  stiffness, pressure_rate: dF/dtravel and dp/dtravel.
    """

    travel: float
    state: SolverState
    forces: Array
    radii: Array
    by_travel: Array
    stiffness: float
    pressure_rate: float


@dataclass(frozen=True)
class SoftScene:
    """A wall with its filling under a soft ``body``, at rest as the object ``touching`` is at first contact."""

    solid: SolidModel
    supply: Supply
    body: SoftBody
    touching: Indenter

    @cached_property
    def points(self) -> FacePoints:
        """Points of contact: two an edge, as many as an edge has free nodes, so that each force is determined."""
        return FacePoints(self.solid.mesh.outer, self.solid.rest, 1.0, points=2)

    @cached_property
    def widths(self) -> Array:
        """Widths (n_edges, n_points) of the rings that the points stand for, at rest; nondimensional."""
        return np.asarray(self.points.weight / (2.0 * np.pi * self.points.positions(self.solid.rest)[0]))

    def rings(self, radii: Array, which: Index | Flags, reach: float) -> RingCompliance:
        """Rings of the points ``which``, of ``radii`` (n_edges, n_points) within ``reach``, on the object."""
        length = self.solid.length
        return RingCompliance(
            self.body, length * radii.ravel()[which], length * self.widths.ravel()[which], reach * length
        )

    def under(self, travel: float, r: Array) -> tuple[Array, Array, Array]:
        """Height of the surface at rest at radii r, at a travel, and its two derivatives; nondimensional."""
        return self.touching.at(self.touching.height - travel).underside(r)


def balance(scene: SoftScene, travel: float, start: Array, forces: Array) -> SoftState | None:
    """Balance at a travel (R0), from positions ``start`` (n_nodes, 2) and the forces on the points of a state nearby, 0
    at first contact; None if none is found."""
    free, x, before = SolidScene(scene.solid, scene.supply, None), start, None
    touching = forces > 0.0
    r = scene.points.positions(start)[0]
    # In few sizes: the integrals over the object's surface must not change with the points that touch.
    reach, touched = _LEAST_REACH * scene.solid.contact.longest, float(r[touching].max(initial=0.0))
    while _CLOSE * reach < touched:
        reach *= _AROUND
    for _ in range(_ITERATIONS):
        state = evaluate(free, x)
        if state is None:
            return None
        local = state.local if before is None else scene.solid.mixed(before.local, state.local, x - before.x)
        system = _LinearSystem(scene, free, replace(state, local=local), travel, forces, touching, reach)
        step, forces, now = system.step()
        moved = float(np.abs(step).max())
        if not np.isfinite(moved):
            return None
        if moved < _SMALL and (now == touching).all():
            if not system.widens(now):
                return system.finished(travel)
            reach *= _AROUND
        before, touching = state, now
        x = x + step * min(1.0, _LARGEST / moved)
    return None


class _LinearSystem:
    """The equations of balance, linear in a step from one state, for a set of touching points.

    With r the gradient of the wall's and the filling's energy, g the gaps, B their derivatives, f the forces and D the
    compliance of the object: K dx - B'f = -r and B dx + D f = -g.
    """

    def __init__(
        self,
        scene: SoftScene,
        free: SolidScene,
        state: SolverState,
        travel: float,
        forces: Array,
        touching: Flags,
        reach: float,
    ) -> None:
        self._scene, self._free, self._state, self._points = scene, free, state, scene.points
        solid = scene.solid
        r, z = scene.points.positions(state.x)
        self._reach = reach
        under, slope, bend = scene.under(travel, r)
        self._radii, gap = r, under - z
        if not touching.any():
            touching = gap <= gap.min()
        self._near: Index = np.flatnonzero((r <= reach) | touching)
        self._touching = touching.ravel()[self._near]
        self._passes = bool((np.delete(gap.ravel(), self._near) < 0.0).any())
        self._gap, self._force = gap.ravel()[self._near], forces.ravel()[self._near]
        self._rings = scene.rings(r, self._near, reach)
        self._compliance = self._rings.matrix * solid.mu * solid.length
        self._bend = bend.ravel()[self._near]
        self._slopes = self._rings.slopes * solid.mu * solid.length**2
        self._lean = slope.ravel()[self._near] + self._slopes @ self._force

    def _points_by_dofs(self, coordinate: int) -> Array:
        """Derivatives (n, size) of one coordinate of the points, 0 r or 1 z, by the free unknowns."""
        solid, points = self._scene.solid, self._points
        edge, point = np.divmod(self._near, len(points.shape))
        dofs = solid.dofs[points.edges[edge], coordinate]
        # Fixed unknowns have the number -1: the last column.
        rows = np.zeros((len(edge), solid.size + 1))
        np.add.at(rows, (np.arange(len(edge))[:, None], dofs), points.shape[point])
        return rows[:, :-1]

    @cached_property
    def _rows(self) -> Array:
        """Derivatives (n, size) of the gaps by the free unknowns; a point that moves outwards also moves its force."""
        return np.asarray(self._lean[:, None] * self._outwards - self._points_by_dofs(1) + self._moved)

    @cached_property
    def _outwards(self) -> Array:
        return self._points_by_dofs(0)

    @cached_property
    def _moved(self) -> Array:
        """Part of `_rows` by forces that move with their points."""
        return np.asarray((self._slopes.T * self._force) @ self._outwards)

    def _answers(self, loads: Array) -> Array:
        """Displacements (size, n) of the wall with its filling, and with its forces that turn, by loads (size, n)."""
        state, force = self._state, self._force[self._touching]
        outwards = self._outwards[self._touching]
        # The wall alone may be unstable where the contact holds it: `solve` takes an indefinite matrix too.
        solved = solve(tangent(self._free, state), np.column_stack([loads, outwards.T, state.by_volume])).x
        plain, soft = solved[:, :-1], solved[:, -1]
        rate = state.filling.rate
        plain = plain - np.outer(soft, rate * (state.by_volume @ plain) / (1.0 + rate * (state.by_volume @ soft)))
        asked, spread = plain[:, : loads.shape[1]], plain[:, loads.shape[1] :]
        unit, at = self._scene.solid.mu * self._scene.solid.length, np.ix_(self._touching, self._touching)
        turning = -self._rings.curving(self._force * unit * self._scene.solid.length)[at] / unit
        turning[np.diag_indices_from(turning)] -= force * self._bend[self._touching]
        moved = np.linalg.solve(np.eye(len(force)) + turning @ outwards @ spread, turning @ outwards @ asked)
        return np.asarray(asked - spread @ moved)

    @cached_property
    def _solved(self) -> tuple[Array, Array]:
        """Answers to unit forces at the touching points and to the residual (size, n + 1), and the matrix of forces."""
        rows = self._rows[self._touching]
        # The residual holds the forces before as they are, without what they would do by moving.
        unbalanced = self._state.residual + self._moved.T @ self._force
        answers = self._answers(np.column_stack([rows.T, unbalanced]))
        compliance = self._compliance[np.ix_(self._touching, self._touching)]
        return answers, np.asarray(rows @ answers[:, :-1] + compliance, dtype=np.float64)

    def _at(self, gap: Array, residual: float) -> tuple[Array, Array]:
        """Step (size,) and forces at the touching points for gaps there, and a share of the residual."""
        answers, matrix = self._solved
        loaded = residual * answers[:, -1]
        forces = np.asarray(np.linalg.solve(matrix, self._rows[self._touching] @ loaded - gap), dtype=np.float64)
        return answers[:, :-1] @ forces - loaded, forces

    def step(self) -> tuple[Array, Array, Flags]:
        """Displacement (n_nodes, 2), and forces and touching points (n_edges, n_points) after it."""
        moved, pushed = self._at(self._gap[self._touching], 1.0)
        forces = np.zeros(len(self._near))
        forces[self._touching] = pushed
        gaps = self._gap + self._rows @ moved + self._compliance @ forces
        now = np.where(self._touching, forces > 0.0, gaps < 0.0)
        return self._scene.solid.expand(moved), self._all(np.maximum(forces, 0.0)), self._all(now) > 0.0

    def widens(self, touching: Flags) -> bool:
        """True if the contact comes close to the reach, beyond which no point may touch, or a point passes there."""
        return self._passes or bool(self._radii[touching].max(initial=0.0) > _CLOSE * self._reach)

    def _all(self, values: Array) -> Array:
        out = np.zeros(self._radii.size)
        out[self._near] = values
        return out.reshape(self._radii.shape)

    def finished(self, travel: float) -> SoftState:
        """The balance, with its changes by the travel: the gaps then close by as much."""
        moved, pushed = self._at(-np.ones(int(self._touching.sum())), 0.0)
        rate = -self._state.filling.rate * float(moved @ self._state.by_volume)
        forces = self._all(self._force)
        return SoftState(
            travel, self._state, forces, self._radii, self._scene.solid.expand(moved), float(pushed.sum()), rate
        )
