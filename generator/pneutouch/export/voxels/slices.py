"""The slices of a job: which resin lies in every voxel, layer by layer, in memory that does not grow with their number.

A mixed voxel is stiff if its share exceeds its threshold. Thresholds are blue noise: the voxels below any share lie
evenly and without pattern. Void and cluster (R. Ulichney, Proc. SPIE 1913, 332-343, 1993, DOI 10.1117/12.152707) makes
them on a periodic block, with distances in mm: voxels are not cubes. Energies are whole numbers, so that every machine
ranks alike. Each block is shifted by an amount of its own, else the block would show as a pattern. NumPy and SciPy have
no blue noise.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from pneutouch.arrays import Array, Flags, Indices, Labels, Singles
from pneutouch.body.section import Window
from pneutouch.export.voxels.raster import RecentLayers, SkinCompensation, VoxelBody, VoxelJob, interior, reach_for

BLOCK = (48, 16, 32)
"""Voxels of the block along z, y, x: at 27 um layers about 1.3 mm each way, ranked in about a second; our choice."""

_WIDTH = 1.5
"""Standard deviation of the Gaussian that makes the energy, divided by the mean pitch: Ulichney's choice."""

_REACH = 4.5
"""Number of standard deviations beyond which the energy of a voxel is neglected."""

_START = 0.1
"""Share of the voxels in the initial pattern: Ulichney's choice."""

_SCALE = 2**40
_TAKEN = 2**62


class _Field:
    """The energy of a pattern of chosen voxels on the block, flat (n,): high where they are crowded."""

    def __init__(self, shape: tuple[int, int, int], pitch: tuple[float, float, float], seed: int) -> None:
        width = _WIDTH * float(np.prod(pitch)) ** (1 / 3)
        reach = [min(int(np.ceil(_REACH * width / step)), (n - 1) // 2) for step, n in zip(pitch, shape, strict=True)]
        grid = np.meshgrid(*(np.arange(-r, r + 1) for r in reach), indexing="ij")
        offsets = np.stack(grid, axis=-1).reshape(-1, 3)
        square = ((offsets * np.array(pitch)) ** 2).sum(axis=1)
        weights = np.rint(_SCALE * np.exp(-square / (2 * width**2))).astype(np.int64)
        offsets, self._weights = offsets[weights > 0], weights[weights > 0]
        self._strides = (shape[1] * shape[2], shape[2])
        strides = np.array([*self._strides, 1])
        self._places = [
            ((np.arange(shape[k])[:, None] + offsets[None, :, k]) % shape[k]) * strides[k] for k in range(3)
        ]
        # A little noise decides between equals.
        self.energy = np.random.default_rng(seed).integers(0, _SCALE >> 20, int(np.prod(shape)))
        self.on = np.zeros(len(self.energy), bool)

    def flip(self, index: int) -> None:
        z, rest = divmod(index, self._strides[0])
        y, x = divmod(rest, self._strides[1])
        place = self._places[0][z] + self._places[1][y] + self._places[2][x]
        # What is taken is never the largest void.
        sign = -1 if self.on[index] else 1
        self.energy[place] += sign * self._weights
        self.energy[index] += sign * _TAKEN
        self.on[index] = not self.on[index]

    def void(self) -> int:
        """The place of least energy, not chosen: the largest void."""
        return int(self.energy.argmin())

    def cluster(self) -> int:
        """The place of greatest energy among the chosen ones: the tightest cluster."""
        return int(self.energy.argmax())


def void_and_cluster(shape: tuple[int, int, int], pitch: tuple[float, float, float], seed: int) -> Indices:
    """Ranks, 0 to n - 1, of a block's voxels by void and cluster; ``shape`` and ``pitch`` (mm) along z, y, x."""
    field = _Field(shape, pitch, seed)
    count = int(_START * len(field.on))
    for _ in range(count):
        field.flip(field.void())
    for _ in range(10 * count):
        tight = field.cluster()
        field.flip(tight)
        loose = field.void()
        field.flip(loose)
        if loose == tight:
            break
    ranks = np.empty(len(field.on), np.int64)
    energy, on = field.energy.copy(), field.on.copy()
    for rank in range(count - 1, -1, -1):
        ranks[tight := field.cluster()] = rank
        field.flip(tight)
    field.energy, field.on = energy, on
    for rank in range(count, len(ranks)):
        ranks[loose := field.void()] = rank
        field.flip(loose)
    return ranks.reshape(shape)


@dataclass(frozen=True)
class Thresholds:
    """Thresholds between 0 and 1, ``values`` of the block along z, y, x; each block in space has its own shift."""

    values: Array
    seed: int = 0

    def layer(self, number: int, rows: slice, columns: slice) -> Array:
        """Thresholds (rows, columns) of part of a layer; they do not depend on the part that is asked for."""
        depth, height, width = self.values.shape
        row, column = np.arange(rows.start, rows.stop), np.arange(columns.start, columns.stop)
        blocks = row[0] // height, column[0] // width
        grid = np.meshgrid(
            np.arange(blocks[0], row[-1] // height + 1), np.arange(blocks[1], column[-1] // width + 1), indexing="ij"
        )
        shift = _shifts(number // depth, grid[0], grid[1], self.seed)
        at = np.ix_(row // height - blocks[0], column // width - blocks[1])
        z = (number + shift[0] % depth)[at] % depth
        y = (row[:, None] + (shift[1] % height)[at]) % height
        x = (column[None, :] + (shift[2] % width)[at]) % width
        return np.asarray(self.values[z, y, x])


def _shifts(block: int, row: Indices, column: Indices, seed: int) -> tuple[Indices, Indices, Indices]:
    """Three whole numbers from 0 to 2^20 for blocks of space, arrays of one shape: mixed bits of their place.

    The mixer is splitmix64 (Steele, Lea and Flood, OOPSLA 2014, DOI 10.1145/2660193.2660195): the same everywhere.
    """
    place = (np.uint64(seed + 1) << np.uint64(48)) + (np.uint64(block + 1) << np.uint64(32))
    mixed = place + (row.astype(np.uint64) << np.uint64(16)) + column.astype(np.uint64)
    mixed = mixed * np.uint64(0x9E3779B97F4A7C15)
    mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    mixed ^= mixed >> np.uint64(31)
    parts = [((mixed >> np.uint64(20 * k)) & np.uint64(2**20 - 1)).astype(np.int64) for k in range(3)]
    return parts[0], parts[1], parts[2]


@lru_cache(maxsize=2)
def thresholds(pitch: tuple[float, float, float], seed: int) -> Thresholds:
    """Thresholds for voxels of ``pitch`` mm along x, y, z: as many different values as the block has voxels."""
    ranks = void_and_cluster(BLOCK, (pitch[2], pitch[1], pitch[0]), seed)
    values = (ranks + 0.5) / ranks.size
    values.setflags(write=False)
    return Thresholds(values, seed)


@dataclass(frozen=True)
class Cubes:
    """A coarse grid over a window of voxels, (layers, rows, columns); ``edge``: voxels along the edges of a cube."""

    shape: tuple[int, int, int]
    edge: tuple[int, int, int]

    @staticmethod
    def over(shape: tuple[int, int, int], pitch: tuple[float, float, float], edge: float) -> "Cubes":
        """Cubes of about ``edge`` mm over a window of voxels of ``pitch`` mm along x, y, z."""
        counts = tuple(max(1, round(edge / step)) for step in reversed(pitch))
        return Cubes(shape, counts)  # type: ignore[arg-type]

    def empty(self) -> Array:
        """Array of zeros, one for every cube."""
        return np.zeros(tuple(-(-n // e) for n, e in zip(self.shape, self.edge, strict=True)))

    def add(self, totals: Array, layer: int, values: Array | Flags | Singles) -> None:
        """Add a layer's values (rows, columns) to the totals of their cubes."""
        _, rows, columns = self.edge
        summed = np.add.reduceat(values.astype(np.float32), np.arange(0, values.shape[0], rows), axis=0)
        totals[layer // self.edge[0]] += np.add.reduceat(summed, np.arange(0, values.shape[1], columns), axis=1)


CUBE = 1.0
"""Edge, mm, of the cubes in which the realised share is compared with the given one (see `VoxelCounts`)."""

FULL = 0.5
"""Share of a cube that must lie in the body for it to count, else a few voxels would decide; our choice."""


@dataclass
class VoxelCounts:
    """Counts of a body: voxels, skin voxels, and sums of the second resin's share requested, given and realised.

    ``given`` is what was left for the dither: the share requested, the skin's moved beneath it, less what did not fit
    because the interior was full. ``worst`` is the greatest difference of the given and the realised fraction over the
    body's voxels in a cube of `CUBE` that is `FULL` enough, of which there are ``cubes``.
    """

    voxels: int = 0
    skin: int = 0
    requested: float = 0.0
    given: float = 0.0
    realised: int = 0
    worst: float = 0.0
    cubes: int = 0


@dataclass
class VoxelSlicer:
    """Slices of a job in turn. ``tallies`` by body and ``counts`` by resin are complete after the last slice."""

    job: VoxelJob
    tallies: dict[str, VoxelCounts] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=dict)

    def __iter__(self) -> Iterator[Labels]:
        """Labels (rows, columns) of each layer: 0 for the background, k for the k-th of ``job.used``."""
        job = self.job
        used = {resin: k + 1 for k, resin in enumerate(job.used)}
        layers = [_Layers(job, body, used) for body in job.bodies]
        shape = (len(job.raster.y), len(job.raster.x))
        totals = np.zeros(len(used) + 1, np.int64)
        for number in range(len(job.raster.z)):
            labels = np.zeros(shape, np.uint8)
            # The first body wins where two overlap.
            for body in reversed(layers):
                body.paint(number, labels)
            totals += np.bincount(labels.ravel(), minlength=len(totals))
            yield labels
        self.tallies = {body.body.solid.name: body.finish() for body in layers}
        self.counts = {resin: int(totals[k]) for resin, k in used.items()}


class _Layers:
    """One body of a job, layer by layer: a plain one is painted, a mixed one dithered under a skin."""

    def __init__(self, job: VoxelJob, body: VoxelBody, used: dict[str, int]) -> None:
        self.body, self._raster = body, job.raster
        self._labels = [used[resin] for resin in body.blend.resins]
        self._levels, rows, columns = job.raster.window(body.inside.low, body.inside.high)
        self._rows, self._columns = _wider(rows, len(job.raster.y)), _wider(columns, len(job.raster.x))
        self._window = job.raster.plane(self._rows, self._columns)
        self.tally = VoxelCounts()
        if body.blend.share is not None:
            self._mixed = _Mixed(job, self)

    @property
    def levels(self) -> slice:
        """Layers that the body lies in."""
        return self._levels

    @property
    def window(self) -> Window:
        """Rows and columns that the body lies in, and one more in each direction where there is one."""
        return self._window

    @property
    def place(self) -> tuple[slice, slice]:
        """The window's rows and columns in the raster."""
        return self._rows, self._columns

    def section(self, number: int) -> Flags | None:
        """The body's voxels in the window, (rows, columns); None beyond its layers."""
        if not self._levels.start <= number < self._levels.stop:
            return None
        return self.body.inside.section(self._window, float(self._raster.z[number]))

    def paint(self, number: int, labels: Labels) -> None:
        """Write the labels of the body's voxels in a layer."""
        here = self._mixed.here(number) if self.body.blend.share is not None else self.section(number)
        if here is None:
            return
        part = labels[self._rows, self._columns]
        part[here] = self._labels[0]
        self.tally.voxels += int(np.count_nonzero(here))
        if self.body.blend.share is not None:
            part[self._mixed.stiff(number, self.tally)] = self._labels[1]

    def finish(self) -> VoxelCounts:
        """Complete the tally by the comparison of shares in cubes, and return it."""
        if self.body.blend.share is not None:
            self._mixed.finish(self.tally)
        return self.tally


class _Mixed:
    """The dither of one body: stiff droplets by the thresholds of blue noise, none in the skin."""

    def __init__(self, job: VoxelJob, layers: _Layers) -> None:
        self._layers, raster, levels = layers, job.raster, layers.levels
        self._z = raster.z
        self._radius = np.sqrt(layers.window.squares)
        self._noise = thresholds(raster.pitch, job.seed)
        self._made_up = SkinCompensation(self._skin, raster.pitch, reach_for(layers.body.blend.most, raster.pitch))
        self.here = RecentLayers(layers.section, self._made_up.ahead + 4)
        self._parts = RecentLayers(self._parts_of, 2 * self._made_up.ahead + 2)
        shape = (levels.stop - levels.start, *self._radius.shape)
        self._cubes = Cubes.over(shape, raster.pitch, CUBE)
        self._given_in, self._got_in, self._voxels_in = (self._cubes.empty() for _ in range(3))

    def _parts_of(self, number: int) -> tuple[Flags, Singles] | None:
        """A layer's interior, and the requested shares, 0 outside the body; None beyond its layers."""
        below, here, above = self.here(number - 1), self.here(number), self.here(number + 1)
        if here is None:
            return None
        assert self._layers.body.blend.share is not None
        share = np.zeros(here.shape, np.float32)
        radius = self._radius[here]
        share[here] = self._layers.body.blend.share(radius, np.full(radius.shape, self._z[number]))
        return interior(below, here, above), share

    def _skin(self, number: int) -> tuple[Flags, Singles] | None:
        parts = self._parts(number)
        if parts is None:
            return None
        inner, share = parts
        return inner, np.where(inner, np.float32(0), share)

    def stiff(self, number: int, tally: VoxelCounts) -> Flags:
        """Voxels of the second resin in a layer of the body, which are added to ``tally``."""
        parts, here, more = self._parts(number), self.here(number), self._made_up.layer(number)
        assert parts is not None and here is not None
        inner, share = parts
        target = share if more is None else share + more
        chosen: Flags = inner & (target > self._noise.layer(number, *self._layers.place))
        tally.skin += int(np.count_nonzero(here)) - int(np.count_nonzero(inner))
        tally.requested += float(share.sum(dtype=np.float64))
        tally.realised += int(np.count_nonzero(chosen))
        given = np.where(inner, np.minimum(target, np.float32(1)), np.float32(0))
        tally.given += float(given.sum(dtype=np.float64))
        layer = number - self._layers.levels.start
        for totals, values in ((self._given_in, given), (self._got_in, chosen), (self._voxels_in, here)):
            self._cubes.add(totals, layer, values)
        return chosen

    def finish(self, tally: VoxelCounts) -> None:
        """Put the greatest difference in cubes that are full enough, and the number of these, into the tally."""
        held = self._voxels_in >= FULL * np.prod(self._cubes.edge)
        tally.cubes = int(np.count_nonzero(held))
        if tally.cubes:
            off = np.abs(self._got_in - self._given_in)[held] / self._voxels_in[held]
            tally.worst = float(off.max())


def _wider(span: slice, count: int) -> slice:
    return slice(max(0, span.start - 1), min(count, span.stop + 1))
