"""The tables of the sheet as rows of text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from pneutouch.bench.figure import FIGURES, FigureDefinition
from pneutouch.report.measured.beside import CampaignReport, GroupComparison
from pneutouch.report.measured.panels import Panel
from pneutouch.report.measured.words import (
    DASH,
    Bounds,
    between,
    cut,
    difference,
    number,
    overlap,
    said,
    signed,
)
from pneutouch.report.style import MARKERS

MOST = 40
"""Entries of a list of doubts, questions, failures, leaks or volumes that are printed."""
MOST_SPECIMENS = 120
"""Rows of the specimen table that are printed."""

_SHAPES = dict(zip(MARKERS, ("circle", "square", "triangle", "diamond", "triangle down", "plus", "cross"), strict=True))
"""What the markers of the plots are called."""

_NAMES = [figure.name for figure in FIGURES]

Row = list[str]


def resin_table(panel: Panel) -> dict[str, Any]:
    """Every figure of a resin over driving pressure and age: measured beside predicted.

    A figure has its name, unit and rows of driving pressure, age, measured, interval, n, predicted, band, difference, overlap.
    ``absent`` names what was not measured, ``why`` driving pressures without a prediction.
    """
    groups: list[dict[str, Any]] = []
    absent: list[str] = []
    for figure in FIGURES:
        found = [beside for beside in panel.besides if figure.key in beside.group.figures]
        if not found:
            absent.append(f"{figure.name}, {figure.unit}" if _NAMES.count(figure.name) > 1 else figure.name)
            continue
        rows = [[*_condition(beside), *_figure(figure, beside)] for beside in found]
        groups.append({"name": figure.name, "unit": figure.unit, "rows": rows})
    unknown = {b.group.key.driving_pressure_kPa: b.why for b in panel.besides if b.why}
    return {
        "title": panel.label,
        "figures": groups,
        "absent": f"Not measured: {'; '.join(absent)}." if absent else "",
        "why": [f"No prediction at {pressure:g} kPa: {why}" for pressure, why in sorted(unknown.items())],
    }


def _condition(beside: GroupComparison) -> Row:
    return [f"{beside.group.key.driving_pressure_kPa:g}", beside.group.key.age]


def _figure(figure: FigureDefinition, beside: GroupComparison) -> Row:
    estimate, digits = beside.group.figures[figure.key], figure.digits
    measured: Bounds = (estimate.value, estimate.low, estimate.high)
    cells = [number(estimate.value, digits), between(measured, digits), f"{estimate.specimens} / {estimate.runs}"]
    predicted = beside.predicted.get(figure.key)
    if predicted is None:
        return [*cells, "", "", "", ""]
    apart = signed(difference(estimate.value, predicted[0]))
    return [
        *cells,
        number(predicted[0], digits),
        between(predicted, digits),
        apart,
        said(overlap(measured, predicted), ("yes", "no", "")),
    ]


def specimens(panels: Sequence[Panel]) -> tuple[list[Row], str]:
    """Sensitivity and stiffness of each specimen, mean and standard deviation over its runs."""
    rows = []
    for panel in panels:
        for k, sensor in enumerate(panel.sensors):
            for beside in panel.besides:
                values = _of_sensor(beside, sensor)
                if values:
                    marker = f"{k + 1}, {_SHAPES[MARKERS[k % len(MARKERS)]]}"
                    rows.append([panel.label, sensor, marker, *_condition(beside), *values])
    return cut(rows, MOST_SPECIMENS)


def _of_sensor(beside: GroupComparison, sensor: str) -> Row:
    group = beside.group
    each = [found for curve, found in zip(group.curves, group.each, strict=True) if curve.run.sensor == sensor]
    cells: Row = []
    for key, digits in (("sensitivity_kPa_per_N", 4), ("stiffness_N_per_mm", 3)):
        values = np.array([found[key] for found in each if key in found])
        if not values.size:
            cells += [DASH, DASH]
            continue
        mean = float(values.mean())
        spread = number(float(values.std(ddof=1)), 2) if values.size > 1 else DASH
        cells += [number(mean, digits), spread]
    count = sum("sensitivity_kPa_per_N" in found for found in each)
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


def doubts(measured: CampaignReport) -> tuple[list[Row], str]:
    """Stretches not to be trusted: file, seconds, why, used or not; mere notes are in figures.json."""
    rows = [
        [curve.run.file, f"{doubt.start:.2f} to {doubt.end:.2f}", doubt.why, said(doubt.used)]
        for curve in measured.curves for doubt in curve.warnings if doubt.kind != "note"
    ]  # fmt: skip
    return cut(rows, MOST)


def failures(measured: CampaignReport) -> tuple[list[Row], str]:
    """Files that could not be read, and why."""
    # The message begins with the file's path, which stands beside it.
    return cut([[file, why.split(f"{file}: ", 1)[-1]] for file, why in measured.failures], MOST)


def questions(measured: CampaignReport) -> tuple[list[Row], str]:
    """What looks wrong and was not changed."""
    return cut([list(pair) for pair in measured.questions], MOST)
