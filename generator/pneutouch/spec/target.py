"""A target: the sensor's required figures, the given parameters, and the weights. One TOML, or the flags of
``select``."""

from typing import Annotated, Any, Literal

from pydantic import Field, field_validator, model_validator

from pneutouch.spec.fields import FieldsError, SparseTable, Table, name, number
from pneutouch.spec.printer import Process

SearchedShape = Literal["hemisphere", "cap", "ellipsoid", "thimble", "disc", "corrugated", "torus"]
"""Shapes that have proportions to search; a profile is drawn."""

Names = Annotated[list[str], Field(min_length=1, max_length=50)]


class TargetFigures(SparseTable):
    """[target]: the required figures of the sensor. Whatever is left out is free."""

    left_out = ("max_height_mm",)

    sensitivity_kPa_per_N: float | None = number(
        None, unit="kPa/N", low=1e-4, high=1e4, help="Slope of pressure rise over contact force."
    )
    tolerance_percent: float = number(5.0, unit="%", low=0.01, high=100, help="How far the sensitivity may be off.")
    driving_pressure_kPa: float | None = number(
        None, unit="kPa", low=0, high=1000, help="Gauge pressure before contact at which that holds; left out: free."
    )
    force_range_N: float | None = number(
        None, unit="N", low=1e-4, high=1e5, help="Contact force that the range must reach."
    )
    stiffness_least_N_per_mm: float | None = number(
        None,
        unit="N/mm",
        low=1e-6,
        high=1e5,
        help="Least stiffness: the mean over the range, or dF/dz at stiffness_depth_mm.",
    )
    stiffness_most_N_per_mm: float | None = number(
        None,
        unit="N/mm",
        low=1e-6,
        high=1e5,
        help="Greatest stiffness: the mean over the range, or dF/dz at stiffness_depth_mm.",
    )
    stiffness_depth_mm: float | None = number(
        None, unit="mm", low=1, high=3, help="Depth, 1 or 3, at which the stiffness is bounded; left out: the mean."
    )
    max_diameter_mm: float | None = number(
        None,
        unit="mm",
        low=2,
        high=300,
        help="Greatest outer diameter of the unloaded dome: 2 (R0 + t0), of a flat one 2 R0.",
    )
    max_footprint_mm: float | None = number(
        None,
        unit="mm",
        low=4,
        high=400,
        help="Greatest diameter of the whole sensor: membrane, flange and connector, a port at its side left out.",
    )
    max_height_mm: float | None = number(
        None,
        unit="mm",
        low=0.2,
        high=300,
        help="Greatest height of the dome over its flange; for a search over shapes, and for pads.",
    )
    fits: str | None = Field(
        default=None,
        pattern=r"^finger:[0-9]+(\.[0-9]+)?$",
        description="finger:MM, the finger, of that diameter in mm, that the sensor must fit on by a sleeve.",
    )
    same_sensitivity_at_kPa: list[float] | None = Field(
        default=None,
        min_length=2,
        max_length=2,
        description="Two driving pressures, kPa, at both of which the sensitivity holds; for a grade.",
    )
    same_within_percent: float = number(
        2.0, unit="%", low=0.01, high=100, help="How far the sensitivities at the two driving pressures may differ."
    )
    widest_range: bool = Field(default=False, description="Make the force range as wide as a grade can.")

    @model_validator(mode="after")
    def _stiffness_is_ordered(self) -> "TargetFigures":
        least, most = self.stiffness_least_N_per_mm, self.stiffness_most_N_per_mm
        if least is not None and most is not None and least > most:
            raise FieldsError(
                f"stiffness_least_N_per_mm = {least:g} and stiffness_most_N_per_mm = {most:g} contradict each other; "
                f"the least must not exceed the most",
                "stiffness_least_N_per_mm",
                "stiffness_most_N_per_mm",
            )
        depth = self.stiffness_depth_mm
        if depth is not None and depth not in (1, 3):
            raise FieldsError(f"stiffness_depth_mm = {depth:g}: must be 1 or 3", "stiffness_depth_mm")
        if depth is not None and least is most is None:
            bounds = "stiffness_least_N_per_mm", "stiffness_most_N_per_mm"
            text = f"stiffness_depth_mm = {depth:g} bounds nothing: give {' or '.join(bounds)} too"
            raise FieldsError(text, "stiffness_depth_mm", *bounds)
        if all(v is None for v in (self.sensitivity_kPa_per_N, self.force_range_N, least, most)):
            raise FieldsError(
                "give at least one of sensitivity_kPa_per_N, force_range_N and a stiffness",
                "sensitivity_kPa_per_N",
                "force_range_N",
                "stiffness_least_N_per_mm",
                "stiffness_most_N_per_mm",
            )
        return self

    @model_validator(mode="after")
    def _requirement_of_a_grade(self) -> "TargetFigures":
        both_kPa = self.same_sensitivity_at_kPa
        if both_kPa is None:
            return self
        if not 0 <= both_kPa[0] < both_kPa[1] <= 1000:
            raise FieldsError(
                f"same_sensitivity_at_kPa = {both_kPa}: must be two rising driving pressures from 0 to 1000 kPa",
                "same_sensitivity_at_kPa",
            )
        if self.sensitivity_kPa_per_N is None:
            raise FieldsError(
                "same_sensitivity_at_kPa needs sensitivity_kPa_per_N: at some sensitivity a constant mix does it",
                "sensitivity_kPa_per_N",
                "same_sensitivity_at_kPa",
            )
        if self.driving_pressure_kPa is not None:
            raise FieldsError(
                f"driving_pressure_kPa = {self.driving_pressure_kPa:g} and same_sensitivity_at_kPa = {both_kPa} "
                f"contradict each other; give one of them",
                "driving_pressure_kPa",
                "same_sensitivity_at_kPa",
            )
        return self

    @property
    def finger_diameter_mm(self) -> float | None:
        """Diameter, mm, of the finger that the sensor must fit on; None if none is required."""
        return None if self.fits is None else float(self.fits.partition(":")[2])

    @property
    def is_for_a_grade(self) -> bool:
        """True if a requirement is one that only the search of graded membranes handles."""
        return self.widest_range or self.same_sensitivity_at_kPa is not None


class Given(Table):
    """[given]: parameters that are settled already; the rest is solved for."""

    inner_radius_mm: float | None = number(None, unit="mm", low=1, high=100, help="Inner radius R0 of the dome.")
    wall_thickness_mm: float | None = number(None, unit="mm", low=0.05, high=50, help="Wall thickness t0 of the dome.")
    materials: Names | None = Field(
        default=None,
        description="Resins to choose from; left out: all the printer runs.",
        json_schema_extra={"registry": "materials"},
    )
    mix: str | None = Field(
        default=None,
        pattern=r"^[^+]+\+[^+]+$",
        description="SOFT+STIFF, two base resins to mix instead of a resin to choose.",
    )
    graded: bool = Field(default=False, description="Let the mix differ between pole and rim; the solid searches.")

    @model_validator(mode="after")
    def _wall_below_radius(self) -> "Given":
        radius, wall = self.inner_radius_mm, self.wall_thickness_mm
        if radius is not None and wall is not None and wall >= radius:
            raise FieldsError(
                f"wall_thickness_mm = {wall:g} must be less than inner_radius_mm = {radius:g}",
                "wall_thickness_mm",
                "inner_radius_mm",
            )
        return self

    @model_validator(mode="after")
    def _mix_or_materials(self) -> "Given":
        if self.materials is not None and (self.mix is not None or self.graded):
            raise FieldsError(
                "materials and a mix contradict each other; give one of them",
                "materials",
                "mix" if self.mix is not None else "graded",
            )
        return self


class Setting(SparseTable):
    """[setting]: the design that gives everything else: connector, tube, plate, ambient pressure, printer."""

    left_out = ("gauge", "processes", "shapes")

    base: str | None = name(
        None, registry="designs", help="Name or path of a design; left out: defaults, port push-in-4."
    )
    assignments: list[str] = Field(
        default=[], max_length=100, description="What changes the base design, TABLE.KEY=VALUE each."
    )
    profile: str | None = name(None, registry="printers", help="Printer of the membrane.")
    processes: list[Literal["any", Process]] | None = Field(
        default=None,
        min_length=1,
        description="Show the best design of each of these processes, such as polyjet,casting; any: of all that make "
        "an elastomer.",
    )
    tube_length_mm: float | None = number(None, unit="mm", low=0, high=20000, help="Tube to the pressure sensor.")
    dead_volume_mL: float | None = number(
        None, unit="mL", low=0, high=1000, help="Total gas volume behind the cavity; left out: computed."
    )
    gauge: str | None = name(
        None,
        registry="gauges",
        help="Pressure gauge, or any: the one that covers the range and detects the smallest force.",
    )

    shapes: list[Literal["any", SearchedShape]] | None = Field(
        default=None,
        min_length=1,
        description="Search these shapes by the solid and show the best of each, such as cap,disc; any: of all.",
    )

    @field_validator("processes", "shapes", mode="before")
    @classmethod
    def _listed(cls, given: Any) -> Any:
        return [given] if isinstance(given, str) else given

    @model_validator(mode="after")
    def _processes_without_others(self) -> "Setting":
        if self.processes is None:
            return self
        if "any" in self.processes and len(self.processes) > 1:
            raise FieldsError("processes: any stands for all of them; give it alone, or leave it out", "processes")
        if self.profile is not None:
            raise FieldsError(
                "processes and profile contradict each other: a profile is of one process; leave one out",
                "profile",
                "processes",
            )
        return self


class Weights(SparseTable):
    """[weights]: the preferences between designs that all meet the target."""

    left_out = ("prefer",)

    robustness: float = number(1.0, unit="", low=0, high=100, help="Weight on a small uncertainty of the sensitivity.")
    tunability: float = number(
        0.0, unit="", low=0, high=100, help="Weight on a sensitivity that moves with the driving pressure."
    )
    contact_anywhere: bool = Field(
        default=False,
        description="Count an unknown object and place of contact in that uncertainty: the design whose reading they "
        "move least comes first.",
    )
    prefer: Literal["robust", "travel", "force", "low", "ball"] | None = Field(
        default=None,
        description="What comes first in a search over shapes: a sensitivity that the wall's print error moves least "
        "(the default), the longest travel, the greatest force range, the lowest dome, or the one that reads a small "
        "ball most like a plate.",
    )


class Shelf(Table):
    """[have]: what a lab has; the search takes resins, printers, gauges and ports from these alone."""

    materials: Names | None = Field(
        default=None, description="Resins on the shelf.", json_schema_extra={"registry": "materials"}
    )
    printers: Names | None = Field(
        default=None, description="Printers that membranes can be made on.", json_schema_extra={"registry": "printers"}
    )
    gauges: Names | None = Field(default=None, description="Gauges.", json_schema_extra={"registry": "gauges"})
    ports: Names | None = Field(
        default=None, description="Ports whose fittings are there.", json_schema_extra={"registry": "ports"}
    )

    def holds(self, kind: str, name: str) -> bool:
        """True if ``name`` is on the shelf, or if the shelf lists nothing of its ``kind``, such as ports."""
        listed: list[str] | None = getattr(self, kind)
        return listed is None or name in listed


class Target(SparseTable):
    """A whole target file."""

    left_out = ("have",)

    target: TargetFigures
    given: Given = Given()
    setting: Setting = Setting()
    weights: Weights = Weights()
    have: Shelf = Shelf()

    @model_validator(mode="after")
    def _fits(self) -> "Target":
        largest, radius = self.target.max_diameter_mm, self.given.inner_radius_mm
        # A search over shapes counts the inner diameter alone: the wall of a disc lies within it.
        wall = self.given.wall_thickness_mm or 0.0 if self.setting.shapes is None else 0.0
        if largest is not None and radius is not None and 2 * (radius + wall) > largest:
            raise FieldsError(
                f"target.max_diameter_mm = {largest:g} and given.inner_radius_mm = {radius:g} contradict each other: "
                f"the dome alone is {2 * (radius + wall):g} mm wide",
                "target.max_diameter_mm",
                "given.inner_radius_mm",
            )
        return self

    @model_validator(mode="after")
    def _resins_on_the_shelf(self) -> "Target":
        missing = [name for name in self.given.materials or () if not self.have.holds("materials", name)]
        if missing:
            raise FieldsError(
                f"given.materials names {', '.join(missing)}, which have.materials, the shelf, does not",
                "given.materials",
                "have.materials",
            )
        return self

    @model_validator(mode="after")
    def _mix_on_one_machine(self) -> "Target":
        if self.setting.processes is not None and (self.given.mix is not None or self.given.graded):
            mixed = "given.graded" if self.given.graded else "given.mix"
            raise FieldsError(
                f"setting.processes and {mixed} contradict each other: a mix is printed on one machine; leave one out",
                "setting.processes",
                mixed,
            )
        return self

    @model_validator(mode="after")
    def _shapes_and_what_goes_with_them(self) -> "Target":
        only: dict[str, Any] = {
            "target.max_height_mm": self.target.max_height_mm,
            "weights.prefer": self.weights.prefer,
        }
        if self.setting.shapes is None:
            for key, value in only.items():
                if value is not None:
                    raise FieldsError(f"{key} is for a search over shapes; give setting.shapes too", key)
            return self
        others: dict[str, Any] = {
            "setting.processes": self.setting.processes,
            "given.graded": self.given.graded or None,
            "given.mix": self.given.mix,
            "weights.contact_anywhere": self.weights.contact_anywhere or None,
            "setting.gauge": "any" if self.setting.gauge == "any" else None,
        }
        for key, value in others.items():
            if value is not None:
                raise FieldsError(
                    f"a search over setting.shapes does not take {key}; leave one out", "setting.shapes", key
                )
        return self

    @model_validator(mode="after")
    def _grade_and_its_requirement(self) -> "Target":
        target, graded = self.target, self.given.graded
        if target.is_for_a_grade and not graded:
            raise FieldsError(
                "same_sensitivity_at_kPa and widest_range are met by grades; give given.graded = true too",
                "target.same_sensitivity_at_kPa",
                "target.widest_range",
                "given.graded",
            )
        if graded and not target.is_for_a_grade:
            raise FieldsError(
                "given.graded needs target.same_sensitivity_at_kPa or target.widest_range",
                "target.same_sensitivity_at_kPa",
                "target.widest_range",
                "given.graded",
            )
        if graded and target.sensitivity_kPa_per_N is None:
            raise FieldsError(
                "given.graded needs target.sensitivity_kPa_per_N", "target.sensitivity_kPa_per_N", "given.graded"
            )
        if graded and (target.stiffness_least_N_per_mm, target.stiffness_most_N_per_mm) != (None, None):
            raise FieldsError(
                "the search for a grade takes no bounds on the stiffness; leave them out",
                "target.stiffness_least_N_per_mm",
                "target.stiffness_most_N_per_mm",
                "given.graded",
            )
        if graded and self.setting.gauge == "any":
            raise FieldsError(
                "the search for a grade does not choose the gauge; give setting.gauge by name",
                "given.graded",
                "setting.gauge",
            )
        if graded and self.weights.contact_anywhere:
            raise FieldsError(
                "contact_anywhere ranks resins and mixes; the search for a grade does not take it",
                "given.graded",
                "weights.contact_anywhere",
            )
        return self
