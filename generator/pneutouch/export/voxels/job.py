"""Input of a stack: the bodies of one print job, their blends, the raster and the seed."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from pneutouch.body import Solid
from pneutouch.body.section import SolidSection
from pneutouch.export.voxels.blend import ResinBlend
from pneutouch.export.voxels.raster import Raster

BACKGROUND = (0, 0, 0, 255)
"""Opaque black: the background of the utility's own files (BackGroundMaterialRGBA)."""

PALETTE = (
    (230, 159, 0, 255),
    (86, 180, 233, 255),
    (0, 158, 115, 255),
    (240, 228, 66, 255),
    (0, 114, 178, 255),
    (213, 94, 0, 255),
    (204, 121, 167, 255),
    (255, 255, 255, 255),
)
"""Colours that people of any colour vision distinguish (M. Okabe and K. Ito, Color Universal Design, 2008), and
white."""


@dataclass(frozen=True)
class VoxelBody:
    """A body as it is jetted."""

    solid: Solid
    blend: ResinBlend
    inside: SolidSection = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "inside", SolidSection(self.solid))


@dataclass(frozen=True)
class VoxelJob:
    """A print job on a raster. ``resins`` are all that the printer runs: they fix the colours, whatever is used."""

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
        """The colour of each resin in use: that of its place among the printer's, the same in every stack."""
        return colours_of(self.resins, self.used)


def colours_of(resins: Sequence[str], used: Sequence[str]) -> dict[str, tuple[int, int, int, int]]:
    """Colours by resin; the printer's resins take the palette in the order of their names."""
    # A printer of more resins than there are colours shares them out among those in use.
    order = sorted(resins if len(resins) <= len(PALETTE) else used)
    return {resin: PALETTE[order.index(resin)] for resin in used}
