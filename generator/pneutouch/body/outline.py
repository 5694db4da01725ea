"""The section through the axis of a solid, in the plane y = 0."""

import math

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body.mesh import Body
from pneutouch.body.shapes import Bore
from pneutouch.body.solid import Solid
from pneutouch.meridian import Meridian, sample

_ASIDE = 1e-4
"""The plane that cuts a mesh is slightly off, mm: whole rows of vertices lie on y = 0 itself."""


def section_outline(solid: Solid, tolerance: float) -> list[Array]:
    """Loops (n, 2) of (x, z) in mm where the plane y = 0 cuts a solid, within ``tolerance`` mm.

    Of a turned body they follow from its meridian and the bores that the plane meets, without a mesh: a tenth of the
    time that meshing and cutting take. A body with shapes added or cut is cut as a mesh.
    """
    if not isinstance(solid.base, Meridian) or solid.adds or solid.cuts:
        return _cut(solid, tolerance)
    loops, holes = _turned(solid.base, tolerance), [_opening(bore) for bore in solid.bores if abs(bore.y) < bore.radius]
    return _without(loops, holes) if holes else loops


def _turned(meridian: Meridian, tolerance: float) -> list[Array]:
    """Both sides of a meridian: one loop where it ends on the axis, two where it closes away from it."""
    right = np.array([(ring.radius, ring.height) for ring in sample(meridian, tolerance)])
    left = right[::-1] * np.array([-1.0, 1.0])
    if meridian.is_ring:
        return [right, left]
    return [np.concatenate([right, left[left[:, 0] < 0.0]])]


def _opening(bore: Bore) -> Array:
    """The rectangle that a bore leaves, past its open faces by a millimetre as the drill of a mesh is."""
    half = math.sqrt(bore.radius**2 - bore.y**2)
    low = bore.low if bore.closed == "low" else bore.low - 1.0
    high = bore.high if bore.closed == "high" else bore.high + 1.0
    x = bore.x + half * np.array([-1.0, 1.0, 1.0, -1.0])
    return np.stack([x, [low, low, high, high]], axis=1)


def _without(loops: list[Array], holes: list[Array]) -> list[Array]:
    from manifold3d import CrossSection

    return [np.asarray(loop) for loop in (CrossSection(loops) - CrossSection(holes)).to_polygons()]


def mesh_outline(body: Body, height: float = 0.0) -> list[Array]:
    """Loops (n, 2) of (x, z) in mm where the plane y = ``height`` cuts the mesh of a body."""
    from manifold3d import Manifold, Mesh64

    upright = body.vertices[:, [0, 2, 1]] * np.array([1.0, 1.0, -1.0])
    whole = Manifold(Mesh64(np.ascontiguousarray(upright), body.triangles.astype(np.uint64)))
    return [np.asarray(loop) for loop in whole.slice(_ASIDE - height).to_polygons()]


def _cut(solid: Solid, tolerance: float) -> list[Array]:
    return mesh_outline(solid.mesh(tolerance))
