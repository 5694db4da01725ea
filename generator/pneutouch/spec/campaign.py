"""A measurement campaign: which file holds which run of which sensor, on which rig. One TOML file beside the runs."""

import datetime
import os
from pathlib import Path, PurePosixPath
from typing import Annotated, Literal, get_args

from pydantic import Field, ValidationError, model_validator

from pneutouch.errors import InputError, shown
from pneutouch.formats import format_of, problem_of
from pneutouch.spec.design import Printable
from pneutouch.spec.fields import Table, number
from pneutouch.spec.files import design_inside, inside
from pneutouch.spec.read import read_toml, validate
from pneutouch.tables.unit_words import UNITS

Encoding = Literal[
    "utf-8",
    "utf-16",
    "utf-16-le",
    "utf-16-be",
    "cp1252",
    "latin-1",
    "cp1250",
    "cp1251",
    "cp932",
    "gb18030",
    "mac-roman",
]
"""Encodings that can be stated; of these utf-8, the three of UTF-16 and cp1252 are found by themselves."""

PlannedKind = Literal["steps", "saturation", "loop", "relaxation", "leak", "injection"]
"""Kind of a run that a rig does; see `bench.indents`. Leak and injection need no plate."""

RunKind = Literal[PlannedKind, "hand"]
"""Kind of a run; a press by hand has no travel."""

AS_DESIGNED = "as-designed"
"""Name in place of a resin's: the membrane as the design has it, perhaps a mix that no file names."""


class Column(Table):
    """A column of the files: its name, its unit, and its sign."""

    name: str = Field(min_length=1, description="Name in the header of the file.")
    unit: str = Field(default="", description="Unit of its numbers; left out: the unit in the header.")
    sign: Literal[1, -1] = Field(default=1, description="-1 where the rig counts in the opposite direction.")


def _column(name: str, unit: str) -> Column:
    return Column(name=name, unit=unit)


class ColumnMap(Table):
    """[columns]: the column map. Position counts into the sensor, force and pressure rise as it is pressed. A channel
    left out is the column of its default name, else the one whose header states channel and unit."""

    time: Column = _column("time_s", "s")
    position: Column = _column("position_mm", "mm")
    force: Column = _column("force_N", "N")
    pressure: Column = _column("pressure_kPa", "kPa")
    volume: Column = _column("volume_mL", "mL")

    @model_validator(mode="after")
    def _known_units(self) -> "ColumnMap":
        for key, units in UNITS.items():
            unit = getattr(self, key).unit
            if unit and unit not in units:
                raise ValueError(f"{key}.unit = {shown(unit)}: must be one of {', '.join(units)}")
        names = [getattr(self, key).name for key in UNITS]
        for key, name in zip(UNITS, names, strict=True):
            if names.count(name) > 1:
                raise ValueError(f"{key}.name = {shown(name)}: declared for two channels; must be one column each")
        return self


class FileFormat(Table):
    """[format]: how the files are written. Entries that are left out are found from each file."""

    delimiter: Literal[",", ";", "\t", " "] | None = Field(
        default=None,
        description="Between the cells of a text file: comma, semicolon, tab or space (any number of them).",
    )
    decimal: Literal[".", ","] | None = Field(default=None, description="Decimal mark of a text file: point or comma.")
    encoding: Encoding | None = Field(default=None, description="Encoding of a text file, such as utf-8 or cp1252.")
    skip_rows: int | None = Field(default=None, ge=0, le=100_000, description="Rows before the header.")
    sheet: str | None = Field(
        default=None, min_length=1, max_length=200, description="Sheet of a workbook, or group of a TDMS file."
    )


def merged_columns(under: ColumnMap, over: ColumnMap | None) -> ColumnMap:
    """Columns of ``under``, replaced by those that ``over`` states; None: by none."""
    both = [one for one in (under, over) if one is not None]
    return ColumnMap.model_validate(
        {key: getattr(one, key).model_dump() for one in both for key in one.model_fields_set}
    )


def merged_format(under: FileFormat, over: FileFormat | None) -> FileFormat:
    """File format ``under``, with the values that ``over`` states in place of its own; None: without any."""
    both = [one.model_dump(exclude_none=True) for one in (under, over) if one is not None]
    return FileFormat.model_validate({key: value for one in both for key, value in one.items()})


class Rig(Table):
    """[rig]: the abilities of the instruments. Defaults are the paper's (Supplement C)."""

    name: Printable = Field(default="the paper's rig: ATI SI-40-2, SMC PSE543-R06", max_length=120, description="Name.")
    force_range_N: float = number(40.0, unit="N", low=1e-3, high=1e5, help="Greatest force of the force sensor.")
    force_resolution_N: float = number(0.02, unit="N", low=0, high=100, help="Resolution of the force sensor.")
    pressure_range_kPa: float = number(100.0, unit="kPa", low=1e-2, high=1e5, help="Greatest gauge pressure read.")
    travel_mm: float = number(
        100.0, unit="mm", low=0.1, high=1e4, help="Travel of the stage (Actuonix L16-100: 100 mm)."
    )
    compliance_mm_per_N: float = number(
        0.0, unit="mm/N", low=0, high=10, help="Travel by which stage and force sensor yield, subtracted."
    )
    rate_Hz: float = number(10_000.0, unit="Hz", low=1, high=1e6, help="Sampling rate.")


Volume = Annotated[float, Field(ge=0, le=1e4)]
"""A volume of room air, mL."""


_KIND = f"Kind of run: {', '.join(get_args(RunKind))}; left out: recognised, but for injection and saturation."


class CampaignRun(Table):
    """One [[runs]] entry: a file and its measurement."""

    file: Printable = Field(min_length=1, max_length=1000, description="Path of the file, from the campaign's folder.")
    kind: RunKind = Field(default="steps", description=_KIND)
    sensor: Printable = Field(min_length=1, max_length=60, description="Name of the specimen.")
    resin: str = Field(default=AS_DESIGNED, min_length=1, description=f"Name of its material, or {shown(AS_DESIGNED)}.")
    driving_pressure_kPa: float = number(0.0, unit="kPa", low=0, high=1000, help="Gauge pressure before contact.")
    run: int = Field(default=1, ge=1, le=10_000, description="Number of the repetition.")
    date: datetime.date | None = Field(default=None, description="Day of the run.")
    age_days: float = number(0.0, unit="d", low=0, high=36_500, help="Age of the print on that day.")
    volumes_mL: list[Volume] | None = Field(
        default=None, min_length=3, max_length=10_000, description="Of an injection: volumes to be pushed, mL in all."
    )
    columns: ColumnMap | None = Field(default=None, description="Columns of this file, in place of the campaign's.")
    format: FileFormat | None = Field(default=None, description="How this file is written, likewise.")

    @model_validator(mode="after")
    def _volumes_are_pushed(self) -> "CampaignRun":
        if self.volumes_mL is not None and self.kind != "injection":
            raise ValueError(f"volumes_mL: given to a run of kind {self.kind}; must be left out but of an injection")
        return self

    @property
    def label(self) -> str:
        """Name of the run in tables and messages."""
        return f"{self.sensor}, {self.driving_pressure_kPa:g} kPa, {self.kind}, run {self.run}"


class Campaign(Table):
    """A whole campaign file."""

    campaign_format: str = Field(default=format_of("campaign"), description="Format of this file and its version.")
    title: Printable = Field(default="Measurement campaign", max_length=120, description="Title of the measured sheet.")
    lab: Printable = Field(default="", max_length=120, description="Who measured.")
    design: str | None = Field(default=None, min_length=1, description="Design of the sensors, where no flag names it.")
    assignments: list[str] = Field(
        default=[], max_length=100, description="What changes the design, TABLE.KEY=VALUE each."
    )
    simulated: bool = Field(default=False, description="True if a program made the files; every sheet says so.")
    ambient_pressure_kPa: float | None = number(
        None, unit="kPa", low=20, high=1000, help="Absolute pressure in the laboratory; left out: the design's."
    )
    rig: Rig = Rig()
    columns: ColumnMap = ColumnMap()
    format: FileFormat = FileFormat()
    runs: list[CampaignRun] = Field(min_length=1, max_length=100_000, description="The runs.")

    def reading(self, run: CampaignRun) -> tuple[ColumnMap, FileFormat]:
        """The columns and the format of a run's file."""
        return merged_columns(self.columns, run.columns), merged_format(self.format, run.format)

    @model_validator(mode="after")
    def _of_this_format(self) -> "Campaign":
        problem = problem_of("campaign", self.campaign_format)
        if problem is not None:
            raise ValueError(f"campaign_format = {shown(self.campaign_format)}: {problem[0]}; {problem[1]}")
        return self

    @model_validator(mode="after")
    def _runs_can_be_read(self) -> "Campaign":
        for place, run in enumerate(self.runs):
            try:
                self.reading(run)
            except ValidationError as error:
                # The words of `ColumnMap`, without the head that pydantic gives them.
                why = error.errors()[0]["msg"].removeprefix("Value error, ")
                raise ValueError(f"runs[{place}].columns with those of the campaign: {why}") from None
        return self

    @model_validator(mode="after")
    def _runs_differ(self) -> "Campaign":
        files: dict[str, int] = {}
        keys: dict[tuple[object, ...], int] = {}
        resins: dict[str, str] = {}
        for place, run in enumerate(self.runs):
            key = (run.kind, run.sensor, run.driving_pressure_kPa, run.run, run.age_days)
            file = str(PurePosixPath(os.path.normpath(run.file)))
            same_file, same_run = files.setdefault(file, place), keys.setdefault(key, place)
            if same_file != place:
                raise ValueError(
                    f"runs[{place}].file = {shown(run.file)}: is that of runs[{same_file}] too; must be there once"
                )
            if same_run != place:
                raise ValueError(
                    f"runs[{place}] ({run.file}): the same sensor, kind, pressure and run as runs[{same_run}] "
                    f"({self.runs[same_run].file}); number repetitions with run = 1, 2, 3"
                )
            if resins.setdefault(run.sensor, run.resin) != run.resin:
                raise ValueError(
                    f"runs[{place}] ({run.file}): sensor {shown(run.sensor)} is of {run.resin} here and of "
                    f"{resins[run.sensor]} before; a sensor must be of one resin"
                )
        return self


CAMPAIGN = "campaign.toml"


def campaign_of(data: Path) -> tuple[Campaign, Path]:
    """Campaign, and folder of its runs, by folder or campaign file. Raises InputError, also for a run outside."""
    path = data / CAMPAIGN if data.is_dir() else data
    if (data.is_dir() and not path.exists()) or (path.is_file() and path.suffix != ".toml"):
        problem = f"holds no {CAMPAIGN}" if data.is_dir() else f"neither a folder with a {CAMPAIGN} nor such a file"
        raise InputError(problem, file=data, remedy="`pneutouch plan` writes one to be filled in")
    campaign = validate(Campaign, read_toml(path), str(path))
    for place, run in enumerate(campaign.runs):
        inside(path.parent, run.file, file=path, key=f"runs[{place}].file")
    return campaign, path.parent


def design_of(campaign: Campaign, folder: Path) -> str | None:
    """Design that a campaign in ``folder`` names, as a command takes it; None if it names none. Raises InputError."""
    if campaign.design is None:
        return None
    return design_inside(folder, campaign.design, file=folder / CAMPAIGN, key="design")
