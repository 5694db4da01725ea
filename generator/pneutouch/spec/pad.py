"""The pad file: cells of one design in a pattern, one TOML a pad, known by its [pad] table."""

import math
import re
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from pneutouch.spec.design import DocumentHead
from pneutouch.spec.fields import EntryError, FieldsError, SparseTable, Table, number
from pneutouch.spec.read import Changes
from pneutouch.spec.values import plain_name

MOST_CELLS = 64

PAD_CAMPAIGN = "pad-campaign.toml"
"""Name of the file of a pad's campaign."""

_LAYOUT = re.compile(r"(ring|row|hex):([1-9]\d?)|grid:([1-9]\d?)x([1-9]\d?)|points")
_FORMS = "ring:N, row:N, hex:N, grid:NxM or points"


def _layout(text: str) -> str:
    found = _LAYOUT.fullmatch(text)
    if found is None:
        raise ValueError(f"must be {_FORMS}, such as ring:7 or grid:2x4")
    count = int(found[2] or 2) if found[3] is None else int(found[3]) * int(found[4])
    if not 2 <= count <= MOST_CELLS:
        raise ValueError(f"has {count} cells; a pad has 2 to {MOST_CELLS}")
    return text


def _points(points: list[list[float]]) -> list[list[float]]:
    for index, point in enumerate(points):
        if len(point) != 2 or not all(abs(at) <= 200.0 for at in point):
            raise EntryError("a place is [x, y], each from -200 to 200 mm", index, point)
    return points


class PadGroup(SparseTable):
    """[[pad.groups]]: cells that differ from the others in dome or driving pressure."""

    left_out = ("driving_pressure_kPa", "assignments")

    cells: list[int] = Field(min_length=1, max_length=MOST_CELLS, description="Numbers of its cells, from 1.")
    driving_pressure_kPa: float | None = number(
        None, unit="kPa", low=0, high=1000, help="Driving pressure that these cells hold; left out: as the others."
    )
    assignments: list[str] = Field(
        default=[], description="Changes of the cell's design for these, of [membrane] and [indentation]."
    )

    @property
    def pressures(self) -> Changes:
        """Change of the cell's design to the pressure that these cells hold, if they hold one of their own."""
        own_kPa = self.driving_pressure_kPa
        return {} if own_kPa is None else {"pneumatics.driving_pressures_kPa": [own_kPa]}


class PadTable(SparseTable):
    """[pad]: which sensor, how many of it, and where."""

    left_out = ("points_mm", "thickness_mm", "groups")

    cell: Annotated[str, AfterValidator(plain_name)] = Field(description="Design of each cell, by name.")
    layout: Annotated[str, AfterValidator(_layout)] = Field(default="ring:7", description=f"Pattern: {_FORMS}.")
    pitch_mm: float = number(12.0, unit="mm", low=2, high=100, help="Distance of neighbours; of points it is not used.")
    points_mm: Annotated[list[list[float]], AfterValidator(_points)] | None = Field(
        default=None,
        min_length=2,
        max_length=MOST_CELLS,
        description="Places [x, y] of the cells of the layout points.",
        json_schema_extra={"unit": "mm", "low": -200.0, "high": 200.0},
    )
    thickness_mm: float | None = number(
        None,
        unit="mm",
        low=1,
        high=100,
        help="Thickness of the manifold under the membrane; left out: the least in which every channel has its way.",
    )
    groups: list[PadGroup] = Field(
        default=[],
        max_length=MOST_CELLS,
        description="Cells that differ: each a [[pad.groups]] with cells, driving_pressure_kPa, assignments.",
    )

    @model_validator(mode="after")
    def _points_and_layout(self) -> "PadTable":
        if (self.layout == "points") == (self.points_mm is None):
            given = "without" if self.points_mm is None else "is for"
            problem = f'points_mm is the list of a layout = "points": {self.layout} {given} points_mm'
            raise FieldsError(problem, "layout", "points_mm")
        return self

    @model_validator(mode="after")
    def _groups_of_cells(self) -> "PadTable":
        numbers, count = [number for group in self.groups for number in group.cells], len(self.places)
        if any(not 1 <= number <= count for number in numbers) or len(set(numbers)) < len(numbers):
            raise FieldsError(f"groups have cells from 1 to {count}, each once: {numbers}", "groups", "layout")
        if len(numbers) == count:
            problem = "groups hold every cell: leave out those of the cell as it is, or change its design"
            raise FieldsError(problem, "groups", "cell")
        return self

    @property
    def group_of(self) -> tuple[int, ...]:
        """For each cell the number of its group, from 1; 0 for one in none."""
        groups = {number: k for k, group in enumerate(self.groups, start=1) for number in group.cells}
        return tuple(groups.get(number, 0) for number in range(1, len(self.places) + 1))

    @property
    def places(self) -> tuple[tuple[float, float], ...]:
        """Axes (x, y) of the cells, mm, in the order of their numbers."""
        if self.points_mm is not None:
            return tuple((point[0], point[1]) for point in self.points_mm)
        kind, _, size = self.layout.partition(":")
        sides = [int(one) for one in size.split("x")]
        if kind == "ring":
            return _ring(sides[0], self.pitch_mm)
        if kind == "hex":
            return _hexagonal(sides[0], self.pitch_mm)
        columns, rows = (sides[0], 1) if kind == "row" else (sides[1], sides[0])
        return tuple(
            ((k - 0.5 * (columns - 1)) * self.pitch_mm, (0.5 * (rows - 1) - j) * self.pitch_mm)
            for j in range(rows)
            for k in range(columns)
        )


def _ring(count: int, pitch: float) -> tuple[tuple[float, float], ...]:
    """One cell in the middle and the others around it, as far apart as the pitch or farther; of two, a row."""
    around = count - 1
    if around == 1:
        return (-0.5 * pitch, 0.0), (0.5 * pitch, 0.0)
    radius = pitch * max(1.0, 0.5 / math.sin(math.pi / around))
    turns = [2.0 * math.pi * k / around for k in range(around)]
    return ((0.0, 0.0), *((radius * math.cos(turn), radius * math.sin(turn)) for turn in turns))


def _hexagonal(count: int, pitch: float) -> tuple[tuple[float, float], ...]:
    """The places of a triangular lattice nearest to one of them, by distance and then by angle."""
    size = math.ceil(math.sqrt(count)) + 1
    lattice = [
        (pitch * (a + 0.5 * b), pitch * b * math.sqrt(0.75))
        for a in range(-size, size + 1)
        for b in range(-size, size + 1)
    ]
    lattice.sort(key=lambda at: (round(math.hypot(*at), 6), round(math.atan2(at[1], at[0]) % (2.0 * math.pi), 6)))
    return tuple(lattice[:count])


class PadFile(Table):
    """A whole pad file."""

    document: DocumentHead = DocumentHead(title="Pad of pneumatic touch sensors")
    pad: PadTable


class PadRun(Table):
    """[[runs]]: one recording of a ball on a pad."""

    file: str = Field(min_length=1, max_length=200, description="Name of the file beside the campaign.")
    kind: Literal["stage", "hand"] = Field(
        default="stage", description="Whether a stage knows where the ball is, or it is held by hand."
    )


class PadCampaign(Table):
    """A campaign of balls pressed onto a pad: one TOML file beside its recordings."""

    pad: str = Field(min_length=1, description="Pad, by name or path.")
    assignments: list[str] = Field(default=[], description="Changes of the pad, as `set` takes them.")
    driving_pressure_kPa: float = Field(ge=0, le=1000, description="Driving pressure of every cell.")
    ball_radius_mm: float = Field(gt=0, le=1000, description="Radius of the ball.")
    force_resolution_N: float = number(0.02, unit="N", low=1e-6, high=100, help="Resolution of the force sensor.")
    simulated: bool = Field(default=False, description="True for data of `simulate`, which nobody measured.")
    runs: list[PadRun] = Field(min_length=1, description="Recordings.")


class PadCalibration(Table):
    """Readings of a pad in hand over its prediction, fitted to a campaign."""

    pad: str = Field(description="Name of the pad.")
    places_mm: list[list[float]] = Field(description="Axes [x, y] of its cells.")
    groups: list[PadGroup] = Field(default=[], description="Its groups of cells.")
    driving_pressure_kPa: float = Field(ge=0, le=1000, description="Driving pressure of the campaign.")
    force_factor: float = Field(gt=0, le=20, description="Force over the predicted one, of every cell.")
    force_factor_uncertainty: float = Field(ge=0, le=20, description="Its standard uncertainty.")
    rise_factors: list[float] = Field(description="Pressure rise over the predicted one, by cell.")
    rise_factor_uncertainties: list[float] = Field(description="Their standard uncertainties.")
    model_error: float = Field(
        ge=0, le=1, description="Error left in rises, over the greatest of a reading: root mean square."
    )
    readings: int = Field(ge=1, description="Number of readings.")
    simulated: bool = Field(default=False, description="True if the campaign was simulated.")
    digest: str = Field(description="SHA-256 of the recordings.")


def channels(count: int) -> list[str]:
    """Names of the columns of pressure, kPa, in the order of the cells."""
    return [f"pressure_{k}_kPa" for k in range(1, count + 1)]
