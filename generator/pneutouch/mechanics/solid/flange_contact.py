"""Contact of the outer wall with the free top of its own flange: both give, which couples their nodes."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.solid.base_contact import BaseLoad
from pneutouch.mechanics.solid.contact import Contact
from pneutouch.mechanics.solid.elements import line_shapes
from pneutouch.mechanics.solid.mesh import SolidMesh
from pneutouch.mechanics.solid.terms import TermState

_POINTS = 3
_ROOT_STEPS = 30
_ROOT = 1.0e-14


class _Body(Protocol):
    """Part of a `SolidModel` that its flange uses: this file cannot import the model, which imports this file."""

    mesh: SolidMesh
    rest: Array
    size: int
    contact: Contact

    def folded(self, blocks: Array) -> Array:
        """Sum (size,) of vectors on the rows of `meeting_nodes`, (n_edges, 2 (3 + n_top))."""
        ...


class _Touch(NamedTuple):
    """Place on the top under each point of the wall, and the traction there, (n_edges, n_points) each."""

    place: Array
    traction: Array


def meeting_nodes(mesh: SolidMesh) -> Index:
    """Nodes that the contact couples, (n_edges, 3 + n_top): of each edge of the outer wall that is no further from its
    foot than the flange is wide, and those of the flange's top; no rows without a flange."""
    top = top_nodes(mesh)
    if top.size == 0:
        return np.zeros((0, 3), np.intp)
    foot = mesh.nodes[top[0]]
    width = mesh.nodes[top[-1], 0] - foot[0]
    near = mesh.outer[np.hypot(*(mesh.nodes[mesh.outer[:, 0]] - foot).T) < width]
    return np.concatenate([near, np.broadcast_to(top, (near.shape[0], top.size))], axis=1)


def top_nodes(mesh: SolidMesh) -> Index:
    """Nodes of the flange's top from the foot of the wall to the rim, (n_top,)."""
    if mesh.flange.size == 0:
        return np.zeros(0, np.intp)
    return np.append(mesh.flange[:, [0, 2]].ravel(), mesh.flange[-1, 1])


class FlangeContact:
    """psi = (k/2) sum w <-g>^2 on the outer wall near its foot; an `EnergyTerm`.

    g is the height of a point of the wall over the top of the flange at the same radius. The top is the natural cubic
    spline through its nodes: with a tangent that turns steadily, the energy is once continuously differentiable.
    """

    noise = 0.0

    def __init__(self, solid: _Body) -> None:
        self._solid, self._stiffness = solid, solid.contact.stiffness
        nodes = meeting_nodes(solid.mesh)
        self._edges, self._top = nodes[:, :3], nodes[0, 3:]
        x, w = np.polynomial.legendre.leggauss(_POINTS)
        self._shape, slope = line_shapes(x, 3)
        line = solid.rest[self._edges]
        measure = np.hypot(line[..., 0] @ slope.T, line[..., 1] @ slope.T) * w
        self._weight = 2.0 * np.pi * (line[..., 0] @ self._shape.T) * measure
        self._spline = cardinal_splines(self._top.size)

    def at(self, x: Array) -> TermState:
        """Energy and its derivatives at positions x (n_nodes, 2)."""
        solid, met = self._solid, self._meet(x)
        if met is None:
            return TermState(0.0, np.zeros(solid.size))
        energy = float(np.vdot(self._weight, met.traction**2)) / (2.0 * self._stiffness)
        n, first, second = evaluated(self._spline, met.place)
        r, z = x[self._top].T
        speed = first @ r
        tilt = (first @ z) / speed
        bend = (second @ z - tilt * (second @ r)) / speed**2
        by_gap = self._directions(tilt, n)
        load = self._weight * met.traction
        stiff = np.where(met.traction > 0.0, self._stiffness * self._weight, 0.0)
        blocks = np.einsum("eq,eqi,eqk->eik", stiff, by_gap, by_gap)
        blocks -= np.einsum("eq,eqik->eik", load, self._curvature(tilt, bend, n, first / speed[..., None]))
        return TermState(energy, solid.folded(-np.einsum("eq,eqi->ei", load, by_gap)), fold_blocks=blocks)

    def load(self, x: Array) -> BaseLoad:
        """Load of the wall on the flange at positions x (n_nodes, 2)."""
        met = self._meet(x)
        if met is None:
            return BaseLoad()
        most = float(met.traction.max())
        return BaseLoad(float(np.vdot(self._weight, met.traction)), most, most / self._stiffness)

    def _meet(self, x: Array) -> _Touch | None:
        """Points of the wall below the top of the flange at positions x (n_nodes, 2); None if there are none."""
        line, top = x[self._edges], x[self._top]
        r, z = line[..., 0] @ self._shape.T, line[..., 1] @ self._shape.T
        # A spline rises over its highest node by less than its nodes differ.
        if z.min() > top[:, 1].max() + np.ptp(top[:, 1]):
            return None
        place = _located(self._spline, top[:, 0], r)
        height = z - evaluated(self._spline, place)[0] @ top[:, 1]
        below = (height < 0.0) & (r < top[-1, 0])
        return _Touch(place, np.where(below, -self._stiffness * height, 0.0)) if below.any() else None

    def _directions(self, tilt: Array, n: Array) -> Array:
        """Derivative of the gaps by the positions of wall and top, interleaved r and z, (n_edges, n_points, 2 m)."""
        out = np.empty((*tilt.shape, 2 * (3 + n.shape[-1])))
        out[..., 0:6:2], out[..., 1:6:2] = -tilt[..., None] * self._shape, self._shape
        out[..., 6::2], out[..., 7::2] = tilt[..., None] * n, -n
        return out

    def _curvature(self, tilt: Array, bend: Array, n: Array, turn: Array) -> Array:
        """Second derivative of the gaps by the same, (n_edges, n_points, 2 m, 2 m); ``turn`` are slopes over speed.

        The place on the top follows from its radius: d place = (dr - n dR) / speed.
        """
        m = 2 * (3 + n.shape[-1])
        # How the radius of a point against the top's changes: all that makes a gap nonlinear.
        slide = np.zeros((*tilt.shape, m))
        slide[..., 0:6:2], slide[..., 6::2] = self._shape, -n
        # How the tilt of the top at a fixed place changes.
        tip = np.zeros((*tilt.shape, m))
        tip[..., 6::2], tip[..., 7::2] = -tilt[..., None] * turn, turn
        cross = slide[..., :, None] * tip[..., None, :]
        along = bend[..., None, None] * slide[..., :, None] * slide[..., None, :]
        return np.asarray(-along - cross - np.swapaxes(cross, -1, -2))


def cardinal_splines(count: int) -> Array:
    """Coefficients (count - 1, 4, count) of the natural cubic splines that are 1 at one of the places 0, 1, 2, ... and
    0 at the others: by interval, power of the distance from its start, and place of the 1."""
    value = np.eye(count)
    system = 4.0 * np.eye(count) + np.eye(count, k=1) + np.eye(count, k=-1)
    right = np.zeros((count, count))
    right[1:-1] = 6.0 * (value[2:] - 2.0 * value[1:-1] + value[:-2])
    system[[0, -1]] = value[[0, -1]]
    bend = np.linalg.solve(system, right)
    slope = value[1:] - value[:-1] - (2.0 * bend[:-1] + bend[1:]) / 6.0
    return np.stack([value[:-1], slope, 0.5 * bend[:-1], (bend[1:] - bend[:-1]) / 6.0], axis=1)


def evaluated(spline: Array, place: Array) -> tuple[Array, Array, Array]:
    """Values and two derivatives (..., count) at places (...); straight on beyond the first and the last."""
    last = spline.shape[0]
    held = np.clip(place, 0.0, last)
    beyond = (place - held)[..., None]
    k = np.minimum(held.astype(np.intp), last - 1)
    t = (held - k)[..., None]
    a, b, c, d = (spline[k, power] for power in range(4))
    slope = b + t * (2.0 * c + t * 3.0 * d)
    bend = np.where(beyond == 0.0, 2.0 * c + 6.0 * t * d, 0.0)
    return a + t * (b + t * (c + t * d)) + beyond * slope, slope, bend


def _located(spline: Array, radii: Array, r: Array) -> Array:
    """Places where the top, with nodes at ``radii``, has the radii r."""
    first = (r - radii[0]) / (radii[1] - radii[0])
    place = np.where(r < radii[0], first, np.interp(r, radii, np.arange(radii.size)))
    for _ in range(_ROOT_STEPS):
        n, slope, _ = evaluated(spline, place)
        step = (np.minimum(r, radii[-1]) - n @ radii) / (slope @ radii)
        place = place + step
        if np.abs(step).max() < _ROOT:
            break
    return place
