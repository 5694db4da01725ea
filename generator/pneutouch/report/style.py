"""How figures look: one font, one line width family, readable in grayscale, the same bytes every time."""

from __future__ import annotations

import hashlib
import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneutouch.parts.lettering.glyphs import FONTS

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
"""What matplotlib draws an SVG at."""


@contextmanager
def figure(width_mm: float, height_mm: float) -> Iterator[Figure]:
    """A figure of a size in mm in the style of the project; nothing global changes."""
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
    """The figure as SVG without date, ready to stand inside HTML."""
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    buffer, dpi, layout = io.StringIO(), drawn.dpi, drawn.get_layout_engine()
    if layout is not None:
        # Saving would draw everything once, unseen, to lay it out: the layout alone gives the same places.
        FigureCanvasSVG(drawn)
        drawn.dpi = _SVG_DPI
        layout.execute(drawn)
        drawn.dpi = dpi
        drawn.set_layout_engine(None)
    drawn.savefig(buffer, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    text = buffer.getvalue()
    return _named_by_content(text[text.index("<svg") :])


def _named_by_content(text: str) -> str:
    """Clip paths called by what they are as printed: their own names follow digits of the layout that no drawing
    repeats."""
    names = {
        old: "p" + hashlib.sha256(" ".join(content.split()).encode()).hexdigest()[:10]
        for old, content in re.findall(r'<clipPath id="(p[0-9a-f]+)">(.*?)</clipPath>', text, re.DOTALL)
    }
    return re.sub(r'(?<=id=")p[0-9a-f]+(?=")|(?<=url\(#)p[0-9a-f]+(?=\))', lambda at: names.get(at[0], at[0]), text)


Label = tuple[float, float, str, dict[str, Any]]
"""x, y (data), text and look of a label."""


def label_ends(ax: Axes, ends: list[Label], gap: float = 0.062) -> None:
    """Write labels right of the axes, as near to their curves' ends as ``gap`` (share of the height) allows.

    Call it once the limits and scales of the axes stand.
    """
    for (x, y, text, look), (_, height) in zip(ends, _spread(ax, ends, gap), strict=True):
        _labelled(ax, (x, y), text, (1.04, height), "left", look)


def label_points(ax: Axes, points: list[Label], shift: tuple[float, float], gap: float = 0.055) -> None:
    """Write labels next to points, ``shift`` away (shares of width and height), at least ``gap`` apart in height.

    Call it once the limits and scales of the axes stand.
    """
    for (x, y, text, look), (across, height) in zip(points, _spread(ax, points, gap), strict=True):
        side = "left" if shift[0] > 0 else "right"
        _labelled(ax, (x, y), text, (across + shift[0], height + shift[1]), side, look)


def _spread(ax: Axes, labels: list[Label], gap: float) -> list[tuple[float, float]]:
    """Places in shares of the axes: heights moved apart to ``gap``, in the middle where the points' own are."""
    to_axes = ax.transData + ax.transAxes.inverted()
    native = [tuple(map(float, to_axes.transform((x, y)))) for x, y, *_ in labels]
    order = sorted(range(len(native)), key=lambda k: (native[k][1], k))
    placed: dict[int, float] = {}
    for before, k in zip([None, *order], order, strict=False):
        placed[k] = native[k][1] if before is None else max(native[k][1], placed[before] + gap)
    shift = sum(placed[k] - native[k][1] for k in order) / max(len(order), 1)
    return [(native[k][0], placed[k] - shift) for k in range(len(native))]


def _labelled(
    ax: Axes, at: tuple[float, float], text: str, place: tuple[float, float], side: str, look: dict[str, Any]
) -> None:
    """One label with a thin line to its point."""
    arrow: dict[str, Any] = {"arrowstyle": "-", "lw": 0.4, "color": MUTED, "shrinkA": 2, "shrinkB": 1}
    arrow["relpos"] = (0 if side == "left" else 1, 0.5)
    style: dict[str, Any] = {"va": "center", "annotation_clip": False, "zorder": 5, "path_effects": halo(), **look}
    ax.annotate(text, at, xytext=place, textcoords="axes fraction", ha=side, arrowprops=arrow, **style)


def note(ax: Axes, text: str, at: tuple[float, float], offset: tuple[float, float], **look: Any) -> None:
    """A small text ``offset`` points from a point of the data."""
    ax.annotate(text, at, xytext=offset, textcoords="offset points", **{"fontsize": 6.5, **look})


def halo() -> list[AbstractPathEffect]:
    """A white rim around letters that may stand on lines."""
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=1.8, foreground="white")]


def plain_ticks(axis: Axis) -> None:
    """Ticks of a logarithmic axis as plain numbers at 1, 2 and 5 of each decade; at 1 alone where they are many."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(10, (1.0, 2.0, 5.0) if high < 300 * low else (1.0,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())
