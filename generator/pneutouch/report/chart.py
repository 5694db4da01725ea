"""A chart as a record, and the one function that draws it: curves, points, bands and notes in one or more panels."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.report.style import (
    BOLD,
    FAINT,
    INK,
    LINES,
    MUTED,
    band,
    figure,
    label_ends,
    legend_above,
    note,
    plain_ticks,
    svg,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIZE = (86.0, 62.0)
"""Width and height of a chart in mm: two in a row on A4, and readable on a phone."""

WIDE = 180.0
"""Width of a chart over the whole row of A4, mm."""

Values = Array | Sequence[float]
AxisEnds = tuple[float | None, float | None]


@dataclass(frozen=True)
class PlotLine:
    """A curve or a set of points, ``x`` and ``y`` (n,); without points it is only an entry of the legend.

    ``label`` stands in the legend, ``end`` right of the axes at the last point. A line
    without ``dashes`` is only points, every ``every``-th marked; a ``picked`` one is what the chart is about. ``low``
    and ``high`` bound its band, plain or with hatch number ``hatch``; ``over`` is its drawing order.
    """

    x: Values = ()
    y: Values = ()
    label: str = ""
    end: str = ""
    tone: str = INK
    dashes: Any = LINES[0]
    width: float = 1.2
    marker: str = ""
    size: float = 3.2
    filled: bool = False
    every: int = 1
    picked: bool = False
    low: Values | None = None
    high: Values | None = None
    hatch: int | None = None
    over: float = 3.0


@dataclass(frozen=True)
class Note:
    """A small text near the data point ``at``, preferably on its ``side``, a direction (right, up)."""

    text: str
    at: tuple[float, float]
    side: tuple[float, float] = (0.0, 1.0)
    tone: str = INK
    bold: bool = False


@dataclass(frozen=True)
class Span:
    """A shaded or hatched stretch of one axis from ``low`` to ``high``, over the full length of the other axis."""

    low: float
    high: float
    axis: str = "x"
    tone: str = FAINT
    hatched: bool = False
    label: str = ""


@dataclass(frozen=True)
class Panel:
    """One pair of axes; ``x`` and ``y`` are their titles, with units. An end None in ``xlim`` or ``ylim`` is automatic.

    ``log`` and ``zero`` name the axes that are logarithmic or have a line at zero. ``rows`` (from above) and
    ``columns`` are names that stand at 0, 1, 2, ... in place of numbers, ``ticks`` the only numbers of the horizontal
    axis. ``equal``: both axes have one scale.
    """

    x: str = ""
    y: str = ""
    lines: tuple[PlotLine, ...] = ()
    notes: tuple[Note, ...] = ()
    title: str = ""
    xlim: AxisEnds | None = None
    ylim: AxisEnds | None = None
    log: str = ""
    zero: str = ""
    rows: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()
    ticks: tuple[float, ...] = ()
    spans: tuple[Span, ...] = ()
    equal: bool = False


@dataclass(frozen=True)
class Chart:
    """Panels in rows of ``across``; ``x`` and ``y`` are titles for all, axes named in ``shared`` have common limits.

    ``size`` is in mm, ``heights`` are relative heights of the rows (None: equal); the legend has ``keys`` columns.
    """

    panels: tuple[Panel, ...]
    size: tuple[float, float] = SIZE
    across: int = 1
    x: str = ""
    y: str = ""
    shared: str = ""
    heights: tuple[float, ...] | None = None
    keys: int = 4
    legend: str = ""


def drawn_svg(chart: Chart | Panel) -> str:
    """A chart as SVG; a panel alone is drawn as a chart of the default size."""
    with chart_figure(Chart((chart,)) if isinstance(chart, Panel) else chart) as drawn:
        return svg(drawn)


@contextmanager
def chart_figure(chart: Chart) -> "Iterator[Figure]":
    """The chart as a matplotlib figure, to be saved inside the ``with`` block."""
    down, count = -(-len(chart.panels) // chart.across), len(chart.panels)
    shared: dict[str, Any] = {f"share{axis}": True for axis in chart.shared}
    with figure(*chart.size) as drawn:
        axes = list(drawn.subplots(down, chart.across, squeeze=False, height_ratios=chart.heights, **shared).flat)
        for ax in axes[count:]:
            ax.remove()
        for ax, panel in zip(axes[:count], chart.panels, strict=True):
            draw_panel(ax, panel)
        if chart.x or chart.y:
            drawn.supxlabel(chart.x, fontsize=7.5)
            drawn.supylabel(chart.y, fontsize=7.5)
        drawn.align_ylabels(axes[:count])
        legend_above(*axes[:count], columns=chart.keys, title=chart.legend)
        yield drawn


def draw_panel(ax: "Axes", panel: Panel) -> None:
    """Draw a panel into axes; its legend is left to the caller."""
    for span in panel.spans:
        _shade(ax, span)
    for axis in panel.zero:
        (ax.axvline if axis == "x" else ax.axhline)(0.0, color=INK, lw=0.6, zorder=1)
    for axis in panel.log:
        (ax.set_xscale if axis == "x" else ax.set_yscale)("log")
    for line in panel.lines:
        _draw(ax, line)
    if panel.equal:
        ax.set_aspect("equal")
    ax.set(xlabel=panel.x, ylabel=panel.y)
    if panel.xlim is not None:
        ax.set_xlim(*panel.xlim)
    if panel.ylim is not None:
        ax.set_ylim(*panel.ylim)
    _ticks(ax, panel)
    if panel.title:
        ax.set_title(plain_text(panel.title), fontsize=7.5, loc="left", pad=3)
    if ended := [line for line in panel.lines if line.end and len(line.x)]:
        looks = [{"color": INK, **BOLD} if line.picked else {"color": MUTED} for line in ended]
        ends = zip(ended, looks, strict=True)
        label_ends(ax, [(float(line.x[-1]), float(line.y[-1]), plain_text(line.end), look) for line, look in ends])
    for one in panel.notes:
        note(ax, plain_text(one.text), one.at, one.side, color=one.tone, **(BOLD if one.bold else {}))


def _draw(ax: "Axes", one: PlotLine) -> None:
    """Draw a curve with its band."""
    label = plain_text(one.label) or None
    if one.low is not None and one.high is not None:
        if one.hatch is not None:
            x, low, high = map(np.asarray, (one.x, one.low, one.high))
            band(ax, x, low, high, one.hatch, one.tone, label)
        else:
            alone = None if one.dashes or one.marker else label
            look: dict[str, Any] = {"fc": FAINT, "alpha": 0.55, "ec": "none", "zorder": 1, "label": alone}
            ax.fill_between(one.x, one.low, one.high, **look)
            for edge in (one.low, one.high):
                ax.plot(one.x, edge, color=MUTED, lw=0.5, zorder=1.5)
    if one.dashes or one.marker:
        points: dict[str, Any] = {
            "marker": one.marker or None,
            "ms": one.size,
            "mec": one.tone,
            "mew": 0.8,
            "markevery": one.every,
        }
        (drawn,) = ax.plot(
            one.x,
            one.y,
            color=one.tone,
            ls=one.dashes,
            lw=one.width,
            mfc=one.tone if one.filled else "white",
            zorder=one.over,
            # A point on the rim of the axes is whole.
            clip_on=bool(one.dashes),
            solid_capstyle="butt",
            label=label,
            **points,
        )
        # An entry of the legend has no place that a layout may care for.
        drawn.set_in_layout(len(one.x) > 0)


def _shade(ax: "Axes", span: Span) -> None:
    draw = ax.axvspan if span.axis == "x" else ax.axhspan
    look: dict[str, Any] = {"color": span.tone, "alpha": 0.35, "lw": 0}
    if span.hatched:
        look = {"facecolor": "none", "edgecolor": span.tone, "hatch": "////", "lw": 0.3}
    draw(span.low, span.high, label=span.label or None, zorder=0.5, **look)


def _ticks(ax: "Axes", panel: Panel) -> None:
    """Set the numbers or names along the axes."""
    if panel.ticks:
        ax.set_xticks(panel.ticks)
    for axis in panel.log:
        plain_ticks(ax.xaxis if axis == "x" else ax.yaxis)
    if panel.rows:
        ax.set_yticks(range(len(panel.rows)), list(map(plain_text, panel.rows)))
        ax.set_ylim(len(panel.rows) - 0.5, -0.5)
        ax.grid(visible=False, axis="y")
    if panel.columns:
        ax.set_xticks(range(len(panel.columns)), list(map(plain_text, panel.columns)))
        ax.tick_params(axis="x", labelrotation=30 if len(panel.columns) > 4 else 0)


def plain_text(text: str) -> str:
    """Text escaped so that matplotlib sees no formula in it."""
    return text.replace("$", r"\$")


def bars_between(x: Iterable[float], low: Iterable[float], high: Iterable[float], look: PlotLine) -> list[PlotLine]:
    """Upright bars in the style ``look`` from ``low`` to ``high`` at places ``x``: intervals of single points."""
    return [replace(look, x=(at, at), y=(a, b)) for at, a, b in zip(x, low, high, strict=True)]
