"""Print meshes that keep a tolerance: ours beside other kernels, time beside measured deviation.

``python -m benchmarks.meshing`` writes docs/background/meshing.json.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np

from benchmarks.store import LIBRARY, store, timed
from pneutouch.body import Frame, Solid
from pneutouch.catalogue import load_scene
from pneutouch.export.step import exact_solid
from pneutouch.parts import assemble
from pneutouch.shape.meridian import Arc, Meridian
from pneutouch.spec.read import parse_changes

BODIES = {
    "membrane": ("paper-dome", []),
    "connector": ("paper-dome", []),
    "connector, side port": ("stiff-dome", ["connector.port=thread-M5", "connector.mount=robot-50-4-M6"]),
}

TOLERANCES = (0.1, 0.05, 0.016, 0.005)
FINER = (0.0016, 0.0008, 0.0004)
"""CadQuery takes its tolerance as a relative one and needs to be asked for much less."""

OURS, MANIFOLD = "pneutouch", "manifold3d alone"
_RUNS = 7


@dataclass(frozen=True)
class Row:
    """One method at one tolerance; ``deviation`` and ``volume_error`` are measured against the exact solid."""

    body: str
    method: str
    tolerance: float
    milliseconds: float
    triangles: int
    deviation: float
    volume_error: float


def plain_grid(meridian: Meridian, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """The textbook way: inscribed chords and circles, every ring with the same number of vertices."""
    half = 0.5 * tolerance
    count = int(np.ceil(np.pi / np.arccos(1 - half / meridian.bounds()[0])))
    plane: list[tuple[float, float]] = []
    for piece in meridian.pieces:
        cuts = 1
        if isinstance(piece, Arc):
            cuts = int(np.ceil(abs(piece.last - piece.first) / (2 * np.arccos(1 - half / piece.radius))))
            plane += [piece.at(a) for a in np.linspace(piece.first, piece.last, cuts + 1)[:-1]]
        else:
            plane.append(piece.start)
    plane.append(meridian.end)
    angle = 2 * np.pi * np.arange(count) / count
    rings = np.array(plane)
    x, y = rings[:, :1] * np.cos(angle), rings[:, :1] * np.sin(angle)
    vertices = np.stack([x, y, np.repeat(rings[:, 1:], count, 1)], axis=-1).reshape(-1, 3)
    row, column = np.meshgrid(np.arange(len(rings) - 1), np.arange(count), indexing="ij")
    a, b = row * count + column, row * count + (column + 1) % count
    quads = np.stack([a, b, b + count, a, b + count, a + count], axis=-1).reshape(-1, 3)
    corners = vertices[quads]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return vertices, quads[area > 1e-12]


def manifold_solid(solid: Solid, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """The same operations by manifold3d alone: its revolve of an inscribed outline, its cylinders, its batch booleans."""
    from manifold3d import Manifold, OpType

    whole = _revolved(solid.meridian, tolerance)
    adds = [_placed(_revolved(f.shape.meridian, tolerance), f.shape.frame) for f in solid.adds]
    cuts = [_placed(_revolved(f.shape.meridian, tolerance), f.shape.frame) for f in solid.cuts]
    for bore in solid.bores:
        count = _circle(bore.radius, tolerance)
        low, high = bore.low - (bore.closed != "low"), bore.high + (bore.closed != "high")
        cuts.append(
            Manifold.cylinder(high - low, bore.radius, circular_segments=count).translate((bore.x, bore.y, low))
        )
    if adds:
        whole = Manifold.batch_boolean([whole, *adds], OpType.Add)
    if cuts:
        whole = Manifold.batch_boolean([whole, *cuts], OpType.Subtract)
    mesh = whole.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts, np.int64)


def _circle(radius: float, tolerance: float) -> int:
    return max(8, 4 * int(np.ceil(np.pi / np.arccos(1 - min(0.5 * tolerance / radius, 0.5)) / 4)))


def _placed(shape: Any, frame: Frame) -> Any:
    if frame == Frame():
        return shape
    return shape.transform(np.column_stack([frame.rotation, np.array(frame.origin)]))


def _revolved(meridian: Meridian, tolerance: float) -> Any:
    from manifold3d import CrossSection, Manifold

    half = 0.5 * tolerance
    outline: list[tuple[float, float]] = []
    for piece in meridian.pieces:
        if isinstance(piece, Arc):
            cuts = int(np.ceil(abs(piece.last - piece.first) / (2 * np.arccos(1 - half / piece.radius))))
            outline += [piece.at(a) for a in np.linspace(piece.first, piece.last, cuts + 1)[:-1]]
        else:
            outline.append(piece.start)
    outline.append(meridian.end)
    return Manifold.revolve(
        CrossSection([np.array(outline)]), circular_segments=_circle(meridian.bounds()[0], tolerance)
    )


def cadquery_tessellate(shape: Any, tolerance: float, angle: float) -> tuple[np.ndarray, np.ndarray]:
    """CadQuery's tessellate on a fresh copy: Open CASCADE keeps the mesh it has made."""
    vertices, triangles = shape.copy().tessellate(tolerance, angle)
    return np.array([v.toTuple() for v in vertices]), np.array(triangles)


def occ_absolute(shape: Any, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """Open CASCADE's mesher asked for an absolute tolerance."""
    from OCP.BRepMesh import BRepMesh_IncrementalMesh

    copy = shape.copy()
    BRepMesh_IncrementalMesh(copy.wrapped, tolerance, False, 3.2, False)
    vertices, triangles = copy.tessellate(1e3, 3.2)
    return np.array([v.toTuple() for v in vertices]), np.array(triangles)


def measure(solid: Solid) -> list[Row]:
    """Every method at every tolerance; the median of several runs taken in turn."""
    import cadquery as cq

    shape = cq.Shape.cast(exact_solid(solid))
    methods: dict[str, Callable[[float], tuple[np.ndarray, np.ndarray]]] = {
        OURS: lambda t: (body := solid.mesh(t), (body.vertices, body.triangles))[1],
        MANIFOLD: lambda t: manifold_solid(solid, t),
        "CadQuery, angle off": lambda t: cadquery_tessellate(shape, t, 3.2),
        "CadQuery, angle 0.1": lambda t: cadquery_tessellate(shape, t, 0.1),
        "OCC, absolute": lambda t: occ_absolute(shape, t),
    }
    if not (solid.bores or solid.adds or solid.cuts):
        methods["plain grid, numpy"] = lambda t: plain_grid(solid.meridian, t)
    keys = [(method, t) for method in methods for t in (*TOLERANCES, *(FINER if "CadQuery" in method else ()))]
    seconds: dict[tuple[str, float], list[float]] = {key: [] for key in keys}
    for _ in range(_RUNS):
        for method, tolerance in keys:
            seconds[method, tolerance].append(timed(partial(methods[method], tolerance))[1])
    return [_row(solid, m, t, methods[m](t), statistics.median(seconds[m, t])) for m, t in keys]


def same_error(rows: list[Row], tolerance: float, prefix: str) -> float | None:
    """Time of another method over ours at the same measured deviation: its cheapest row that is no worse; None without."""
    ours = next(row for row in rows if (row.method, row.tolerance) == (OURS, tolerance))
    good = [row for row in rows if row.method.startswith(prefix) and row.deviation <= ours.deviation]
    return min(row.milliseconds for row in good) / ours.milliseconds if good else None


def _row(solid: Solid, method: str, tolerance: float, mesh: tuple[np.ndarray, np.ndarray], seconds: float) -> Row:
    vertices, triangles = mesh
    grid = [(i, j, 6 - i - j) for i in range(7) for j in range(7 - i)]
    points = np.einsum("wk,mkd->mwd", np.array(grid, float) / 6, vertices[triangles]).reshape(-1, 3)
    a, b, c = np.moveaxis(vertices[triangles], 1, 0)
    volume = abs(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)
    deviation = max(
        float(solid.distance(part).max()) for part in np.array_split(points, max(1, len(points) // 200_000))
    )
    return Row(solid.name, method, tolerance, 1e3 * seconds, len(triangles), deviation, volume / solid.volume - 1)


def compared(rows: list[Row]) -> dict[str, list[float]]:
    """Least and greatest time of ours over that of manifold3d, and of CadQuery over ours at the same measured error."""
    ours = {row.tolerance: row for row in rows if row.method == OURS}
    alone = [ours[row.tolerance].milliseconds / row.milliseconds for row in rows if row.method == MANIFOLD]
    kernels = [ratio for t in TOLERANCES if (ratio := same_error(rows, t, "CadQuery")) is not None]
    return {"manifold": [min(alone), max(alone)], "cadquery": [min(kernels), max(kernels)]}


def main() -> None:
    found: dict[str, list[Row]] = {}
    for label, (design, chosen) in BODIES.items():
        assembly = assemble(load_scene(design, parse_changes(chosen), LIBRARY))
        found[label] = measure(assembly.solid(label.split(",")[0]))
    bodies = {label: [asdict(row) for row in rows] for label, rows in found.items()}
    data = {"bodies": bodies, "compared": {label: compared(rows) for label, rows in found.items()}}
    store("meshing", data)


if __name__ == "__main__":
    main()
