"""The dome on its printed flange: its mesh, and the contact of the outer wall with the free top of the flange.

The flange is held where the connector holds it. Wall and top both deform, which couples their nodes.
"""

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.solid.banded import FaceSums
from pneutouch.mechanics.solid.base_contact import BaseLoad, load_on
from pneutouch.mechanics.solid.elements import TermState
from pneutouch.mechanics.solid.mesh import SolidMesh, boundary, cell_counts, graded, grid_cells, with_middles
from pneutouch.mechanics.solid.object_contact import Contact, FacePoints
from pneutouch.shape.dome import DomeShape

_CELLS_PER_WALL = 2
_COINCIDE = 1e-9
"""Nodes closer than this share of the wall coincide."""


def printed_dome(
    shape: DomeShape, flange_width: float, flange_thickness: float, arc: int | None = None, through: int | None = None
) -> SolidMesh:
    """Mesh of a dome whose rim continues below z = 0 as a flange (mm), clamped on its inside, underside and outside.

    The flange's top is free, as in the connector's groove, so the foot of the wall yields slightly. Nine-node cells;
    ``arc`` and ``through`` as in `mesh.dome`.
    """
    n, m = cell_counts(shape, arc, through)
    wall, outer = shape.wall_thickness, shape.outer_radius
    rim = outer + flange_width
    cap = shape.points(with_middles(graded(n, 1.0)), with_middles(np.linspace(0.0, 1.0, m + 1)))
    cap[-1, :, 0] = 0.0
    across = cap[0, :, 0]
    deep, wide = (max(2, round(_CELLS_PER_WALL * size / wall)) for size in (flange_thickness, flange_width))
    down = with_middles(np.linspace(-flange_thickness, 0.0, 1 + deep))
    out = with_middles(np.linspace(outer, rim, 1 + wide))
    blocks = [cap, _rectangle(across, down), _rectangle(out, down)]
    nodes, cells, first = _merge(blocks, _COINCIDE * wall)
    height = cap.shape[1]
    r, z = nodes.T
    high = np.flatnonzero((np.abs(z) <= _COINCIDE * wall) & (r >= outer - _COINCIDE * wall))
    high = high[np.argsort(r[high])]
    top = np.stack([high[:-2:2], high[2::2], high[1:-1:2]], axis=1).astype(np.intp)
    faces = (r <= shape.inner_radius + _COINCIDE) | (z <= _COINCIDE - flange_thickness) | (r >= rim - _COINCIDE)
    return SolidMesh(
        nodes,
        cells,
        inner=first[boundary(n, height, 0)],
        outer=first[boundary(n, height, height - 1)],
        clamped=np.flatnonzero((z <= _COINCIDE) & faces).astype(np.intp),
        axis=first[np.arange(height) + 2 * n * height],
        sliding=np.zeros(0, np.intp),
        length=shape.scale,
        wall=wall,
        flange=top,
    )


def _rectangle(r: Array, z: Array) -> Array:
    """Points (len(z), len(r), 2) of a rectangular block, (r, z), in the order of the dome's grid."""
    return np.stack(np.broadcast_arrays(r[None, :], z[:, None]), axis=-1)


def _merge(blocks: list[Array], gap: float) -> tuple[Array, Index, Index]:
    """Join blocks whose points coincide within ``gap``: nodes (n, 2), cells (m, 9), node numbers of the first block."""
    points = np.concatenate([block.reshape(-1, 2) for block in blocks])
    _, kept, number = np.unique(np.round(points / gap), axis=0, return_index=True, return_inverse=True)
    number = number.reshape(-1)
    starts = np.cumsum([0, *(block.shape[0] * block.shape[1] for block in blocks)])
    cells = [
        number[start + grid_cells(block.shape[0] // 2, block.shape[1] // 2, 9)]
        for start, block in zip(starts, blocks, strict=False)
    ]
    return points[kept], np.concatenate(cells).astype(np.intp), number[: starts[1]].astype(np.intp)


_ROOT_STEPS = 30
_ROOT = 1.0e-14


class _Touch(NamedTuple):
    """Spline coordinate on the flange's top under each wall point, and the traction, (n_edges, n_points) each."""

    place: Array
    traction: Array


def meeting_nodes(mesh: SolidMesh) -> Index:
    """Nodes coupled by the contact of wall and flange, (n_edges, 3 + n_top): the 3 of each edge of the outer wall that
    lies within a flange width of its foot, then those of the flange's top; no rows without a flange."""
    top = top_nodes(mesh)
    if top.size == 0:
        return np.zeros((0, 3), np.intp)
    foot = mesh.nodes[top[0]]
    width = mesh.nodes[top[-1], 0] - foot[0]
    near = mesh.outer[np.hypot(*(mesh.nodes[mesh.outer[:, 0]] - foot).T) < width]
    return np.concatenate([near, np.broadcast_to(top, (near.shape[0], top.size))], axis=1)


def top_nodes(mesh: SolidMesh) -> Index:
    """Nodes of the flange's top from the foot of the wall to the rim, (n_top,); none without a flange."""
    if mesh.flange.size == 0:
        return np.zeros(0, np.intp)
    return np.append(mesh.flange[:, [0, 2]].ravel(), mesh.flange[-1, 1])


class FlangeContact:
    """Contact energy (k/2) sum w <-g>^2 on the outer wall near its foot, an `EnergyTerm`; symbols as in `BaseContact`.

    g is the height of a point of the wall over the top of the flange at the same radius. The top is the natural cubic
    spline through its nodes: its tangent is continuous, and so the energy is once continuously differentiable.
    """

    noise = 0.0

    def __init__(self, meeting: Index, rest: Array, contact: Contact, faces: FaceSums) -> None:
        self._faces, self._stiffness, self._top = faces, contact.stiffness, meeting[0, 3:]
        self._wall = FacePoints(meeting[:, :3], rest, contact.stiffness)
        self._shape, self._weight = self._wall.shape, self._wall.weight
        self._spline = cardinal_splines(self._top.size)

    def at(self, x: Array) -> TermState:
        """Energy and its derivatives at positions x (n_nodes, 2)."""
        met = self._meet(x)
        if met is None:
            return TermState(0.0, np.zeros(self._faces.outer.size))
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
        assert self._faces.fold is not None
        gradient = self._faces.fold.vector([-np.einsum("eq,eqi->ei", load, by_gap)])
        return TermState(self._wall.energy(met.traction), gradient, fold_blocks=blocks)

    def load(self, x: Array) -> BaseLoad:
        """Load of the wall on the flange at positions x (n_nodes, 2)."""
        met = self._meet(x)
        return BaseLoad() if met is None else load_on(self._wall, met.traction)

    def _meet(self, x: Array) -> _Touch | None:
        """Contact at positions x (n_nodes, 2); None if no point of the wall is below the flange's top."""
        top = x[self._top]
        r, z = self._wall.positions(x)
        # A spline rises over its highest node by less than its nodes differ.
        if z.min() > top[:, 1].max() + np.ptp(top[:, 1]):
            return None
        place = _located(self._spline, top[:, 0], r)
        height = z - evaluated(self._spline, place)[0] @ top[:, 1]
        below = (height < 0.0) & (r < top[-1, 0])
        return _Touch(place, np.where(below, -self._stiffness * height, 0.0)) if below.any() else None

    def _directions(self, tilt: Array, n: Array) -> Array:
        """Derivative of the gaps by the coordinates, r and z in turn, of the m nodes of edge and top, (n_edges,
        n_points, 2 m); ``tilt``: slope of the top, ``n``: values of the cardinal splines."""
        out = np.empty((*tilt.shape, 2 * (3 + n.shape[-1])))
        out[..., 0:6:2], out[..., 1:6:2] = -tilt[..., None] * self._shape, self._shape
        out[..., 6::2], out[..., 7::2] = tilt[..., None] * n, -n
        return out

    def _curvature(self, tilt: Array, bend: Array, n: Array, turn: Array) -> Array:
        """Second derivative of the gaps by coordinates, (n_edges, n_points, 2 m, 2 m); arguments as in `_directions`;
        ``bend``, ``turn``: derivatives by radius of ``tilt`` and ``n``. The place on the top depends on its node radii
        R: d place = (dr - n dR) / speed, with speed = d(radius)/d(place)."""
        m = 2 * (3 + n.shape[-1])
        # Change of the radius of a point relative to the top: only this makes a gap nonlinear.
        slide = np.zeros((*tilt.shape, m))
        slide[..., 0:6:2], slide[..., 6::2] = self._shape, -n
        # Change of the tilt of the top at a fixed place.
        tip = np.zeros((*tilt.shape, m))
        tip[..., 6::2], tip[..., 7::2] = -tilt[..., None] * turn, turn
        cross = slide[..., :, None] * tip[..., None, :]
        along = bend[..., None, None] * slide[..., :, None] * slide[..., None, :]
        return np.asarray(-along - cross - np.swapaxes(cross, -1, -2))


def cardinal_splines(count: int) -> Array:
    """Coefficients (count - 1, 4, count) of the natural cubic splines that are 1 at one of the knots 0, 1, 2, ... and 0
    at the others, indexed by interval, power of the distance from the interval's start, and knot of the 1."""
    value = np.eye(count)
    system = 4.0 * np.eye(count) + np.eye(count, k=1) + np.eye(count, k=-1)
    right = np.zeros((count, count))
    right[1:-1] = 6.0 * (value[2:] - 2.0 * value[1:-1] + value[:-2])
    system[[0, -1]] = value[[0, -1]]
    bend = np.linalg.solve(system, right)
    slope = value[1:] - value[:-1] - (2.0 * bend[:-1] + bend[1:]) / 6.0
    return np.stack([value[:-1], slope, 0.5 * bend[:-1], (bend[1:] - bend[:-1]) / 6.0], axis=1)


def evaluated(spline: Array, place: Array) -> tuple[Array, Array, Array]:
    """Values and first two derivatives (..., count) of `cardinal_splines` at places (...); linear beyond the ends."""
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
    """Spline coordinates, like r, at which the top with node radii ``radii`` (n_top,) has the radii r."""
    first = (r - radii[0]) / (radii[1] - radii[0])
    place = np.where(r < radii[0], first, np.interp(r, radii, np.arange(radii.size)))
    for _ in range(_ROOT_STEPS):
        n, slope, _ = evaluated(spline, place)
        step = (np.minimum(r, radii[-1]) - n @ radii) / (slope @ radii)
        place = place + step
        if np.abs(step).max() < _ROOT:
            break
    return place
