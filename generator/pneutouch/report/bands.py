"""The bands of intervals around curves: each is hatched in its own direction, so that they stay apart in grayscale."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pneutouch.arrays import Array
from pneutouch.report.style import LINES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patches import Patch

HATCHES = ("//", "\\\\", "||", "..", "--", "++")
_FILL, _HATCH = 0.07, 0.55
"""Opacity of the ground and of the hatch: the curves and the other bands are seen through both."""


def band(ax: Axes, x: Array, low: Array, high: Array, number: int, tone: str) -> None:
    """Draw the band of curve ``number`` between ``low`` and ``high`` (n,), with its ends in the line of the curve."""
    from matplotlib.colors import to_rgba

    fill, lines = to_rgba(tone, _FILL), to_rgba(tone, _HATCH)
    ax.fill_between(x, low, high, lw=0, zorder=1, facecolor=fill, edgecolor=lines, hatch=_hatch(number))
    for end in (low, high):
        ax.plot(x, end, color=tone, lw=0.5, ls=LINES[number % len(LINES)], zorder=2)


def band_key(number: int, tone: str) -> Patch:
    """The band of a curve for a legend."""
    from matplotlib.colors import to_rgba
    from matplotlib.patches import Patch

    fill, lines = to_rgba(tone, _FILL), to_rgba(tone, _HATCH)
    return Patch(lw=0, facecolor=fill, edgecolor=lines, hatch=2 * _hatch(number))


def _hatch(number: int) -> str:
    return HATCHES[number % len(HATCHES)]
