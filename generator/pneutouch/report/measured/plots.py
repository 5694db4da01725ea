"""Plots of the measured datasheet, most with one panel for each resin.

Markers of runs: shape by specimen, filled at the youngest age, open later; lines of presses: by driving pressure.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.figures import FIRST, fitted_loop
from pneutouch.bench.record import MeasuredCurve
from pneutouch.report import curves
from pneutouch.report.blocks import Plot
from pneutouch.report.chart import SIZE, WIDE, Chart, Panel, PlotLine, bars_between, drawn_svg
from pneutouch.report.measured.tables import CampaignReport, GroupComparison, ResinGroups, some
from pneutouch.report.style import INK, LINES, MARKERS, MUTED
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from pneutouch.units import KPA

_LEAST_SPAN = 20.0
"""Least span of driving pressures, kPa, from which the margin of an axis is computed."""
_MOST_TICKS, _COLUMNS = 5, 4
_LONG = 15
"""An entry of the legend with more letters does not fit into a third of a narrow plot."""

_HEIGHT = 52.0
_ROW = {2: 60.0, 3: 55.0, 4: 55.0}
"""Height of a row of panels in mm by the number of columns."""
_LEGEND = 4.0
"""Height of a line of the legend, mm."""

SKY = "#3F8FBF"
"""A blue that differs from INK in grayscale, which ACCENT does not."""
_TONES = (INK, SKY, MUTED)

_PER_DECADE = 8
"""Points of a relaxation per decade of time."""

Groups = Sequence[ResinGroups]


def _multiples(
    groups: Groups, draw: Callable[[ResinGroups], Panel], legend: Sequence[PlotLine], shared: str = ""
) -> str:
    """SVG of one panel per resin, drawn by ``draw``; axes are named once. ``legend``: lines without points."""
    panels = [draw(group) for group in groups]
    named = panels[0].x, panels[0].y
    panels = [
        replace(panel, x="", y="", title="" if group.alone else group.label)
        for panel, group in zip(panels, groups, strict=True)
    ]
    panels[0] = replace(panels[0], lines=(*panels[0].lines, *legend))
    down = math.ceil(len(panels) / _COLUMNS)
    across = math.ceil(len(panels) / down)
    wide, keys = (SIZE[0], 3) if across == 1 else (WIDE, 7)
    if across == 1 and max((len(entry.label) for entry in legend), default=0) > _LONG:
        keys = 2
    high = (_HEIGHT if across == 1 else _ROW[across] * down) + math.ceil(len(legend) / keys) * _LEGEND
    return drawn_svg(Chart(tuple(panels), (wide, high), across, *named, shared=shared, keys=keys))


def _plot(groups: Groups, title: str, words: str, *drawing: Any) -> Plot | None:
    """Plot of ``groups``, or None without any, with caption ``words``; over the whole row for several resins."""
    if not groups:
        return None
    return Plot(_multiples(groups, *drawing), words, title, full=len(groups) > 1)


def _tone(groups: ResinGroups, pressure_kPa: float) -> PlotLine:
    """Tone and dashes of a driving pressure: the same in every panel."""
    k = groups.campaign_pressures_kPa.index(pressure_kPa)
    return PlotLine(tone=_TONES[k % len(_TONES)], dashes=LINES[k % len(LINES)], width=1.0)


def _spots(groups: ResinGroups, comparison: GroupComparison, curve: MeasuredCurve) -> PlotLine:
    """Style of a run's points: marker by specimen, tone by driving pressure, filled for the youngest age."""
    key = comparison.group.key
    young = key.age_days == next(iter(groups.ages))
    marker = MARKERS[groups.sensors.index(curve.run.sensor) % len(MARKERS)]
    tone = _tone(groups, key.driving_pressure_kPa).tone
    return PlotLine(tone=tone, dashes="", marker=marker, size=2.6, filled=young, over=4)


def _key(groups: Groups) -> list[PlotLine]:
    """Legend of the runs: markers of the specimens, fill of the ages."""
    point = PlotLine(dashes="", marker="o", size=3.4, filled=True)
    most = min(max((len(group.sensors) for group in groups), default=0), len(MARKERS))
    lines = [replace(point, marker=MARKERS[k], label=f"specimen {k + 1}") for k in range(most)]
    if len({age for group in groups for age in group.ages}) > 1:
        lines += [replace(point, label="youngest"), replace(point, filled=False, label="older")]
    return lines


_BAND = PlotLine(low=(), high=(), dashes="", label="predicted, 95 %")


def _ends(values: Sequence[float], most: int = 2) -> list[float]:
    """All values if they are at most ``most``, else the first and the last."""
    return list(values) if len(values) <= most else [values[0], values[-1]]


def sensitivities(groups: Groups) -> Plot | None:
    """Plot of the specimens' mean sensitivity over driving pressure with interval and predicted band, or None."""
    groups = [g for g in groups if any(SENSITIVITY_KEY in b.group.figures for b in g.comparisons)]
    words = "Mean over specimens with its 95 % interval, in the predicted band."
    if not groups:
        return None
    ages = list(dict.fromkeys(age for g in groups for age in g.ages.values()))
    known = any(SENSITIVITY_KEY in b.predicted for g in groups for b in g.comparisons)
    legend = [PlotLine(label="predicted", width=1.0), _BAND] if known else []
    legend += [replace(_mean(k), label=f"measured, {age}") for k, age in enumerate(ages)]
    pressures_kPa = groups[0].campaign_pressures_kPa
    span_kPa = pressures_kPa[-1] - pressures_kPa[0]
    slack = 0.08 * max(span_kPa, _LEAST_SPAN)
    apart = min(np.diff(pressures_kPa), default=span_kPa) > 0.15 * span_kPa
    few = span_kPa == 0 or (apart and len(pressures_kPa) <= _MOST_TICKS)
    across = pressures_kPa[0] - slack, pressures_kPa[-1] + slack

    def draw(group: ResinGroups) -> Panel:
        lines = [*_predicted_sensitivity(group, 0.5 * slack), *_measured_sensitivity(group, ages, 0.18 * slack)]
        panel = curves.sensitivities(lines)
        return replace(panel, xlim=across, ylim=up, ticks=pressures_kPa if few else ())

    means = [
        b.group.figures[SENSITIVITY_KEY] for g in groups for b in g.comparisons if SENSITIVITY_KEY in b.group.figures
    ]
    ends = [end for one in means for end in (one.value, one.high)]
    ends += [end for g in groups for b in g.comparisons for end in b.predicted.get(SENSITIVITY_KEY, ())]
    top = 1.12 * max(end for end in ends if end is not None)
    up = 1.12 * min(0.0, *(one.value for one in means)), top or 1.0
    return _plot(groups, "Sensitivity over driving pressure", words, draw, legend, "xy")


def _mean(k: int) -> PlotLine:
    return PlotLine(dashes="", marker=MARKERS[k % len(MARKERS)], size=3.6, filled=k == 0, over=5)


def _predicted_sensitivity(groups: ResinGroups, half: float) -> list[PlotLine]:
    """Line of the predictions with its band; at a single driving pressure ``half`` kPa to each side; [] for none."""
    known = {
        b.group.key.driving_pressure_kPa: b.predicted[SENSITIVITY_KEY]
        for b in reversed(groups.comparisons)
        if SENSITIVITY_KEY in b.predicted
    }
    rows = [(p, *known[p]) for p in sorted(known)]
    if len(rows) == 1:
        rows = [(rows[0][0] + side, *rows[0][1:]) for side in (-half, half)]
    if not rows:
        return []
    x, value, low, high = zip(*rows, strict=True)
    whole = None not in (*low, *high)
    line = PlotLine(x, value, width=1.0, over=2)
    return [replace(line, low=np.array(low, float), high=np.array(high, float)) if whole else line]


def _measured_sensitivity(groups: ResinGroups, ages: list[str], aside: float) -> list[PlotLine]:
    """Means with their intervals; those of different ages stand ``aside`` kPa apart."""
    lines = []
    for comparison in groups.comparisons:
        estimate = comparison.group.figures.get(SENSITIVITY_KEY)
        if estimate is None:
            continue
        k = ages.index(comparison.group.key.age)
        place_kPa = comparison.group.key.driving_pressure_kPa + aside * (k - 0.5 * (len(ages) - 1))
        if estimate.low is not None and estimate.high is not None:
            # Caps on an interval without width would hide the marker.
            caps = "_" if estimate.high > estimate.low else ""
            look = PlotLine(width=0.9, marker=caps, size=4, over=4)
            lines += bars_between((place_kPa,), (estimate.low,), (estimate.high,), look)
        lines.append(replace(_mean(k), x=(place_kPa,), y=(estimate.value,)))
    return lines


def responses(groups: Groups) -> Plot | None:
    """Plot of pressure rise over force: points of runs over predicted curves and bands; None without runs."""
    words = "Pressure rise over contact force. {}sensitivity{}"
    return _curves(groups, "Response", words, curves.rises, SENSITIVITY_KEY)


def indentations(groups: Groups) -> Plot | None:
    """Plot of force over indentation, drawn as `responses`, with bands of the stiffness; None without runs."""
    words = "Contact force over indentation. {}stiffness{}"
    return _curves(groups, "Force over indentation", words, curves.forces, STIFFNESS_KEY)


def _curves(
    groups: Groups, title: str, words: str, draw: Callable[[Sequence[curves.Press]], Panel], figure: str
) -> Plot | None:
    groups = [g for g in groups if any(b.group.lined for b in g.comparisons)]
    drawn = [b for g in groups for b in g.comparisons if b.group.lined]
    legend = _key(groups)
    for pressure_kPa in sorted({b.group.key.driving_pressure_kPa for b in drawn}):
        legend.append(replace(_tone(groups[0], pressure_kPa), label=f"{pressure_kPa:g} kPa"))
    if any(b.state is not None and b.relative_band(figure) for b in drawn):
        legend.append(_BAND)
    many = groups and len(groups[0].campaign_pressures_kPa) > 2
    ends = " at the lowest and the highest driving pressure" if many else ""
    alone = " Thin lines join the points of runs without a prediction." if any(b.state is None for b in drawn) else ""
    said = words.format("Markers: every run; lines: predicted, with the band of the ", f"{ends}.{alone}")
    return _plot(groups, title, said, lambda group: draw(_presses(group)), legend)


def _presses(groups: ResinGroups) -> list[curves.Press]:
    """Runs, and predictions for their youngest age; bands only at the lowest and the highest driving pressure."""
    shaded_kPa = _ends(groups.driving_pressures_kPa)
    presses: list[curves.Press] = []
    done: set[float] = set()
    for comparison in groups.comparisons:
        runs, pressure_kPa = some(comparison.group.lined), comparison.group.key.driving_pressure_kPa
        tone = _tone(groups, pressure_kPa)
        for run in runs:
            look = _spots(groups, comparison, run)
            if comparison.state is None:
                look = replace(look, dashes=tone.dashes, width=0.5)
            presses.append(curves.Press(run.indentation, run.force, run.rise / KPA, look))
        if runs and comparison.state is not None and pressure_kPa not in done:
            done.add(pressure_kPa)
            bands = map(
                comparison.relative_band, (SENSITIVITY_KEY, STIFFNESS_KEY) if pressure_kPa in shaded_kPa else ("", "")
            )
            presses.append(curves.predicted_press(comparison.state, tone, *bands))
    return presses


def loops(groups: Groups) -> Plot | None:
    """Plot of how far a loop opens, of one run at the lowest and one at the highest driving pressure; or None.

    A loop is narrower than the line that would draw it: its fitted branches are drawn from their middle.
    """
    words = (
        "Pressure rise from the loop's middle, in percent of the full-scale rise: the distance of the two branches, "
        "fitted to all cycles, is the hysteresis. The first run at the lowest and at the highest driving pressure."
    )
    runs = {
        g.label: [(p, run) for p in _ends(g.driving_pressures_kPa) if (run := _loop_of(g, p)) is not None]
        for g in groups
    }
    pressures_kPa = sorted({p for each in runs.values() for p, _ in each})
    look = PlotLine(width=0.9, filled=True, every=16)
    looks = {
        p: replace(look, tone=_TONES[k % len(_TONES)], marker=MARKERS[k % len(MARKERS)])
        for k, p in enumerate(pressures_kPa)
    }
    legend = [replace(one, label=f"{p:g} kPa", dashes="") for p, one in looks.items()]
    legend += [PlotLine(label="loading", width=0.9), PlotLine(label="unloading", width=0.9, dashes=LINES[1])]

    def draw(group: ResinGroups) -> Panel:
        lines = [
            replace(looks[p], x=force, y=side * opening, dashes=dashes)
            for p, run in runs[group.label]
            for force, opening in opened(run)
            for side, dashes in ((1.0, LINES[0]), (-1.0, LINES[1]))
        ]
        return Panel("contact force  (N)", "from the middle  (% FS)", tuple(lines), xlim=(0, None), zero="y")

    return _plot([g for g in groups if runs[g.label]], "Hysteresis", words, draw, legend)


def opened(run: MeasuredCurve) -> list[tuple[Array, Array]]:
    """Force (N) and distance of the loading branch from the middle of its loop (% of full scale); [] without a fit."""
    fitted = fitted_loop(run)
    return [] if fitted is None else [(fitted[0], 100.0 * fitted[2] / float(np.ptp(fitted[1])))]


def _loop_of(groups: ResinGroups, pressure_kPa: float) -> MeasuredCurve | None:
    """The first run at a driving pressure with cycles of loading and unloading; None if there is none."""
    members = (one.group for one in groups.comparisons if one.group.key.driving_pressure_kPa == pressure_kPa)
    return next((curve for group in members for curve in group.curves if curve.loop), None)


def relaxations(groups: Groups) -> Plot | None:
    """Plot of force and rise over the logarithm of time in a hold, percent of their value at `FIRST`; or None."""
    words = "Force and pressure rise in a long hold, in percent of their value at 1 s; every driving pressure."
    legend = [*_key(groups), PlotLine(label="force", width=0.9)]
    legend.append(PlotLine(label="pressure rise", tone=MUTED, width=0.9, dashes=LINES[1]))

    def draw(group: ResinGroups) -> Panel:
        runs = [(b, curve) for b in group.comparisons for curve in some(b.group.of_kind("relaxation"))]
        lines = [line for b, curve in runs for line in _relaxation(curve, _spots(group, b, curve))]
        across, up = "time in the hold  (s)", f"share of the value at {FIRST:g} s  (%)"
        return Panel(across, up, tuple(lines), log="x")

    relaxed = [
        g for g in groups if any(c.relaxation is not None for b in g.comparisons for c in b.group.of_kind("relaxation"))
    ]
    return _plot(relaxed, "Relaxation", words, draw, legend, "xy")


def _relaxation(curve: MeasuredCurve, look: PlotLine) -> list[PlotLine]:
    """Mean force and rise in a hold over equal steps of log time, % of the first; [] if none is past `FIRST`."""
    if curve.relaxation is None:
        return []
    time, *channels = curve.relaxation
    if time.size == 0 or time[-1] <= FIRST:
        return []
    edges = np.geomspace(FIRST, time[-1], max(int(_PER_DECADE * np.log10(time[-1] / FIRST)), 2) + 1)
    later = time >= FIRST
    which = np.digitize(time[later], edges[1:-1])
    count = np.bincount(which)
    seconds, *means = (
        np.bincount(which, weights=part[later])[count > 0] / count[count > 0] for part in (time, *channels)
    )
    return [
        replace(look, x=seconds, y=100 * values / values[0], dashes=dashes, tone=tone, width=0.7, every=3)
        for values, tone, dashes in zip(means, (INK, MUTED), LINES, strict=False)
    ]


def ageings(measured: CampaignReport) -> Plot | None:
    """Plot of the change of sensitivity between ages with intervals, and the paper's change in a year; or None."""
    rows = measured.ageing
    if not rows:
        return None
    words = "Change of the sensitivity since fresh, in percent of the aged one, with its 95 % interval."
    known = [(k, row.low, row.high) for k, row in enumerate(rows) if row.low is not None and row.high is not None]
    papers = [(row.published_change_one_year_percent, k) for k, row in enumerate(rows)]
    papers = [(side * x, k) for x, k in papers if x is not None for side in (-1, 1)]
    lines = [PlotLine((low, high), (k, k), width=0.9, marker="|", size=4) for k, low, high in known]
    point = PlotLine(dashes="", marker="o", size=3.6, filled=True, label="measured")
    lines.append(replace(point, x=[row.sensitivity_change_percent for row in rows], y=range(len(rows))))
    if papers:
        x, y = zip(*papers, strict=True)
        lines.append(PlotLine(x, y, "paper, one year (sign not given)", dashes="", marker=MARKERS[3], size=4.2))
    names = tuple(f"{row.resin}, {row.driving_pressure_kPa:g} kPa, {row.age}" for row in rows)
    panel = Panel("change of sensitivity  (%)", "", tuple(lines), zero="x", rows=names)
    return Plot(drawn_svg(Chart((panel,), (SIZE[0], 22 + 5.2 * len(rows)), keys=2)), words)
