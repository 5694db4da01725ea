"""The figures of a measured campaign, compared with the predicted ones."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pneutouch.spec.campaign import RunKind


@dataclass(frozen=True, slots=True)
class ReadColumn:
    """A column of a file, as a campaign file states it."""

    name: str
    """Name of the column."""
    unit: str
    """Unit of its values."""
    sign: int | None = None
    """-1 if its values are turned over."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadTables:
    """The columns and the layout of a file, as the tables of a campaign file."""

    columns: Mapping[str, ReadColumn]
    """Columns by channel."""
    format: Mapping[str, str | int] | None = None
    """Layout of the file, by key of the table [format]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadFiles(ReadTables):
    """Files read alike, whose columns or layout were found by their look."""

    files: tuple[str, ...]
    """Paths of the files."""
    whole_campaign: bool
    """True if they are all runs of the campaign."""


@dataclass(frozen=True, slots=True)
class PredictedFigure:
    """The predicted figure."""

    value: float
    """Value."""
    low: float | None
    """Lower end of the interval."""
    high: float | None
    """Upper end of the interval."""
    measured_off_percent: float | None
    """Measured over predicted, less 100 %."""


@dataclass(frozen=True, slots=True)
class CampaignFigure:
    """A measured figure."""

    value: float
    """Value."""
    low: float | None
    """Lower end of the interval."""
    high: float | None
    """Upper end of the interval."""
    unit: str
    """Unit of the value."""
    specimens: int
    """Number of specimens."""
    runs: int
    """Number of runs."""
    interval_over: str | None
    """Source of the interval's scatter: specimens or runs; null: there is no interval."""
    predicted: PredictedFigure | None = None
    """The predicted figure."""


@dataclass(frozen=True, slots=True)
class MeasuredGroup:
    """Runs of one resin, age and driving pressure."""

    resin: str
    """Name of its material."""
    age: str
    """Age of the print, in words."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    sensors: tuple[str, ...]
    """Specimens of the group."""
    files: tuple[str, ...]
    """Files of the runs."""
    why_not_predicted: str | None
    """Reason for which there is no predicted figure; null: there are."""
    figures: Mapping[str, CampaignFigure]
    """Figures by name."""
    depth_mm: float | None = None
    """Greatest measured depth, to which the predicted figures are read; null: not known."""
    predicted_range_mm: float | None = None
    """Depth to which `predict` gives its figures; null: not predicted."""


@dataclass(frozen=True, slots=True)
class DoubtfulPart:
    """A part of the record that is doubtful."""

    start_s: float
    """Start of the part."""
    end_s: float
    """End of the part."""
    why: str
    """Reason."""
    used: bool
    """True if it was used all the same."""


@dataclass(frozen=True, slots=True)
class RunWarning(DoubtfulPart):
    """A part of the record that is doubtful, or a note on it."""

    kind: str
    """Kind."""


@dataclass(frozen=True, slots=True)
class RunOfSensor:
    """A run, as the campaign states it."""

    file: str
    """Path of the file."""
    kind: RunKind
    """Kind."""
    sensor: str
    """Name of the specimen."""
    resin: str
    """Name of its material."""
    run: int
    """Number of the repetition."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    age_days: float
    """Age of the print."""


@dataclass(frozen=True, slots=True)
class MeasuredRun(RunOfSensor):
    """A run."""

    points: int
    """Number of points of the curve."""
    figures: Mapping[str, float]
    """Figures by name."""
    warnings: tuple[RunWarning, ...]
    """Doubtful parts."""
    kind_by_record: bool = False
    """True if the kind was not stated, and told from the record."""


@dataclass(frozen=True, slots=True)
class InjectionFigure:
    """A figure of a leak run or of an injection."""

    sensor: str
    """Name of the specimen."""
    figure: str
    """Name of the figure."""
    value: float
    """Value."""
    standard_error: float | None
    """Standard error of the value."""
    unit: str
    """Unit of the value."""


@dataclass(frozen=True, slots=True)
class AgeingChange:
    """The change of the sensitivity with age."""

    resin: str
    """Name of its material."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    age: str
    """Age of the print, in words."""
    sensitivity_change_percent: float
    """Change of the sensitivity, of the aged one as in the paper's Supplement E."""
    low: float | None
    """Lower end of the interval."""
    high: float | None
    """Upper end of the interval."""
    published_change_one_year_percent: float | None
    """Published change within a year."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """A requirement of the target against its measurement."""

    what: str
    """Required figure."""
    required: str
    """Required value."""
    measured: str
    """Measured value."""
    passed: bool | None
    """True if it is met; null: the interval holds values on both sides, and more specimens would decide."""


@dataclass(frozen=True, slots=True)
class DataQuestion:
    """Data that look wrong and were not changed."""

    file: str
    """Path of the file."""
    question: str
    """Part of the data to look at, in words."""


@dataclass(frozen=True, slots=True)
class FileFailure:
    """A file that could not be used."""

    file: str
    """Path of the file."""
    message: str
    """In words."""


@dataclass(frozen=True, slots=True)
class MeasuredCampaign:
    """Figures of a campaign, measured and predicted."""

    title: str
    """Title."""
    lab: str
    """Laboratory that measured."""
    simulated: bool
    """True if a program made the files."""
    design: str
    """Name of the design."""
    input_hash: str
    """Digest of the inputs and the version."""
    model: str
    """Model that computed it."""
    level: float
    """Level of the intervals."""
    groups: tuple[MeasuredGroup, ...]
    """Runs of one resin, age and driving pressure."""
    runs: tuple[MeasuredRun, ...]
    """Runs."""
    injections: tuple[InjectionFigure, ...]
    """Figures of injections."""
    ageing: tuple[AgeingChange, ...]
    """Changes with age."""
    target: tuple[Verdict, ...]
    """The target."""
    questions: tuple[DataQuestion, ...]
    """Parts of the data to look at."""
    failures: tuple[FileFailure, ...]
    """Files that could not be used."""
    read_as: tuple[ReadFiles, ...]
    """Columns and formats that were found by the look of the files."""
    folder: str | None = None
    """Folder that it was written to; only in the output of the command."""
