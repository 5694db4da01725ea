"""The sheet of a comparison: what differs, figures with intervals, overlaid curves and sections.

The comparison as one HTML page and one PDF from the same content and the same figures.

The pictures of a comparison: curves with their bands, differences with their intervals, and sections laid over one
another. Sensors differ by line and marker, and stay apart in grayscale.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.body.section import section_outline
from pneutouch.parts import Assembly
from pneutouch.report import comparison_words, pages
from pneutouch.report.comparison_words import labels
from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, MUTED, band, figure, svg
from pneutouch.results.comparison import ComparedCurve, ComparisonRecord, DifferenceRecord, RowRecord
from pneutouch.results.record import plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


WIDTH = 86.0
"""Width in mm: two in a row on A4, and readable on a phone."""

MOST = 6
"""Sensors that are drawn: more cover one another."""

_SHORT = 16
"""Letters of a name that fits into half the width of a legend."""

_TONES = (INK, "#3F8FBF", "#B4631D", MUTED, ACCENT, "#8C8C8C")
_PANELS, _RUNS, _TOLERANCE, _TALLEST = 4, 30, 5e-3, 1.6


def _look(k: int) -> dict[str, Any]:
    return {"color": _TONES[k % len(_TONES)], "ls": LINES[k % len(LINES)], "lw": 1.2}


def _spots(k: int) -> dict[str, Any]:
    tone = _TONES[k % len(_TONES)]
    return {"ls": "", "marker": MARKERS[k % len(MARKERS)], "ms": 2.8, "mew": 0.6, "mec": tone, "mfc": "white"}


def responses(comparison: ComparisonRecord) -> dict[str, str]:
    """Pressure rise over contact force with the band of the sensitivity, a plot a driving pressure."""
    axes: tuple[str, str] = ("contact_force_N", "pressure_rise_kPa")
    words = "contact force  (N)", "pressure rise  (kPa)"
    return _curves(comparison, axes, words, "sensitivity_kPa_per_N")


def indentations(comparison: ComparisonRecord) -> dict[str, str]:
    """Contact force over indentation in the same way; the band is that of the stiffness."""
    axes: tuple[str, str] = ("indentation_mm", "contact_force_N")
    words = "indentation  (mm)", "contact force  (N)"
    return _curves(comparison, axes, words, "stiffness_N_per_mm")


def _curves(comparison: ComparisonRecord, keys: tuple[str, str], words: tuple[str, str], band: str) -> dict[str, str]:
    """A plot a driving pressure, by its title; all have the same axes."""
    names, plots = labels(comparison)[:MOST], {}
    ends = [max((max(getattr(c, key)) for c in comparison.curves if c.label in names), default=0.0) for key in keys]
    if not all(ends):
        return {}
    for pressure_kPa in _spread([float(p) for p in comparison.driving_pressures_kPa]):
        with figure(WIDTH, 56 + 4 * _key_lines(names)) as drawn:
            ax = drawn.subplots()
            for k, name in enumerate(names):
                _draw(ax, k, _of(comparison, name, pressure_kPa), keys, _ends(comparison, band, k, pressure_kPa))
            ax.set(
                xlabel=words[0], ylabel=words[1], xlim=(0, 1.04 * ends[0]), ylim=(0, _top(comparison, band) * ends[1])
            )
            _legend(drawn, comparison, names)
            plots[f"{pressure_kPa:g} kPa"] = svg(drawn)
    return plots


def _top(comparison: ComparisonRecord, band: str) -> float:
    """Height of the axis over the greatest value: space for the bands, as far as they do not flatten the curves."""
    shown = [(k, row.driving_pressure_kPa) for row in comparison.figures for k in range(len(row.values[:MOST]))]
    ratios = [matching[1] for k, p in shown if (matching := _ends(comparison, band, k, p)) is not None]
    return min(1.05 * max(ratios, default=1.0), _TALLEST)


def _spread(values: Sequence[float]) -> list[float]:
    """All of them where they are few, else some spread evenly over all."""
    if len(values) <= _PANELS:
        return list(values)
    return [values[round(k * (len(values) - 1) / (_PANELS - 1))] for k in range(_PANELS)]


def _of(comparison: ComparisonRecord, label: str, pressure_kPa: float) -> list[ComparedCurve]:
    matching = [c for c in comparison.curves if c.label == label and c.driving_pressure_kPa == pressure_kPa]
    return matching[:: math.ceil(len(matching) / _RUNS) or 1]


def _ends(comparison: ComparisonRecord, key: str, k: int, pressure_kPa: float | None) -> tuple[float, float] | None:
    """Ends of a figure's interval over its value."""
    for row in comparison.figures:
        if row.figure == key and row.driving_pressure_kPa == pressure_kPa:
            one = row.values[k]
            if one is not None and one.low is not None and one.value and one.high is not None:
                return one.low / one.value, one.high / one.value
    return None


def _draw(
    ax: Axes, k: int, curves: Sequence[ComparedCurve], keys: tuple[str, str], ends: tuple[float, float] | None
) -> None:
    """One predicted curve with its band, or the points of measured runs."""
    for curve in curves:
        x, y = (np.array(getattr(curve, key)) for key in keys)
        if curve.measured:
            ax.plot(x, y, zorder=4, **_spots(k))
            continue
        ax.plot(x, y, zorder=3, **_look(k))
        if ends is not None:
            band(ax, x, ends[0] * y, ends[1] * y, k, _TONES[k % len(_TONES)])


def _legend(drawn: Figure, comparison: ComparisonRecord, names: Sequence[str]) -> None:
    from matplotlib.lines import Line2D

    measured = [one.kind == "measured" for one in comparison.compared]
    handles = [Line2D([], [], **(_spots(k) if measured[k] else _look(k))) for k in range(len(names))]
    texts = [_cut(name) for name in names]
    drawn.legend(handles, texts, loc="outside upper left", ncols=_key_columns(names), handlelength=2.6)


def _key_columns(names: Sequence[str]) -> int:
    """Columns of a legend: one where a name would not fit into half the width."""
    return 2 if max(map(len, names), default=0) <= _SHORT else 1


def _key_lines(names: Sequence[str]) -> int:
    return math.ceil(len(names) / _key_columns(names))


def _cut(text: str, most: int = 44) -> str:
    escaped = text.replace("$", r"\$")
    return escaped if len(text) <= most else f"{escaped[: most - 1]}…"


def differences(comparison: ComparisonRecord) -> str | None:
    """Differences from the first sensor in percent with their intervals; filled where they exceed them."""
    rows = [
        (f"{row.name}{_at(row)}", span, one.exceeds, k)
        for row in comparison.figures
        for k, one in enumerate(row.differences[: MOST - 1])
        if one is not None and (span := _span(one)) is not None
    ]
    if not rows:
        return None
    names = list(dict.fromkeys(name for name, *_ in rows))
    others = labels(comparison)[1:MOST]
    with figure(WIDTH, 14 + 4.2 * len(names) + 4 * _key_lines(others) * (len(others) > 1)) as drawn:
        ax = drawn.subplots()
        for name, (low, percent, high), exceeds, k in rows:
            place = names.index(name) + 0.22 * (k - 0.5 * (len(others) - 1))
            tone = _TONES[(k + 1) % len(_TONES)] if len(others) > 1 else INK
            ax.plot([low, high], [place, place], color=tone, lw=1.0, marker="|", ms=4)
            marker = MARKERS[k % len(MARKERS)]
            face = tone if exceeds else "white"
            ax.plot(percent, place, ls="", marker=marker, ms=4.4, mec=tone, mfc=face, zorder=4)
        ax.axvline(0, color=INK, lw=0.8)
        ax.set_yticks(range(len(names)), names)
        # The caption names the first sensor: its name may be longer than the axis.
        ax.set(xlabel="difference  (%)", ylim=(len(names) - 0.5, -0.5))
        ax.grid(visible=False, axis="y")
        if len(others) > 1:
            _key(drawn, others)
        return svg(drawn)


def _span(one: DifferenceRecord) -> tuple[float, float, float] | None:
    """Lower end, value and upper end of a difference in percent; None without an interval or with one of no width."""
    low, percent, high = one.low_percent, one.percent, one.high_percent
    return None if low is None or percent is None or high is None or high <= low else (low, percent, high)


def _at(row: RowRecord) -> str:
    return "" if row.driving_pressure_kPa is None else f" at {row.driving_pressure_kPa:g} kPa"


def _key(drawn: Figure, others: Sequence[str]) -> None:
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color=_TONES[k + 1], marker=MARKERS[k % len(MARKERS)], ms=4, lw=1.0) for k in range(len(others))
    ]
    drawn.legend(handles, [_cut(name) for name in others], loc="outside upper left", ncols=_key_columns(others))


def sections(comparison: ComparisonRecord, parts: Mapping[str, Assembly]) -> str | None:
    """Outlines of the sections of all sensors on one another, their domes' base planes at one height."""
    names = [name for name in labels(comparison)[:MOST] if name in parts]
    if not names:
        return None
    from matplotlib.lines import Line2D

    with figure(WIDTH, 62 + 4 * _key_lines(names)) as drawn:
        ax = drawn.subplots()
        for name in names:
            look = _look(labels(comparison).index(name))
            for solid in parts[name].solids:
                for loop in section_outline(solid, _TOLERANCE):
                    closed = np.vstack([loop, loop[:1]])
                    ax.plot(closed[:, 0], closed[:, 1], **{**look, "lw": 0.9})
        ax.set(aspect="equal", xlabel="x  (mm)", ylabel="z  (mm)")
        handles = [Line2D([], [], **_look(labels(comparison).index(name))) for name in names]
        texts = [_cut(name) for name in names]
        drawn.legend(handles, texts, loc="outside upper left", ncols=_key_columns(names), handlelength=2.6)
        return svg(drawn)


_KINDS = {"design": "design, predicted", "build": "build, as predicted when it was built", "measured": "measured"}

_MANY = f"The first {MOST} are drawn."


def comparison_sheet(comparison: ComparisonRecord, parts: Mapping[str, Assembly]) -> dict[str, bytes]:
    """``comparison.html`` and ``comparison.pdf``; ``parts`` are the assemblies by label. Same input, same bytes."""
    groups = _pictures(comparison, parts)
    names = {picture: f"figure-{k}" for k, picture in enumerate(p for _, _, drawn in groups for p in drawn.values())}
    labels = comparison_words.labels(comparison)
    content = {
        "title": " and ".join([", ".join(labels[:-1]), labels[-1]]),
        "tool": f"pneutouch {comparison.pneutouch}",
        "labels": labels,
        "compared": [[one.label, _KINDS[one.kind], one.source or "–"] for one in comparison.compared],
        "marks": comparison_words.marks(comparison),
        "summary": comparison_words.summary(comparison),
        "inputs": comparison_words.input_rows(comparison),
        "groups": [
            {
                "title": comparison_words.heading(p),
                "rows": [_row(row) for row in comparison.figures if row.driving_pressure_kPa == p],
            }
            for p in comparison_words.pressures(comparison)
        ],
        "criterion": comparison.criterion,
        "notes": comparison.notes,
        "figures": [
            {
                "title": title,
                "caption": caption,
                "plots": [{"name": names[picture], "title": head} for head, picture in drawn.items()],
            }
            for title, caption, drawn in groups
            if drawn
        ],
    }
    pictures = {name: picture for picture, name in names.items()}
    return {
        "comparison.html": pages.html("compare.html.j2", content, pictures).encode(),
        "comparison.pdf": pages.pdf("compare.typ", plain(content), pictures),
    }


@dataclass(frozen=True, slots=True)
class _FigureCells:
    """Cells of a row of figures."""

    name: str
    values: list[tuple[str, str]]
    differences: list[tuple[str, str, str]]


def _row(row: RowRecord) -> _FigureCells:
    cells = comparison_words.figure_cells(row), comparison_words.difference_cells(row)
    return _FigureCells(comparison_words.figure_name(row), *cells)


def _pictures(comparison: ComparisonRecord, parts: Mapping[str, Assembly]) -> list[tuple[str, str, dict[str, str]]]:
    """Title, caption, and the plots by their own titles."""
    many = f" {_MANY}" if len(comparison.compared) > MOST else ""
    apart, cut = differences(comparison), sections(comparison, parts)
    return [
        (
            "Differences",
            f"From {comparison_words.labels(comparison)[0]}, with their intervals (k = 2). Filled: the difference is "
            f"greater than its uncertainty; open: it does not.{many}",
            {} if apart is None else {"": apart},
        ),
        (
            "Response",
            "Pressure rise over contact force up to the range's end, by driving pressure. Lines: predicted, with the "
            f"interval of the sensitivity; markers: measured.{many}",
            responses(comparison),
        ),
        (
            "Force over indentation",
            "By driving pressure. Lines: predicted, with the interval of the stiffness; markers: measured." + many,
            indentations(comparison),
        ),
        (
            "Sections",
            f"Through the axis, laid over one another; the dome's base plane is z = 0.{many}",
            {} if cut is None else {"": cut},
        ),
    ]
