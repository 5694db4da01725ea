"""Voxel stacks of the graded dome: whole stacks, dithers of an even fraction, and rasters of the membrane (two minutes).

``python -m benchmarks.voxels`` writes docs/background/voxels.json and the picture of a stack, voxels.png. Dithers are
compared by evenness in 1 mm cubes, spectrum and time; rasters by volume and surface error against time, ours from the exact
solid beside meshes sliced.
"""

from __future__ import annotations

import resource
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.store import DOCS, LIBRARY, store, timed
from pneutouch.body import Solid
from pneutouch.body.section import SolidSection
from pneutouch.catalogue import load_scene
from pneutouch.export.voxels.raster import Raster, raster
from pneutouch.export.voxels.slices import thresholds
from pneutouch.export.voxels.stack import read_stack
from pneutouch.parts import assemble
from pneutouch.workflows.build_voxels import plan_voxels, write_voxels
from pneutouch.workflows.show import draw

PITCH = (25.4 / 600, 25.4 / 300, 0.027)
SHAPE = (96, 64, 128)
"""Layers, rows, columns: whole blocks of the blue noise, 2.6 x 5.4 x 5.4 mm."""

FRACTIONS = (0.02, 0.1, 0.25, 0.5, 0.75, 0.9, 0.98)
_WARM = 96
"""Layers before the block in which error diffusion gets under way; without them it starts late at fractions near 0 and 1."""

COARSE = 0.4
"""Wavelength in mm from which a spectrum counts as clumps: about a quarter of a wall of 1.5 mm."""

Flags = np.ndarray

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
class DitherRow:
    """One dither of one fraction. ``cube`` is the worst error of fraction in a 1 mm cube; ``clumps`` the power at long
    wavelengths and ``peak`` the greatest of a single wave among them, over that of white noise; ``seconds`` a million voxels."""

    method: str
    fraction: float
    whole: float
    cube: float
    clumps: float
    peak: float
    seconds: float


def blue_noise(fraction: float) -> Flags:
    """Thresholds of void and cluster: what a stack is made with."""
    noise = thresholds(PITCH, 1)
    rows, columns = slice(0, SHAPE[1]), slice(0, SHAPE[2])
    return np.array([fraction > noise.layer(number, rows, columns) for number in range(SHAPE[0])])


def white_noise(fraction: float) -> Flags:
    """Every voxel for itself."""
    return np.random.default_rng(1).random(SHAPE) < fraction


def error_diffusion(fraction: float, noise: float = 0.5) -> Flags:
    """Half of a voxel's error to the next row (1, 2, 1), half to the next layer (1, 2, 1 along x); rows turn from layer to
    layer. Threshold shaken by ``noise``, or rows of one phase would form walls."""
    rng = np.random.default_rng(1)
    layers, rows, columns = SHAPE
    layers += _WARM
    out = np.zeros((layers, rows, columns), bool)
    carried = rng.uniform(-0.5, 0.5, (rows, columns))
    for z in range(layers):
        below, carried = carried, np.zeros((rows, columns))
        shaken = 0.5 + noise * (rng.random((rows, columns)) - 0.5)
        beside = np.zeros(columns)
        for y in range(rows) if z % 2 == 0 else range(rows - 1, -1, -1):
            wanted = fraction + below[y] + beside
            out[z, y] = wanted > shaken[y]
            half = 0.5 * (wanted - out[z, y])
            # Along x the block closes on itself: no error is lost there.
            beside = 0.5 * half + 0.25 * (np.roll(half, 1) + np.roll(half, -1))
            carried[y] += beside
        # What the last row would pass on goes up too: no error leaves the block.
        carried[y] += beside
    return out[_WARM:]


METHODS: dict[str, Callable[[float], Flags]] = {
    "blue noise": blue_noise,
    "error diffusion": error_diffusion,
    "white noise": white_noise,
}


def spectrum(block: Flags) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (1/mm) and powers over that of white noise, of every wave of a block but the mean."""
    fraction = block.mean()
    power = np.abs(np.fft.rfftn(block - fraction)) ** 2 / (block.size * fraction * (1 - fraction))
    axes = [np.fft.fftfreq(n, d) for n, d in zip(SHAPE[:2], (PITCH[2], PITCH[1]), strict=True)]
    z, y, x = np.meshgrid(*axes, np.fft.rfftfreq(SHAPE[2], PITCH[0]), indexing="ij")
    return np.sqrt(x**2 + y**2 + z**2).ravel()[1:], power.ravel()[1:]


def radial(block: Flags, edges: np.ndarray) -> np.ndarray:
    """Mean power in rings of frequency between ``edges`` (1/mm)."""
    frequency, power = spectrum(block)
    place = np.digitize(frequency, edges) - 1
    kept = (place >= 0) & (place < len(edges) - 1)
    total = np.bincount(place[kept], power[kept], len(edges) - 1)
    return total / np.maximum(np.bincount(place[kept], minlength=len(edges) - 1), 1)


def worst_cube(block: Flags, fraction: float) -> float:
    """The greatest error of fraction over all cubes of 1 mm that lie in the block, wherever they begin."""
    size = [round(1 / step) for step in reversed(PITCH)]
    total = np.pad(block.cumsum(0).cumsum(1).cumsum(2), ((1, 0),) * 3)
    for axis, n in enumerate(size):
        total = np.take(total, range(n, total.shape[axis]), axis) - np.take(total, range(total.shape[axis] - n), axis)
    return float(np.abs(total / np.prod(size) - fraction).max())


def dithers() -> list[DitherRow]:
    """Every method at every fraction."""
    blue_noise(0.5)
    rows = []
    for method, make in METHODS.items():
        for fraction in FRACTIONS:
            block, taken = timed(partial(make, fraction))
            seconds = taken / block.size / (1 + _WARM / SHAPE[0] * (method == "error diffusion")) * 1e6
            frequency, power = spectrum(block)
            long = power[frequency < 1 / COARSE]
            rows.append(
                DitherRow(
                    method,
                    fraction,
                    float(abs(block.mean() - fraction)),
                    worst_cube(block, fraction),
                    float(long.mean()),
                    float(long.max()),
                    seconds,
                )
            )
    return rows


@dataclass(frozen=True)
class RasterRow:
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
    from matplotlib.path import Path as Outline

    column, row = np.meshgrid(np.arange(len(grid.x)) + 0.5, np.arange(len(grid.y)) + 0.5)
    middles = np.column_stack([column.ravel(), row.ravel()])
    layers = []
    for rings in _polygons(solid, grid):
        inside = np.zeros(len(middles), bool)
        for ring in rings:
            inside ^= Outline(ring).contains_points(middles)
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


def rasters(solid: Solid) -> list[RasterRow]:
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
            rows.append(
                RasterRow(method, layer, coarser, seconds, count, count * grid.voxel / solid.volume - 1, mean, most)
            )
    for pitch in (0.4, 0.2, 0.1):
        seconds, (box, axes) = _timed(lambda pitch=pitch: cubes(solid, pitch), 1)
        mean, most = boundary(box, axes, solid)
        rows.append(
            RasterRow(
                TRIMESH, 1000 * pitch, 1.0, seconds, int(box.sum()), box.sum() * pitch**3 / solid.volume - 1, mean, most
            )
        )
    return rows


def _timed(run: Callable[[], object], runs: int) -> tuple[float, object]:
    found = [timed(run) for _ in range(runs)]
    return min(seconds for _, seconds in found), found[-1][0]


def stack(assembly: Any, mode: str) -> dict[str, Any]:
    """One whole stack: what it took and what came out."""
    start = time.process_time()
    plan = plan_voxels(assembly, mode=mode, library=LIBRARY)
    with tempfile.TemporaryDirectory() as scratch:
        folder, _ = write_voxels(plan, Path(scratch), "")
        seconds = time.process_time() - start
        held, reading = timed(partial(read_stack, folder))
        if mode == "High Mix":
            draw(held, DOCS / "voxels.png")
        return {
            "mode": mode,
            "layer_um": held.manifest["layer_um"],
            "pixels": held.manifest["pixels"],
            "layers": held.manifest["layers"],
            "seconds": seconds,
            "reading_seconds": reading,
            "peak_MB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
            "MB": sum(path.stat().st_size for path in folder.iterdir()) / 1e6,
            "bodies": held.manifest["bodies"],
        }


def main() -> None:
    assembly = assemble(load_scene("graded-dome", None, LIBRARY))
    found = {
        "stacks": [stack(assembly, mode) for mode in ("High Mix", "High Quality")],
        "dithers": [asdict(row) for row in dithers()],
        "rasters": [asdict(row) for row in rasters(assembly.solids[0])],
    }
    store("voxels", found)


if __name__ == "__main__":
    main()
