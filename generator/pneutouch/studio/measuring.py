"""Jobs on measured runs: recognise their columns, compute their figures, fit the model to a sensor."""

import contextlib
import shutil
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, get_args

from pneutouch.bench.calibrate.parameters import NAMES, USUAL
from pneutouch.catalogue import DesignSource, Library, load_scene, user_folder
from pneutouch.errors import ComputationError, InputError, PneutouchError
from pneutouch.evaluation.resins import resin_of
from pneutouch.report.measured.sheet import tiles
from pneutouch.results.calibration import OutcomeRecord
from pneutouch.results.measured import MeasuredCampaign
from pneutouch.spec.campaign import CAMPAIGN, Campaign, CampaignRun, RunKind, campaign_of
from pneutouch.spec.options import CalibrationOptions, options_of
from pneutouch.studio.form import Question
from pneutouch.studio.job import Report
from pneutouch.studio.measured import (
    CommandWords,
    PageGroup,
    PageRun,
    calibrate_words,
    characterize_words,
    page_group,
    page_run,
    page_runs,
    placed,
    write_runs,
)
from pneutouch.tables.unit_words import UNITS
from pneutouch.workflows.calibrate.calibrate import CalibrationOutcome, run_calibration
from pneutouch.workflows.characterize.campaign import characterize as run_characterize
from pneutouch.workflows.characterize.campaign import write
from pneutouch.workflows.characterize.load import (
    Reading,
    load_curves,
    parse_columns,
    read_as,
    reading_text,
    recognise,
    with_reading,
)

_NO_RUNS = (".toml", ".json", ".md", ".html", ".pdf", ".svg", ".png", ".zip", ".3mf", ".step", ".stl", ".glb")
"""Endings of files that may lie next to runs but are none themselves."""

KINDS: tuple[str, ...] = get_args(RunKind)
"""Kinds of runs that a campaign may list."""

_SENSOR = "sensor-1"
"""Name of the specimen of runs that came without a campaign file, until the user gives another."""

_CHECK, _READ = "finding columns, files", "reading runs, MB"


@dataclass(frozen=True, slots=True, kw_only=True)
class RecognisedRuns:
    """The runs of the files that the page was given; ``planned`` if a campaign file lists them.

    ``read_as`` are lines for a campaign file, ``unused`` the files that are no runs, ``units`` those of a channel.
    """

    title: str
    simulated: bool
    design: str | None
    assignments: list[str]
    runs: list[PageRun]
    planned: bool
    read_as: str
    unused: list[str]
    kinds: tuple[str, ...] = KINDS
    units: dict[str, list[str]] = field(
        default_factory=lambda: {channel: list(known) for channel, known in UNITS.items()}
    )
    """Units that a column may have, by channel."""


@dataclass(frozen=True, slots=True)
class FittedName:
    """A parameter that can be fitted; ``usual`` if it is unless the user chooses others."""

    name: str
    usual: bool


@dataclass(frozen=True, slots=True)
class FittableSensor:
    """A sensor that can be fitted, with the driving pressures of its steps runs, kPa."""

    name: str
    driving_pressures_kPa: list[float]


@dataclass(frozen=True, slots=True, kw_only=True)
class CharacterizedCampaign(CommandWords):
    """Figures of a campaign, as ``characterize`` has them in JSON, without the folder, and for the page."""

    document: MeasuredCampaign
    title: str
    lab: str
    simulated: bool
    design: str
    model: str
    tiles: list[list[str]]
    runs: tuple[PageRun, ...]
    groups: list[PageGroup]
    read_as: str
    sheet: str
    sensors: list[FittableSensor]
    parameters: list[FittedName]


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibratedSensor(CommandWords):
    """A calibration as ``calibrate`` has it in JSON; ``opens``: the calibrated design, if it was saved."""

    document: OutcomeRecord
    chart: str
    saved: str | None
    opens: Question | None


@dataclass(frozen=True)
class _Given:
    """Input of a job: the campaign's folder below the working folder, its files, ``planned`` if with a campaign file,
    the page's design (None: the campaign's), options for reading, and the user's folder, ``root``."""

    data: Path
    files: list[str]
    planned: bool
    question: Question | None
    source: DesignSource | None
    reading: Reading
    library: Library
    root: Path

    @property
    def run_files(self) -> list[str]:
        """Files that may be runs."""
        return [file for file in self.files if not file.lower().endswith(_NO_RUNS)]


def recognised(arguments: Mapping[str, Any], folder: Path, report: Report) -> RecognisedRuns:
    """The runs of the files: as their campaign file lists them, with the columns found; else proposed, each with the
    kind and the driving pressure that its record shows.

    Raises InputError if the campaign is wrong or nothing may be a run.
    """
    with _given(arguments, folder) as given:
        if given.planned:
            return _planned(given, report)
        if not given.run_files:
            raise InputError("none of the files can be a run", remedy="give the files that the rig recorded")
        if given.source is None:
            raise InputError(f"no {CAMPAIGN} names the design", remedy="compare with the page's design")
        return _proposed(given, given.source, report)


def _planned(given: _Given, report: Report) -> RecognisedRuns:
    campaign, folder = campaign_of(given.data)
    read = with_reading(campaign, given.reading)
    runs, sources = [], {}
    for place, run in enumerate(read.runs):
        report(place, len(read.runs), _CHECK)
        try:
            sources[run.file] = recognise(run, read, folder)
            runs.append(page_run(run, sources[run.file]))
        except PneutouchError as error:
            runs.append(page_run(run, None, str(error)))
    named = {run.file for run in campaign.runs}
    return RecognisedRuns(
        title=campaign.title,
        simulated=campaign.simulated,
        design=campaign.design,
        assignments=campaign.assignments,
        runs=runs,
        planned=True,
        read_as=reading_text(read_as(sources, len(read.runs))),
        unused=[file for file in given.run_files if file not in named],
    )


def _proposed(given: _Given, source: DesignSource, report: Report) -> RecognisedRuns:
    scene = load_scene(source, {}, given.library)
    resin = resin_of(scene)
    runs, sources, seen = [], {}, Counter[float]()
    for place, file in enumerate(given.run_files):
        report(place, len(given.run_files), _CHECK)
        run, problem = CampaignRun(file=file, sensor=_SENSOR, resin=resin), None
        try:
            loaded = load_curves(given.data / file, scene, reading=given.reading)
            sources[file] = loaded.sources[Path(file).name]
            (shown,) = loaded.campaign.runs
            read_kPa = shown.driving_pressure_kPa
            run = run.model_copy(update={"driving_pressure_kPa": read_kPa, "kind": shown.kind})
        except PneutouchError as error:
            problem = str(error).removeprefix(f"{given.data / file}: none of its files can be read\n")
        seen[run.driving_pressure_kPa] += 1
        run = run.model_copy(update={"run": seen[run.driving_pressure_kPa]})
        runs.append(page_run(run, sources.get(file), problem))
    return RecognisedRuns(
        title="",
        simulated=False,
        design=None,
        assignments=[],
        runs=runs,
        planned=False,
        read_as=reading_text(read_as(sources, len(given.run_files))),
        unused=[file for file in given.files if file not in given.run_files],
    )


def characterize(arguments: Mapping[str, Any], folder: Path, report: Report) -> CharacterizedCampaign:
    """Run the command ``characterize`` on the campaign; its files go into ``folder``. Raises InputError as it does."""
    with _given(arguments, folder) as given:
        _plan(given, arguments)
        outcome = run_characterize(
            given.data,
            given.source,
            library=given.library,
            progress=lambda done, total: report(done, total, _READ),
            reading=given.reading,
        )
        report(0, 0, "drawing the measured sheet")
        written = write(outcome, folder)
        if not given.planned:
            shutil.copyfile(given.data / CAMPAIGN, folder / CAMPAIGN)
        runs, measured = page_runs(outcome), outcome.measured
        words = _noted(given, characterize_words(given.data, given.question, arguments))
    return CharacterizedCampaign(
        document=outcome.figures,
        title=measured.campaign.title,
        lab=measured.campaign.lab,
        simulated=measured.campaign.simulated,
        design=measured.scene.name,
        model=measured.model,
        tiles=[[one.name, one.value, one.unit, one.condition] for one in tiles(measured)],
        runs=runs,
        groups=[page_group(each) for each in measured.comparisons],
        read_as=reading_text(outcome.read_as),
        sheet=f"{written.name}/measured-datasheet.html",
        sensors=_sensors(measured.campaign) if outcome.fitted else [],
        parameters=[FittedName(name, name in USUAL) for name in NAMES],
        command=words.command,
        before=words.before,
    )


def _sensors(campaign: Campaign) -> list[FittableSensor]:
    pressures: dict[str, set[float]] = {}
    for run in campaign.runs:
        if run.kind in ("steps", "injection"):
            held = pressures.setdefault(run.sensor, set())
            held |= {run.driving_pressure_kPa} if run.kind == "steps" else set()
    return [FittableSensor(name, sorted(held)) for name, held in sorted(pressures.items())]


def calibrate(arguments: Mapping[str, Any], folder: Path, report: Report) -> CalibratedSensor:
    """Run the command ``calibrate`` on the campaign; its files go into ``folder``.

    Without ``save`` the calibration goes there as well, and nothing into the user's folder. Raises InputError as the
    command does.
    """
    save = _text(arguments, "save")
    with _given(arguments, folder) as given:
        _plan(given, arguments)
        stated = {key: value for key, value in arguments.items() if value not in (None, "", [])}
        options = options_of(CalibrationOptions, {**stated, "save": save})
        outcome = run_calibration(
            given.data,
            given.source,
            options,
            folder,
            given.library,
            lambda done, total: report(done, total, _READ),
            given.reading,
            folder if save is None else given.root,
        )
        words = _noted(given, calibrate_words(given.data, given.question, arguments, options))
    paths = [Path(path) for path in outcome.record.written]
    there = tuple(str(path.relative_to(folder)) for path in paths if path.is_relative_to(folder))
    return CalibratedSensor(
        document=replace(outcome.record, written=there),
        chart=f"{there[0]}/residuals.svg",
        saved=str(paths[-1]) if save is not None else None,
        opens=None if save is None else _opens(given, outcome, arguments["bases"]),
        command=words.command,
        before=words.before,
    )


def _opens(given: _Given, outcome: CalibrationOutcome, bases: Mapping[str, str]) -> Question | None:
    """The calibrated design as a question; None if the page has no such design to open."""
    named = {"calibration": outcome.record.calibration}
    if given.question is not None:
        return replace(given.question, values={**given.question.values, **named})
    if outcome.design_given not in bases:
        return None
    values = dict(text.split("=", 1) for text in outcome.assignments)
    return Question(outcome.design_given, {**values, **named})


@contextlib.contextmanager
def _given(arguments: Mapping[str, Any], folder: Path) -> Iterator[_Given]:
    """Input of a job, with its files in the working folder, so that messages name files as the user does.

    Errors become InputError or ComputationError, with file and key in the message; so do arguments that are not valid.
    """
    library, root = Library.default(), user_folder().absolute()
    place = folder.absolute().parent / "input"
    place.mkdir(exist_ok=True)
    try:
        data, files = placed(arguments["files"], _texts(arguments, "paths"), place)
        given_design = arguments.get("design")
        question = None if given_design is None else Question.of(given_design)
        source = None if question is None else question.source(arguments["bases"], library)
        planned = CAMPAIGN in files
        with contextlib.chdir(place):
            yield _Given(data, files, planned, question, source, _reading(arguments), library, root)
    except InputError as error:
        raise InputError(str(error)) from None
    except PneutouchError as error:
        raise ComputationError(str(error)) from None


def _plan(given: _Given, arguments: Mapping[str, Any]) -> None:
    """Write the campaign file if none came with the runs. Raises InputError if no runs are given."""
    if given.planned:
        return
    runs = arguments.get("runs")
    if not isinstance(runs, list) or not runs or not all(isinstance(run, dict) for run in runs):
        raise InputError("no runs are given", key="runs", remedy="choose the files that are runs")
    write_runs(given.data, runs)


def _noted(given: _Given, words: CommandWords) -> CommandWords:
    """The words of a command; if no campaign file was given, they add where the written one is."""
    if given.planned:
        return words
    place = f"{CAMPAIGN}, which the command needs next to the runs, is in the zip of the measured sheet"
    return replace(words, before="; ".join(each for each in (words.before, place) if each))


def _reading(arguments: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The tables [columns] and [format] that the page states, read like the command's options. Raises InputError."""
    columns, stated = arguments.get("columns") or "", arguments.get("format") or {}
    if not isinstance(columns, str) or not isinstance(stated, dict):
        raise InputError("columns is a text and format is an object")
    known = {key: value for key, value in stated.items() if value not in (None, "")}
    rows = known.get("skip_rows")
    # Python's own bound on the digits of a number is no message for a user.
    if isinstance(rows, str) and rows.isdecimal() and len(rows) < 10:
        known["skip_rows"] = int(rows)
    return {"columns": parse_columns([columns] if columns.strip() else []), "format": known}


def _text(arguments: Mapping[str, Any], key: str) -> str | None:
    value = arguments.get(key)
    if value is not None and not isinstance(value, str):
        raise InputError("must be a text", key=key)
    return value


def _texts(arguments: Mapping[str, Any], key: str) -> list[str]:
    values = arguments.get(key) or []
    if not isinstance(values, list) or not all(isinstance(value, str) for value in values):
        raise InputError("must be a list of texts", key=key)
    return values
