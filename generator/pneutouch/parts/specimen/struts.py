"""Strut lattices: one octant of the cell by one batch boolean, mirrored and tiled by index.

Every lattice here is its own mirror image in the planes at all multiples of half a cell. So an octant, [0, a/2]^3, and
its mirror images fill any number of half cells, and two of them share the same outline by construction: nothing is
intersected twice and no positions are compared. Only a block that ends inside a half cell is cut to size, in one
boolean.

A strut is the convex hull of two balls. All balls of a lattice are the same polyhedron in the same orientation. The
octant is made with a side of one, with its nodes and balls on a grid of 2^-20: sums are exact, and struts that join at
a node have identical facets there, not only nearly identical ones.
"""

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.body.shapes import circle_count, widen
from pneutouch.body.solid import manifold_of, mesh_of
from pneutouch.errors import ComputationError
from pneutouch.parts.specimen.faces import complement
from pneutouch.parts.specimen.family import (
    Box,
    Mesh,
    PatternContext,
    PatternFamily,
    PatternGeometry,
    along,
    check_count,
    check_least,
    heights,
    snapped,
)
from pneutouch.spec.specimen import StrutLattice

Ends = tuple[tuple[float, float, float], tuple[float, float, float]]

_A, _B, _C = (0.5, 0.5, 0.0), (0.5, 0.0, 0.5), (0.0, 0.5, 0.5)
_O = (0.0, 0.0, 0.0)
_KELVIN = [(0.0, 0.25, 0.5), (0.25, 0.0, 0.5), (0.5, 0.0, 0.25), (0.5, 0.25, 0.0), (0.25, 0.5, 0.0), (0.0, 0.5, 0.25)]

STRUTS: dict[str, tuple[Ends, ...]] = {
    "simple-cubic": ((_O, (0.5, 0.0, 0.0)), (_O, (0.0, 0.5, 0.0)), (_O, (0.0, 0.0, 0.5))),
    "bcc": ((_O, (0.5, 0.5, 0.5)),),
    "fcc": ((_O, _A), (_O, _B), (_O, _C)),
    "octet": ((_O, _A), (_O, _B), (_O, _C), (_A, _B), (_B, _C), (_C, _A)),
    "kelvin": tuple(itertools.pairwise([*_KELVIN, _KELVIN[0]])),
}
"""Struts, or their parts, in an octant of the cell, in units of the cell. Mirror images make the rest."""

_GRID = 2.0**-20
"""Grid of the balls' vertices, in half cells: sums of them with nodes on the same grid are exact."""

_MERGED = 1e-5
"""Detail in half cells removed after the boolean: a float32 reader merges points closer than 4e-6 mm at 60 mm."""

_NUDGES = (0.0, 1e-5, -1e-5, 3e-5, -3e-5, 1e-4, -1e-4, 3e-4)
"""Relative changes, in the order tried, of a radius that does not give a clean octant."""

_CUTS = (1e-3, 1e-4, 3e-3, 2e-5, 6e-3)
"""Detail in mm removed where a lattice is cut to size, in the order tried: a cut may pass arbitrarily close to the
corners of the lattice, and the remaining piece must neither almost vanish nor be flattened into the face."""


@dataclass(frozen=True)
class Lattice:
    """A strut lattice: kind, cell and strut radius in mm, and number of sides of a round strut, a multiple of four."""

    kind: str
    cell: float
    radius: float
    sides: int

    @staticmethod
    def of(kind: str, cell: float, radius: float, tolerance: float) -> "Lattice":
        """Lattice with as many sides per strut as a chord tolerance (mm) requires."""
        return Lattice(kind, cell, radius, circle_count(radius, tolerance))

    def ball(self) -> Array:
        """Corners (n, 3), in half cells, of the polyhedron that represents the ball of every node, about its centre.

        A subdivided octahedron: the three coordinate planes cut it along its edges, so half balls are exact.
        """
        steps = self.sides // 4
        corners = [
            (i * sx, j * sy, (steps - i - j) * sz)
            for i in range(steps + 1)
            for j in range(steps + 1 - i)
            for sx in (-1, 1)
            for sy in (-1, 1)
            for sz in (-1, 1)
        ]
        points = np.unique(np.array(corners, float), axis=0)
        # Equal angles along the edges: plain normalisation would crowd points at the corners of the octahedron.
        bent = np.sign(points) * np.sin(0.5 * np.pi * np.abs(points) / steps)
        unit = bent / np.linalg.norm(bent, axis=1, keepdims=True)
        # Widened until the equator has the area of its circle, like the circles of turned bodies.
        return np.asarray(np.rint(unit * self.radius / (0.5 * self.cell) * widen(self.sides) / _GRID) * _GRID)

    def struts(self) -> list[tuple[Array, Array]]:
        """Ends (3,), in half cells, of every strut that reaches into the octant, mirror images included."""
        reach = 1.1 * self.radius / (0.5 * self.cell)
        segments: dict[tuple[float, ...], tuple[Array, Array]] = {}
        for one, other in STRUTS[self.kind]:
            for signs in itertools.product((-1.0, 1.0), repeat=3):
                for shift in itertools.product((0.0, 1.0), repeat=3):
                    a, b = (2.0 * (np.array(shift) + np.array(signs) * np.array(end)) for end in (one, other))
                    low, high = np.minimum(a, b) - reach, np.maximum(a, b) + reach
                    if (high > 0).all() and (low < 1.0).all():
                        key = tuple(sorted([tuple(a.tolist()), tuple(b.tolist())]))
                        segments[key] = (a, b)  # type: ignore[index]
        return [segments[key] for key in sorted(segments)]

    def distance(self, points: Array) -> Array:
        """Distances (n,) of points (n, 3) in the octant from the nearest strut's axis, all in half cells."""
        nearest = np.full(len(points), np.inf)
        for a, b in self.struts():
            direction = b - a
            share = np.clip((points - a) @ direction / (direction @ direction), 0.0, 1.0)
            nearest = np.minimum(nearest, np.linalg.norm(points - a - share[:, None] * direction, axis=1))
        return nearest


def octant(lattice: Lattice) -> Mesh:
    """Closed mesh of the lattice in an octant of side one: one batch union of its struts and one cut.

    Struts that cross at symmetric places can leave a spike or a touching edge (manifold3d 3.5.4: octet, cell 7.7 mm,
    radius 0.5 mm). The radius is then changed by a few parts in 100,000. Raises ComputationError if that does not help.
    """
    for nudge in _NUDGES:
        tried = replace(lattice, radius=lattice.radius * (1 + nudge))
        piece = _octant(tried)
        if _sound(tried, piece):
            return piece
    raise ComputationError(
        f"{lattice.kind}: no clean cell of {lattice.cell:g} mm with struts of {lattice.radius:g} mm; change either by "
        "0.01 mm"
    )


def _octant(lattice: Lattice) -> Mesh:
    from manifold3d import Manifold, OpType

    ball = lattice.ball()
    hulls = [Manifold.hull_points(np.concatenate([ball + a, ball + b])) for a, b in lattice.struts()]
    whole = Manifold.batch_boolean(hulls, OpType.Add) ^ Manifold.cube((1.0, 1.0, 1.0))
    return snapped(Mesh(*mesh_of(whole.simplify(_MERGED))), Box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), 1e-9)


def _sound(lattice: Lattice, piece: Mesh) -> bool:
    """True if every vertex lies on a strut, and the octant together with its mirror images is closed."""
    reach = 1.01 * widen(lattice.sides) * lattice.radius / (0.5 * lattice.cell)
    if (lattice.distance(piece.vertices) > reach).any():
        return False
    return tiled(piece, 1.0, (2, 2, 2), np.zeros(3)).is_closed()


def tiled(piece: Mesh, half: float, counts: tuple[int, int, int], origin: Array) -> Mesh:
    """An octant, scaled to ``half`` mm, and its mirror images, ``counts`` along each axis, from ``origin`` (3,).

    A vertex on a plane between octants is one of both, known by its number and the plane's, not by its position.
    """
    vertices, triangles = piece.vertices, piece.triangles
    on_low, on_high = vertices == 0.0, vertices == 1.0
    index = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1).reshape(-1, 3)
    odd = (index % 2).astype(bool)
    on_first = np.where(odd[:, None, :], on_high, on_low)
    on_last = np.where(odd[:, None, :], on_low, on_high)
    # Planes have even codes, the spaces between them odd ones.
    code = 2 * index[:, None, :] + 1 - on_first + on_last
    local = np.where(odd[:, None, :], 1.0 - vertices, vertices)
    place = np.where(code % 2 == 0, (code // 2) * half, (index[:, None, :] + local) * half)
    sizes = [2 * n + 1 for n in counts]
    key = ((np.arange(len(vertices)) * sizes[0] + code[..., 0]) * sizes[1] + code[..., 1]) * sizes[2] + code[..., 2]
    _, first, number = np.unique(key.reshape(-1), return_index=True, return_inverse=True)
    corners = number.reshape(key.shape)[:, triangles]
    flip = odd.sum(axis=1) % 2 == 1
    corners[flip] = corners[flip][:, :, ::-1]
    kept = corners[~_inner(code[:, triangles], sizes)]
    return Mesh(place.reshape(-1, 3)[first] + origin, kept).compact()


def _inner(code: Indices, sizes: list[int]) -> Flags:
    """Mask (octants, triangles) of triangles on a plane between two octants: both have them, so neither keeps them."""
    inner = np.zeros(code.shape[:2], bool)
    for axis in range(3):
        one = code[..., axis]
        flat = (one == one[..., :1]).all(axis=-1) & (one[..., 0] % 2 == 0)
        inner |= flat & (one[..., 0] > 0) & (one[..., 0] < sizes[axis] - 1)
    return inner


def half_cells(cell: float, box: Box) -> tuple[tuple[int, int, int], bool]:
    """Numbers of half cells along each axis that cover a box, and True if they fill it exactly."""
    size = np.array(box.high) - np.array(box.low)
    a, b, c = (math.ceil(round(length / (0.5 * cell), 6)) for length in size.tolist())
    return (a, b, c), bool(np.allclose(np.array([a, b, c]) * 0.5 * cell, size, rtol=0, atol=1e-6))


def fill(lattice: Lattice, box: Box, piece: Mesh | None = None) -> Mesh:
    """Closed mesh of the lattice in a box; cells start at its least corner. One boolean cuts it if half cells do not
    fit. ``piece`` is the octant, if it is known already."""
    counts, whole = half_cells(lattice.cell, box)
    mesh = tiled(piece or octant(lattice), 0.5 * lattice.cell, counts, np.array(box.low))
    return snapped(mesh, box, 2e-6) if whole else _cut(mesh, box)


def _cut(mesh: Mesh, box: Box) -> Mesh:
    """Part of a mesh inside a box whose low sides the mesh is flush with."""
    from manifold3d import Manifold

    size = np.array(box.high) - np.array(box.low)
    cut = manifold_of(mesh.vertices - np.array(box.low), mesh.triangles) ^ Manifold.cube(size.tolist())
    for detail in _CUTS:
        mesh = Mesh(*mesh_of(cut.simplify(detail)))
        placed = snapped(Mesh(mesh.vertices + np.array(box.low), mesh.triangles), box, 1e-6)
        if placed.is_closed() and complement(box, placed).is_closed():
            break
    return placed


_SAMPLES = 28
"""Number of samples along each side of an octant for the first guess of a radius."""

_LARGEST = 0.85
"""Greatest radius over the radius at which no matrix is left: above it slivers remain (our choice)."""

_CLOSE = 1e-3
"""Relative error of the volume fraction at which the search stops."""

_TRIES = 8


def box(layer: StrutLattice, context: PatternContext, number: int) -> Box:
    """Box that the lattice fills: the whole width, with cells from its least corner. Raises InputError."""
    cell = layer.pitch(context.speed)
    start, end = along(layer, context)
    low, high = heights(layer, context, layer.height_mm)
    around = Box((start, context.block.low[1], low), (end, context.block.high[1], high))
    for axis, key in ((0, "cell_mm"), (1, "cell_mm"), (2, "height_mm" if layer.height_mm else "cell_mm")):
        if around.high[axis] - around.low[axis] < 0.5 * cell - 1e-9:
            length = around.high[axis] - around.low[axis]
            text = f"half a cell of {cell:.4g} mm does not fit into {length:.4g} mm along {'xyz'[axis]}; take a smaller"
            raise context.refuse(number, key, getattr(layer, key) or cell, text)
    if layer.strut_radius_mm is not None:
        check_least(context, number, "strut_radius_mm", layer.strut_radius_mm, "pin", 2.0)
        # From the greatest distance on no matrix is left.
        most = _LARGEST * float(_distances(layer.kind, cell).max())
        if layer.strut_radius_mm > most:
            raise context.refuse(
                number,
                "strut_radius_mm",
                layer.strut_radius_mm,
                f"leaves no matrix between the struts of a {layer.kind} cell of "
                f"{cell:.4g} mm; it must be at most {most:.3g} mm",
            )
    return around


def draw(layer: StrutLattice, context: PatternContext, number: int) -> PatternGeometry:
    """Geometry of the lattice, with its radius and with the volume fraction as measured on its mesh."""
    around, cell = box(layer, context, number), layer.pitch(context.speed)
    (a, b, c), _ = half_cells(cell, around)
    first = layer.strut_radius_mm or _guess(layer.kind, cell, layer.volume_fraction or 0.0)
    sides = circle_count(first, context.tolerance)
    check_count(context, number, layer.period_key(), cell, a * b * c * 2.5 * sides * len(STRUTS[layer.kind]))
    if layer.strut_radius_mm is not None:
        lattice = Lattice(layer.kind, cell, layer.strut_radius_mm, sides)
        mesh = fill(lattice, around)
    else:
        lattice, mesh = _solved(layer, context, number, around, sides)
        check_count(context, number, layer.period_key(), cell, len(mesh.triangles))
    truth = {
        "cell_mm": cell,
        "strut_radius_mm": lattice.radius,
        "sides": lattice.sides,
        "volume_fraction": mesh.volume / around.volume,
    }
    return PatternGeometry(mesh, around, (cell,), truth)


def _solved(layer: StrutLattice, context: PatternContext, number: int, around: Box, sides: int) -> tuple[Lattice, Mesh]:
    """Lattice with a given volume fraction: by its octant only if half cells fill the box, else by the whole mesh."""
    cell, target = layer.pitch(context.speed), layer.volume_fraction or 0.0
    _check_fraction(layer, context, number, cell, target)
    _, whole = half_cells(cell, around)
    radius = _guess(layer.kind, cell, target)
    tried: list[tuple[float, float]] = []
    for _ in range(_TRIES):
        lattice = Lattice(layer.kind, cell, radius, sides)
        piece = octant(lattice)
        mesh = piece if whole else fill(lattice, around, piece)
        fraction = mesh.volume / (1.0 if whole else around.volume)
        if abs(fraction - target) <= _CLOSE * target:
            return lattice, fill(lattice, around, piece) if whole else mesh
        tried.append((radius, fraction))
        radius = _next(tried, target)
    raise ComputationError(
        f"layer[{number}].volume_fraction = {target:g}: no strut radius gives it within {_TRIES} steps",
        file=context.where,
        remedy="give strut_radius_mm instead",
    )


def _next(tried: list[tuple[float, float]], target: float) -> float:
    """Next radius to try: at first as if the fraction grew with its square, then along the secant of two tries."""
    radius, fraction = tried[-1]
    if len(tried) == 1 or tried[-1][1] == tried[-2][1]:
        return radius * math.sqrt(target / fraction)
    before, was = tried[-2]
    return radius + (target - fraction) * (radius - before) / (fraction - was)


def _check_fraction(layer: StrutLattice, context: PatternContext, number: int, cell: float, target: float) -> None:
    """Raise InputError for a volume fraction whose struts cannot be printed or leave no matrix."""
    distances = _distances(layer.kind, cell)
    thinnest, thickest = 0.5 * context.least("pin"), _LARGEST * float(distances.max())
    low, high = (float((distances < radius).mean()) for radius in (thinnest, thickest))
    radius = _guess(layer.kind, cell, target)
    if radius > thickest or radius < thinnest:
        raise context.refuse(
            number,
            "volume_fraction",
            target,
            f"{layer.kind} struts in a cell of {cell:.4g} mm would be {2 * radius:.3g} mm thick; "
            + (
                f"it must be from {low:.3f} to {high:.3f}, {2 * thinnest:g} to {2 * thickest:.3g} mm"
                if thinnest < thickest
                else f"no fraction is printable, so take a cell_mm over {cell * thinnest / thickest:.3g}"
            ),
        )


def _guess(kind: str, cell: float, fraction: float) -> float:
    """Radius in mm within which a share ``fraction`` of evenly spread samples lies."""
    return float(np.quantile(_distances(kind, cell), fraction))


def _distances(kind: str, cell: float) -> Array:
    """Distances (n,) in mm of samples in an octant from the nearest strut."""
    lattice = Lattice(kind, cell, 0.3 * cell, 8)
    line = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    points = np.array(list(itertools.product(line, line, line)))
    return np.asarray(0.5 * cell * lattice.distance(points))


FAMILY = PatternFamily(box, draw)
