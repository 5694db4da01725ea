"""The pictures of a sweep: a figure over each swept parameter, lines with bands, and a map over two."""

from __future__ import annotations

import io
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.report.chart import WIDE, Chart, Panel, PlotLine, bars_between, chart_figure, plain_text
from pneutouch.report.style import HATCHES, INK, LINES, MARKERS, MUTED, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patches import PathPatch
    from matplotlib.transforms import Bbox

_LINES, _PANELS = 6, 4
_TONES = (INK, "#3F8FBF", "#B4631D", MUTED, "#0B5C8A", "#9A9A9A")
_RATIOS = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)
_OUTSIDE, _MOST_TEXTS = "#EFEFEF", 120
_MOST_PATHS, _DPI = 5000, 200
"""Most cells of a map that are paths in an SVG, and the resolution of more: 50,000 paths take 7 MB."""


@dataclass(frozen=True)
class SweptAxis:
    """A swept parameter: key, name in words, unit, and values, which are numbers or names."""

    key: str
    words: str
    unit: str
    values: tuple[Any, ...]

    @property
    def numeric(self) -> bool:
        """True if all values are finite numbers; infinite friction (a surface that grips) has no place on an axis."""
        return all(isinstance(value, int | float) and math.isfinite(value) for value in self.values)

    @property
    def label(self) -> str:
        """Title of an axis: the words, and the unit if there is one."""
        return f"{self.words}  ({self.unit})" if self.unit not in ("", "1") else self.words

    def text(self, place: int) -> str:
        """Value number ``place`` with its unit."""
        value = self.values[place]
        if isinstance(value, str):
            return value
        return f"{value:g}" if self.unit in ("", "1") else f"{value:g} {self.unit}"

    def named(self, place: int) -> str:
        """Value number ``place`` after the parameter's words; a name from a catalogue stands alone."""
        value = self.values[place]
        alone = isinstance(value, str) and value not in ("true", "false")
        return self.text(place) if alone else f"{self.words} {self.text(place)}"


@dataclass(frozen=True)
class SweptFigure:
    """A figure over the axes: ``value``, ``low`` and ``high`` have one dimension per axis; NaN for a missing one."""

    label: str
    axes: tuple[SweptAxis, ...]
    value: Array
    low: Array
    high: Array

    def at(self, order: Sequence[int]) -> SweptFigure:
        """The figure with its axes in the order of the numbers ``order``."""
        axes = tuple(self.axes[k] for k in order)
        return SweptFigure(self.label, axes, *(np.transpose(a, order) for a in self.arrays))

    @property
    def arrays(self) -> tuple[Array, Array, Array]:
        """Value, lower and upper end."""
        return self.value, self.low, self.high


def pictures(swept: SweptFigure) -> dict[str, tuple[str, bytes]]:
    """SVG and PNG by name: ``over-KEY`` for each axis that varies, and ``map`` over the first two of numbers.

    A map is not drawn over driving pressures. Other axes become lines (names first), then panels, then the title only.
    """
    varied = [k for k, axis in enumerate(swept.axes) if len(axis.values) > 1]
    drawn = {f"over-{swept.axes[k].key}": _over(_ordered(swept, [k])) for k in varied}
    numbers = [k for k in varied if swept.axes[k].numeric and swept.axes[k].key != "driving_pressure_kPa"]
    if len(numbers) > 1:
        drawn["map"] = _mapped(_ordered(swept, numbers[:2]))
    return drawn


def _ordered(swept: SweptFigure, first: list[int]) -> SweptFigure:
    """The figure with the axes ``first``, then axes of names, of numbers, and constant ones; at least three in all."""
    others = [k for k in range(len(swept.axes)) if k not in first]
    others.sort(key=lambda k: (len(swept.axes[k].values) == 1, swept.axes[k].numeric))
    swept, none = swept.at([*first, *others]), SweptAxis("", "", "", ("",))
    while len(swept.axes) < 3:
        swept = SweptFigure(swept.label, (*swept.axes, none), *(a[..., None] for a in swept.arrays))
    return swept


def spread_places(count: int, most: int = _PANELS) -> list[int]:
    """At most ``most`` of the numbers 0 to ``count`` - 1, spread evenly over all."""
    return list(range(count)) if count <= most else sorted({round(k * (count - 1) / (most - 1)) for k in range(most)})


def _panels(swept: SweptFigure) -> list[tuple[str, SweptFigure]]:
    """Title, and figure over the first two axes, for values of the third; axes after it are at their middle values."""
    middle = tuple(len(axis.values) // 2 for axis in swept.axes[3:])
    fixed = [axis.named(k) for axis, k in zip(swept.axes[3:], middle, strict=True) if axis.key]
    panels = []
    for place in spread_places(len(swept.axes[2].values)):
        words = [swept.axes[2].named(place)] if swept.axes[2].key else []
        cut: tuple[Any, ...] = (slice(None), slice(None), place, *middle)
        arrays = (a[cut] for a in swept.arrays)
        panels.append((", ".join([*words, *fixed]), SweptFigure(swept.label, swept.axes[:2], *arrays)))
    return panels


def _size(count: int) -> tuple[float, float]:
    across = min(count, 2)
    return (WIDE if across > 1 else 0.62 * WIDE), 66 * math.ceil(count / across) + 8


def _over(swept: SweptFigure) -> tuple[str, bytes]:
    """SVG and PNG of lines, or points over names, for values of the second axis that have a figure somewhere."""
    kept = [k for k in range(len(swept.axes[1].values)) if np.isfinite(swept.value[:, k]).any()]
    kept = [kept[k] for k in spread_places(len(kept), _LINES)]
    lines = replace(swept.axes[1], values=tuple(swept.axes[1].values[k] for k in kept))
    swept = SweptFigure(swept.label, (swept.axes[0], lines, *swept.axes[2:]), *(a[:, kept] for a in swept.arrays))
    known = np.concatenate([a[np.isfinite(a)].ravel() for a in swept.arrays])
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
    limits = min(0.0, low), high + 0.05 * (high - low or abs(high) or 1.0)
    panels = [replace(_lines(one), title=title, ylim=limits) for title, one in _panels(swept)]
    across, keys = min(len(panels), 2), 6 if len(panels) > 1 else 3
    with chart_figure(Chart(tuple(panels), _size(len(panels)), across, keys=keys, legend=lines.words)) as drawn:
        return _files(drawn)


def _lines(swept: SweptFigure) -> Panel:
    """Panel with a line, or points over names, for each value of the second axis, with its band."""
    axis, lines = swept.axes
    drawn: list[PlotLine] = []
    for n in range(len(lines.values)):
        look = PlotLine(tone=_TONES[n], marker=MARKERS[n], size=3.0, label=lines.text(n) if lines.key else "", over=4)
        value, low, high = (a[:, n] for a in swept.arrays)
        if axis.numeric:
            x: Array = np.array(axis.values, np.float64)
            drawn.append(replace(look, x=x, y=value, low=low, high=high, hatch=n, dashes=LINES[n % len(LINES)]))
        else:
            aside = 0.12 * (n - (len(lines.values) - 1) / 2)
            places = [k + aside for k in range(len(axis.values))]
            drawn.append(replace(look, x=places, y=value, dashes=""))
            drawn += bars_between(places, low, high, PlotLine(tone=_TONES[n], width=0.9))
    names = () if axis.numeric else tuple(f"{v:g}" if isinstance(v, float) else str(v) for v in axis.values)
    return Panel(axis.label, swept.label, tuple(drawn), columns=names)


def _mapped(swept: SweptFigure) -> tuple[str, bytes]:
    """SVG and PNG of maps over the first two axes, all with the same colour scale."""
    panels = _panels(swept)
    values = np.concatenate([one.value[np.isfinite(one.value)] for _, one in panels])
    span = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    with figure(*_size(len(panels))) as drawn:
        drawn.set_dpi(_DPI)
        axes = _grid(drawn, len(panels))
        for ax, (title, one) in zip(axes, panels, strict=True):
            shown = _map(ax, one, span)
            ax.set_title(plain_text(title), fontsize=7.5, loc="left", pad=4)
        drawn.colorbar(shown, ax=axes, label=swept.label, shrink=0.9)
        return _files(drawn)


def _grid(drawn: Figure, count: int) -> list[Axes]:
    """A list of ``count`` axes in rows of at most two."""
    grid = list(drawn.subplots(math.ceil(count / 2), min(count, 2), squeeze=False).flat)
    for ax in grid[count:]:
        ax.remove()
    return grid[:count]


def _map(ax: Axes, swept: SweptFigure, span: tuple[float, float]) -> Any:
    """Draw coloured cells with their values if they are few; missing ones are gray. Returns them for the colour bar."""
    first, second = swept.axes
    x, y = (np.array(axis.values, float) for axis in (first, second))
    order_x, order_y = np.argsort(x), np.argsort(y)
    cells = swept.value[np.ix_(order_x, order_y)].T
    low, high = span
    ax.set_facecolor(_OUTSIDE)
    scale: dict[str, Any] = {"cmap": "cividis", "vmin": low, "vmax": high, "shading": "nearest"}
    scale["rasterized"] = cells.size > _MOST_PATHS
    shown = ax.pcolormesh(x[order_x], y[order_y], np.ma.masked_invalid(cells), **scale)
    if cells.size <= _MOST_TEXTS:
        for (row, column), cell in np.ndenumerate(cells):
            known = bool(np.isfinite(cell))
            tone = "white" if known and cell < 0.5 * (low + high) else INK
            at = float(x[order_x][column]), float(y[order_y][row])
            ax.text(*at, f"{cell:.3g}" if known else "–", ha="center", va="center", fontsize=6, color=tone)
    ax.grid(visible=False)
    ax.set(xlabel=first.label, ylabel=second.label)
    return shown


@dataclass(frozen=True)
class MapPanel:
    """A figure over both axes of a map, (n, m), NaN where it is missing, and reasons (n, m), "" where it is known."""

    title: str
    value: Array
    reasons: tuple[tuple[str, ...], ...]

    @property
    def heading(self) -> str:
        """Title with the least and the greatest value, or "not predicted"."""
        known = self.value[np.isfinite(self.value)]
        ends = f"{known.min():.3g} to {known.max():.3g}" if known.size else "not predicted"
        return f"{self.title}: {ends}" if self.title else ends


@dataclass(frozen=True)
class SweptMap:
    """A contour map: its caption, its two axes with ascending values, and a panel for each driving pressure."""

    caption: str
    axes: tuple[SweptAxis, SweptAxis]
    panels: tuple[MapPanel, ...]

    @property
    def counts(self) -> dict[str, int]:
        """Number of missing states by reason, greatest first."""
        counted = Counter(word for panel in self.panels for row in panel.reasons for word in row if word)
        return dict(sorted(counted.items(), key=lambda entry: (-entry[1], entry[0])))


def contour_map(swept: SweptMap) -> tuple[str, bytes]:
    """The map as SVG and PNG, with the same contour levels in all panels."""
    counts, known = swept.counts, np.concatenate([p.value[np.isfinite(p.value)] for p in swept.panels])
    levels = contour_levels(known)
    ground = {"facecolor": "white", "edgecolor": MUTED, "linewidth": 0.0}
    looks = {reason: {**ground, "hatch": 2 * HATCHES[min(k, len(HATCHES) - 1)]} for k, reason in enumerate(counts)}
    width, height = _size(len(swept.panels))
    with figure(width, height + 5 + 4 * (len(counts) + bool(counts))) as drawn:
        grid, lines = _grid(drawn, len(swept.panels)), []
        for ax, panel in zip(grid, swept.panels, strict=True):
            ax.set_title(plain_text(panel.heading), fontsize=7.5, loc="left", pad=4)
            lines.append(_contours(ax, swept.axes, panel, levels, looks))
        drawn.suptitle(plain_text(swept.caption), x=0.01, ha="left", fontsize=8)
        _legend(drawn, counts, looks)
        # The labels are laid along their lines: the axes have to have their size.
        drawn.draw_without_rendering()
        for ax, contours in zip(grid, lines, strict=True):
            _label_lines(ax, contours)
        return _files(drawn)


def contour_levels(known: Array) -> Array:
    """Round levels around the values ``known`` (n,), at most ten steps; in ratios where the greatest value is over 7
    times the least; two around a constant."""
    from matplotlib.ticker import MaxNLocator

    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
    if high - low <= 1e-3 * abs(high):
        return np.array([low - 1e-3 * abs(low) - 1e-9, high + 1e-3 * abs(high) + 1e-9])
    if low > 0.0 and high > 7.0 * low:
        first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
        rounds = np.array([step * 10.0**k for k in range(first, last + 1) for step in _RATIOS])
        return rounds[np.searchsorted(rounds, low, "right") - 1 : np.searchsorted(rounds, high) + 1]
    return np.asarray(MaxNLocator(10, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high), float)


def _contours(
    ax: Axes, axes: tuple[SweptAxis, SweptAxis], panel: MapPanel, levels: Array, looks: dict[str, dict[str, Any]]
) -> Any:
    """Draw shades and lines over the known points, above hatched cells at the missing ones; returns the lines."""
    from matplotlib.colors import LinearSegmentedColormap

    x, y = (np.array(axis.values, float) for axis in axes)
    for reason, look in looks.items():
        cells = missing_cells(panel, reason)
        if cells.any():
            ax.add_patch(_outline(x, y, cells, look))
    shown = np.ma.masked_invalid(panel.value.T)
    shades = LinearSegmentedColormap.from_list("shades", ["#F6F9FB", "#86A9BE"])
    ax.contourf(x, y, shown, levels=levels, colors=shades(np.linspace(0.0, 1.0, len(levels) - 1)), zorder=2)
    ax.grid(visible=False)
    ax.set(xlabel=axes[0].label, ylabel=axes[1].label, xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    return ax.contour(x, y, shown, levels=levels, colors=INK, linewidths=0.7, zorder=3)


def _label_lines(ax: Axes, contours: Any) -> None:
    """Write the values on the contour lines, without labels that the frame would cut or another one covers."""
    taken: list[Bbox] = []
    frame = ax.get_window_extent()
    for label in ax.clabel(contours, fontsize=6.5, fmt="%g", colors=INK, inline=False):
        label.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 0.3})
        box = label.get_window_extent()
        if box.count_overlaps(taken) or not all(frame.contains(*corner) for corner in box.corners().tolist()):
            label.set_visible(False)
        else:
            taken.append(box)


def missing_cells(panel: MapPanel, reason: str) -> Array:
    """True for every cell between four points, (n - 1, m - 1), of which one or more is missing for the reason."""
    at = np.array(panel.reasons) == reason
    return np.asarray(at[:-1, :-1] | at[1:, :-1] | at[:-1, 1:] | at[1:, 1:])


def _outline(x: Array, y: Array, cells: Array, look: dict[str, Any]) -> PathPatch:
    """The ``cells`` (n - 1, m - 1) that are True, as one hatched shape."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    corners = (0, 0), (1, 0), (1, 1), (0, 1), (0, 0)
    shapes = [Path([(x[i + a], y[j + b]) for a, b in corners], closed=True) for i, j in np.argwhere(cells).tolist()]
    return PathPatch(Path.make_compound_path(*shapes), zorder=1, **look)


def _legend(drawn: Figure, counts: dict[str, int], looks: dict[str, dict[str, Any]]) -> None:
    """Draw the legend of the reasons under the map, each with its hatch and the number of its states."""
    from matplotlib.patches import Patch

    if counts:
        handles = [Patch(**{**looks[reason], "linewidth": 0.4}) for reason in counts]
        words = [f"{plain_text(reason)} ({count})" for reason, count in counts.items()]
        legend = drawn.legend(handles, words, loc="outside lower left", handlelength=2.6, handleheight=1.0)
        legend.set_title("not predicted, number of states:")
        legend.get_title().set_fontsize(7)
        legend.set_alignment("left")


def _files(drawn: Figure) -> tuple[str, bytes]:
    """The picture as SVG and PNG on white; the same bytes for the same figure."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    text = svg(drawn)
    start = text.index(">", text.index("<svg")) + 1
    opaque = f'{text[:start]}\n <rect width="100%" height="100%" fill="#ffffff"/>{text[start:]}'
    buffer = io.BytesIO()
    FigureCanvasAgg(drawn)
    drawn.savefig(buffer, format="png", dpi=_DPI, facecolor="white", metadata={"Software": None})
    return f'<?xml version="1.0" encoding="utf-8"?>\n{opaque}', buffer.getvalue()
