"""A campaign on the page: files and columns, figures beside predicted ones, and the commands that repeat it."""

import os
import shlex
import shutil
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import Any

from pneutouch.arrays import Array
from pneutouch.bench.figures import BY_KEY
from pneutouch.bench.source import MeasuredFile
from pneutouch.errors import InputError
from pneutouch.report.measured import GroupComparison
from pneutouch.report.measured.tables import some
from pneutouch.report.numbers import overlap
from pneutouch.results.comparison import ValueRecord
from pneutouch.results.measured import DoubtfulPart, RunOfSensor
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from pneutouch.spec.campaign import CAMPAIGN, CampaignRun
from pneutouch.spec.options import CalibrationOptions, option_words
from pneutouch.spec.read import read_toml
from pneutouch.spec.toml_text import toml_text
from pneutouch.studio.answer import on_page
from pneutouch.studio.form import Question
from pneutouch.units import KPA
from pneutouch.workflows.characterize.campaign import CharacterizationResult
from pneutouch.workflows.characterize.predicted import doubtful, of_run


@dataclass(frozen=True, slots=True)
class FileColumn:
    """A column of a run's file, by channel; ``found`` if its header told the channel and nobody stated it."""

    channel: str
    name: str
    unit: str
    sign: float
    found: bool


@dataclass(frozen=True, slots=True)
class PageRun(RunOfSensor):
    """A run with its file's columns, layout and error; questions and doubtful parts, None before it is read."""

    columns: tuple[FileColumn, ...]
    format: Mapping[str, str | int]
    problem: str | None
    questions: tuple[str, ...] | None = None
    doubtful: tuple[DoubtfulPart, ...] | None = None


@dataclass(frozen=True, slots=True)
class PageFigure(ValueRecord):
    """A measured figure with its 95 % interval, the predicted one with its band, and the paper's."""

    key: str
    name: str
    unit: str
    interval_over: str | None
    specimens: int
    runs: int
    predicted: ValueRecord | None = None
    agrees: bool | None = None
    published: float | None = None


@dataclass(frozen=True, slots=True)
class RunCurve:
    """Points of a run from which sensitivity and stiffness are taken."""

    sensor: str
    run: int
    indentation_mm: tuple[float, ...]
    force_N: tuple[float, ...]
    rise_kPa: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class PredictedCurve:
    """The predicted curve up to the end of its range, with bands, None if unknown: the sensitivity's about the rise,
    the stiffness's about the force."""

    indentation_mm: tuple[float, ...]
    force_N: tuple[float, ...]
    rise_kPa: tuple[float, ...]
    low_rise_kPa: tuple[float, ...] | None = None
    high_rise_kPa: tuple[float, ...] | None = None
    low_force_N: tuple[float, ...] | None = None
    high_force_N: tuple[float, ...] | None = None


@dataclass(frozen=True, slots=True)
class GroupCurves:
    """Curves of a group's runs and of its prediction, None if there are no runs or no prediction."""

    runs: tuple[RunCurve, ...]
    predicted: PredictedCurve | None


@dataclass(frozen=True, slots=True)
class PageGroup:
    """A group of runs; of the ``compared`` figures ``agreeing`` have an interval that meets the predicted band."""

    title: str
    sensors: Sequence[str]
    why_not_predicted: str | None
    figures: tuple[PageFigure, ...]
    agreeing: int
    compared: int
    curves: GroupCurves


def page_run(run: CampaignRun, source: MeasuredFile | None, problem: str | None = None) -> PageRun:
    """A run with the columns of its file; with none if ``source`` is None, as for a file that cannot be read."""
    if source is None:
        return PageRun(*of_run(run), (), {}, problem)
    columns = tuple(_column(source, channel) for channel in source.channels)
    return PageRun(*of_run(run), columns, source.content.format or {}, problem)


def _column(source: MeasuredFile, channel: str) -> FileColumn:
    column = getattr(source.columns, channel)
    return FileColumn(channel, column.name, column.unit, column.sign, channel in source.guessed)


def page_runs(outcome: CharacterizationResult) -> tuple[PageRun, ...]:
    """Every run of a campaign, with its columns, its error, questions and doubtful parts."""
    measured = outcome.measured
    failures = dict(measured.failures)
    doubts = {
        curve.run.file: tuple(DoubtfulPart(*doubtful(one)) for one in curve.warnings if one.kind != "note")
        for curve in measured.curves
    }
    return tuple(
        replace(
            page_run(run, outcome.sources.get(run.file), failures.get(run.file)),
            questions=tuple(text for file, text in measured.questions if file == run.file),
            doubtful=doubts.get(run.file, ()),
        )
        for run in measured.campaign.runs
    )


def page_group(comparison: GroupComparison) -> PageGroup:
    """A group of runs with figures and curves."""
    key, figures = comparison.group.key, _figures(comparison)
    known = [row.agrees for row in figures if row.agrees is not None]
    return PageGroup(
        title=f"{comparison.label}, {key.age}, {key.driving_pressure_kPa:g} kPa",
        sensors=comparison.group.sensors,
        why_not_predicted=comparison.why or None,
        figures=figures,
        agreeing=sum(known),
        compared=len(known),
        curves=_curves(comparison),
    )


def _figures(comparison: GroupComparison) -> tuple[PageFigure, ...]:
    rows = []
    for key, estimate in comparison.group.figures.items():
        figure, bounds = BY_KEY[key], (estimate.value, estimate.low, estimate.high)
        predicted = comparison.predicted.get(key)
        agrees = None if predicted is None else overlap(bounds, predicted)
        rows.append(
            PageFigure(
                *bounds,
                key,
                figure.name,
                figure.unit,
                estimate.over or None,
                estimate.specimens,
                estimate.runs,
                predicted=None if predicted is None else ValueRecord(*predicted),
                agrees=None if agrees is None else bool(agrees),
                published=comparison.published.get(key),
            )
        )
    return tuple(rows)


def _curves(comparison: GroupComparison) -> GroupCurves:
    runs = tuple(
        RunCurve(curve.run.sensor, curve.run.run, *map(on_page, (curve.indentation, curve.force, curve.rise / KPA)))
        for curve in some([curve for curve in comparison.group.lined if curve.run.kind != "hand"])
    )
    return GroupCurves(runs, _predicted(comparison) if runs else None)


def _predicted(comparison: GroupComparison) -> PredictedCurve | None:
    state = comparison.state
    if state is None:
        return None
    kept = state.indentation <= state.range_end * (1 + 1e-12)
    force, rise_kPa = state.force[kept], state.pressure_rise[kept] / KPA
    rises = _band(comparison, SENSITIVITY_KEY, rise_kPa)
    forces = _band(comparison, STIFFNESS_KEY, force)
    return PredictedCurve(on_page(state.indentation[kept]), on_page(force), on_page(rise_kPa), *rises, *forces)


def _band(
    comparison: GroupComparison, figure: str, values: Array
) -> tuple[tuple[float, ...] | None, tuple[float, ...] | None]:
    """Low and high curve (n,) of the band of a figure about the curve ``values``; (None, None) without a band."""
    ends = comparison.relative_band(figure)
    return (None, None) if ends is None else (on_page(ends[0] * values), on_page(ends[1] * values))


UNNAMED = "campaign"
"""Name of the folder for files that came without one."""

_DEEPEST, _LONGEST = 8, 200
"""Greatest number of folders above a file, and of bytes of a name in its path."""


def placed(files: Sequence[Mapping[str, str]], paths: Sequence[str], place: Path) -> tuple[Path, list[str]]:
    """Put files (name, path) at their relative ``paths`` below ``place``.

    Returns the campaign's folder, relative to ``place``, and the paths of its files, relative to that folder: the
    folder of the campaign file, else the one that holds all files. Raises InputError for a path that is not valid, for
    two files at one place and for two campaigns.
    """
    if len(files) != len(paths):
        raise InputError("each file has one path", key="paths")
    if not files:
        raise InputError("no files", remedy="give the files of the runs, or the folder of a campaign")
    checked = [_checked(path) for path in paths]
    twice = [path for path, count in Counter(checked).items() if count > 1]
    if twice:
        raise InputError("two files of this name", key="file", value=str(twice[0]), remedy="give one of them")
    folders = {parent for path in checked for parent in path.parents}
    both = next((path for path in checked if path in folders), None)
    if both is not None:
        raise InputError("a file and a folder of this name", key="file", value=str(both), remedy="rename the file")
    plans = [path for path in checked if path.name == CAMPAIGN]
    if len(plans) > 1:
        raise InputError(
            f"{len(plans)} campaign files: {', '.join(map(str, plans[:4]))}", remedy="give one campaign at a time"
        )
    top = plans[0].parent if plans else PurePosixPath(os.path.commonpath([path.parent for path in checked]))
    prefix = PurePosixPath() if top.parts else PurePosixPath(UNNAMED)
    inside = []
    for file, path in zip(files, checked, strict=True):
        if not path.is_relative_to(top):
            continue
        _link(Path(file["path"]), place / prefix / path)
        inside.append(path.relative_to(top).as_posix())
    folder = Path(prefix / top)
    if plans:
        _bring_named(place / folder, inside)
    return folder, inside


def write_runs(folder: Path, runs: Sequence[Mapping[str, Any]]) -> Path:
    """Write the campaign file of runs that the page gives. Raises InputError for values that TOML has no form for."""
    path = folder / CAMPAIGN
    try:
        text = toml_text({"runs": [dict(run) for run in runs]})
    except (TypeError, RecursionError):
        remedy = "its values are texts, numbers, true or false, and lists of these"
        raise InputError("not a run of a campaign file", key="runs", remedy=remedy) from None
    path.write_text(text)
    return path


def _checked(text: Any) -> PurePosixPath:
    """Relative path of a file, checked not to lead out of its folder. Raises InputError."""
    parts = text.split("/") if isinstance(text, str) else [""]
    plain = all(
        part not in ("", ".", "..") and part.isprintable() and "\\" not in part and len(part.encode()) <= _LONGEST
        for part in parts
    )
    if not plain or len(parts) > _DEEPEST:
        raise InputError("not a path of a file in a folder", key="paths", value=text, remedy="rename the file")
    return PurePosixPath(*parts)


def _link(source: Path, target: Path) -> None:
    """Put a file at ``target`` as well, as a link, or as a copy if the file system cannot link it."""
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        target.hardlink_to(source)
    except OSError:
        shutil.copyfile(source, target)


def _bring_named(folder: Path, inside: list[str]) -> None:
    """Move files that came in one folder, chosen one by one, to the folders where the campaign names them.

    Errors of the campaign file are reported when it is read.
    """
    try:
        runs = read_toml(folder / CAMPAIGN).get("runs", [])
    except InputError:
        return
    named = [run.get("file") for run in runs if isinstance(run, dict)] if isinstance(runs, list) else []
    for text in named:
        try:
            path = _checked(text)
        except InputError:
            continue
        there = folder / path
        if path.name in inside and len(path.parts) > 1 and not there.exists():
            try:
                _link(folder / path.name, there)
            except OSError:
                # A folder cannot be where a file is: the run is reported as missing.
                continue
            inside[inside.index(path.name)] = path.as_posix()
            if path.name not in named:
                (folder / path.name).unlink()


_MARKS = {"\t": "tab", " ": "space"}

Parameters = list[tuple[str, str]]
"""Names of a command's parameters with their texts; the text is empty for a parameter that has only a name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandWords:
    """The command that repeats a job; ``before``: a step to do first or a note, "" for none."""

    command: str
    before: str


def characterize_words(data: Path, question: Question | None, arguments: Mapping[str, Any]) -> CommandWords:
    """The command ``characterize`` that repeats the job, with a note on fields that it cannot leave out."""
    parameters: Parameters = []
    if question is not None:
        parameters.append(("design", arguments["bases"][question.base]))
        parameters += [("set", f"{key}={text}") for key, text in question.values.items() if text is not None]
    command = _command("characterize", str(data), [*parameters, *_reading_words(arguments)])
    return CommandWords(command=command, before=_kept(question))


def _kept(question: Question | None) -> str:
    """Note on keys that the page leaves out of the design file, which no option of a command can do; or ""."""
    left = [] if question is None else [key for key, text in question.values.items() if text is None]
    return f"it keeps {', '.join(left)} of the design file, which the page leaves out" if left else ""


def calibrate_words(
    data: Path, question: Question | None, arguments: Mapping[str, Any], options: CalibrationOptions
) -> CommandWords:
    """The command ``calibrate`` that repeats the job, and the steps before it: a changed design is saved first."""
    changed = question is not None and any(key != "calibration" for key in question.values)
    parameters: Parameters = []
    if question is not None:
        parameters.append(("design", "DESIGN" if changed else arguments["bases"][question.base]))
    parameters += option_words(options if options.save else options.model_copy(update={"replace": False}))
    command = _command("calibrate", str(data), [*parameters, *_reading_words(arguments)])
    return CommandWords(command=command, before=_saving(question, arguments) if changed else "")


def _saving(question: Question | None, arguments: Mapping[str, Any]) -> str:
    """Step that saves a changed design under a name before the command."""
    assert question is not None
    changes = [("from", arguments["bases"][question.base])]
    changes += [("set", f"{key}={text}") for key, text in question.values.items() if text is not None]
    return f"before it, with a name for DESIGN: {_command('new', 'DESIGN', changes)}"


def _reading_words(arguments: Mapping[str, Any]) -> Parameters:
    stated = {"columns": (arguments.get("columns") or "").strip(), **(arguments.get("format") or {})}
    return [(name, _MARKS.get(value, str(value))) for name, value in stated.items() if value not in (None, "")]


def _command(command: str, given: str, parameters: Parameters) -> str:
    words = ["pneutouch", command, given]
    for name, text in parameters:
        words += [f"--{name.replace('_', '-')}", *([text] if text else [])]
    return shlex.join(words)
