"""How figures look: one font, one line width family, readable in grayscale, the same bytes every time."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FONTS = Path(__file__).parent / "fonts"
BOLD: dict[str, Any] = {"family": "Inter Semi Bold", "weight": 600}
INK, ACCENT, MUTED, FAINT = "#16212B", "#0B5C8A", "#6C7A86", "#C9D1D8"
MM = 1 / 25.4
LINES = ("-", (0, (5, 1.6)), (0, (2.5, 1.2)), (0, (5, 1.2, 1, 1.2)), (0, (1, 1.1)))
MARKERS = ("o", "s", "^", "D", "v", "P", "X")

_SETTINGS: dict[Any, Any] = {
    "font.family": "Inter", "font.size": 7.5, "text.color": INK,
    "axes.edgecolor": INK, "axes.labelcolor": INK, "axes.linewidth": 0.6, "axes.labelsize": 7.5,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "axes.axisbelow": True,
    "grid.color": "#E4E9ED", "grid.linewidth": 0.5,
    "xtick.color": INK, "ytick.color": INK, "xtick.labelsize": 7, "ytick.labelsize": 7,
    "xtick.major.width": 0.6, "ytick.major.width": 0.6, "xtick.major.size": 2.5, "ytick.major.size": 2.5,
    "lines.linewidth": 1.2, "lines.markersize": 3.2, "legend.fontsize": 7, "legend.frameon": False,
    "hatch.linewidth": 0.35, "svg.hashsalt": "pneutouch", "svg.fonttype": "path",
    "mathtext.fontset": "custom", "mathtext.rm": "Inter", "mathtext.it": "Inter", "mathtext.bf": "Inter",
    "mathtext.cal": "Inter",
}  # fmt: skip


@contextmanager
def figure(width_mm: float, height_mm: float) -> Iterator[Figure]:
    """A figure of a size in mm under the house style; nothing global changes."""
    import matplotlib
    from matplotlib import font_manager
    from matplotlib.figure import Figure as MplFigure

    for name in ("Inter-Regular.otf", "Inter-SemiBold.otf"):
        font_manager.fontManager.addfont(FONTS / name)
    with matplotlib.rc_context(_SETTINGS):
        yield MplFigure(figsize=(width_mm * MM, height_mm * MM), layout="constrained")


def svg(drawn: Figure) -> str:
    """The figure as SVG without date, ready to stand inside HTML."""
    buffer = io.StringIO()
    drawn.savefig(buffer, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    text = buffer.getvalue()
    return text[text.index("<svg") :]


def label_ends(ax: Axes, ends: list[tuple[float, str, dict[str, Any]]], x: float, gap: float) -> None:
    """Write labels to the right of ``x`` at heights as near to their curves' ends as ``gap`` (data) allows."""
    placed: list[float] = []
    for height, _, _ in sorted(ends, key=lambda end: end[0]):
        placed.append(height if not placed else max(height, placed[-1] + gap))
    shift = sum(p - e[0] for p, e in zip(placed, sorted(ends, key=lambda e: e[0]), strict=True)) / max(len(ends), 1)
    for y, (height, text, look) in zip(placed, sorted(ends, key=lambda end: end[0]), strict=True):
        ax.annotate(
            text, (x, height), xytext=(x + 0.05 * (ax.get_xlim()[1] - ax.get_xlim()[0]), y - shift),
            va="center", annotation_clip=False,
            arrowprops={"arrowstyle": "-", "lw": 0.4, "color": MUTED, "relpos": (0, 0.5), "shrinkA": 2, "shrinkB": 1}, **look,
        )  # fmt: skip
