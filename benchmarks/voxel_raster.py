"""Rasters of the membrane: volume and surface error against time, ours from the exact solid beside meshes sliced."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pneutouch.body import Solid
from pneutouch.body.section import SolidSection
from pneutouch.export.voxels.raster import Raster, raster

DPI = (600, 300)
RASTERS = ((14.0, 1.0), (27.0, 1.0), (27.0, 2.0), (27.0, 4.0), (27.0, 8.0))
"""Layer in um, and how much coarser all three steps are."""

OURS, SLICED, CONTAINED, TRIMESH = (
    "exact sections",
    "manifold3d slices, Pillow",
    "manifold3d slices, matplotlib",
    "trimesh",
)
_MESH = 0.005
"""Chord tolerance in mm of the peers' mesh."""

_RUNS = 3


@dataclass(frozen=True)
class Row:
    """One way at one raster. ``surface`` are the mean and the greatest distance in mm of the boundary from the exact
    surface: of the middles of all faces between a voxel inside and one outside."""

    method: str
    layer_um: float
    coarser: float
    seconds: float
    voxels: int
    volume: float
    mean: float
    most: float


def exact(solid: Solid, grid: Raster) -> np.ndarray:
    """Ours: every layer a comparison with the radii at its height."""
    inside = SolidSection(solid)
    plane = grid.plane(slice(0, len(grid.y)), slice(0, len(grid.x)))
    return np.array([inside.section(plane, float(z)) for z in grid.z])


def _polygons(solid: Solid, grid: Raster) -> list[list[np.ndarray]]:
    """The mesh sliced at every layer, in pixels."""
    body = solid.mesh(_MESH).manifold()
    low = np.array([grid.x[0], grid.y[-1]]) - 0.5 * np.array(grid.pitch[:2])
    scale = np.array(grid.pitch[:2])
    return [[(np.asarray(ring) - low) / scale for ring in body.slice(float(z)).to_polygons()] for z in grid.z]


def sliced(solid: Solid, grid: Raster) -> np.ndarray:
    """Polygons filled by Pillow, outer rings first, holes taken out again."""
    from PIL import Image, ImageDraw

    layers = []
    for rings in _polygons(solid, grid):
        picture = Image.new("1", (len(grid.x), len(grid.y)))
        draw = ImageDraw.Draw(picture)
        signed = [(float(np.sum(r[:, 0] * np.roll(r[:, 1], -1) - r[:, 1] * np.roll(r[:, 0], -1))), r) for r in rings]
        for area, ring in sorted(signed, key=lambda pair: -pair[0]):
            draw.polygon([tuple(point) for point in ring - 0.5], fill=int(area > 0))
        layers.append(np.asarray(picture)[::-1])
    return np.array(layers)


def contained(solid: Solid, grid: Raster) -> np.ndarray:
    """Pixel middles tested against the polygons by matplotlib."""
    from matplotlib.path import Path

    column, row = np.meshgrid(np.arange(len(grid.x)) + 0.5, np.arange(len(grid.y)) + 0.5)
    middles = np.column_stack([column.ravel(), row.ravel()])
    layers = []
    for rings in _polygons(solid, grid):
        inside = np.zeros(len(middles), bool)
        for ring in rings:
            inside ^= Path(ring).contains_points(middles)
        layers.append(inside.reshape(column.shape)[::-1])
    return np.array(layers)


def cubes(solid: Solid, pitch: float) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Trimesh's own voxels, which are cubes: the shell, filled. Returns them (z, y, x) and their centres."""
    import trimesh

    body = solid.mesh(min(0.1 * pitch, 0.05))
    found = trimesh.Trimesh(body.vertices, body.triangles, process=False).voxelized(pitch).fill()
    box, origin = found.matrix, found.transform[:3, 3]
    axes = tuple(origin[k] + pitch * np.arange(box.shape[k]) for k in range(3))
    return box.transpose(2, 1, 0), (axes[0], axes[1], axes[2])


def boundary(box: np.ndarray, axes: tuple[np.ndarray, np.ndarray, np.ndarray], solid: Solid) -> tuple[float, float]:
    """Mean and greatest distance in mm of the middles of the boundary's faces from the exact surface."""
    padded = np.pad(box, 1)
    x, y, z = (np.concatenate([[2 * a[0] - a[1]], a, [2 * a[-1] - a[-2]]]) for a in axes)
    total, count, most = 0.0, 0, 0.0
    for axis in range(3):
        a, b = np.take(padded, range(padded.shape[axis] - 1), axis), np.take(padded, range(1, padded.shape[axis]), axis)
        at = [index.astype(float) for index in np.nonzero(a ^ b)]
        at[axis] += 0.5
        lines = (z, y, x)
        points = np.column_stack([np.interp(at[k], np.arange(len(lines[k])), lines[k]) for k in (2, 1, 0)])
        for part in np.array_split(points, max(1, len(points) // 200_000)):
            distance = solid.distance(part)
            total, count, most = total + float(distance.sum()), count + len(part), max(most, float(distance.max()))
    return total / count, most


def measure(solid: Solid) -> list[Row]:
    """Ours at every raster, the peers from 27 um x 2 on; the least of several times."""
    rows = []
    for layer, coarser in RASTERS:
        grid = raster([SolidSection(solid)], DPI, layer, coarser=coarser)
        ways: dict[str, Callable[[Solid, Raster], np.ndarray]] = {OURS: exact, SLICED: sliced, CONTAINED: contained}
        for method, way in ways.items():
            if method == CONTAINED and coarser < 2:
                continue
            seconds, box = _timed(lambda way=way, grid=grid: way(solid, grid), _RUNS if method == OURS else 1)
            mean, most = boundary(box, (grid.x, grid.y, grid.z), solid)
            count = int(box.sum())
            rows.append(Row(method, layer, coarser, seconds, count, count * grid.voxel / solid.volume - 1, mean, most))
    for pitch in (0.4, 0.2, 0.1):
        seconds, (box, axes) = _timed(lambda pitch=pitch: cubes(solid, pitch), 1)
        mean, most = boundary(box, axes, solid)
        rows.append(
            Row(
                TRIMESH, 1000 * pitch, 1.0, seconds, int(box.sum()), box.sum() * pitch**3 / solid.volume - 1, mean, most
            )
        )
    return rows


def _timed(run: Callable[[], object], runs: int) -> tuple[float, object]:
    best, found = np.inf, None
    for _ in range(runs):
        start = time.process_time()
        found = run()
        best = min(best, time.process_time() - start)
    return float(best), found
