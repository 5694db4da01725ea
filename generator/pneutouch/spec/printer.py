"""A printer profile: the machine's build volume, resolution and materials."""

from typing import Literal

from pydantic import Field, field_validator, model_validator

from pneutouch.errors import InputError
from pneutouch.spec.fields import MaterialKind, SparseTable, Table
from pneutouch.spec.material import MakingFacts, Material
from pneutouch.spec.values import Quantity
from pneutouch.units import UM

HOLE_UNDERSIZE_MM = (-0.5, 1.0)
"""Bounds of `Printer.hole_undersize_mm`, our choice: beyond them a hole was not printed but misread, and bores drawn
wider by it vanish or meet."""

Process = Literal["polyjet", "filament", "resin", "casting"]
"""Process by which bodies are made; "resin" is stereolithography, which prints moulds."""

CAST_STEP_MM = 0.02
"""Step of the mesh of a cast body, which copies its mould: no process sets one."""


def _no_machine(title: str, what: str) -> InputError:
    return InputError(f"{title}: has no {what}: a cast body is not printed", remedy="take the profile of a printer")


class Envelope(Table):
    """Build envelope in mm."""

    x: float = Field(gt=0, description="Width of the build envelope.", json_schema_extra={"unit": "mm"})
    y: float = Field(gt=0, description="Depth of the build envelope.", json_schema_extra={"unit": "mm"})
    z: float = Field(gt=0, description="Height of the build envelope.", json_schema_extra={"unit": "mm"})
    source: str = Field(min_length=8, description="Table, page or address; how far it was verified.")


class Mode(Table):
    """A print mode: its layer height, and whether it mixes digital materials. A mode of casting has no layers."""

    name: str = Field(description="Name of the mode, as the vendor calls it.")
    layer_height_um: float | None = Field(default=None, gt=0, description="Left out: it builds no layers.")
    digital_materials: bool = Field(description="Whether it mixes digital materials.")
    resins_at_once: int | None = Field(
        default=None, ge=1, le=8, description="Base resins in one job, if fewer than the machine's."
    )
    layer_seconds: Quantity | None = Field(
        default=None, description="Time of one layer, s; of one swath if a layer has several."
    )
    source: str = Field(min_length=8, description="Table, page or address; how far it was verified.")

    @property
    def layer_um(self) -> float:
        """Layer height, µm. Raises InputError for a mode without layers."""
        if self.layer_height_um is None:
            raise _no_machine(self.name, "layers")
        return self.layer_height_um

    @property
    def label(self) -> str:
        """Name and layer height, as sheets print it: ``High Quality, 16 µm``."""
        return self.name if self.layer_height_um is None else f"{self.name}, {self.layer_height_um:g} µm"


class Resolution(Table):
    """Smallest addressable step in the plane, in micrometres."""

    x_um: float = Field(gt=0, description="Step along x.")
    y_um: float = Field(gt=0, description="Step along y.")
    source: str = Field(min_length=8, description="Table, page or address; how far it was verified.")


class VoxelPrint(Table):
    """Input of the machine's voxel print utility: a stack of PNG slices on the raster of ``resolution``."""

    colours: int = Field(ge=1, le=8, description="Most colours of a stack, the background not counted.")
    least_slices: int = Field(ge=1, description="Fewest slices of a stack.")
    source: str = Field(min_length=8, description="Table, page or address; how far it was verified.")


class FeatureSize(Table):
    """A smallest size in mm: below ``least`` it fails, below ``recommended`` it is at risk."""

    least: float | None = Field(
        default=None,
        gt=0,
        description="Below this a feature fails: an error of `check`.",
        json_schema_extra={"unit": "mm"},
    )
    recommended: float = Field(
        gt=0, description="Below this a feature is at risk: a warning of `check`.", json_schema_extra={"unit": "mm"}
    )
    source: str = Field(min_length=8, description="Table, page or address; how far it was verified.")


class SmallestSizes(Table):
    """Smallest features, walls and pins by kind of material; ``channel`` is a hole much longer than wide."""

    wall_rigid_mm: FeatureSize | None = Field(default=None, description="Left out: the process makes nothing rigid.")
    wall_soft_mm: FeatureSize = Field(description="Wall of an elastomer.")
    pin_rigid_mm: FeatureSize | None = Field(default=None, description="Left out: the process makes nothing rigid.")
    pin_soft_mm: FeatureSize = Field(description="Free-standing pin of an elastomer.")
    hole_mm: FeatureSize = Field(description="Hole no longer than three widths.")
    channel_mm: FeatureSize = Field(description="Hole much longer than wide.")
    gap_mm: FeatureSize = Field(description="Gap between bodies of one job.")
    emboss_mm: FeatureSize = Field(description="Raised or engraved detail.")

    def wall(self, kind: MaterialKind) -> FeatureSize:
        """The wall limit for a kind of material; the soft one where the process makes nothing rigid."""
        return self.wall_soft_mm if kind == "elastomer" else self.wall_rigid_mm or self.wall_soft_mm

    def pin(self, kind: MaterialKind) -> FeatureSize:
        """The limit of a free-standing pin for a kind of material; the soft one if the process makes none rigid."""
        return self.pin_soft_mm if kind == "elastomer" else self.pin_rigid_mm or self.pin_soft_mm


_ENVELOPE = "Left out of casting alone: the printer of the mould bounds the size."


class Printer(SparseTable):
    """One machine as a lab runs it, or casting, which has no machine: no envelope, no pixels and no layers."""

    left_out = ("making",)

    title: str = Field(description="Name of the machine.")
    process: Process = Field(description="How bodies are made; resin is stereolithography, casting has no machine.")
    envelope_mm: Envelope | None = Field(default=None, description=_ENVELOPE)
    resolution: Resolution | None = Field(default=None, description="Left out of casting alone.")
    accuracy_mm: Quantity = Field(description="Deviation of a printed length from the drawn one, to either side.")
    smallest: SmallestSizes = Field(description="Smallest sizes that it makes.")
    resins: list[str] = Field(min_length=1, description="Base resins or filaments the machine runs.")
    resins_at_once: int = Field(ge=1, le=8, description="Base resins in one job.")
    mode: list[Mode] = Field(min_length=1, description="Print modes, one table each.")
    support: str = Field(description="Support material and how it comes off.")
    hole_undersize_mm: Quantity = Field(description="By how much a printed hole is smaller in diameter than drawn.")
    swath_mm: Quantity | None = Field(default=None, description="Width that one pass of the heads covers.")
    deposition_mm3_per_s: Quantity | None = Field(default=None, description="Material laid down in a second; filament.")
    voxel_print: VoxelPrint | None = Field(default=None, description="Left out: the machine takes no voxel stacks.")
    making: MakingFacts | None = Field(default=None, description="Facts for the steps of the print sheet.")

    @field_validator("hole_undersize_mm")
    @classmethod
    def _holes_nearly_true(cls, given: Quantity) -> Quantity:
        low, high = HOLE_UNDERSIZE_MM
        for key in ("value", "low", "high"):
            number = getattr(given, key)
            if number is not None and not low <= number <= high:
                raise ValueError(f"{key} = {number:g}: must be from {low:g} to {high:g} mm")
        return given

    @model_validator(mode="after")
    def _of_its_process(self) -> "Printer":
        layered = [mode.layer_height_um is not None for mode in self.mode]
        given = {"envelope_mm": self.envelope_mm, "resolution": self.resolution}
        if self.is_casting:
            wrong = [key for key, table in given.items() if table is not None]
            if wrong or any(layered):
                key = wrong[0] if wrong else "mode.layer_height_um"
                raise ValueError(f'{key}: process = "casting" has none; leave it out')
            return self
        for key, table in given.items():
            if table is None:
                raise ValueError(f'{key}: missing; it may be left out with process = "casting" alone')
        if not all(layered):
            raise ValueError('mode.layer_height_um: missing; it may be left out with process = "casting" alone')
        if self.smallest.wall_rigid_mm is None or self.smallest.pin_rigid_mm is None:
            raise ValueError("smallest: wall_rigid_mm and pin_rigid_mm are missing")
        return self

    @property
    def is_casting(self) -> bool:
        """True if it stands for casting in a mould, not for a machine."""
        return self.process == "casting"

    @property
    def pixel(self) -> Resolution:
        """The step in the plane. Raises InputError for casting, which has none."""
        if self.resolution is None:
            raise _no_machine(self.title, "pixels")
        return self.resolution

    @property
    def envelope(self) -> Envelope:
        """The build envelope. Raises InputError for casting, which has none."""
        if self.envelope_mm is None:
            raise _no_machine(self.title, "build volume")
        return self.envelope_mm

    def mode_for(self, *materials: Material) -> Mode | None:
        """The finest mode that makes the materials in one job, else None.

        Casting needs a table [casting] of each material; a mix that no machine has a code for needs voxel print.
        """
        if self.is_casting and not all(material.is_cast for material in materials):
            return None
        resins = {resin for material in materials for resin in material.base_resins}
        if not resins <= set(self.resins) or len(resins) > self.resins_at_once:
            return None
        if self.voxel_print is None and any(material.is_uncoded for material in materials):
            return None
        mixed = any(material.is_digital for material in materials)
        modes = [
            mode
            for mode in self.mode
            if (mode.digital_materials or not mixed) and len(resins) <= (mode.resins_at_once or self.resins_at_once)
        ]
        return min(modes, key=lambda mode: mode.layer_height_um or 0.0, default=None)

    def finest_step(self, mode: Mode) -> float:
        """The smallest step the machine can make in a mode, in mm: no mesh needs to be finer."""
        if self.is_casting:
            return CAST_STEP_MM
        return UM * min(mode.layer_um, self.pixel.x_um, self.pixel.y_um)
