"""The slices of a job: which resin lies in every voxel, layer by layer, in memory that does not grow with their
number.

A coarse grid of cubes over voxels, in which fractions are compared.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from pneutouch.arrays import Array, Flags, Labels, Singles
from pneutouch.body.section import Window
from pneutouch.export.voxels.bluenoise import thresholds
from pneutouch.export.voxels.raster import VoxelBody, VoxelJob
from pneutouch.export.voxels.skin import RecentLayers, SkinCompensation, interior, reach_for


@dataclass(frozen=True)
class Cubes:
    """A coarse grid over a window of voxels, (layers, rows, columns); ``edge`` are voxels of a cube in each
    direction."""

    shape: tuple[int, int, int]
    edge: tuple[int, int, int]

    @staticmethod
    def over(shape: tuple[int, int, int], pitch: tuple[float, float, float], edge: float) -> Cubes:
        """Cubes of about ``edge`` mm over a window of voxels of ``pitch`` mm along x, y, z."""
        counts = tuple(max(1, round(edge / step)) for step in reversed(pitch))
        return Cubes(shape, counts)  # type: ignore[arg-type]

    def empty(self) -> Array:
        """A number for every cube."""
        return np.zeros(tuple(-(-n // e) for n, e in zip(self.shape, self.edge, strict=True)))

    def add(self, totals: Array, layer: int, values: Array | Flags | Singles) -> None:
        """Add a layer's values (rows, columns) to the totals of their cubes."""
        _, rows, columns = self.edge
        summed = np.add.reduceat(values.astype(np.float32), np.arange(0, values.shape[0], rows), axis=0)
        totals[layer // self.edge[0]] += np.add.reduceat(summed, np.arange(0, values.shape[1], columns), axis=1)


CUBE = 1.0
"""Edge in mm of the cubes in which the dithered share is compared with the given one."""

FULL = 0.5
"""Share of a cube that must lie in the body for it to count: the error of a few voxels has no meaning; our choice."""


@dataclass
class VoxelCounts:
    """Voxel counts of a body: voxels, skin voxels, the sums of the second resin's share asked for and realised.

    ``given`` is what was left for the dither: the skin's share made up for beneath it, less what did not fit because
    the interior was full. ``worst`` is the greatest difference of the given and the realised fraction over the body's
    voxels in a cube of `CUBE` that is `FULL` enough, of which there are ``cubes``.
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
    """Slices of a job in turn. ``tallies`` by body and ``counts`` by resin are whole after the last one."""

    job: VoxelJob
    tallies: dict[str, VoxelCounts] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=dict)

    def __iter__(self) -> Iterator[Labels]:
        """Labels (rows, columns): 0 for the background, k for the k-th of ``job.used``."""
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
        """The body's voxels in the window, None beyond its layers."""
        if not self._levels.start <= number < self._levels.stop:
            return None
        return self.body.inside.section(self._window, float(self._raster.z[number]))

    def paint(self, number: int, labels: Labels) -> None:
        """Write the body's voxels of a layer."""
        here = self._mixed.here(number) if self.body.blend.share is not None else self.section(number)
        if here is None:
            return
        part = labels[self._rows, self._columns]
        part[here] = self._labels[0]
        self.tally.voxels += int(np.count_nonzero(here))
        if self.body.blend.share is not None:
            part[self._mixed.stiff(number, self.tally)] = self._labels[1]

    def finish(self) -> VoxelCounts:
        """The tally, its cubes looked through."""
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
        """A layer's interior, and its shares, 0 outside."""
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
        """Voxels of the second resin in a layer of the body."""
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
        """Look through the cubes that are full enough."""
        held = self._voxels_in >= FULL * np.prod(self._cubes.edge)
        tally.cubes = int(np.count_nonzero(held))
        if tally.cubes:
            off = np.abs(self._got_in - self._given_in)[held] / self._voxels_in[held]
            tally.worst = float(off.max())


def _wider(span: slice, count: int) -> slice:
    return slice(max(0, span.start - 1), min(count, span.stop + 1))
