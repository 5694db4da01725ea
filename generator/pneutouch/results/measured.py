"""The figures of a measured campaign, compared with the predicted ones."""

from collections.abc import Mapping
from dataclasses import dataclass

from pneutouch.results.comparison import ValueRecord
from pneutouch.spec.campaign import RunKind


@dataclass(frozen=True, slots=True)
class ReadColumn:
    """A column of a file, as a campaign file states it."""

    name: str
    """Name of the column."""
    unit: str
    """Unit of its values."""
    sign: int | None = None
    """-1 if the rig counts in the opposite direction; left out: it does not."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadTables:
    """The columns and the layout of a file, as the tables of a campaign file."""

    columns: Mapping[str, ReadColumn]
    """Columns by channel."""
    format: Mapping[str, str | int] | None = None
    """Layout of the file, by key of the table [format]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadFiles(ReadTables):
    """Files read alike, whose columns or layout were found from the files themselves."""

    files: tuple[str, ...]
    """Paths of the files."""
    whole_campaign: bool
    """True if they are all runs of the campaign."""


@dataclass(frozen=True, slots=True)
class PredictedFigure(ValueRecord):
    """A predicted figure, read as the measured one is."""

    measured_off_percent: float | None
    """Measured over predicted, less 100 %; null: the prediction is 0."""


@dataclass(frozen=True, slots=True)
class CampaignFigure(ValueRecord):
    """A measured figure."""

    unit: str
    """Unit of the value."""
    specimens: int
    """Number of specimens."""
    runs: int
    """Number of runs."""
    interval_over: str | None
    """Source of the interval's scatter: specimens or runs; null: there is no interval."""
    predicted: PredictedFigure | None = None
    """The predicted figure; left out: not predicted."""


@dataclass(frozen=True, slots=True)
class MeasuredGroup:
    """Runs of one resin, age and driving pressure."""

    resin: str
    """Name of the membrane's resin."""
    age: str
    """Age of the print, in words."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    sensors: tuple[str, ...]
    """Specimens of the group."""
    files: tuple[str, ...]
    """Files of the runs."""
    why_not_predicted: str | None
    """Reason why there are no predicted figures; null: there are some."""
    figures: Mapping[str, CampaignFigure]
    """Figures by name."""
    depth_mm: float | None = None
    """Greatest measured depth, to which the predicted figures are read; null: not known."""
    predicted_range_mm: float | None = None
    """Depth to which `predict` gives its figures; null: not predicted."""


@dataclass(frozen=True, slots=True)
class DoubtfulPart:
    """A part of a run's record that may be wrong."""

    start_s: float
    """Start of the part."""
    end_s: float
    """End of the part."""
    why: str
    """Reason for the doubt."""
    used: bool
    """True if the part was used nevertheless."""


@dataclass(frozen=True, slots=True)
class RunWarning(DoubtfulPart):
    """A part of a run's record that may be wrong, or a note on it."""

    kind: str
    """Kind of the doubt: gap, clipped, spike, note, asked or other."""


@dataclass(frozen=True, slots=True)
class RunOfSensor:
    """A run, as the campaign states it."""

    file: str
    """Path of the file."""
    kind: RunKind
    """Kind of the run."""
    sensor: str
    """Name of the specimen."""
    resin: str
    """Name of the membrane's resin."""
    run: int
    """Number of the repetition."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    age_days: float
    """Age of the print."""


@dataclass(frozen=True, slots=True)
class MeasuredRun(RunOfSensor):
    """A run with the figures measured in it."""

    points: int
    """Number of points of the curve."""
    figures: Mapping[str, float]
    """Figures by name."""
    warnings: tuple[RunWarning, ...]
    """Parts of the record that may be wrong."""
    kind_by_record: bool = False
    """True if the campaign states no kind, and it was recognised from the record."""


@dataclass(frozen=True, slots=True)
class InjectionFigure:
    """A figure of a leak run or of an injection."""

    sensor: str
    """Name of the specimen."""
    figure: str
    """Name of the figure, with the run."""
    value: float
    """Value of the figure."""
    standard_error: float | None
    """Standard error of the value."""
    unit: str
    """Unit of the value."""
    predicted: float | None = None
    """Predicted value, without an interval."""


@dataclass(frozen=True, slots=True)
class AgeingChange:
    """The change of the sensitivity with age, in one resin at one driving pressure."""

    resin: str
    """Name of the membrane's resin."""
    driving_pressure_kPa: float
    """Gauge pressure before contact."""
    age: str
    """Age of the print, in words."""
    sensitivity_change_percent: float
    """Aged less fresh sensitivity, over the aged one as in the paper's Supplement E."""
    low: float | None
    """Lower end of the interval."""
    high: float | None
    """Upper end of the interval."""
    published_change_one_year_percent: float | None
    """Change within a year that the paper measured; null: none."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """A requirement of a target against its measurement."""

    what: str
    """Required figure."""
    required: str
    """Required value."""
    measured: str
    """Measured value."""
    passed: bool | None
    """True if it is met; null: the interval holds values on both sides, or there is none."""


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
    """Reason, in words."""


@dataclass(frozen=True, slots=True)
class MeasuredCampaign:
    """Figures of a campaign, measured and predicted."""

    title: str
    """Title of the campaign."""
    lab: str
    """Laboratory that measured."""
    simulated: bool
    """True if a program made the files."""
    design: str
    """Name of the design."""
    input_hash: str
    """Short digest of the inputs and of the program's version."""
    model: str
    """Model that predicted the figures."""
    level: float
    """Probability of the intervals, from 0 to 1."""
    groups: tuple[MeasuredGroup, ...]
    """Groups of runs of one resin, age and driving pressure."""
    runs: tuple[MeasuredRun, ...]
    """Runs with their figures."""
    injections: tuple[InjectionFigure, ...]
    """Figures of leak runs and of injections."""
    ageing: tuple[AgeingChange, ...]
    """Changes of the sensitivity with age."""
    target: tuple[Verdict, ...]
    """Requirements of the target against their measurements; empty: no target."""
    questions: tuple[DataQuestion, ...]
    """Data that look wrong and were not changed."""
    failures: tuple[FileFailure, ...]
    """Files that could not be used."""
    read_as: tuple[ReadFiles, ...]
    """Columns and formats that were found from the files themselves."""
    folder: str | None = None
    """Folder that it was written to; only in the output of the command."""
