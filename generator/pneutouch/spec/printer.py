"""A printer profile: what the machine can hold, resolve and build."""

from typing import Literal

from pydantic import Field, field_validator

from pneutouch.spec.fields import MaterialKind, Table
from pneutouch.spec.material import Material
from pneutouch.spec.quantity import Quantity
from pneutouch.units import UM

HOLE_UNDERSIZE_MM = (-0.5, 1.0)
"""Bounds of `Printer.hole_undersize_mm`, our choice: beyond them a hole was not printed but misread, and bores drawn
wider by it vanish or meet."""


_INCH_UM = 25400.0


class Envelope(Table):
    """Build envelope in mm."""

    x: float = Field(gt=0)
    y: float = Field(gt=0)
    z: float = Field(gt=0)
    source: str = Field(min_length=8)


class Mode(Table):
    """A print mode: its layer height, and whether it mixes digital materials."""

    name: str
    layer_height_um: float = Field(gt=0)
    digital_materials: bool
    resins_at_once: int | None = Field(default=None, ge=1, le=8, description="Fewer than the machine, where it is so.")
    layer_seconds: Quantity | None = Field(
        default=None, description="Time of one layer, s; of one swath where there are several."
    )
    source: str = Field(min_length=8)


class Resolution(Table):
    """Smallest addressable step in the plane, in micrometres."""

    x_um: float = Field(gt=0)
    y_um: float = Field(gt=0)
    source: str = Field(min_length=8)

    @property
    def dpi(self) -> tuple[int, int]:
        """Dots an inch along x and y: the integer nearest to the value of the rounded steps."""
        return round(_INCH_UM / self.x_um), round(_INCH_UM / self.y_um)


class VoxelPrint(Table):
    """What the machine's voxel print utility takes: a stack of PNG slices on the raster of ``resolution``."""

    colours: int = Field(ge=1, le=8, description="Most colours of a stack, the background not counted.")
    least_slices: int = Field(ge=1, description="Fewest slices of a stack.")
    source: str = Field(min_length=8)


class FeatureSize(Table):
    """A smallest size in mm: below ``least`` it fails, below ``recommended`` it is at risk."""

    least: float | None = Field(default=None, gt=0)
    recommended: float = Field(gt=0)
    source: str = Field(min_length=8)


class SmallestSizes(Table):
    """Smallest features, walls and pins by kind of material; ``channel`` is a hole much longer than wide."""

    wall_rigid_mm: FeatureSize
    wall_soft_mm: FeatureSize
    pin_rigid_mm: FeatureSize
    pin_soft_mm: FeatureSize
    hole_mm: FeatureSize
    channel_mm: FeatureSize
    gap_mm: FeatureSize
    emboss_mm: FeatureSize

    def wall(self, kind: MaterialKind) -> FeatureSize:
        """The wall limit for a kind of material."""
        return self.wall_soft_mm if kind == "elastomer" else self.wall_rigid_mm

    def pin(self, kind: MaterialKind) -> FeatureSize:
        """The limit of a free-standing pin for a kind of material."""
        return self.pin_soft_mm if kind == "elastomer" else self.pin_rigid_mm


class Printer(Table):
    """One machine as a lab runs it."""

    title: str
    process: Literal["polyjet", "filament"]
    envelope_mm: Envelope
    resolution: Resolution
    accuracy_mm: Quantity
    smallest: SmallestSizes
    resins: list[str] = Field(min_length=1, description="Base resins or filaments the machine runs.")
    resins_at_once: int = Field(ge=1, le=8)
    mode: list[Mode] = Field(min_length=1)
    support: str = Field(description="Support material and how it comes off.")
    hole_undersize_mm: Quantity = Field(description="By how much a printed hole is smaller in diameter than drawn.")
    swath_mm: Quantity | None = Field(default=None, description="Width that one pass of the heads covers.")
    deposition_mm3_per_s: Quantity | None = Field(default=None, description="Material laid down in a second; filament.")
    voxel_print: VoxelPrint | None = Field(default=None, description="Left out: the machine takes no voxel stacks.")

    @field_validator("hole_undersize_mm")
    @classmethod
    def _holes_nearly_true(cls, given: Quantity) -> Quantity:
        low, high = HOLE_UNDERSIZE_MM
        for key in ("value", "low", "high"):
            number = getattr(given, key)
            if number is not None and not low <= number <= high:
                raise ValueError(f"{key} = {number:g}: must be from {low:g} to {high:g} mm")
        return given

    def mode_for(self, *materials: Material) -> Mode | None:
        """The finest mode that prints the materials in one job, or None where the machine cannot."""
        resins = {resin for material in materials for resin in material.base_resins}
        if not resins <= set(self.resins) or len(resins) > self.resins_at_once:
            return None
        mixed = any(material.is_digital for material in materials)
        modes = [
            mode
            for mode in self.mode
            if (mode.digital_materials or not mixed) and len(resins) <= (mode.resins_at_once or self.resins_at_once)
        ]
        return min(modes, key=lambda mode: mode.layer_height_um, default=None)

    def finest_step(self, mode: Mode) -> float:
        """The smallest step the machine can make in a mode, in mm: no mesh needs to be finer."""
        return UM * min(mode.layer_height_um, self.resolution.x_um, self.resolution.y_um)
