"""Meshing one membrane and keeping the tolerance: ours beside other kernels, time beside measured deviation."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from pneutouch.body import Solid
from pneutouch.export.step import exact_solid
from pneutouch.meridian import Arc, Meridian

TOLERANCES = (0.1, 0.05, 0.016, 0.005)
_RUNS = 7


@dataclass(frozen=True)
class Row:
    """One method at one tolerance; ``deviation`` and ``volume_error`` are measured against the exact solid."""

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


def manifold_revolve(meridian: Meridian, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """manifold3d's own revolve of the same inscribed outline."""
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
    count = int(np.ceil(np.pi / np.arccos(1 - half / meridian.bounds()[0])))
    mesh = Manifold.revolve(CrossSection([np.array(outline)]), circular_segments=count).to_mesh()
    return np.asarray(mesh.vert_properties, float), np.asarray(mesh.tri_verts, np.int64)


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
    shape = exact_solid(solid)
    methods: dict[str, Callable[[float], tuple[np.ndarray, np.ndarray]]] = {
        "pneutouch": lambda t: (body := solid.mesh(t), (body.vertices, body.triangles))[1],
        "plain grid, numpy": lambda t: plain_grid(solid.meridian, t),
        "manifold3d revolve": lambda t: manifold_revolve(solid.meridian, t),
        "CadQuery, angle off": lambda t: cadquery_tessellate(shape, t, 3.2),
        "CadQuery, angle 0.1": lambda t: cadquery_tessellate(shape, t, 0.1),
        "OCC, absolute": lambda t: occ_absolute(shape, t),
    }
    seconds: dict[tuple[str, float], list[float]] = {(m, t): [] for m in methods for t in TOLERANCES}
    for _ in range(_RUNS):
        for key in seconds:
            start = time.process_time()
            methods[key[0]](key[1])
            seconds[key].append(time.process_time() - start)
    return [_row(solid, m, t, methods[m](t), statistics.median(seconds[m, t])) for m, t in seconds]


def _row(solid: Solid, method: str, tolerance: float, mesh: tuple[np.ndarray, np.ndarray], seconds: float) -> Row:
    vertices, triangles = mesh
    grid = [(i, j, 6 - i - j) for i in range(7) for j in range(7 - i)]
    points = np.einsum("wk,mkd->mwd", np.array(grid, float) / 6, vertices[triangles]).reshape(-1, 3)
    a, b, c = np.moveaxis(vertices[triangles], 1, 0)
    volume = abs(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)
    return Row(
        method, tolerance, 1e3 * seconds, len(triangles), float(solid.distance(points).max()), volume / solid.volume - 1
    )
