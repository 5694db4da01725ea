"""Campaign as the page shows it: files with their columns, figures compared with the predicted ones, curves."""

from typing import Any

from pneutouch.bench.figure import BY_KEY
from pneutouch.bench.source import MeasuredFile
from pneutouch.report.measured import CampaignReport, GroupComparison
from pneutouch.report.measured.head import tiles
from pneutouch.report.measured.panels import some
from pneutouch.report.measured.words import overlap
from pneutouch.rounding import rounded
from pneutouch.spec.campaign import CampaignRun
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
