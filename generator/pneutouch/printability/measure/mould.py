"""A closed mould measured on its meshes: overlaps, the space that the silicone fills, and undercuts along the draw."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.body import Body
from pneutouch.body.solid import manifold_of
from pneutouch.parts.mould.pieces import channels, silicone
from pneutouch.parts.mould.size import MouldSize

UP, DOWN = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)

LEAVES = {"mould-cap": DOWN, "mould-ring": DOWN, "mould-core": UP}
"""Direction in which silicone leaves each part that shapes it: cap and ring are lifted off, the core is drawn."""

_GRID = 3
"""Points on each triangle, see `Body.surface_points`."""

_REACH = 0.5
"""Distance in mm by which the window of the void reaches past the flange, within `parts.mould.size.LAND`."""

_SIDES = 256
"""Sides of the prism from which the void is taken; it lies in the ring, clear of the gap at the ring's outside."""

_ROUNDING = 1e-9
"""Volume in mm3, from rounding, that faces which touch may seem to share."""

_MOST_POINTS = 3000
"""Greatest number of points whose rays are cast for each part."""


@dataclass(frozen=True, slots=True)
class CavityMatch:
    """Volumes, mm3: the void of the closed mould, the membrane, what either lacks; and the membrane's area, mm2."""

    void: float
    membrane: float
    missing: float
    extra: float
    area: float

    @property
    def offset(self) -> float:
        """Mean distance between both surfaces, mm: volumes that either has more, divided by the area."""
        return (self.missing + self.extra) / self.area


@dataclass(frozen=True, slots=True)
class UndercutPlace:
    """A point of a part, mm, from which the silicone cannot leave along its draw."""

    part: str
    where: tuple[float, float, float]


def overlaps(closed: Sequence[Body]) -> dict[tuple[str, str], float]:
    """Volumes in mm3 that two bodies of the closed mould share; pairs that share none are left out."""
    shapes = [(body.name, body.bounds, body.manifold()) for body in closed]
    shared = {}
    for (one, box, first), (other, limit, second) in combinations(shapes, 2):
        if (box[0] > limit[1]).any() or (limit[0] > box[1]).any():
            continue
        volume = float((first ^ second).volume())
        if volume > _ROUNDING:
            shared[one, other] = volume
    return shared


def cavity_match(size: MouldSize, closed: Sequence[Body], tolerance: float) -> CavityMatch:
    """Comparison of the first cavity of the closed mould, channels plugged, with the membrane; ``tolerance`` in mm."""
    from manifold3d import Manifold, OpType

    plugs = [manifold_of(*tool.mesh(tolerance)) for tool in channels(size)]
    whole = Manifold.batch_boolean([*(body.manifold() for body in closed), *plugs], OpType.Add)
    reach, low, high = size.faces.edge.start[0] + _REACH, size.low - 1e-3, size.faces.high + 1e-3
    window = Manifold.cylinder(high - low, reach, reach, _SIDES).translate((0.0, 0.0, low))
    void = window - whole
    membrane = silicone(size, closed[0].material).mesh(tolerance).manifold()
    return CavityMatch(
        void=float(void.volume()),
        membrane=float(membrane.volume()),
        missing=float((membrane - void).volume()),
        extra=float((void - membrane).volume()),
        area=float(membrane.surface_area()),
    )


def undercuts(size: MouldSize, bodies: Sequence[Body], tolerance: float) -> list[UndercutPlace]:
    """Places where a part of the first cavity holds the silicone back, found by rays along the draw.

    A ray starts ``tolerance`` mm off each point of the faces that form the silicone and runs as the silicone leaves the
    part; if it meets the part again, the point is an undercut.
    """
    places: list[UndercutPlace] = []
    for body in bodies:
        if body.name not in LEAVES:
            continue
        solid, direction = body.manifold(), np.array(LEAVES[body.name])
        length = float(np.ptp(body.vertices, axis=0).max()) + 1.0
        for start, point, back in _starts(size, body, tolerance):
            along = -direction if back else direction
            if solid.ray_cast(tuple(start), tuple(start + length * along)):
                x, y, z = (float(value) for value in point)
                places.append(UndercutPlace(body.name, (x, y, z)))
    return places


def _starts(size: MouldSize, body: Body, tolerance: float) -> list[tuple[Array, Array, bool]]:
    """Starts of rays, points of the faces, and True if the silicone there leaves backwards, out of the funnel."""
    points = body.surface_points(_GRID)
    count = len(points) // len(body.triangles)
    a, b, c = np.moveaxis(body.corners, 1, 0)
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    normals = np.repeat(normals, count, axis=0)
    forms = _whole(size.faces.meridian.distance(points) <= 2 * tolerance, count)
    back = np.zeros(len(points), bool)
    if body.name == "mould-core":
        for k, tool in enumerate(channels(size)):
            inside = (points[:, 2] < size.low - tolerance) & (points[:, 2] > size.foot_low + tolerance)
            channel = inside & _whole(tool.distance(points) <= 2 * tolerance, count)
            forms |= channel
            if k == 0:
                back |= channel & (points[:, 2] < size.neck_height)
    rows = np.flatnonzero(forms)
    rows = rows[:: max(1, math.ceil(len(rows) / _MOST_POINTS))]
    return [(points[k] + tolerance * normals[k], points[k], bool(back[k])) for k in rows]


def _whole(near: Flags, count: int) -> Flags:
    """True for the ``count`` points of each triangle whose points are all ``near``."""
    return np.repeat(near.reshape(-1, count).all(axis=1), count)
