"""Meridian meshes: quadrilaterals in the (r, z) half plane with named boundaries.

Also the number of cells that resolve the object that presses a sensor.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from pneutouch.arrays import Array, Index, distinct
from pneutouch.mechanics.sensor import Sensor
from pneutouch.shape.dome import DomeShape

#: Walls up to this share of R0 need one cell across (S within 0.2 % of a refined mesh), thicker ones two. The atlas
#: begins above it, so that one family of meshes covers its whole box.
_THIN = 0.055
_TO_BENDING_LENGTH = 3.0
_ARC_CELLS = (24, 48)

START, END, MIDDLE = range(3)
"""Columns of a table of edges: an edge's nodes, in their order; a linear edge has no middle."""

CELLS_PER_RADIUS = 4
"""Cells of the outer wall over a length equal to the least radius of an object. With fewer the wall appears to leave a
ball at its lowest point; with these the force is within 1 % of a refined mesh (docs/background/contact.md)."""


@dataclass(frozen=True)
class SolidMesh:
    """Mesh of a meridian section of the wall, in mm: quadratic (8 or 9 nodes) or linear (4 nodes) quadrilaterals.

    nodes:   (n_nodes, 2), columns r and z.
    cells:   (n_cells, 4 | 8 | 9): corners counter-clockwise in (xi, eta), then the mid-sides of eta=-1, xi=+1, eta=+1,
      xi=-1, then the centre.
    inner, outer: (n_edges, 2 | 3) edges of the wall's face to the cavity and of its outer face: start, end, (middle);
      both run from the base to the apex, which is the end of the last edge.
    clamped: nodes with both displacements zero.
    axis:    nodes on r = 0, whose radial displacement is zero.
    sliding: nodes with only the vertical displacement zero (a symmetry plane).
    length, wall: units of length of the solver (`DomeShape.scale`) and of the contact's stiffness (wall thickness).
    flange: (n_edges, 3) edges of a flange's free top, from the foot of the outer wall to the rim; empty without one.
    floor: height of the rigid body behind the wall (`DomeShape.floor`).
    """

    nodes: Array
    cells: Index
    inner: Index
    outer: Index
    clamped: Index
    axis: Index
    sliding: Index
    length: float
    wall: float
    flange: Index = field(default_factory=lambda: np.zeros((0, 3), dtype=np.intp))
    floor: float = 0.0

    @property
    def pocket(self) -> float:
        """Volume between the floor and the inner face's rim, mm3."""
        radius, height = self.nodes[self.inner[0, START]].tolist()
        return float(np.pi * radius**2 * (height - self.floor))

    @property
    def inner_apex(self) -> int:
        """Number of the inner face's node on the axis."""
        return int(self.inner[-1, END])

    @property
    def outer_apex(self) -> int:
        """Number of the outer face's node on the axis."""
        return int(self.outer[-1, END])

    def __post_init__(self) -> None:
        if self.cells.shape[1] not in (4, 8, 9):
            raise ValueError(f"cells have {self.cells.shape[1]} nodes; 4, 8 or 9 are known")
        if not np.isfinite(self.nodes).all() or self.nodes[:, 0].min() < 0.0:
            raise ValueError("node coordinates must be finite, with r >= 0")
        if not (self.length > 0.0 and self.wall > 0.0):
            raise ValueError("length and wall must be positive")
        for name, line in (("inner", self.inner), ("outer", self.outer)):
            if (line[1:, START] != line[:-1, END]).any() or line[-1, END] not in self.axis:
                raise ValueError(f"the {name} edges must form one line from the base to the axis")


def grid_cells(n_columns: int, n_rows: int, nodes_per_cell: int) -> Index:
    """Cells (n_cells, nodes_per_cell) over (2 n_columns + 1) x (2 n_rows + 1) points, numbered column by column."""
    height = 2 * n_rows + 1
    corner = (2 * np.arange(n_columns)[:, None] * height + 2 * np.arange(n_rows)[None, :]).reshape(-1, 1)
    right, up = 2 * height, 2
    offsets = [0, right, right + up, up, height, right + 1, height + up, 1, height + 1]
    return np.asarray((corner + np.array(offsets)[None, :nodes_per_cell]).astype(np.intp))


def boundary(n_columns: int, height: int, row: int) -> Index:
    """Edges (start, end, middle) along one row of a grid with ``height`` rows, in column order; (n_columns, 3)."""
    start = 2 * np.arange(n_columns) * height + row
    return np.stack([start, start + 2 * height, start + height], axis=1).astype(np.intp)


def _from_grid(grid: Array, n_columns: int, n_rows: int, order: int, scales: tuple[float, float]) -> SolidMesh:
    """Mesh over a grid of points (2 n_columns + 1, 2 n_rows + 1, 2), first column clamped, last column on the axis."""
    height = 2 * n_rows + 1
    nodes = grid.reshape(-1, 2).copy()
    base = np.arange(height)
    top = 2 * n_columns * height + base
    nodes[top, 0] = 0.0
    cells = grid_cells(n_columns, n_rows, {1: 4, 2: 9, 8: 8}[order])
    inner, outer = boundary(n_columns, height, 0), boundary(n_columns, height, height - 1)
    if order == 1:
        inner, outer = inner[:, :2], outer[:, :2]
    keep = distinct(cells)
    renumber = np.full(nodes.shape[0], -1, dtype=np.intp)
    renumber[keep] = np.arange(keep.size)
    base, top = (renumber[x][renumber[x] >= 0] for x in (base, top))
    cells, inner, outer = (renumber[x] for x in (cells, inner, outer))
    none = np.zeros(0, dtype=np.intp)
    length, wall = scales
    return SolidMesh(nodes[keep], cells, inner, outer, clamped=base, axis=top, sliding=none, length=length, wall=wall)


def graded(n: int, ratio: float) -> Array:
    """Points (n + 1,) from 0 to 1 with intervals in geometric progression; the first is `ratio` times the last."""
    steps = np.geomspace(ratio, 1.0, n) if n > 1 else np.ones(1)
    return np.concatenate([[0.0], np.cumsum(steps) / steps.sum()])


def with_middles(points: Array) -> Array:
    """Points (2 n - 1,): the given ones (n,) and the middles of the intervals between them."""
    out = np.empty(2 * points.size - 1)
    out[::2], out[1::2] = points, 0.5 * (points[1:] + points[:-1])
    return out


def arc_cells(arc: float, wall_ratio: Array) -> Array:
    """Number of cells along an arc that keeps the sensitivity within 0.5 %: three per bending length, 24 to 48.

    ``arc`` is the length of the inner face and ``wall_ratio`` (of any shape) the wall thickness, both over the scale of
    the dome; the bending length is the square root of the ratio.
    """
    return np.asarray(np.clip(np.ceil(_TO_BENDING_LENGTH * arc / np.sqrt(wall_ratio)), *_ARC_CELLS))


def cell_counts(shape: DomeShape, arc: int | None, through: int | None) -> tuple[int, int]:
    """Numbers of cells along the arc and across the wall: as given, else (None) the default for the shape."""
    ratio = shape.wall_thickness / shape.scale
    along = int(arc_cells(shape.arcs[0] / shape.scale, np.array(ratio)))
    return arc or along, through or cells_across(ratio)


def cells_across(wall_ratio: float) -> int:
    """Number of cells across a wall: one if its thickness over the shape's scale is at most 0.055, else two."""
    return 1 if wall_ratio <= _THIN else 2


def dome(
    shape: DomeShape,
    arc: int | None = None,
    through: int | None = None,
    order: int = 2,
    base_ratio: float = 1.0,
    slides: bool = False,
) -> SolidMesh:
    """Mesh of the wall of a shape on the plane z = 0, `arc` cells from base to apex and `through` across the wall.

    Nodes lie on both faces of the shape and, between them, on the straight lines from face to face. None: the default
    number of cells (`cell_counts`). order: 2 for nine-node, 8 for eight-node, 1 for four-node cells. base_ratio < 1
    makes cells shorter towards the base. slides: the base face moves freely in r (a symmetry plane), for tests against
    the sphere. Raises ValueError for sizes that are not positive.
    """
    size = shape.inner_radius, shape.wall_thickness
    if not (np.isfinite(size).all() and min(size) > 0.0):
        raise ValueError("inner_radius {} and wall_thickness {} must be positive and finite".format(*size))
    arc, through = cell_counts(shape, arc, through)
    grid = shape.points(with_middles(graded(arc, base_ratio)), with_middles(np.linspace(0.0, 1.0, through + 1)))
    mesh = replace(_from_grid(grid, arc, through, order, (shape.scale, shape.wall_thickness)), floor=shape.floor)
    if not slides:
        return mesh
    return replace(mesh, clamped=mesh.sliding, sliding=mesh.clamped)


def nodes_along(edges: Index) -> Index:
    """Node numbers (n_nodes,) of a face from end to end, from its edges (n_edges, 2 | 3)."""
    inward = edges[:, [START, MIDDLE]] if edges.shape[1] > MIDDLE else edges[:, [START]]
    return np.append(inward.ravel(), edges[-1, END])


MOST_CELLS = 192
"""Greatest number of cells along the arc for an object: with more, a prediction takes minutes."""


def object_cells(sensor: Sensor) -> int | None:
    """Number of cells along the arc that resolves the pressing object; None if the default is enough or for a plate."""
    if sensor.protocol.body is None:
        return None
    shape, smallest = sensor.dome.shape, sensor.protocol.body.smallest
    cells = int(np.ceil(CELLS_PER_RADIUS * shape.arcs[1] / smallest))
    return cells if cells > cell_counts(shape, None, None)[0] else None
