"""Document that ``characterize`` prints: every figure measured and predicted, and everything that is doubtful."""

from typing import Any

from pneutouch.bench.figure import BY_KEY
from pneutouch.bench.interval import LEVEL, Estimate
from pneutouch.bench.record import MeasuredCurve
from pneutouch.report.measured import CampaignReport, GroupComparison

_INJECTION = ("sensor", "figure", "value", "standard_error", "unit")
_CHANGE = ("sensitivity_change_percent", "low", "high", "published_change_one_year_percent")
_AGEING = ("resin", "driving_pressure_kPa", "age", *_CHANGE)
_VERDICT = ("what", "required", "measured", "passed")
_OF_RUN = ("file", "kind", "sensor", "resin", "run", "driving_pressure_kPa", "age_days")


def document(measured: CampaignReport) -> dict[str, Any]:
    """A campaign as plain data."""
    campaign = measured.campaign
    return {
        "title": campaign.title,
        "lab": campaign.lab,
        "simulated": campaign.simulated,
        "design": measured.scene.name,
        "input_hash": measured.input_hash,
        "model": measured.model,
        "level": LEVEL,
        "groups": [_group(comparison) for comparison in measured.comparisons],
        "runs": [_run(*of) for b in measured.comparisons for of in zip(b.group.curves, b.group.each, strict=True)],
        "injections": [dict(zip(_INJECTION, row, strict=True)) for row in measured.injections],
        "ageing": [dict(zip(_AGEING, row, strict=True)) for row in measured.ageing],
        "target": [{key: getattr(v, key) for key in _VERDICT} for v in measured.verdicts],
        "questions": [{"file": file, "question": text} for file, text in measured.questions],
        "failures": [{"file": file, "message": text} for file, text in measured.failures],
    }


def _group(comparison: GroupComparison) -> dict[str, Any]:
    group = comparison.group
    return {
        "resin": group.key.resin,
        "age": group.key.age,
        "driving_pressure_kPa": group.key.driving_pressure_kPa,
        "sensors": group.sensors,
        "files": [curve.run.file for curve in group.curves],
        "why_not_predicted": comparison.why or None,
        "figures": {key: _figure(key, estimate, comparison) for key, estimate in group.figures.items()},
    }


def _figure(key: str, estimate: Estimate, comparison: GroupComparison) -> dict[str, Any]:
    figure: dict[str, Any] = {
        "value": estimate.value,
        "low": estimate.low,
        "high": estimate.high,
        "unit": BY_KEY[key].unit,
        "specimens": estimate.specimens,
        "runs": estimate.runs,
        "interval_over": estimate.over or None,
    }
    if key in comparison.predicted:
        value, low, high = comparison.predicted[key]
        off = 100 * (estimate.value / value - 1) if value else None
        figure["predicted"] = {"value": value, "low": low, "high": high, "measured_off_percent": off}
    return figure


def _run(curve: MeasuredCurve, values: dict[str, float]) -> dict[str, Any]:
    return {
        **{key: getattr(curve.run, key) for key in _OF_RUN},
        "points": len(curve.force) - 1,
        "figures": dict(values),
        "warnings": [
            {"start_s": round(d.start, 4), "end_s": round(d.end, 4), "why": d.why, "used": d.used, "kind": d.kind}
            for d in curve.warnings
        ],
    }
