"""The mixing chart: the modulus of a mix over its fraction, between the bounds that no mix can leave."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from benchmarks.mixing_theory import (
    THRESHOLD,
    Law,
    hashin_shtrikman_high,
    hashin_shtrikman_low,
    percolation,
    reuss,
    voigt,
)
from pneutouch.arrays import Array
from pneutouch.catalogue.mixture import ResolvedMixingCurve
from pneutouch.report.style import ACCENT, BOLD, FAINT, INK, LINES, MUTED, figure, halo, plain_ticks, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_COUNT = 601

_OUTER: dict[str, Any] = {"color": MUTED, "lw": 0.8, "ls": LINES[4]}
_INNER: dict[str, Any] = {"color": INK, "lw": 0.9, "ls": LINES[1]}
_LOOKS = (_OUTER, _OUTER, _INNER, _INNER, {"color": INK, "lw": 0.7, "ls": LINES[3]})
_PLACES = ((0.78, 0.1), (0.02, 0.95), (0.56, 0.5), (0.3, 0.95), (0.27, 0.6))
"""Positions of the labels of the lines, in shares of the axes, where nothing else stands."""
_ORDER = (1, 3, 4, 2, 0)


class MixingLine(NamedTuple):
    """A bound or model of a mix: moduli (n,) in MPa over the chart's fractions, and the point of its label."""

    label: str
    modulus: Array
    mark: tuple[float, float]


@dataclass(frozen=True)
class MixingChart:
    """A mixing curve between its bounds.

    Attributes:
        law: The curve.
        stiff: Greatest modulus of its stiff resin, MPa.
        names: Labels of its points.
        fraction: Volume fractions of the lines, (n,).
        lines: Reuss, Voigt, Hashin and Shtrikman low and high, percolation.
    """

    law: ResolvedMixingCurve
    stiff: float
    names: tuple[str, ...]
    fraction: Array
    lines: tuple[MixingLine, ...]


def mixing_data(law: ResolvedMixingCurve, stiff: tuple[float, float], names: tuple[str, ...]) -> MixingChart:
    """The chart of a curve; ``stiff`` are the least and greatest modulus of its stiff resin, MPa, ``names`` its points.

    Of each bound the widest that the range of the stiff resin makes.
    """
    soft, fraction = float(law.modulus[0]), np.linspace(0.0, 1.0, _COUNT)

    def line(label: str, bound: Law, modulus: float, at: float) -> MixingLine:
        return MixingLine(label, bound(fraction, soft, modulus), (at, float(bound(np.array(at), soft, modulus))))

    low, high = stiff
    lines = (
        line("Reuss: equal stress", reuss, low, 0.88),
        line("Voigt: equal strain", voigt, high, 0.12),
        line("Hashin and Shtrikman, softest isotropic mix", hashin_shtrikman_low, low, 0.88),
        line("Hashin and Shtrikman, stiffest isotropic mix", hashin_shtrikman_high, high, 0.36),
        line(f"droplets that touch beyond {100 * THRESHOLD:g} %", percolation, low, 0.2),
    )
    return MixingChart(law, high, names, fraction, lines)


def mixing_chart(chart: MixingChart, size: tuple[float, float]) -> str:
    """Shear modulus over fraction with bounds, curve, band and named points, as SVG; ``size`` is width and height in
    mm."""
    law = chart.law
    with figure(*size) as drawn:
        ax = drawn.add_subplot()
        for line, look in zip(chart.lines, _LOOKS, strict=True):
            ax.plot(chart.fraction, line.modulus, **look)
        _curve(ax, law)
        fraction = f"volume fraction of {law.curve.stiff} in {law.curve.soft}  (-)"
        limits = (0.6 * float(law.modulus[0]), 2 * chart.stiff)
        ax.set(yscale="log", xlim=(0, 1), ylim=limits, ylabel="shear modulus  (MPa)", xlabel=fraction)
        plain_ticks(ax.yaxis)
        _labels(ax, chart)
        return svg(drawn)


def _curve(ax: Axes, law: ResolvedMixingCurve) -> None:
    """The band, the curve and its points."""
    # The ends of the points' ranges too: the band steps there.
    ends = [end for point in law.curve.points for end in (point.low, point.high)]
    along = np.unique([*np.linspace(0.0, law.fraction[-1], _COUNT), *(end for end in ends if end <= law.fraction[-1])])
    if law.curve.is_assumed:
        low, high = law.band_at(along)
        ax.fill_between(along, low, high, fc=FAINT, alpha=0.6, ec=MUTED, lw=0.5, zorder=1)
    ax.plot(along, law.modulus_at(along), color=ACCENT, lw=2.0, zorder=4)
    ax.plot(law.fraction, law.modulus, "o", color=INK, mfc="white", ms=4.2, zorder=5, clip_on=False)


def _labels(ax: Axes, chart: MixingChart) -> None:
    """Names of the points and of the lines."""
    law = chart.law
    text: dict[str, Any] = {"fontsize": 6.5, "color": INK, "path_effects": halo(), "zorder": 6}
    for name, x, y in zip(chart.names, law.fraction, law.modulus, strict=True):
        ax.annotate(name, (x, y), xytext=(6, -4), textcoords="offset points", va="top", **text, **BOLD)
    arrow: dict[str, Any] = {"arrowstyle": "-", "lw": 0.4, "color": MUTED, "shrinkA": 1, "shrinkB": 1}
    side: dict[str, Any] = {"textcoords": "axes fraction", "va": "center", "ha": "left", "arrowprops": arrow}
    for k in _ORDER:
        ax.annotate(chart.lines[k].label, chart.lines[k].mark, xytext=_PLACES[k], **side, **text)
    if law.curve.is_assumed:
        above: dict[str, Any] = {"xytext": (0, 4), "textcoords": "offset points", "va": "bottom", "ha": "center"}
        ax.annotate("where the curve may be", (0.42, float(law.modulus[-1])), **above, **text)
