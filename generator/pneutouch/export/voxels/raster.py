"""The raster of a stack, the blends of its bodies at every voxel, and the skin of a mixed body.

The outermost voxels of a mixed body, which have a neighbour outside, stay soft resin, and their share of the other
resin goes just beneath: no stiff droplet lies at a face, where air could leak along it.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Generic, TypeVar

import numpy as np

from pneutouch.arrays import Array, Flags, Singles
from pneutouch.body import Solid
from pneutouch.body.section import SolidSection, Window, places_within
from pneutouch.catalogue import Library
from pneutouch.errors import InputError, shown
from pneutouch.shape.dome import DomeShape
from pneutouch.spec.grade import MixingCurve
from pneutouch.spec.material import Material
from pneutouch.units import UM

INCH = 25.4
"""An inch, mm."""

_ROUNDING = 1e-6
"""Share of a step by which a size may miss a whole number of steps through rounding."""


@dataclass(frozen=True)
class Raster:
    """Centres of the voxels in the design frame, mm: ``x`` (columns), ``y`` (rows), ``z`` (layers).

    Row 0 is the one at the greatest y of the tray, so that a slice shows the part from above; layer 0 lies on the tray.
    ``dpi`` are the dots an inch along x and y; ``pitch`` the voxel's edges along x, y, z in mm.
    """

    x: Array
    y: Array
    z: Array
    dpi: tuple[int, int]
    pitch: tuple[float, float, float]

    @property
    def voxel(self) -> float:
        """Volume of a voxel, mm3."""
        return math.prod(self.pitch)

    @property
    def size(self) -> tuple[float, float, float]:
        """Edges of the whole stack, mm."""
        x, y, z = self.pitch
        return len(self.x) * x, len(self.y) * y, len(self.z) * z

    def window(self, low: Array, high: Array) -> tuple[slice, slice, slice]:
        """Slices of layers, rows and columns whose centres lie in the box between two corners (3,), mm."""
        x, y, z = (places_within(centres, low[k], high[k]) for k, centres in enumerate((self.x, self.y, self.z)))
        return z, y, x

    def plane(self, rows: slice, columns: slice) -> Window:
        """Window of rows and columns of a layer, in which sections are taken."""
        return Window(self.x[columns], self.y[rows])


def raster(
    bodies: Sequence[SolidSection], dpi: tuple[int, int], layer_um: float, *, upright: bool = True, coarser: float = 1.0
) -> Raster:
    """The raster that holds bodies: the z axis is on lines of the grid, and the first layer begins at the lowest face.

    ``upright`` False turns the bodies over, half a turn about x, as `pneutouch.body.Body.turned_over` does. ``coarser``
    multiplies all three pitches, for studies of the raster's error.
    """
    low = np.min([body.low for body in bodies], axis=0)
    high = np.max([body.high for body in bodies], axis=0)
    dx, dy, dz = coarser * INCH / dpi[0], coarser * INCH / dpi[1], coarser * layer_um * UM
    x, y = _grid(low[0], high[0], dx), _grid(low[1], high[1], dy)
    # A layer is printed where its middle lies inside.
    count = max(1, math.ceil((high[2] - low[2]) / dz - 0.5 - _ROUNDING))
    up = (np.arange(count) + 0.5) * dz
    z = low[2] + up if upright else high[2] - up
    return Raster(x, y[::-1].copy() if upright else y, z, dpi, (dx, dy, dz))


def _grid(low: float, high: float, step: float) -> Array:
    first, last = math.floor(low / step + _ROUNDING), math.ceil(high / step - _ROUNDING)
    return np.asarray((np.arange(first, last) + 0.5) * step, np.float64)


Share = Callable[[Array, Array], Array]
"""Volume fraction of the second resin at points (r, z), arrays of one shape, mm in the design frame."""


@dataclass(frozen=True)
class ResinBlend:
    """The resins of a body, soft one first; ``share`` is that of the second, None if there is only one.

    ``most`` is the greatest share. ``assumed`` states its basis where it was neither measured nor requested.
    """

    resins: tuple[str, ...]
    share: Share | None = None
    most: float = 0.0
    assumed: str = ""


def blend(material: Material, name: str, library: Library, where: str, shape: DomeShape) -> ResinBlend:
    """The blend of a material; ``name`` is its name in the catalogue, ``where`` the file and key that request it,
    ``shape`` the shape of the dome along whose arc a graded material varies.

    A digital material of the catalogue has no published mix: its fraction is taken from the mixing curve that it is a
    point of. Raises InputError if there is none, and for more than two resins.
    """
    resins = tuple(material.base_resins)
    if len(resins) == 1:
        return ResinBlend(resins)
    if len(resins) > 2:
        raise InputError(f"{where} = {shown(name)}: mixed from {len(resins)} resins; voxels are mixed from two at most")
    if material.along is not None:
        arc, fractions = np.array(material.along.arc), np.array(material.along.stiff_fraction)
        return ResinBlend(resins, lambda r, z: np.interp(shape.arc_share(r, z), arc, fractions), float(fractions.max()))
    if material.mix is not None:
        stiff = material.mix.fractions[resins[1]]
        return ResinBlend(resins, _even(stiff), stiff)
    fraction, why = _assumed(name, resins, library, where)
    return ResinBlend(resins, _even(fraction), fraction, f"{name} is {fraction:.1%} {resins[1]}: {why}")


def _even(fraction: float) -> Share:
    return lambda r, z: np.full(np.shape(r), fraction)


def _assumed(name: str, resins: tuple[str, ...], library: Library, where: str) -> tuple[float, str]:
    """Fraction of a digital material by its point on a mixing curve, and the source of that. Raises InputError."""
    curve_name = f"{resins[0]}+{resins[1]}"
    if curve_name in library.paths("mixing"):
        curve: MixingCurve = library.load("mixing", curve_name)
        for point in curve.points:
            if point.material == name:
                return point.fraction, point.source
    raise InputError(
        f"{where} = {shown(name)}: no vendor publishes how much {resins[1]} is in it, and "
        f"printprofiles/mixing/{curve_name}.toml has no point for it; give "
        f"{{ from = {shown(resins[0])}, to = {shown(resins[1])}, fraction = .. }} instead"
    )


BACKGROUND = (0, 0, 0, 255)
"""Opaque black: the background of the utility's own files (BackGroundMaterialRGBA)."""

_HEX = (0xE69F00, 0x56B4E9, 0x009E73, 0xF0E442, 0x0072B2, 0xD55E00, 0xCC79A7, 0xFFFFFF)
PALETTE = tuple((colour >> 16, colour >> 8 & 255, colour & 255, 255) for colour in _HEX)
"""Colours that people of any colour vision distinguish (M. Okabe and K. Ito, Color Universal Design, 2008), and
white."""


@dataclass(frozen=True)
class VoxelBody:
    """A body as it is jetted: its solid, its blend of resins, and ``inside``, its sections."""

    solid: Solid
    blend: ResinBlend
    inside: SolidSection = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "inside", SolidSection(self.solid))


@dataclass(frozen=True)
class VoxelJob:
    """A print job on a raster. ``resins`` are all that the printer runs: the colours follow from them."""

    bodies: tuple[VoxelBody, ...]
    raster: Raster
    resins: tuple[str, ...]
    seed: int = 1

    @property
    def used(self) -> tuple[str, ...]:
        """Resins of the bodies, in the order of the labels 1, 2, ...; 0 is the background."""
        return tuple(sorted({resin for body in self.bodies for resin in body.blend.resins}))

    @property
    def colours(self) -> dict[str, tuple[int, int, int, int]]:
        """The colour of each resin in use; see `colours_of`."""
        return colours_of(self.resins, self.used)


def colours_of(resins: Sequence[str], used: Sequence[str]) -> dict[str, tuple[int, int, int, int]]:
    """Colours of the ``used`` resins: the printer's resins by name, or if too many those used, take the palette."""
    # A printer of more resins than there are colours shares them out among those in use.
    order = sorted(resins if len(resins) <= len(PALETTE) else used)
    return {resin: PALETTE[order.index(resin)] for resin in used}


Item = TypeVar("Item")

LEAST_REACH, MOST_REACH = 0.12, 0.4
"""Least and greatest distance, mm, over which the share of a skin voxel is spread; two voxels at least. Less than a
wall: our choice."""


def interior(below: Flags | None, here: Flags, above: Flags | None) -> Flags:
    """Voxels of a layer (rows, columns) with all six neighbours inside; None is an empty layer."""
    if below is None or above is None:
        return np.zeros_like(here)
    inner = here & below & above
    inner[1:] &= here[:-1]
    inner[:-1] &= here[1:]
    inner[:, 1:] &= here[:, :-1]
    inner[:, :-1] &= here[:, 1:]
    inner[0], inner[-1], inner[:, 0], inner[:, -1] = False, False, False, False
    return inner


def reach_for(most: float, pitch: tuple[float, float, float]) -> float:
    """Distance in mm over which the share of a skin voxel is spread if the share is ``most`` at most.

    Far enough that an edge, where the shares of two faces come together, is not filled beyond one.
    """
    required = 2 * most * max(pitch) / (1 - most) if most < 1 else MOST_REACH
    return min(max(required, LEAST_REACH), MOST_REACH)


class RecentLayers(Generic[Item]):
    """Items made for layers in turn; the last ``keep`` are kept, so that those of neighbours are not made again."""

    def __init__(self, make: Callable[[int], Item], keep: int) -> None:
        self._make, self._keep = make, keep
        self._items: dict[int, Item] = {}

    def __call__(self, number: int) -> Item:
        """The item of a layer."""
        if number not in self._items:
            self._items[number] = self._make(number)
            while len(self._items) > self._keep:
                del self._items[next(iter(self._items))]
        return self._items[number]


class SkinCompensation:
    """Addition to the share of every interior voxel, so that the body keeps the share of its skin.

    The share requested in a skin voxel goes in equal parts to the interior voxels of the box of ``reach`` mm around it:
    the sum over the body is kept, and so is that of any region much larger than the reach. A share with no interior
    near is lost.
    """

    def __init__(
        self, parts: Callable[[int], tuple[Flags, Singles] | None], pitch: tuple[float, float, float], reach: float
    ) -> None:
        """``parts`` gives the interior and the skin's shares (0 elsewhere) of a layer, None beyond the body's."""
        x, y, z = (max(2, round(reach / step)) for step in pitch)
        self._parts, self._plane, self._up = parts, (y, x), z
        self._capacity = RecentLayers(self._capacities, 2 * z + 2)
        self._given = RecentLayers(self._gifts, 2 * z + 2)

    @property
    def ahead(self) -> int:
        """Number of layers to each side that the addition to a layer depends on."""
        return 2 * self._up

    def layer(self, number: int) -> Singles | None:
        """Addition in a layer, (rows, columns), valid in the interior; None if there is none."""
        return _sum(self._given(k) for k in self._around(number))

    def _around(self, number: int) -> range:
        return range(number - self._up, number + self._up + 1)

    def _capacities(self, number: int) -> Singles | None:
        parts = self._parts(number)
        return None if parts is None else _boxed(parts[0].astype(np.float32), self._plane)

    def _gifts(self, number: int) -> Singles | None:
        parts = self._parts(number)
        capacity = _sum(self._capacity(k) for k in self._around(number))
        if parts is None or capacity is None:
            return None
        deficit = parts[1]
        return _boxed(np.divide(deficit, capacity, out=np.zeros_like(deficit), where=capacity > 0), self._plane)


def _sum(layers: Iterable[Singles | None]) -> Singles | None:
    total: Singles | None = None
    for layer in layers:
        if layer is not None:
            total = layer.copy() if total is None else np.add(total, layer, out=total)
    return total


def _boxed(values: Singles, reach: tuple[int, int]) -> Singles:
    """Sums over the box of ``reach`` rows and columns to each side of every value."""
    for axis, far in enumerate(reach):
        lines = np.moveaxis(values, axis, 0)
        total = values.copy()
        out = np.moveaxis(total, axis, 0)
        for step in range(1, far + 1):
            out[step:] += lines[:-step]
            out[:-step] += lines[step:]
        values = total
    return values
