"""The tables of the sheet as rows of text.

Meaning of each figure, in one line; formulas and sources are in docs/howto/measuring.md.

Effects of time and direction: hysteresis loops, relaxation, ageing.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.figures import FIGURES, FIRST, FigureDefinition
from pneutouch.bench.record import MeasuredCurve
from pneutouch.report.measured.head import (
    DASH,
    Bounds,
    FigureRows,
    ListedRows,
    ResinTable,
    between,
    cut,
    difference,
    number,
    overlap,
    signed,
    word_of,
)
from pneutouch.report.measured.panels import (
    NARROW,
    TONES,
    CampaignReport,
    GroupComparison,
    Panel,
    Plot,
    ends_of,
    key,
    multiples,
    some,
)
from pneutouch.report.style import INK, LINES, MARKERS, MUTED, figure, plain_ticks, svg
from pneutouch.results.measured import AgeingChange
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes


MOST = 40
"""Entries of a list of warnings, questions, failures, leaks or volumes that are printed."""
MOST_SPECIMENS = 120
"""Rows of the specimen table that are printed."""

_SHAPES = dict(zip(MARKERS, ("circle", "square", "triangle", "diamond", "triangle down", "plus", "cross"), strict=True))
"""Names of the markers of the plots."""

_NAMES = [figure.name for figure in FIGURES]

Row = list[str]


def resin_table(panel: Panel) -> ResinTable:
    """Every figure of a resin over driving pressure and age: measured and predicted."""
    groups: list[FigureRows] = []
    absent: list[str] = []
    for each in FIGURES:
        compared = [comparison for comparison in panel.comparisons if each.key in comparison.group.figures]
        if not compared:
            absent.append(f"{each.name}, {each.unit}" if _NAMES.count(each.name) > 1 else each.name)
            continue
        rows = [[*_condition(comparison), *_figure(each, comparison)] for comparison in compared]
        groups.append(FigureRows(each.name, each.unit, rows))
    unknown = {b.group.key.driving_pressure_kPa: b.why for b in panel.comparisons if b.why}
    return ResinTable(
        panel.label,
        groups,
        f"Not measured: {'; '.join(absent)}." if absent else "",
        [f"No prediction at {pressure:g} kPa: {why}" for pressure, why in sorted(unknown.items())],
    )


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


def specimens(panels: Sequence[Panel]) -> ListedRows:
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
    for name, digits in (("sensitivity_kPa_per_N", 4), ("stiffness_N_per_mm", 3)):
        values = np.array([figures[name] for figures in each if name in figures])
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
        [
            row.resin,
            f"{row.driving_pressure_kPa:g}",
            row.age,
            signed(row.sensitivity_change_percent),
            _percent(row.low, row.high),
            DASH if (paper := row.published_change_one_year_percent) is None else f"± {paper:.3g}",
        ]
        for row in measured.ageing
    ]


def _percent(low: float | None, high: float | None) -> str:
    return DASH if low is None or high is None else f"{signed(low)} to {signed(high)}"


def injections(measured: CampaignReport) -> ListedRows:
    """Sensor, name, value, standard error, unit of leak and injection runs."""
    rows = [
        [row.sensor, row.figure, number(row.value, 4), number(row.standard_error, 2), row.unit]
        for row in measured.injections
    ]
    return cut(rows, MOST)


def warning_rows(measured: CampaignReport) -> ListedRows:
    """Parts not to be trusted: file, seconds, why, used or not; mere notes are in figures.json."""
    rows = [
        [curve.run.file, f"{warning.start:.2f} to {warning.end:.2f}", warning.why, word_of(warning.used)]
        for curve in measured.curves
        for warning in curve.warnings
        if warning.kind != "note"
    ]
    return cut(rows, MOST)


def failures(measured: CampaignReport) -> ListedRows:
    """Files that are not used, and why."""
    # The message begins with the file's path, which is printed next to it.
    return cut([[file, why.split(f"{file}: ", 1)[-1]] for file, why in measured.failures], MOST)


def questions(measured: CampaignReport) -> ListedRows:
    """Parts of the data that look wrong and were not changed."""
    return cut([list(pair) for pair in measured.questions], MOST)


WHERE = "Formulas, units and sources: docs/howto/measuring.md, section Definitions."

LINES_OF = {
    "sensitivity_kPa_per_N": "Slope of the least-squares line of pressure rise over force, with intercept, over a run.",
    "sensitivity_through_origin_kPa_per_N": "Slope of the least-squares line through the origin.",
    "r_squared": "Share of the variance of the rise that the line with intercept explains.",
    "nonlinearity_percent": "Greatest distance from that line over the full-scale rise.",
    "repeatability_kPa_per_N": "Standard deviation of the sensitivity between runs of a specimen, pooled.",
    "part_to_part_kPa_per_N": "Standard deviation of the specimens' mean sensitivities.",
    "stiffness_N_per_mm": "Force at the greatest depth over that depth.",
    "force_range_N": "Greatest force of the sensitivity test, at its greatest depth.",
    "saturation_force_N": "Force at which the local slope of rise over force falls below half the fitted one.",
    "sensing_range_N": "Saturation force, or the greatest force reached where the sensor did not saturate.",
    "hysteresis_width_percent": "Greatest difference in rise between loading and unloading, over the full-scale rise.",
    "hysteresis_area_percent": "Area between loading and unloading over the area under loading.",
    "relaxation_force_percent": "Loss of force from 1 s of the hold to its end, over the force at 1 s.",
    "relaxation_force_percent_per_decade": "Slope of that loss over the decimal logarithm of time.",
    "relaxation_pressure_percent": "Loss of pressure rise from 1 s of the hold to its end, over the rise at 1 s.",
    "relaxation_pressure_percent_per_decade": "Slope of that loss over the decimal logarithm of time.",
    "drift_pressure_kPa_per_min": "Slope of the pressure over time without contact.",
    "noise_force_N": "Standard deviation of a force sample without contact, trend taken out.",
    "noise_pressure_kPa": "Standard deviation of a pressure sample without contact, trend taken out.",
    "resolution_N": "Three standard deviations of the pressure's noise over the sensitivity.",
}
"""Lines by key of `bench.figure.FIGURES`."""

TERMS = (
    (
        "95 % interval",
        "Of a mean: over specimens, Student's t; with one specimen over its runs, which does not include other "
        "specimens. Of a standard deviation: chi-square.",
    ),
    ("n", "Specimens / runs behind a value."),
    (
        "Predicted band",
        "The interval that holds the figure of a printed sensor with 95 %, as the predicted datasheet states it.",
    ),
    ("Difference", "Measured less predicted, in percent of the predicted."),
    (
        "Overlap",
        "Whether the measured interval and the predicted band share a value; a measured value without an interval "
        "counts as itself. Empty where the prediction has no band.",
    ),
    ("Full scale", "Difference of the greatest and the least pressure rise of the run."),
)
"""Further words of the tables."""


def rows() -> list[list[str]]:
    """Name with unit, and meaning: of every figure, then of the tables' other words."""
    named = [[f"{f.name}, {f.unit}" if f.unit else f.name, LINES_OF[f.key]] for f in FIGURES]
    return [*named, *([what, meaning] for what, meaning in TERMS)]


_POINTS = 120
"""Points of a branch that are drawn."""
_PER_DECADE = 8
"""Points of a relaxation a decade of time."""


def loops(panels: Sequence[Panel]) -> Plot | None:
    """Rise over force in and out, of one run at the lowest and at the highest driving pressure.

    More loops in a panel, or those of several specimens, would hide one another.
    """
    from matplotlib.lines import Line2D

    panels = [
        panel for panel in panels if any(_loop_of(panel, pressure_kPa) for pressure_kPa in panel.driving_pressures_kPa)
    ]
    if not panels:
        return None
    pressures_kPa = sorted(
        {
            pressure_kPa
            for panel in panels
            for pressure_kPa in ends_of(panel.driving_pressures_kPa)
            if _loop_of(panel, pressure_kPa)
        }
    )
    tones = {pressure_kPa: TONES[k % len(TONES)] for k, pressure_kPa in enumerate(pressures_kPa)}
    legend: dict[str, Any] = {
        **{f"{p:g} kPa": Line2D([], [], ls="", marker="s", ms=5, color=tone) for p, tone in tones.items()},
        "loading": Line2D([], [], color=INK, lw=0.9),
        "unloading": Line2D([], [], color=INK, lw=0.9, ls=LINES[1]),
    }

    def draw(ax: Axes, panel: Panel) -> None:
        for pressure_kPa in ends_of(panel.driving_pressures_kPa):
            curve = _loop_of(panel, pressure_kPa)
            for force_up, rise_up, force_down, rise_down in curve.loop if curve else ():
                ax.plot(*_thin(force_up, rise_up / KPA), color=tones[pressure_kPa], lw=0.9)
                ax.plot(*_thin(force_down, rise_down / KPA), color=tones[pressure_kPa], lw=0.9, ls=LINES[1])
        ax.set(xlim=(0, None), ylim=(0, None))

    return multiples(panels, draw, ("contact force  (N)", "pressure rise  (kPa)"), legend)


def _loop_of(panel: Panel, driving_pressure_kPa: float) -> MeasuredCurve | None:
    """The first loop run at a driving pressure."""
    runs = (
        curve
        for comparison in panel.comparisons
        if comparison.group.key.driving_pressure_kPa == driving_pressure_kPa
        for curve in comparison.group.of_kind("loop")
        if curve.loop
    )
    return next(runs, None)


def _thin(x: Array, y: Array) -> tuple[Array, Array]:
    step = max(len(x) // _POINTS, 1)
    return x[::step], y[::step]


def relaxations(panels: Sequence[Panel]) -> Plot | None:
    """Force and pressure rise over the logarithm of time, in percent of their value at `FIRST`; every run."""
    from matplotlib.lines import Line2D

    panels = [panel for panel in panels if any(curve.relaxation is not None for curve in _relaxed(panel))]
    if not panels:
        return None
    legend: dict[str, Any] = {
        **key(panels),
        "force": Line2D([], [], color=INK, lw=0.9),
        "pressure rise": Line2D([], [], color=MUTED, lw=0.9, ls=LINES[1]),
    }

    def draw(ax: Axes, panel: Panel) -> None:
        ax.set_xscale("log")
        for comparison in panel.comparisons:
            for curve in some(comparison.group.of_kind("relaxation")):
                _relaxation(ax, curve, panel.spots(comparison, curve))
        plain_ticks(ax.xaxis)

    return multiples(
        panels, draw, ("time in the hold  (s)", f"share of the value at {FIRST:g} s  (%)"), legend, shared=True
    )


def _relaxed(panel: Panel) -> list[MeasuredCurve]:
    return [curve for comparison in panel.comparisons for curve in comparison.group.of_kind("relaxation")]


def _relaxation(ax: Axes, curve: MeasuredCurve, look: dict[str, Any]) -> None:
    if curve.relaxation is None:
        return
    time, *channels = curve.relaxation
    if time.size == 0 or time[-1] <= FIRST:
        return
    edges = np.geomspace(FIRST, time[-1], max(int(_PER_DECADE * np.log10(time[-1] / FIRST)), 2) + 1)
    later = time >= FIRST
    which = np.digitize(time[later], edges[1:-1])
    count = np.bincount(which)
    seconds, *means = (
        np.bincount(which, weights=part[later])[count > 0] / count[count > 0] for part in (time, *channels)
    )
    for values, color, line in zip(means, (INK, MUTED), LINES[:2], strict=True):
        style = {
            **look,
            "ls": line,
            "color": color,
            "mec": color,
            "lw": 0.7,
            "markevery": 3,
            "mfc": color if look["mfc"] != "white" else "white",
        }
        ax.plot(seconds, 100 * values / values[0], **style)


def ageings(measured: CampaignReport) -> Plot | None:
    """Change of sensitivity between ages with its interval, one row a group; and the paper's change in a year."""
    rows = measured.ageing
    if not rows:
        return None
    with figure(NARROW, 22 + 5.2 * len(rows)) as drawn:
        ax = drawn.add_subplot()
        for k, row in enumerate(rows):
            if row.low is not None and row.high is not None:
                ax.plot([row.low, row.high], [k, k], color=INK, lw=0.9, marker="|", ms=4)
            label = "measured" if k == 0 else None
            ax.plot(row.sensitivity_change_percent, k, ls="", marker="o", color=INK, ms=3.6, label=label)
            paper = row.published_change_one_year_percent
            if paper is not None:
                first = all(each.published_change_one_year_percent is None for each in rows[:k])
                ax.plot(
                    [-paper, paper],
                    [k, k],
                    ls="",
                    marker=MARKERS[3],
                    color=INK,
                    mfc="white",
                    ms=4.2,
                    label="paper, one year (sign not given)" if first else None,
                )
        ax.axvline(0, color=INK, lw=0.6)
        ax.set_yticks(range(len(rows)), [_short(row) for row in rows])
        ax.set(xlabel="change of sensitivity  (%)", ylim=(len(rows) - 0.4, -0.6))
        ax.grid(visible=False, axis="y")
        drawn.legend(loc="outside upper left", ncols=2, handletextpad=0.2)
        return Plot(svg(drawn), wide=False)


def _short(row: AgeingChange) -> str:
    return f"{row.resin}, {row.driving_pressure_kPa:g} kPa, {row.age}".replace("$", r"\$")
