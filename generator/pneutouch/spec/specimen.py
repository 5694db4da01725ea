"""The specimen file: a soft block with rigid patterns in it, one TOML a specimen, known by its [block] table.

Section 5 of the paper slides a sensor over such a block (Figure 9). A pattern is given by its pitch, or by the
frequency that it is to have at the speed of the scan; the pitch is then speed over frequency.
"""

from typing import Annotated, Any, Literal

from pydantic import Field, SerializeAsAny, model_validator

from pneutouch.errors import InputError, nearest, shown
from pneutouch.spec.design import DocumentHead, Printable
from pneutouch.spec.fields import Table, name, number
from pneutouch.spec.read import validate

StrutKind = Literal["simple-cubic", "bcc", "fcc", "octet", "kelvin"]
SurfaceKind = Literal["gyroid", "schwarz-p", "diamond"]


class Block(Table):
    """[block]: the body that is scanned; x runs along the path, z up to the scanned surface at height_mm."""

    length_mm: float = number(60.0, unit="mm", low=1, high=1000, help="Length along the path of the scan.")
    width_mm: float = number(20.0, unit="mm", low=1, high=1000, help="Width across the path.")
    height_mm: float = number(8.0, unit="mm", low=0.5, high=500, help="Height up to the scanned surface.")
    matrix: str = name("Agilus30", registry="materials", help="Resin of the block.")
    inclusion: str = name("VeroClear", registry="materials", help="Resin of the patterns in it.")

    @model_validator(mode="after")
    def _two(self) -> "Block":
        if self.matrix == self.inclusion:
            raise ValueError(f"inclusion = {shown(self.inclusion)} is the matrix too; it must be another material")
        return self


class Scan(Table):
    """[scan]: how the sensor is moved over it (paper, Figure 9)."""

    speed_mm_per_s: float = number(4.0, unit="mm/s", low=0.001, high=10000, help="Speed along the path.")


def _check_one(key: str, value: object, other: str, instead: object) -> None:
    """Raise ValueError unless one of the keys has a value, and the other None."""
    if (value is None) == (instead is None):
        both = "both are" if value is not None else "neither is"
        raise ValueError(f"exactly one of {key} and {other} must be given; {both}")


class Layer(Table):
    """Fields that every [[layer]] has."""

    kind: str = Field(description="Kind of pattern.")
    name: Printable | None = Field(default=None, min_length=1, max_length=40, description="Name of the pattern.")
    depth_mm: float = number(0.0, unit="mm", low=0, high=500, help="Depth of its top below the surface.")
    start_mm: float = number(0.0, unit="mm", low=0, high=1000, help="Where it begins along the path.")
    end_mm: float | None = number(
        None, unit="mm", low=0, high=1000, help="Where it ends along the path; left out: at the end of the block."
    )
    target_frequency_Hz: float | None = number(
        None, unit="Hz", low=1e-4, high=1e5, help="Frequency at the speed of the scan, instead of the pitch."
    )

    def period(self) -> float | None:
        """Pitch or cell as given, mm; None if the frequency is given instead."""
        raise NotImplementedError

    def period_key(self) -> str:
        """Name of the key that gives the pitch or cell."""
        return "pitch_mm"

    def pitch(self, speed: float) -> float:
        """Pitch along the path in mm, at a speed of the scan in mm/s."""
        given = self.period()
        if given is not None:
            return given
        assert self.target_frequency_Hz is not None
        return speed / self.target_frequency_Hz

    @model_validator(mode="after")
    def _one_period(self) -> "Layer":
        _check_one(self.period_key(), self.period(), "target_frequency_Hz", self.target_frequency_Hz)
        return self

    @model_validator(mode="after")
    def _ends_beyond_its_start(self) -> "Layer":
        if self.end_mm is not None and self.end_mm <= self.start_mm:
            raise ValueError(f"end_mm = {self.end_mm:g} must be more than start_mm = {self.start_mm:g}")
        return self


class _Pitched(Layer):
    pitch_mm: float | None = number(None, unit="mm", low=0.001, high=1000, help="Pitch along the path.")
    height_mm: float = number(
        1.0, unit="mm", low=0.001, high=500, help="Height of the bars, or of the sheet in its troughs."
    )
    offset_mm: float = number(0.0, unit="mm", low=0, high=1000, help="Shift of the pattern along the path.")

    def period(self) -> float | None:
        return self.pitch_mm


class Bars(_Pitched):
    """Straight bars across the path; the first one's near side stands at start + offset."""

    kind: Literal["bars"] = Field(description="Straight bars across the path.")
    width_mm: float = number(1.5, unit="mm", low=0.001, high=1000, help="Width of a bar along the path.")
    span_mm: float | None = number(
        None, unit="mm", low=0.001, high=1000, help="Length of a bar across the path; left out: the block's width."
    )


class Sinusoid(_Pitched):
    """A sheet across the block whose top is a sine; its crests lie at depth_mm."""

    kind: Literal["sinusoid"] = Field(description="A sheet whose top is a sine.")
    amplitude_mm: float = number(0.5, unit="mm", low=0.001, high=500, help="Half of the height from trough to crest.")


class RandomPhase(Layer):
    """A sheet whose top is a sum of sines of one amplitude, with phases drawn once from a seed."""

    kind: Literal["random-phase"] = Field(description="A sheet whose top is a sum of sines.")
    pitches_mm: list[Annotated[float, Field(ge=0.001, le=1000)]] | None = Field(
        default=None, min_length=1, max_length=50, description="pitches along the path, each from 0.001 to 1000 mm"
    )
    target_frequencies_Hz: list[Annotated[float, Field(ge=1e-4, le=1e5)]] | None = Field(
        default=None, min_length=1, max_length=50, description="frequencies at the speed of the scan, Hz"
    )
    amplitude_mm: float = number(0.3, unit="mm", low=0.001, high=500, help="Amplitude of each sine.")
    height_mm: float = number(1.0, unit="mm", low=0.001, high=500, help="Thickness under the lowest trough.")
    seed: int = Field(default=1, ge=0, le=2**31 - 1, description="Seed of the phases; a whole number from 0.")

    def period(self) -> float | None:
        """First pitch as given, mm; None if frequencies are given instead."""
        return None if self.pitches_mm is None else self.pitches_mm[0]

    def period_key(self) -> str:
        """Name of the key that gives the pitches."""
        return "pitches_mm"

    def pitches(self, speed: float) -> list[float]:
        """Pitches in mm, as given or from the frequencies at a speed in mm/s."""
        if self.pitches_mm is not None:
            return self.pitches_mm
        return [speed / frequency for frequency in self.target_frequencies_Hz or []]

    @model_validator(mode="after")
    def _one_period(self) -> "RandomPhase":
        if self.target_frequency_Hz is not None:
            raise ValueError("a random-phase layer takes target_frequencies_Hz, a list, not target_frequency_Hz")
        _check_one("pitches_mm", self.pitches_mm, "target_frequencies_Hz", self.target_frequencies_Hz)
        return self


class _Celled(Layer):
    cell_mm: float | None = number(None, unit="mm", low=0.01, high=1000, help="Side of the cubic cell.")
    height_mm: float | None = number(
        None, unit="mm", low=0.001, high=500, help="Height of the layer; left out: down to the bottom of the block."
    )
    volume_fraction: float | None = number(
        None, unit="", low=0.001, high=0.999, help="Share of the layer that it fills."
    )

    def period(self) -> float | None:
        return self.cell_mm

    def period_key(self) -> str:
        return "cell_mm"


class StrutLattice(_Celled):
    """A lattice of round struts."""

    kind: StrutKind = Field(description="Cell of the lattice.")
    strut_radius_mm: float | None = number(None, unit="mm", low=0.001, high=500, help="Radius of the struts.")

    @model_validator(mode="after")
    def _one_radius(self) -> "StrutLattice":
        _check_one("strut_radius_mm", self.strut_radius_mm, "volume_fraction", self.volume_fraction)
        return self


class MinimalSurface(_Celled):
    """A triply periodic minimal surface: a sheet about it, or the network on one side of it."""

    kind: SurfaceKind = Field(description="The surface.")
    form: Literal["sheet", "network"] = Field(default="sheet", description="sheet or network")
    thickness_mm: float | None = number(
        None, unit="mm", low=0.001, high=500, help="Mean thickness of a sheet: its volume over its middle surface."
    )

    @model_validator(mode="after")
    def _one_thickness(self) -> "MinimalSurface":
        _check_one("thickness_mm", self.thickness_mm, "volume_fraction", self.volume_fraction)
        if self.form == "network" and self.thickness_mm is not None:
            raise ValueError(f"thickness_mm = {self.thickness_mm:g}: a network has none; give volume_fraction")
        return self


class FramePlate(Table):
    """[frame]: a rigid plate under the block, wider than it, a hole in each corner and a cut corner at x = y = 0."""

    material: str | None = name(None, registry="materials", help="Material; left out: that of the patterns.")
    border_mm: float = number(8.0, unit="mm", low=1, high=100, help="Width of the plate beyond the block.")
    thickness_mm: float = number(3.0, unit="mm", low=0.5, high=50, help="Thickness of the plate.")
    hole_diameter_mm: float = number(
        3.4, unit="mm", low=0.1, high=50, help="Mounting holes; 3.4 mm clears an M3 screw."
    )
    mark: str = Field(
        default="",
        pattern=r"^[A-Za-z0-9.+-]{0,24}$",
        description="up to 24 letters, digits, points, + or -; left out: no mark",
    )


class SpecimenPrint(Table):
    """[print]: the printer."""

    profile: str = name("j735", registry="printers", help="Printer; it holds all materials at once.")


class Specimen(Table):
    """A whole specimen file; ``layer`` holds models of LAYERS."""

    document: DocumentHead = DocumentHead(title="Texture specimen")
    block: Block = Block()
    scan: Scan = Scan()
    layer: list[SerializeAsAny[Layer]] = Field(min_length=1, max_length=50, description="one [[layer]] a pattern")
    frame: FramePlate | None = None
    print: SpecimenPrint = SpecimenPrint()


_KINDS: tuple[tuple[type[Layer], Any], ...] = (
    (Bars, ("bars",)),
    (Sinusoid, ("sinusoid",)),
    (RandomPhase, ("random-phase",)),
    (StrutLattice, ("simple-cubic", "bcc", "fcc", "octet", "kelvin")),
    (MinimalSurface, ("gyroid", "schwarz-p", "diamond")),
)

LAYERS: dict[str, type[Layer]] = {kind: model for model, kinds in _KINDS for kind in kinds}
"""Model of a [[layer]] table by its ``kind``."""


def validate_specimen(content: dict[str, Any], where: str) -> Specimen:
    """Specimen from the content of a file, layers checked by the models of their kinds. Raises InputError."""
    layers = content.get("layer", [])
    if not isinstance(layers, list):
        raise InputError("layer: must be tables, written [[layer]]", file=where)
    models = [_layer(layer, f"{where}: layer[{k}]") for k, layer in enumerate(layers)]
    return validate(Specimen, {**content, "layer": models}, where)


def _layer(content: Any, where: str) -> Layer:
    kind = content.get("kind") if isinstance(content, dict) else None
    if not isinstance(kind, str) or kind not in LAYERS:
        raise InputError(f"{where}.kind = {shown(kind)}: unknown.{nearest(str(kind), LAYERS)}")
    return validate(LAYERS[kind], content, where)
