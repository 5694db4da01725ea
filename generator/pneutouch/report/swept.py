"""The pictures of a sweep: a figure over each swept parameter, lines with bands, and a map over two."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.report.style import INK, LINES, MARKERS, MUTED, band, band_key, figure, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LINES, _PANELS, _WIDTH = 6, 4, 180.0
_TONES = (INK, "#3F8FBF", "#B4631D", MUTED, "#0B5C8A", "#9A9A9A")
_OUTSIDE, _MOST_TEXTS = "#EFEFEF", 120


@dataclass(frozen=True)
class SweptAxis:
    """A parameter: its key, its words, its unit, and its values: numbers, or names."""

    key: str
    words: str
    unit: str
    values: tuple[Any, ...]

    @property
    def numeric(self) -> bool:
        """True if the values are numbers that have a place on an axis; infinity, a surface that grips, has none."""
        return all(isinstance(value, int | float) and math.isfinite(value) for value in self.values)

    @property
    def label(self) -> str:
        """Words and unit for an axis."""
        return f"{self.words}  ({self.unit})" if self.unit not in ("", "1") else self.words

    def text(self, place: int) -> str:
        """A value with its unit."""
        value = self.values[place]
        if isinstance(value, str):
            return value
        return f"{value:g}" if self.unit in ("", "1") else f"{value:g} {self.unit}"

    def named(self, place: int) -> str:
        """A value with its words; a name of a catalogue stands alone."""
        value = self.values[place]
        alone = isinstance(value, str) and value not in ("true", "false")
        return self.text(place) if alone else f"{self.words} {self.text(place)}"


@dataclass(frozen=True)
class SweptFigure:
    """A figure over the axes: ``value``, ``low`` and ``high`` have a dimension an axis; NaN for a missing one."""

    label: str
    axes: tuple[SweptAxis, ...]
    value: Array
    low: Array
    high: Array

    def at(self, order: Sequence[int]) -> SweptFigure:
        """The axes in another order."""
        axes = tuple(self.axes[k] for k in order)
        return SweptFigure(self.label, axes, *(np.transpose(a, order) for a in (self.value, self.low, self.high)))


def pictures(swept: SweptFigure) -> dict[str, tuple[str, bytes]]:
    """SVG and PNG by name: ``over-KEY`` for each axis that varies, ``map`` where two numbers do.

    Other axes become lines (names first), then panels; what is left stays at its middle value, which the title states.
    """
    varied = [k for k, axis in enumerate(swept.axes) if len(axis.values) > 1]
    drawn = {}
    for k in varied:
        others = sorted((j for j in range(len(swept.axes)) if j != k), key=lambda j: _rank(swept.axes[j]))
        drawn[f"over-{swept.axes[k].key}"] = _panels(swept.at([k, *others]), 2, _lines)
    numbers = [k for k in varied if swept.axes[k].numeric and swept.axes[k].key != "driving_pressure_kPa"]
    if len(numbers) > 1:
        chosen = numbers[:2]
        others = sorted((j for j in range(len(swept.axes)) if j not in chosen), key=lambda j: _rank(swept.axes[j]))
        drawn["map"] = _panels(swept.at([*chosen, *others]), 2, _map)
    return drawn


def _rank(axis: SweptAxis) -> tuple[bool, bool]:
    """Names become lines before numbers; what does not vary comes last."""
    return len(axis.values) == 1, axis.numeric


def _some(count: int, most: int) -> list[int]:
    """Places spread evenly over all."""
    return list(range(count)) if count <= most else sorted({round(k * (count - 1) / (most - 1)) for k in range(most)})


Draw = Callable[["Axes", SweptFigure, Any], Any]


def _panels(swept: SweptFigure, used: int, draw: Draw) -> tuple[str, bytes]:
    """A panel for each value of the axis after the ``used`` ones; those after it stay at their middle value."""
    while len(swept.axes) < used + 1:
        swept = SweptFigure(
            swept.label, (*swept.axes, SweptAxis("", "", "", ("",))), *(a[..., None] for a in _arrays(swept))
        )
    if draw is _lines:
        swept = _thinned(swept)
    middle = [len(axis.values) // 2 for axis in swept.axes[used + 1 :]]
    fixed = [axis.named(k) for axis, k in zip(swept.axes[used + 1 :], middle, strict=True) if axis.key]
    places = _some(len(swept.axes[used].values), _PANELS)
    across = min(len(places), 2)
    down = math.ceil(len(places) / across)
    ranging = _arrays(swept) if draw is _lines else (swept.value[:, :, places],)
    known = np.concatenate([a[np.isfinite(a)].ravel() for a in ranging])
    span = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
    shown: Any = None
    with figure(_WIDTH if across > 1 else 0.62 * _WIDTH, 66 * down + 8) as drawn:
        grid = drawn.subplots(down, across, squeeze=False)
        for ax, place in zip(grid.flat, places, strict=False):
            one = SweptFigure(swept.label, swept.axes[:used], *(_cut(a, (place, *middle)) for a in _arrays(swept)))
            shown = draw(ax, one, span)
            words = [swept.axes[used].named(place)] if swept.axes[used].key else []
            ax.set_title(_plain(", ".join([*words, *fixed])), fontsize=7.5, loc="left", pad=4)
        for ax in list(grid.flat)[len(places) :]:
            ax.remove()
        _finish(drawn, swept, shown, list(grid.flat)[: len(places)])
        return _files(drawn)


def _arrays(swept: SweptFigure) -> tuple[Array, Array, Array]:
    return swept.value, swept.low, swept.high


def _thinned(swept: SweptFigure) -> SweptFigure:
    """At most `_LINES` values of the second axis, of those that have a figure anywhere."""
    first, second, *others = swept.axes
    known = [k for k in range(len(second.values)) if np.isfinite(swept.value[:, k]).any()]
    kept = [known[k] for k in _some(len(known), _LINES)]
    lines = SweptAxis(second.key, second.words, second.unit, tuple(second.values[k] for k in kept))
    return SweptFigure(swept.label, (first, lines, *others), *(a[:, kept] for a in _arrays(swept)))


def _cut(values: Array, places: tuple[int, ...]) -> Array:
    """Values at places along the last axes."""
    for place in reversed(places):
        values = np.take(values, place, axis=-1)
    return values


def _finish(drawn: Figure, swept: SweptFigure, shown: Any, axes: list[Axes]) -> None:
    """A legend of the lines, or the scale of a map."""
    if isinstance(shown, dict):
        if len(shown) > 1 or swept.axes[1].key:
            handles, title = list(shown.values()), swept.axes[1].words
            legend = drawn.legend(
                handles,
                list(shown),
                loc="outside upper left",
                ncols=6 if len(axes) > 1 else 3,
                handlelength=2.6,
                title=title,
                title_fontsize=7,
            )
            legend.set_alignment("left")
    else:
        drawn.colorbar(shown, ax=axes, label=swept.label, shrink=0.9)


def _lines(ax: Axes, swept: SweptFigure, span: tuple[float, float]) -> dict[str, Any]:
    """A line, or points over names, for each value of the second axis, with its band; returns the legend."""
    from matplotlib.lines import Line2D

    axis, lines = swept.axes
    handles = {}
    for n in range(len(lines.values)):
        look: dict[str, Any] = {"color": _TONES[n], "marker": MARKERS[n], "ms": 3.0, "mfc": "white", "mew": 0.7}
        apart = 0.0 if axis.numeric else 0.12 * (n - (len(lines.values) - 1) / 2)
        x = apart + np.array(axis.values if axis.numeric else range(len(axis.values)), float)
        style = LINES[n % len(LINES)] if axis.numeric else ""
        value, low, high = (a[:, n] for a in _arrays(swept))
        ax.plot(x, value, ls=style, lw=1.2, zorder=4, **look)
        if axis.numeric:
            band(ax, x, low, high, n, _TONES[n])
        else:
            ax.vlines(x, low, high, color=_TONES[n], lw=0.9, zorder=3)
        line = Line2D([], [], ls=style, lw=1.2, **look)
        handles[_plain(lines.text(n))] = (band_key(n, _TONES[n]), line) if axis.numeric else line
    if not axis.numeric:
        ax.set_xticks(range(len(axis.values)), [f"{v:g}" if isinstance(v, float) else str(v) for v in axis.values])
        ax.tick_params(axis="x", labelrotation=30 if len(axis.values) > 4 else 0)
    slack = 0.05 * (span[1] - span[0] or abs(span[1]) or 1.0)
    ax.set(xlabel=axis.label, ylabel=swept.label, ylim=(min(0.0, span[0]), span[1] + slack))
    return handles


def _map(ax: Axes, swept: SweptFigure, span: tuple[float, float]) -> Any:
    """Cells in shades of one tone with their values if they are few; impossible points are crossed out."""
    first, second = swept.axes
    x, y = (np.array(axis.values, float) for axis in (first, second))
    order_x, order_y = np.argsort(x), np.argsort(y)
    cells = swept.value[np.ix_(order_x, order_y)].T
    low, high = span
    ax.set_facecolor(_OUTSIDE)
    scale: dict[str, Any] = {"cmap": "cividis", "vmin": low, "vmax": high, "shading": "nearest"}
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


def _plain(text: str) -> str:
    return text.replace("$", r"\$")


def _files(drawn: Figure) -> tuple[str, bytes]:
    """The picture as SVG and PNG on white; the same bytes for the same figure."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    text = svg(drawn)
    start = text.index(">", text.index("<svg")) + 1
    opaque = f'{text[:start]}\n <rect width="100%" height="100%" fill="#ffffff"/>{text[start:]}'
    buffer = io.BytesIO()
    FigureCanvasAgg(drawn)
    drawn.savefig(buffer, format="png", dpi=200, facecolor="white", metadata={"Software": None})
    return f'<?xml version="1.0" encoding="utf-8"?>\n{opaque}', buffer.getvalue()
