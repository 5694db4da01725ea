"""The design file: the TOML file that a user writes, one a design. Defaults are the paper's sensor."""

import datetime
import math
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, Field, StringConstraints, model_validator

from pneutouch.errors import shown
from pneutouch.spec.contact import ContactTable
from pneutouch.spec.fields import (
    EntryError,
    FieldsError,
    SparseTable,
    Table,
    declaration,
    list_check,
    name,
    number,
    numbers,
)
from pneutouch.spec.membrane_table import Membrane
from pneutouch.spec.part import PerforatedRing

if TYPE_CHECKING:
    pass

MOST_CAVITIES = 16


class Mould(Table):
    """[mould]: the machine and material of the mould, how many domes it makes, and its details.

    Defaults without a source are this project's own choice and untested; `pneutouch check` judges them.
    """

    profile: str = name("abs-filament", registry="printers", help="Printer of the mould.")
    material: str = name("ABS", registry="materials", help="Material of the mould.")
    cavities: int = number(1, unit="", low=1, high=MOST_CAVITIES, help="Domes that one mould makes at a time.")
    wall_mm: float = number(4.0, unit="mm", low=1, high=20, help="Thickness of plates and of walls between cavities.")
    draft_deg: float = number(
        2.0,
        unit="deg",
        low=0.5,
        high=10,
        help="Slope of faces along their draw; the flange of a cast membrane has it too.",
    )
    fastener: Literal["screws", "clips"] = Field(
        default="screws", description="What holds the mould closed: M3 screws, or spring clips on ledges."
    )
    vent_diameter_mm: float = number(
        1.5, unit="mm", low=0.5, high=10, help="Vents at the flange's underside, the highest place as poured."
    )
    sprue_diameter_mm: float = number(1.8, unit="mm", low=0.5, high=20, help="Pour channel where it meets the flange.")
    clearance_mm: float = number(
        0.1, unit="mm", low=0.05, high=1, help="Clearance per side of the cones that centre core and cap."
    )
    shrinkage_percent: float | None = number(
        None, unit="%", low=0, high=10, help="Linear shrinkage of the silicone; left out: the material's."
    )


def _within(low: float, high: float, unit: str) -> AfterValidator:
    check = list_check(low, high, unit)
    return AfterValidator(lambda values: None if values is None else sorted(check(values)))


def _printable(text: str) -> str:
    if not text.isprintable():
        raise ValueError(f"{shown(text)} has characters that cannot be printed; it must be one line of printable text")
    return text


Printable = Annotated[str, AfterValidator(_printable)]


class DocumentHead(Table):
    """[document]: the head of the datasheet."""

    title: Printable = Field(default="Pneumatic touch sensor", max_length=80, description="Title of the datasheet.")
    revision: Printable = Field(default="A", max_length=8, description="Revision letter of the design.")
    date: datetime.date | None = Field(
        default=None, description="Date of the revision; left out, the datasheet is undated."
    )


class Connector(SparseTable):
    """[connector]: the rigid body that closes the cavity and carries the tube."""

    left_out = ("glue",)

    material: str = name("ABS", registry="materials", help="Material of the connector.")
    port: str = name("barb-4x2.5", registry="ports", help="Pneumatic port.")
    seat: str = name("glued-flange", registry="seats", help="How the membrane's flange is held.")
    mount: str = name("bolt-circle-4xM3", registry="mounts", help="Pattern of the mounting holes.")
    finger_diameter_mm: float | None = number(
        None,
        unit="mm",
        low=6,
        high=100,
        help="Finger that a sleeve goes over, for a mount that is one, whatever number its name has; left out: the "
        "mount's own.",
    )
    glue: Literal["silicone-adhesive", "cyanoacrylate", "epoxy"] | None = Field(
        default=None,
        description="Glue of a glued flange or a cast ring: silicone-adhesive, cyanoacrylate or epoxy; left out: "
        "silicone-adhesive for a cast flange, epoxy for a cast ring, else the maker's choice.",
    )


def _adaptors(pieces: list[list[float]]) -> list[list[float]]:
    for index, piece in enumerate(pieces):
        if len(piece) != 2 or not all(0.1 <= size <= 1000.0 for size in piece) or piece[1] > 50.0:
            raise EntryError("an adaptor is [length, bore], from 0.1 to 1000 and 50 mm", index, piece)
    return pieces


class Pneumatics(SparseTable):
    """[pneumatics]: pressures, tube, gauge and gas volume."""

    left_out = ("gauge", "gauge_volume_mL", "injected_volumes_mL", "apex_heights_mm", "adaptors_mm")

    driving_pressures_kPa: Annotated[list[float], _within(-100, 1000, "kPa")] = numbers(
        [0.0, 5.0, 12.0, 22.0],
        unit="kPa",
        low=-100,
        high=1000,
        help="Gauge pressures before contact at which the sensor is used: the online stiffness. Below 0: a vacuum.",
    )
    injected_volumes_mL: Annotated[list[float] | None, _within(-1000, 100000, "mL")] = numbers(
        None,
        unit="mL",
        low=-1000,
        high=100000,
        help="Gas that a syringe injects into the vented sensor, as a volume at ambient pressure: further states, also "
        "beyond the limit point, where one pressure has two; left out: none.",
    )
    apex_heights_mm: Annotated[list[float] | None, _within(0, 1000, "mm")] = numbers(
        None,
        unit="mm",
        low=0,
        high=1000,
        help="Heights of the inflated dome outside, above the base plane: further states, as by injected_volumes_mL; "
        "left out: none.",
    )
    ambient_pressure_kPa: float = number(
        101.325, unit="kPa", low=20, high=1000, help="Absolute pressure around the sensor."
    )
    tube: str | None = name(
        None, registry="tubes", help="Tube between port and pressure sensor; left out: the port's usual one."
    )
    tube_length_mm: float = number(
        300.0, unit="mm", low=0, high=20000, help="Tube between the port and the pressure sensor."
    )
    adaptors_mm: Annotated[list[list[float]], AfterValidator(_adaptors)] | None = Field(
        default=None,
        max_length=20,
        json_schema_extra={"unit": "mm", "low": 0.1, "high": 1000.0},
        description="Reducers and fittings between tube and gauge, from the tube on: [length, bore] of each.",
    )
    gauge: str | None = name(
        None, registry="gauges", help="Pressure gauge at the end of the tube; left out: the paper's, +-100 kPa."
    )
    gauge_volume_mL: float | None = number(
        None,
        unit="mL",
        low=0,
        high=1000,
        help="Gas in the gauge's port, chamber and fitting; left out: as its maker states, if so.",
    )
    dead_volume_mL: float | None = number(
        None,
        unit="mL",
        low=0,
        high=1000,
        help="Total gas volume behind the cavity; left out: computed from connector and tube.",
    )


class Environment(SparseTable):
    """[environment]: surroundings of the sensor."""

    left_out = ("temperature_C",)

    temperature_C: float | None = number(
        None, unit="°C", low=-60, high=150, help="Temperature of the membrane; left out: that of its data, about 20."
    )


class Indentation(Table):
    """[indentation]: how the sensor is pressed (paper, section 3-B)."""

    depth_mm: float | None = number(
        None,
        unit="mm",
        low=0.01,
        high=200,
        help="Plate travel after first contact; left out: three quarters of the dome's height inside.",
    )
    steps: int = number(14, unit="", low=2, high=1000, help="Number of equal plate steps.")
    checked_waves: int = number(
        8,
        unit="",
        low=0,
        high=32,
        help="Greatest number of waves around the axis for which the model solid checks the stability of the pressed "
        "dome: one is sway, more are lobes; 0: no check.",
    )
    plate_diameter_mm: float = number(
        30.0, unit="mm", low=1, high=500, help="Diameter of the rigid flat plate; the same key of [contact] is as good."
    )


class Print(Table):
    """[print]: the printers, and the orientation of the membrane."""

    profile: str = name("objet260-connex", registry="printers", help="Printer of the membrane.")
    connector_profile: str = name("abs-filament", registry="printers", help="Printer of the connector.")
    orientation: Literal["dome-up", "dome-down"] = Field(
        default="dome-up", description="How the membrane stands in the machine: dome-up or dome-down."
    )


Reason = Annotated[str, StringConstraints(strip_whitespace=True, min_length=3, max_length=200)] | None


def _reason(rule: str) -> Any:
    return Field(default=None, description=f"Reason to accept warnings of the rule {rule}.")


class Accepted(Table):
    """[accepted]: print rules whose warnings, not errors, are accepted with a reason each; they become notes."""

    remark: ClassVar[str] = (
        " Only flaws of a print can be accepted: what driving, hollows or resins report is to be mended."
    )

    mesh: Reason = _reason("mesh")
    walls: Reason = _reason("walls")
    pins: Reason = _reason("pins")
    holes: Reason = _reason("holes")
    channels: Reason = _reason("channels")
    gaps: Reason = _reason("gaps")
    emboss: Reason = _reason("emboss")
    edges: Reason = _reason("edges")
    cleaning: Reason = _reason("cleaning")
    matte: Reason = _reason("matte")
    filling: Reason = _reason("filling")
    bubbles: Reason = _reason("bubbles")
    inhibition: Reason = _reason("inhibition")
    glue: Reason = _reason("glue")
    gland: Reason = _reason("gland")
    freedom: Reason = _reason("freedom")
    mixing_curve: Reason = _reason("mixing curve")
    mould_fit: Reason = _reason("mould fit")
    mould_filling: Reason = _reason("mould filling")

    @property
    def reasons(self) -> dict[str, str]:
        """Reasons by the name of the rule."""
        given = self.model_dump(exclude_none=True)
        return {key.replace("_", " "): reason for key, reason in given.items()}


CALIBRATION = "calibration"
"""Key of a design file, outside its tables, that names a calibration."""

NO_CALIBRATION = "none"
"""Name that stands for no calibration; as a change it overrides the one that a design file names."""


class DesignFile(SparseTable):
    """A whole design file."""

    left_out = (CALIBRATION, "mould", "cast_ring", "accepted", "environment")
    prefixed: ClassVar[tuple[str, ...]] = ("accepted", "mould")

    calibration: str | None = Field(
        default=None,
        min_length=1,
        max_length=200,
        description="Calibration of the sensor in hand, by name; left out: the design as it is drawn.",
        json_schema_extra={"registry": "calibrations"},
    )
    document: DocumentHead = DocumentHead()
    membrane: Membrane = Membrane()
    connector: Connector = Connector()
    pneumatics: Pneumatics = Pneumatics()
    environment: Environment = Environment()
    indentation: Indentation = Indentation()
    contact: ContactTable = ContactTable()
    print: Print = Print()
    mould: Mould = Mould()
    cast_ring: PerforatedRing = PerforatedRing()
    accepted: Accepted = Accepted()

    @model_validator(mode="before")
    @classmethod
    def _one_plate(cls, content: Any) -> Any:
        """Copy the plate's diameter from [contact] into [indentation]. Raises FieldsError if they differ."""
        if not isinstance(content, dict):
            return content
        tables = [content.get("indentation", {}), content.get("contact", {})]
        if not all(isinstance(table, dict) for table in tables):
            return content
        old, new = (table.get("plate_diameter_mm") for table in tables)
        known = declaration(ContactTable, "plate_diameter_mm")
        if type(new) not in (int, float) or not (known.low or 0) <= new <= (known.high or math.inf):
            # None, or what the table that it stands in refuses.
            return content
        if old is not None and old != new:
            raise FieldsError(
                f"contact.plate_diameter_mm = {shown(new)} and indentation.plate_diameter_mm = {shown(old)} are one "
                "diameter: change both, or take one out",
                "indentation.plate_diameter_mm",
                "contact.plate_diameter_mm",
            )
        return {**content, "indentation": {**tables[0], "plate_diameter_mm": new}}

    @property
    def calibration_name(self) -> str | None:
        """Name of the calibration; None if none is named, or ``none`` is."""
        return None if self.calibration == NO_CALIBRATION else self.calibration

    @property
    def depth_mm(self) -> float:
        """Plate travel: as given, else 0.75 of the dome's inner height (R0 in the paper, section 3-B)."""
        given = self.indentation.depth_mm
        return 0.75 * self.membrane.dome.height if given is None else given

    @model_validator(mode="after")
    def _depth_inside_dome(self) -> "DesignFile":
        given = self.indentation.depth_mm
        if given is not None and given > 0.95 * (height := self.membrane.dome.height):
            raise FieldsError(
                f"indentation.depth_mm = {given:g} must be at most 0.95 of the dome's height inside, {height:g} mm "
                f"(membrane.inner_radius_mm = {self.membrane.inner_radius_mm:g}): the plate would reach the seat",
                "membrane.inner_radius_mm",
                "indentation.depth_mm",
            )
        return self
