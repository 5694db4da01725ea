"""The results file: a lab's readings of its coupons, one TOML with one table a coupon and material, printer or design.

An empty list means not measured. Else there are at least two readings, so that there is a spread; in a curve three.
"""

import datetime
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, Field, ValidationError, model_validator

from pneutouch.errors import InputError, nearest, shown
from pneutouch.spec.design import Printable
from pneutouch.spec.fields import Table, table_of
from pneutouch.spec.read import read_toml

COUPON_NAMES = ("puck", "dumbbell", "gauge", "leak-cap", "volume-plug")
"""Names of the coupons that have a table, which are also their names on the command line."""

LEAST_READINGS = 2


def _readings(low: float, high: float, unit: str, least: int = LEAST_READINGS) -> AfterValidator:
    """Check of a list: empty, or at least ``least`` readings from ``low`` to ``high``."""

    def check(values: list[float]) -> list[float]:
        for place, value in enumerate(values, start=1):
            if not low <= value <= high:
                raise ValueError(f"reading {place} = {value:g}: must be from {low:g} to {high:g} {unit}".rstrip())
        if values and len(values) < least:
            raise ValueError(
                f"{shown(values)}: at least {least} readings, so that a spread can be computed; or [] if not measured"
            )
        return values

    return AfterValidator(check)


Shore = Annotated[list[float], _readings(0, 100, "on the Shore scale")]
LengthReadings = Annotated[list[float], _readings(0.01, 1000, "mm")]
Masses = Annotated[list[float], _readings(1e-4, 1e4, "g")]
Pressures = Annotated[list[float], _readings(0.1, 1000, "kPa")]
CurveReadings = Annotated[list[float], _readings(1e-6, 1e5, "", least=3)]


class Puck(Table):
    """[puck.MATERIAL]: hardness readings of all pucks; one mass, diameter and thickness for each puck."""

    shore_a: Shore = Field(default_factory=list, description="Readings on the Shore A scale.")
    shore_d: Shore = Field(default_factory=list, description="Readings on the Shore D scale.")
    mass_g: Masses = Field(default_factory=list, description="Mass of each puck.")
    diameter_mm: LengthReadings = Field(default_factory=list, description="Diameter of each puck.")
    thickness_mm: LengthReadings = Field(default_factory=list, description="Thickness of each puck.")

    @model_validator(mode="after")
    def _density_complete(self) -> "Puck":
        counts = {len(self.mass_g), len(self.diameter_mm), len(self.thickness_mm)}
        if len(counts) > 1:
            raise ValueError(
                f"mass_g, diameter_mm and thickness_mm have {len(self.mass_g)}, {len(self.diameter_mm)} and "
                f"{len(self.thickness_mm)} readings; the density needs one of each a puck"
            )
        return self


class DumbbellSpecimen(Table):
    """One dumbbell: its narrow part, and its curve point by point."""

    width_mm: LengthReadings = Field(default_factory=list, description="Readings of the width of the narrow part.")
    thickness_mm: LengthReadings = Field(
        default_factory=list, description="Readings of the thickness of the narrow part."
    )
    gauge_length_mm: float = Field(default=25.0, gt=0, le=1000, description="Distance of the bench marks.")
    extension_mm: CurveReadings = Field(
        default_factory=list, description="Extension between the bench marks, point by point."
    )
    force_N: CurveReadings = Field(default_factory=list, description="Force at each point.")

    @model_validator(mode="after")
    def _complete(self) -> "DumbbellSpecimen":
        given = [self.width_mm, self.thickness_mm, self.extension_mm]
        if any(given) and not all(given):
            raise ValueError("width_mm, thickness_mm, extension_mm and force_N belong together; one of them is empty")
        if len(self.extension_mm) != len(self.force_N):
            raise ValueError(
                f"extension_mm has {len(self.extension_mm)} points, force_N {len(self.force_N)}; they must have as many"
            )
        return self


class Dumbbell(Table):
    """[dumbbell.MATERIAL]: how the specimens were pulled, and one [[dumbbell.MATERIAL.specimen]] each."""

    hold_s: float = Field(default=60.0, ge=0, le=1e6, description="Hold at each point before the force is read, s.")
    largest_strain: float = Field(default=0.2, ge=0.02, le=2, description="Points beyond are left out of the fit.")
    specimen: list[DumbbellSpecimen] = Field(default_factory=list, description="One table a dumbbell.")


class MixedCoupons(Table):
    """[[mixing."SOFT+STIFF"]]: pucks and dumbbells of two resins, one entry a volume fraction of the stiff one."""

    fraction: float = Field(ge=0, le=1, description="Volume fraction of the stiff resin.")
    shore_a: Shore = Field(default_factory=list, description="Readings on the Shore A scale.")
    dumbbell: Dumbbell = Field(default_factory=Dumbbell, description="Dumbbells of this mix.")


def _rising(points: list[MixedCoupons]) -> list[MixedCoupons]:
    for one, other in pairwise(points):
        if other.fraction <= one.fraction:
            place = "there twice" if other.fraction == one.fraction else f"after {one.fraction:g}"
            raise ValueError(f"fraction = {other.fraction:g}: {place}; the fractions must rise, one entry each")
    return points


Blends = Annotated[list[MixedCoupons], AfterValidator(_rising)]


class GaugeSize(Table):
    """One feature of the gauge. ``came_out`` is false where it is missing, broken, blocked or grown together."""

    nominal_mm: float = Field(gt=0, le=100, description="Size as drawn.")
    measured_mm: LengthReadings = Field(default_factory=list, description="Readings of the printed size.")
    came_out: bool | None = Field(
        default=None, description="Whether the feature is there, whole and open; left out: not inspected."
    )

    @model_validator(mode="after")
    def _agree(self) -> "GaugeSize":
        if self.came_out is False and self.measured_mm:
            raise ValueError(
                f"nominal_mm = {self.nominal_mm:g}: came_out = false, but it was measured; give one of both"
            )
        return self

    @property
    def sound(self) -> bool | None:
        """True if it came out or was measured; None if nothing is stated."""
        return True if self.measured_mm else self.came_out


class FeatureGauge(Table):
    """[gauge.PRINTER.MATERIAL]: the block's lengths, then the rows of the gauge."""

    x: list[GaugeSize] = Field(default_factory=list, description="Lengths of the block along x.")
    y: list[GaugeSize] = Field(default_factory=list, description="Lengths of the block along y.")
    z: list[GaugeSize] = Field(default_factory=list, description="Lengths of the block along z.")
    wall: list[GaugeSize] = Field(default_factory=list, description="Walls.")
    pin: list[GaugeSize] = Field(default_factory=list, description="Pins.")
    hole: list[GaugeSize] = Field(default_factory=list, description="Holes.")
    slot: list[GaugeSize] = Field(default_factory=list, description="Slots.")


class LeakCap(Table):
    """[leak-cap.DESIGN]: pressure at the start and end of each run, and the pressure after each push of the syringe."""

    seconds: float = Field(default=600.0, gt=0, le=1e6, description="How long a run lasted.")
    start_kPa: Pressures = Field(default_factory=list, description="Pressure at the start of each run.")
    end_kPa: Pressures = Field(default_factory=list, description="Pressure at the end of each run.")
    pressure_kPa: Pressures = Field(default_factory=list, description="Pressure after each push of the syringe.")
    ambient_pressure_kPa: float = Field(
        default=101.325, ge=20, le=1000, description="Absolute pressure in the laboratory."
    )

    @model_validator(mode="after")
    def _runs(self) -> "LeakCap":
        if len(self.start_kPa) != len(self.end_kPa):
            raise ValueError(
                f"start_kPa has {len(self.start_kPa)} readings, end_kPa {len(self.end_kPa)}; one each a run"
            )
        return self


class VolumePlug(Table):
    """[volume-plug.DESIGN]: pressure after each push, and the mass of water that the cavity holds."""

    pressure_kPa: Pressures = Field(default_factory=list, description="Pressure after each push of the syringe.")
    water_g: Masses = Field(default_factory=list, description="Mass of the water that fills the cavity.")
    gauge_accuracy_kPa: float = Field(default=0.0, ge=0, le=100, description="Standard uncertainty of the gauge.")


class CouponResults(Table):
    """A whole results file."""

    lab: Printable = Field(min_length=1, max_length=80, description='who measured, such as "Soft lab, bench 2"')
    date: datetime.date = Field(description="a date such as 2026-11-21")
    puck: dict[str, Puck] = Field(default_factory=dict, description="Pucks, one table a material.")
    dumbbell: dict[str, Dumbbell] = Field(default_factory=dict, description="Dumbbells, one table a material.")
    mixing: dict[str, Blends] = Field(
        default_factory=dict, description="Pucks and dumbbells of mixes, one list a pair of resins."
    )
    gauge: dict[str, dict[str, FeatureGauge]] = Field(
        default_factory=dict, description="Feature gauges, one table a printer and material."
    )
    leak_cap: dict[str, LeakCap] = Field(
        default_factory=dict, alias="leak-cap", description="Leak caps, one table a design."
    )
    volume_plug: dict[str, VolumePlug] = Field(
        default_factory=dict, alias="volume-plug", description="Volume plugs, one table a design."
    )


def read_results(path: Path) -> CouponResults:
    """Read a results file. Raises InputError that names file, key, value and what would be right."""
    try:
        return CouponResults.model_validate(read_toml(path))
    except ValidationError as error:
        lines = [f"{path}: {_explained(detail)}" for detail in error.errors()]
        raise InputError("\n".join(lines)) from None


def _explained(detail: Any) -> str:
    """One line for one error of pydantic."""
    key = "".join(f"[{step + 1}]" if isinstance(step, int) else f".{step}" for step in detail["loc"]).lstrip(".")
    kind, last = detail["type"], str(detail["loc"][-1]) if detail["loc"] else ""
    if kind == "value_error":
        return f"{key}: {detail['ctx']['error']}"
    if kind == "extra_forbidden":
        owner = _owner([step for step in detail["loc"][:-1] if isinstance(step, str)])
        what = "coupon" if owner is CouponResults else "key"
        return (
            f"{key}: unknown {what}.{nearest(last, [info.alias or name for name, info in owner.model_fields.items()])}"
        )
    if kind == "missing":
        field = CouponResults.model_fields.get(last)
        return f"{key}: missing; give {field.description if field else 'a number'}"
    message = str(detail["msg"]).removeprefix("Input ").replace("valid ", "").replace("dictionary", "table")
    return f"{key} = {shown(detail['input'])}: {message}"


def _owner(path: list[str]) -> type[Table]:
    """Model of the table at a path of keys; names of materials, printers and designs are skipped."""
    owner: type[Table] = CouponResults
    for step in path:
        field = next((name for name, info in owner.model_fields.items() if step in (name, info.alias)), None)
        inner = None if field is None else _inner(owner, field)
        owner = inner or owner
    return owner


def _inner(owner: type[Table], field: str) -> type[Table] | None:
    if owner is CouponResults and field == "gauge":
        return FeatureGauge
    table = table_of(owner, field)
    return table if table is not None and issubclass(table, Table) else None
