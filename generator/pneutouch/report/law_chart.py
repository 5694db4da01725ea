"""A fitted law: data and law over stretch, and their difference."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.report.style import ACCENT, FAINT, INK, LINES, MARKERS, MUTED, figure, svg

_SHADES = (ACCENT, INK)
_BAND = 5.0
"""Per cent within which a law is good enough."""


class LawCurve(NamedTuple):
    """A law: nominal stress (MPa) over stretch, and its relative differences to the data at stretches ``off_at``."""

    label: str
    stretch: Array
    stress: Array
    off_at: Array
    off: Array


def law_chart(data: Sequence[tuple[Array, Array]], laws: Sequence[LawCurve], largest: float) -> str:
    """Nominal stress over stretch, specimens as points and laws as lines with a band of 5 %, and below the difference.

    SVG. Laws differ by line and shade, specimens by marker, so that they can be distinguished in grayscale.
    """
    with figure(120.0, 110.0) as drawn:
        top, bottom = drawn.subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
        for k, (stretch, stress) in enumerate(data):
            label = "measured" if len(data) == 1 else f"specimen {k + 1}"
            marker = MARKERS[k % len(MARKERS)]
            top.plot(stretch, stress, ls="none", marker=marker, ms=2.6, mfc="white", color=MUTED, mew=0.6, label=label)
        for k, law in enumerate(laws):
            look = {"color": _SHADES[k % 2], "ls": LINES[k % len(LINES)], "lw": 1.2, "zorder": 3}
            top.plot(law.stretch, law.stress, label=law.label, **look)
            bottom.plot(law.off_at, 100 * law.off, marker=MARKERS[k], ms=2.0, **{**look, "lw": 0.8})
        chosen = laws[0]
        share = 1.0 + 0.01 * np.array([-_BAND, _BAND])
        top.fill_between(
            chosen.stretch, share[0] * chosen.stress, share[1] * chosen.stress, color=FAINT, lw=0, label="±5 %"
        )
        bottom.axhspan(-_BAND, _BAND, color=FAINT, lw=0, zorder=0)
        bottom.axhline(0.0, color=MUTED, lw=0.6)
        top.set(ylabel="nominal stress  (MPa)")
        bottom.set(ylabel="law less measured\n(%)", xlabel=f"stretch  (tension up to {largest:.3g} fitted)")
        top.legend(loc="best")
        drawn.align_ylabels([top, bottom])
        return svg(drawn)
