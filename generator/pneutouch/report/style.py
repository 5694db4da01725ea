"""Style of all figures: one font, one line width family, readable in grayscale, the same bytes every time."""

from __future__ import annotations

import hashlib
import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneutouch.arrays import Array
from pneutouch.parts.lettering.glyphs import FONTS
from pneutouch.report.placing import AT_SIDE, NEAR, settle

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure
    from matplotlib.patheffects import AbstractPathEffect


BOLD: dict[str, Any] = {"family": "Inter Semi Bold", "weight": 600}
INK, ACCENT, MUTED, FAINT = "#16212B", "#0B5C8A", "#6C7A86", "#C9D1D8"
MM = 1 / 25.4
LINES = ("-", (0, (5, 1.6)), (0, (2.5, 1.2)), (0, (5, 1.2, 1, 1.2)), (0, (1, 1.1)))
MARKERS = ("o", "s", "^", "D", "v", "P", "X")

_SETTINGS = Path(__file__).with_name("figures.mplstyle")


_SVG_DPI = 72.0
"""Resolution at which matplotlib draws an SVG."""


@contextmanager
def figure(width_mm: float, height_mm: float) -> Iterator[Figure]:
    """An empty figure of a size in mm in the style of the project; matplotlib's settings are restored afterwards."""
    import matplotlib
    from matplotlib import font_manager
    from matplotlib.figure import Figure as MplFigure

    known = {font.fname for font in font_manager.fontManager.ttflist}
    for path in (FONTS / "Inter-Regular.otf", FONTS / "Inter-SemiBold.otf"):
        if str(path) not in known:
            font_manager.fontManager.addfont(path)
    with matplotlib.rc_context(fname=_SETTINGS):
        yield MplFigure(figsize=(width_mm * MM, height_mm * MM), layout="constrained")


def svg(drawn: Figure) -> str:
    """The figure as SVG, on white and without date, its labels in free places, ready to stand inside HTML."""
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    buffer, dpi, layout = io.StringIO(), drawn.dpi, drawn.get_layout_engine()
    if layout is not None:
        # Saving would draw everything once, unseen, to lay it out: the layout alone gives the same places.
        FigureCanvasSVG(drawn)
        drawn.dpi = _SVG_DPI
        layout.execute(drawn)
        settle(drawn)
        drawn.dpi = dpi
        drawn.set_layout_engine(None)
    drawn.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    text = buffer.getvalue()
    return _short(_named_by_content(text[text.index("<svg") :]))


def _short(text: str) -> str:
    """The same picture in fewer bytes: paths to a hundredth of a point, each on one line."""
    return re.sub(r'(?<= d=")[^"]+', lambda path: _NUMBER.sub(_hundredths, " ".join(path[0].split())), text)


_NUMBER = re.compile(r"-?\d+\.\d+")


def _hundredths(number: re.Match[str]) -> str:
    return f"{round(float(number[0]), 2) + 0.0:g}"


def _named_by_content(text: str) -> str:
    """The SVG with clip paths named by their content; matplotlib's own names change from run to run."""
    names = {
        old: "p" + hashlib.sha256(" ".join(content.split()).encode()).hexdigest()[:10]
        for old, content in re.findall(r'<clipPath id="(p[0-9a-f]+)">(.*?)</clipPath>', text, re.DOTALL)
    }
    return re.sub(r'(?<=id=")p[0-9a-f]+(?=")|(?<=url\(#)p[0-9a-f]+(?=\))', lambda at: names.get(at[0], at[0]), text)


Label = tuple[float, float, str, dict[str, Any]]
"""x, y (data), text and text properties of a label."""


def label_ends(ax: Axes, ends: list[Label]) -> None:
    """Write labels right of the axes, each with a thin line to its curve's end; `svg` moves them apart."""
    arrow = {"arrowstyle": "-", "lw": 0.4, "color": MUTED, "shrinkA": 2, "shrinkB": 1, "relpos": (0, 0.5)}
    style: dict[str, Any] = {"va": "center", "annotation_clip": False, "zorder": 5, "fontsize": 6.5}
    for x, y, text, look in ends:
        height = float((ax.transData + ax.transAxes.inverted()).transform((x, y))[1])
        place: dict[str, Any] = {"xytext": (1.04, height), "textcoords": "axes fraction", "ha": "left"}
        ax.annotate(text, (x, y), arrowprops=arrow, **place, **style | look).set_label(AT_SIDE)


def note(ax: Axes, text: str, at: tuple[float, float], side: tuple[float, float] = (0.0, 1.0), **look: Any) -> None:
    """A small text near a data point, on its ``side`` (right, up) or where else `svg` finds a free place; away from the
    point a thin line leads to it."""
    arrow = {"arrowstyle": "-", "lw": 0.4, "color": MUTED, "shrinkA": 1, "shrinkB": 2}
    style: dict[str, Any] = {"fontsize": 6.5, "zorder": 6, "annotation_clip": False, **look}
    place: dict[str, Any] = {"xytext": (8 * side[0], 8 * side[1]), "textcoords": "offset points"}
    label = ax.annotate(text, at, arrowprops=arrow, **place, **style)
    label.set_label(NEAR)
    # Its place is found in the layout that stands without it.
    label.set_in_layout(False)


def legend_above(*axes: Axes, columns: int = 4, title: str = "") -> None:
    """One legend above the axes of a figure, in rows of ``columns`` entries.

    A label that several axes share stands once; lines and bands with one label in the same axes are one entry.
    """
    entries: dict[str, Any] = {}
    for ax in axes:
        own: dict[str, tuple[Any, ...]] = {}
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            own[label] = (*own.get(label, ()), handle)
        entries = entries | {label: parts for label, parts in own.items() if label not in entries}
    if not entries:
        return
    columns = min(columns, len(entries))
    # matplotlib fills columns: taken in this order the entries read row by row.
    words = [word for k in range(columns) for word in list(entries)[k::columns]]
    handles = [entries[word] if len(entries[word]) > 1 else entries[word][0] for word in words]
    look: dict[str, Any] = {"handlelength": 2.6, "handletextpad": 0.4, "columnspacing": 1.4, "borderpad": 0.1}
    drawn = axes[0].get_figure(root=True)
    assert drawn is not None
    legend = drawn.legend(handles, words, loc="outside upper left", ncols=columns, **look)
    if title:
        legend.set_title(title)
        legend.get_title().set_fontsize(7)
        legend.set_alignment("left")


def halo() -> list[AbstractPathEffect]:
    """A white rim around letters that may stand on lines."""
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=1.8, foreground="white")]


def plain_ticks(axis: Axis) -> None:
    """Ticks of a logarithmic axis as plain numbers at 1, 2 and 5 of each decade; only at 1 where they are many."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(10, (1.0, 2.0, 5.0) if high < 300 * low else (1.0,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


HATCHES = ("//", "\\\\", "||", "..", "--", "++")
_FILL, _HATCH = 0.07, 0.55
"""Opacity of a band's ground and of its hatch: curves and other bands are seen through both."""


def band(ax: Axes, x: Array, low: Array, high: Array, number: int, tone: str, label: str | None = None) -> None:
    """Draw the band of curve ``number`` between ``low`` and ``high`` (n,), with edges in the curve's line style."""
    from matplotlib.colors import to_rgba

    fill, lines = to_rgba(tone, _FILL), to_rgba(tone, _HATCH)
    look: dict[str, Any] = {"facecolor": fill, "edgecolor": lines, "hatch": HATCHES[number % len(HATCHES)]}
    ax.fill_between(x, low, high, lw=0, zorder=1, label=label, **look)
    for end in (low, high):
        ax.plot(x, end, color=tone, lw=0.5, ls=LINES[number % len(LINES)], zorder=2)
