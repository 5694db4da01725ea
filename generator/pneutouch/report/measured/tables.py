"""The tables of the sheet as rows of text."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from pneutouch.bench.figure import FIGURES, FigureDefinition
from pneutouch.report.measured.comparison import CampaignReport, GroupComparison
from pneutouch.report.measured.panels import Panel
from pneutouch.report.measured.words import DASH, Bounds, between, cut, difference, number, overlap, signed, word_of
from pneutouch.report.style import MARKERS

MOST = 40
"""Entries of a list of warnings, questions, failures, leaks or volumes that are printed."""
MOST_SPECIMENS = 120
"""Rows of the specimen table that are printed."""

_SHAPES = dict(zip(MARKERS, ("circle", "square", "triangle", "diamond", "triangle down", "plus", "cross"), strict=True))
"""Names of the markers of the plots."""

_NAMES = [figure.name for figure in FIGURES]

Row = list[str]


def resin_table(panel: Panel) -> dict[str, Any]:
    """Every figure of a resin over driving pressure and age: measured and predicted.

    A figure has its name, unit and rows of driving pressure, age, measured, interval, n, predicted, band, difference,
    overlap. ``absent`` names what was not measured, ``why`` driving pressures without a prediction.
    """
    groups: list[dict[str, Any]] = []
    absent: list[str] = []
    for figure in FIGURES:
        compared = [comparison for comparison in panel.comparisons if figure.key in comparison.group.figures]
        if not compared:
            absent.append(f"{figure.name}, {figure.unit}" if _NAMES.count(figure.name) > 1 else figure.name)
            continue
        rows = [[*_condition(comparison), *_figure(figure, comparison)] for comparison in compared]
        groups.append({"name": figure.name, "unit": figure.unit, "rows": rows})
    unknown = {b.group.key.driving_pressure_kPa: b.why for b in panel.comparisons if b.why}
    return {
        "title": panel.label,
        "figures": groups,
        "absent": f"Not measured: {'; '.join(absent)}." if absent else "",
        "why": [f"No prediction at {pressure:g} kPa: {why}" for pressure, why in sorted(unknown.items())],
    }


def _condition(comparison: GroupComparison) -> Row:
    return [f"{comparison.group.key.driving_pressure_kPa:g}", comparison.group.key.age]


def _figure(figure: FigureDefinition, comparison: GroupComparison) -> Row:
    estimate, digits = comparison.group.figures[figure.key], figure.digits
    measured: Bounds = (estimate.value, estimate.low, estimate.high)
    cells = [number(estimate.value, digits), between(measured, digits), f"{estimate.specimens} / {estimate.runs}"]
    predicted = comparison.predicted.get(figure.key)
    if predicted is None:
        return [*cells, "", "", "", ""]
    apart = signed(difference(estimate.value, predicted[0]))
    return [
        *cells,
        number(predicted[0], digits),
        between(predicted, digits),
        apart,
        word_of(overlap(measured, predicted), ("yes", "no", "")),
    ]


def specimens(panels: Sequence[Panel]) -> tuple[list[Row], str]:
    """Sensitivity and stiffness of each specimen, mean and standard deviation over its runs."""
    rows = []
    for panel in panels:
        for k, sensor in enumerate(panel.sensors):
            for comparison in panel.comparisons:
                values = _of_sensor(comparison, sensor)
                if values:
                    marker = f"{k + 1}, {_SHAPES[MARKERS[k % len(MARKERS)]]}"
                    rows.append([panel.label, sensor, marker, *_condition(comparison), *values])
    return cut(rows, MOST_SPECIMENS)


def _of_sensor(comparison: GroupComparison, sensor: str) -> Row:
    group = comparison.group
    each = [figures for curve, figures in zip(group.curves, group.each, strict=True) if curve.run.sensor == sensor]
    cells: Row = []
    for key, digits in (("sensitivity_kPa_per_N", 4), ("stiffness_N_per_mm", 3)):
        values = np.array([figures[key] for figures in each if key in figures])
        if not values.size:
            cells += [DASH, DASH]
            continue
        mean = float(values.mean())
        spread = number(float(values.std(ddof=1)), 2) if values.size > 1 else DASH
        cells += [number(mean, digits), spread]
    count = sum("sensitivity_kPa_per_N" in figures for figures in each)
    return [str(count), *cells] if set(cells) != {DASH} else []


def ageing(measured: CampaignReport) -> list[Row]:
    """Resin, driving pressure, age, change in percent, interval, the paper's, whose sign is not given."""
    return [
        [resin, f"{pressure:g}", age, signed(change), _percent(low, high), DASH if paper is None else f"± {paper:.3g}"]
        for resin, pressure, age, change, low, high, paper in measured.ageing
    ]


def _percent(low: float | None, high: float | None) -> str:
    return DASH if low is None or high is None else f"{signed(low)} to {signed(high)}"


def injections(measured: CampaignReport) -> tuple[list[Row], str]:
    """Sensor, name, value, standard error, unit of leak and injection runs."""
    rows = [
        [sensor, name, number(value, 4), DASH if error is None else number(error, 2), unit]
        for sensor, name, value, error, unit in measured.injections
    ]
    return cut(rows, MOST)


def warning_rows(measured: CampaignReport) -> tuple[list[Row], str]:
    """Parts not to be trusted: file, seconds, why, used or not; mere notes are in figures.json."""
    rows = [
        [curve.run.file, f"{warning.start:.2f} to {warning.end:.2f}", warning.why, word_of(warning.used)]
        for curve in measured.curves
        for warning in curve.warnings
        if warning.kind != "note"
    ]
    return cut(rows, MOST)


def failures(measured: CampaignReport) -> tuple[list[Row], str]:
    """Files that are not used, and why."""
    # The message begins with the file's path, which is printed next to it.
    return cut([[file, why.split(f"{file}: ", 1)[-1]] for file, why in measured.failures], MOST)


def questions(measured: CampaignReport) -> tuple[list[Row], str]:
    """Parts of the data that look wrong and were not changed."""
    return cut([list(pair) for pair in measured.questions], MOST)
