"""The sheet of a comparison: what differs, figures with intervals, overlaid curves and sections.

Sensors differ by line style and marker, so that they can be told apart in grayscale.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from pneutouch.body.section import section_outline
from pneutouch.parts import Assembly
from pneutouch.report import comparison_words as words
from pneutouch.report.blocks import (
    Cell,
    FramedBlocks,
    Heading,
    Items,
    Plot,
    Plots,
    Sheet,
    SheetBlock,
    SheetTable,
    Text,
    section,
)
from pneutouch.report.chart import SIZE, Chart, Panel, PlotLine, drawn_svg
from pneutouch.report.curves import BandEnds, Press, forces, rises
from pneutouch.report.pages import set_sheet
from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, MUTED
from pneutouch.report.swept import spread_places
from pneutouch.results.comparison import ComparedCurve, ComparisonRecord, DifferenceRecord, RowRecord
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from pneutouch.wording import enumerated

MOST = 6
"""Greatest number of sensors drawn: more would cover one another."""

_SHORT, _CUT = 16, 44
"""Greatest number of letters of a name that fits into half the width of a legend, and into all of it."""

_TONES = (INK, "#3F8FBF", "#B4631D", MUTED, ACCENT, "#8C8C8C")
_RUNS, _TOLERANCE, _TALLEST = 30, 5e-3, 1.6


def comparison_sheet(comparison: ComparisonRecord, parts: Mapping[str, Assembly]) -> dict[str, bytes]:
    """``comparison.html`` and ``comparison.pdf``; ``parts`` are the assemblies by label. Same input, same bytes."""
    return set_sheet(described(comparison, parts), "comparison")


def described(comparison: ComparisonRecord, parts: Mapping[str, Assembly]) -> Sheet:
    """The sheet with its plots drawn; ``parts`` are the assemblies by label."""
    labels, tool = words.labels(comparison), f"pneutouch {comparison.pneutouch}"
    title = enumerated(labels)
    compared = [[one.label, _KINDS[one.kind], one.source or "–"] for one in comparison.compared]
    inputs = SheetTable(words.input_rows(comparison), ("Input", *labels))
    return Sheet(
        title=title,
        subtitle="Comparison",
        name=f"{title} – comparison",
        facts=(("Made by", tool),),
        tool=tool,
        foot=tool,
        blocks=(
            *(Text(line, "status") for line in words.marks(comparison)),
            FramedBlocks(
                "", [*(Text(line, "strong") for line in words.summary(comparison)), Text(comparison.criterion, "muted")]
            ),
            *section("What is compared", SheetTable(compared, ("Name", "Kind", "From"))),
            *section("Inputs that differ", inputs if inputs.rows else Text("None that is known.", "muted")),
            Heading("Figures"),
            *(block for p in words.pressures(comparison) for block in _figures(comparison, p)),
            *_plots(comparison, parts),
            *section("What is assumed", Items(comparison.notes)),
        ),
    )


_KINDS = {"design": "design, predicted", "build": "build, as predicted when it was built", "measured": "measured"}


def _figures(comparison: ComparisonRecord, pressure_kPa: float | None) -> list[SheetBlock]:
    """Table of the figures at one driving pressure, or, for None, of those of the whole sensor."""
    labels, title = words.labels(comparison), words.heading(pressure_kPa)
    head = ("Figure", *labels, *(f"{label}, difference" for label in labels[1:]))
    rows = [_row(row) for row in comparison.figures if row.driving_pressure_kPa == pressure_kPa]
    return section(title[0].upper() + title[1:], SheetTable(rows, head, dense=len(labels) > 3), level=3)


def _row(row: RowRecord) -> list[str | Cell]:
    values = [Cell(value, interval) for value, interval in words.figure_cells(row)]
    differences = [
        Cell(percent if word == percent else f"{percent}, {word}", interval, strong=word == "exceeds")
        for percent, interval, word in words.difference_cells(row)
    ]
    return [words.figure_name(row), *values, *differences]


def _plots(comparison: ComparisonRecord, parts: Mapping[str, Assembly]) -> list[SheetBlock]:
    """Sections with the plots; those without data are left out."""
    many = f" The first {MOST} are drawn." if len(comparison.compared) > MOST else ""
    apart = (
        f"From {words.labels(comparison)[0]}, with their intervals (k = 2). Filled: the difference is greater than its "
        "uncertainty; open: it does not."
    )
    lines = "Lines: predicted, with the interval of the {}; markers: measured."
    rising = f"Pressure rise over contact force up to the range's end, by driving pressure. {lines}"
    cut = "Through the axis, laid over one another; the dome's base plane is z = 0."
    drawn = (
        ("Differences", apart, differences(comparison)),
        ("Response", rising.format("sensitivity"), presses(comparison, rises)),
        ("Force over indentation", f"By driving pressure. {lines}".format("stiffness"), presses(comparison, forces)),
        ("Sections", cut, sections(comparison, parts)),
    )
    return [
        block
        for title, said, plots in drawn
        for block in section(title, Plots([Plot(svg, title=name) for name, svg in plots], caption=said + many))
    ]


def _look(k: int) -> PlotLine:
    return PlotLine(tone=_TONES[k % len(_TONES)], dashes=LINES[k % len(LINES)], hatch=k)


def _spots(k: int) -> PlotLine:
    marker, tone = MARKERS[k % len(MARKERS)], _TONES[k % len(_TONES)]
    return PlotLine(tone=tone, dashes="", marker=marker, size=2.8, over=4)


def _drawn(panel: Panel, height: float, looks: Sequence[PlotLine], names: Sequence[str]) -> str:
    """SVG of a panel ``height`` mm high with the legend of the sensors, long names cut, above it."""
    entries = [
        replace(look, label=name if len(name) <= _CUT else f"{name[: _CUT - 1]}…")
        for look, name in zip(looks, names, strict=True)
    ]
    keys = 2 if max(map(len, names), default=0) <= _SHORT else 1
    high = height + 4 * math.ceil(len(names) / keys)
    return drawn_svg(Chart((replace(panel, lines=(*panel.lines, *entries)),), (SIZE[0], high), keys=keys))


def presses(comparison: ComparisonRecord, draw: Callable[[Sequence[Press]], Panel]) -> list[tuple[str, str]]:
    """Title and SVG at up to four driving pressures, with equal axes; ``draw``: `rises` or `forces`; [] for none."""
    names = words.labels(comparison)[:MOST]
    measured = [one.kind == "measured" for one in comparison.compared]
    looks = [_spots(k) if measured[k] else _look(k) for k in range(len(names))]
    every = [_press(one, PlotLine()) for one in comparison.curves if one.label in names]
    lines = [line for line in draw(every).lines if len(line.x)]
    right, high = (max((float(np.max(getattr(line, key))) for line in lines), default=0.0) for key in ("x", "y"))
    if not right or not high:
        return []
    top = _top(comparison, SENSITIVITY_KEY if draw is rises else STIFFNESS_KEY) * high
    plots = []
    for place in spread_places(len(comparison.driving_pressures_kPa)):
        pressure_kPa = float(comparison.driving_pressures_kPa[place])
        shown = [one for k in range(len(names)) for one in _presses(comparison, k, pressure_kPa)]
        panel = replace(draw(shown), xlim=(0, 1.04 * right), ylim=(0, top))
        plots.append((f"{pressure_kPa:g} kPa", _drawn(panel, 56, looks, names)))
    return plots


def _press(curve: ComparedCurve, look: PlotLine, *bands: BandEnds | None) -> Press:
    depth, force, rise_kPa = map(np.array, (curve.indentation_mm, curve.contact_force_N, curve.pressure_rise_kPa))
    return Press(depth, force, rise_kPa, look, *bands)


def _presses(comparison: ComparisonRecord, k: int, pressure_kPa: float) -> list[Press]:
    """Curves of sensor ``k`` at a driving pressure: the predicted one with bands, or points of measured runs."""
    name = words.labels(comparison)[k]
    matching = [c for c in comparison.curves if c.label == name and c.driving_pressure_kPa == pressure_kPa]
    bands = [_ends(comparison, key, k, pressure_kPa) for key in (SENSITIVITY_KEY, STIFFNESS_KEY)]
    return [
        _press(one, _spots(k)) if one.measured else _press(one, _look(k), *bands)
        for one in matching[:: math.ceil(len(matching) / _RUNS) or 1]
    ]


def _top(comparison: ComparisonRecord, key: str) -> float:
    """Axis end over the greatest value: room for the bands, at most `_TALLEST` so that the curves stay legible."""
    shown = [(k, row.driving_pressure_kPa) for row in comparison.figures for k in range(len(row.values[:MOST]))]
    ratios = [matching[1] for k, p in shown if (matching := _ends(comparison, key, k, p)) is not None]
    return min(1.05 * max(ratios, default=1.0), _TALLEST)


def _ends(comparison: ComparisonRecord, key: str, k: int, pressure_kPa: float | None) -> BandEnds | None:
    """Ends of the interval of figure ``key`` of sensor ``k``, divided by its value; None if they are not known."""
    for row in comparison.figures:
        if row.figure == key and row.driving_pressure_kPa == pressure_kPa:
            one = row.values[k]
            if one is not None and one.low is not None and one.value and one.high is not None:
                return one.low / one.value, one.high / one.value
    return None


def differences(comparison: ComparisonRecord) -> list[tuple[str, str]]:
    """Untitled SVG of differences from the first sensor, %; filled: more than their uncertainty; [] for none."""
    rows = []
    for row in comparison.figures:
        at = "" if row.driving_pressure_kPa is None else f" {words.heading(row.driving_pressure_kPa)}"
        spans = enumerate(map(_span, row.differences[: MOST - 1]))
        rows += [(f"{row.name}{at}", k, span) for k, span in spans if span is not None]
    if not rows:
        return []
    names = list(dict.fromkeys(name for name, *_ in rows))
    # The caption names the first sensor: its name may be longer than the axis.
    others = words.labels(comparison)[1:MOST]
    several = len(others) > 1
    looks = [
        PlotLine(tone=_TONES[k + 1] if several else INK, marker=MARKERS[k % len(MARKERS)], size=4.4, width=1.0)
        for k in range(len(others))
    ]
    lines = []
    for name, k, (low, percent, high, exceeds) in rows:
        place = names.index(name) + 0.22 * (k - 0.5 * (len(others) - 1))
        lines.append(replace(looks[k], x=(low, high), y=(place, place), marker="|", size=4))
        lines.append(replace(looks[k], x=(percent,), y=(place,), dashes="", filled=exceeds, over=4))
    panel = Panel("difference  (%)", "", tuple(lines), zero="x", rows=tuple(names))
    legend = (looks, others) if several else ((), ())
    return [("", _drawn(panel, 14 + 4.2 * len(names), *legend))]


def _span(one: DifferenceRecord | None) -> tuple[float, float, float, bool] | None:
    """Lower end, value and upper end in percent, and True if the difference exceeds its uncertainty; None if the
    interval is unknown or has no width."""
    if one is None or one.low_percent is None or one.percent is None or one.high_percent is None:
        return None
    low, percent, high = one.low_percent, one.percent, one.high_percent
    return (low, percent, high, bool(one.exceeds)) if high > low else None


def sections(comparison: ComparisonRecord, parts: Mapping[str, Assembly]) -> list[tuple[str, str]]:
    """Untitled SVG of the section outlines of all sensors in ``parts``, base planes at one height; [] for none."""
    names = words.labels(comparison)[:MOST]
    shown = [k for k, name in enumerate(names) if name in parts]
    if not shown:
        return []
    lines = [
        replace(_look(k), x=(*loop[:, 0], loop[0, 0]), y=(*loop[:, 1], loop[0, 1]), width=0.9)
        for k in shown
        for solid in parts[names[k]].solids
        for loop in section_outline(solid, _TOLERANCE)
    ]
    panel = Panel("x  (mm)", "z  (mm)", tuple(lines), equal=True)
    return [("", _drawn(panel, 62, [_look(k) for k in shown], [names[k] for k in shown]))]
