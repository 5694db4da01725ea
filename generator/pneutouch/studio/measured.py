"""Campaign as the page shows it: files with their columns, figures compared with the predicted ones, curves.

A campaign's folder made of the files that the page was given.
"""

import os
import shutil
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import Any

from pneutouch.bench.figures import BY_KEY
from pneutouch.bench.source import MeasuredFile
from pneutouch.errors import InputError
from pneutouch.report.measured import CampaignReport, GroupComparison
from pneutouch.report.measured.head import overlap, tiles
from pneutouch.report.measured.panels import some
from pneutouch.rounding import rounded
from pneutouch.spec.campaign import CAMPAIGN, CampaignRun
from pneutouch.spec.read import read_toml
from pneutouch.spec.toml_text import toml_text
from pneutouch.units import KPA
from pneutouch.workflows.characterize import CharacterizationResult

_DIGITS = 6

_OF_RUN = ("file", "kind", "sensor", "resin", "driving_pressure_kPa", "run", "age_days")


def run_document(run: CampaignRun, source: MeasuredFile | None, problem: str | None = None) -> dict[str, Any]:
    """A run with the columns of its file: channel, name, unit, sign, and whether it was found by its header."""
    return {
        **{key: getattr(run, key) for key in _OF_RUN},
        "columns": [] if source is None else [_column(source, channel) for channel in source.channels],
        "format": {} if source is None else source.content.get("format", {}),
        "problem": problem,
    }


def _column(source: MeasuredFile, channel: str) -> dict[str, Any]:
    column = getattr(source.columns, channel)
    return {
        "channel": channel,
        "name": column.name,
        "unit": column.unit,
        "sign": column.sign,
        "found": channel in source.guessed,
    }


def runs_document(outcome: CharacterizationResult) -> list[dict[str, Any]]:
    """Every run of a campaign that was read: its columns, its error, the questions and the doubtful parts."""
    measured = outcome.measured
    failures = dict(measured.failures)
    questions: dict[str, list[str]] = {}
    for file, text in measured.questions:
        questions.setdefault(file, []).append(text)
    doubtful = {
        curve.run.file: [
            {"start_s": round(one.start, 4), "end_s": round(one.end, 4), "why": one.why, "used": one.used}
            for one in curve.warnings
            if one.kind != "note"
        ]
        for curve in measured.curves
    }
    return [
        {
            **run_document(run, outcome.sources.get(run.file), failures.get(run.file)),
            "questions": questions.get(run.file, []),
            "doubtful": doubtful.get(run.file, []),
        }
        for run in measured.campaign.runs
    ]


def groups_document(measured: CampaignReport) -> list[dict[str, Any]]:
    """The groups of runs with figures and curves, in the order of the campaign's document."""
    return [_group(one) for one in measured.comparisons]


def _group(comparison: GroupComparison) -> dict[str, Any]:
    key, figures = comparison.group.key, _figures(comparison)
    known = [row["agrees"] for row in figures if row.get("agrees") is not None]
    return {
        "title": f"{comparison.label}, {key.age}, {key.driving_pressure_kPa:g} kPa",
        "sensors": comparison.group.sensors,
        "why_not_predicted": comparison.why or None,
        "figures": figures,
        "agreeing": sum(known),
        "compared": len(known),
        "curves": _curves(comparison),
    }


def _figures(comparison: GroupComparison) -> list[dict[str, Any]]:
    """Measured with its 95 % interval, predicted with its band, whether the two share a value, and the paper's."""
    rows = []
    for key, estimate in comparison.group.figures.items():
        figure, bounds = BY_KEY[key], (estimate.value, estimate.low, estimate.high)
        row: dict[str, Any] = {"key": key, "name": figure.name, "unit": figure.unit}
        row |= dict(zip(("value", "low", "high"), bounds, strict=True))
        row |= {"interval_over": estimate.over or None, "specimens": estimate.specimens, "runs": estimate.runs}
        predicted = comparison.predicted.get(key)
        if predicted is not None:
            row["predicted"] = dict(zip(("value", "low", "high"), predicted, strict=True))
            agrees = overlap(bounds, predicted)
            row["agrees"] = None if agrees is None else bool(agrees)
        if key in comparison.published:
            row["published"] = comparison.published[key]
        rows.append(row)
    return rows


def _curves(comparison: GroupComparison) -> dict[str, Any]:
    """Points of the steps runs, and the predicted curve up to the end of its range with the bands of the sheet's plots:
    that of the sensitivity about the rise, that of the stiffness about the force."""
    runs = [
        {
            "sensor": curve.run.sensor,
            "run": curve.run.run,
            "indentation_mm": curve.indentation.tolist(),
            "force_N": curve.force.tolist(),
            "rise_kPa": (curve.rise / KPA).tolist(),
        }
        for curve in some(comparison.group.of_kind("steps"))
    ]
    state, predicted = comparison.state, None
    if state is not None and runs:
        kept = state.indentation <= state.range_end * (1 + 1e-12)
        curve = {"indentation_mm": state.indentation, "force_N": state.force, "rise_kPa": state.pressure_rise / KPA}
        predicted = {key: values[kept].tolist() for key, values in curve.items()}
        for key, figure in (("rise_kPa", "sensitivity_kPa_per_N"), ("force_N", "stiffness_N_per_mm")):
            ends = comparison.relative_band(figure)
            if ends is not None:
                predicted |= {
                    f"{end}_{key}": (factor * curve[key][kept]).tolist()
                    for end, factor in zip(("low", "high"), ends, strict=True)
                }
    drawn: dict[str, Any] = rounded({"runs": runs, "predicted": predicted}, _DIGITS)
    return drawn


def head_document(measured: CampaignReport) -> dict[str, Any]:
    """Title, laboratory, design, model, whether a program made the runs, and the first figures of the sheet."""
    campaign = measured.campaign.model_dump(include={"title", "lab", "simulated"})
    return {**campaign, "design": measured.scene.name, "model": measured.model, "tiles": tiles(measured)}


UNNAMED = "campaign"
"""Folder of files that came without one."""

_DEEPEST, _LONGEST = 8, 200
"""Folders above a file, and bytes of a name in its path."""


def placed(files: Sequence[Mapping[str, str]], paths: Sequence[str], place: Path) -> tuple[Path, list[str]]:
    """Put files (name, path) at their relative ``paths`` below ``place``.

    Returns the campaign's folder, relative to ``place``, and the paths of its files, relative to that folder. It is the
    one that holds the campaign file; else the one that holds all. Raises InputError for a path that is none, for two
    files at one place and for two campaigns.
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
    """A path below a folder, without a step out of it. Raises InputError."""
    parts = text.split("/") if isinstance(text, str) else [""]
    plain = all(
        part not in ("", ".", "..") and part.isprintable() and "\\" not in part and len(part.encode()) <= _LONGEST
        for part in parts
    )
    if not plain or len(parts) > _DEEPEST:
        raise InputError("not a path of a file in a folder", key="paths", value=text, remedy="rename the file")
    return PurePosixPath(*parts)


def _link(source: Path, target: Path) -> None:
    """The same file at another place, without a copy where the file system can."""
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        target.hardlink_to(source)
    except OSError:
        shutil.copyfile(source, target)


def _bring_named(folder: Path, inside: list[str]) -> None:
    """Files that were chosen one by one lie in one folder: those that the campaign names in another go there.

    What is wrong with the campaign file is reported when it is read.
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
