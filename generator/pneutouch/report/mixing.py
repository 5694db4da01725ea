"""The mixing chart: how stiff a mix is over its fraction, between what no mix can be softer and stiffer than."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.catalogue.mixture import ResolvedMixingCurve
from pneutouch.mechanics.mixing import (
    THRESHOLD,
    hashin_shtrikman_high,
    hashin_shtrikman_low,
    percolation,
    reuss,
    voigt,
)
from pneutouch.report.style import ACCENT, BOLD, FAINT, INK, LINES, MUTED, figure, halo, plain_ticks, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_COUNT = 601


@dataclass(frozen=True)
class MixingChart:
    """A curve with the moduli of its stiff resin, least and greatest, MPa; ``names`` are those of its points."""

    law: ResolvedMixingCurve
    stiff: tuple[float, float]
    names: tuple[str, ...]


def mixing_chart(chart: MixingChart, size: tuple[float, float]) -> str:
    """Shear modulus over fraction with bounds, curve, band and named points, as SVG; ``size`` is width and height in mm."""
    law, stiff = chart.law, chart.stiff
    f = np.linspace(0.0, 1.0, _COUNT)
    soft = float(law.modulus[0])
    with figure(*size) as drawn:
        ax = drawn.add_subplot()
        # The widest that the stiff resin's own range makes of each bound.
        low, high = reuss(f, soft, stiff[0]), voigt(f, soft, stiff[1])
        ax.plot(f, low, color=MUTED, lw=0.8, ls=LINES[4])
        ax.plot(f, high, color=MUTED, lw=0.8, ls=LINES[4])
        ax.plot(f, hashin_shtrikman_low(f, soft, stiff[0]), color=INK, lw=0.9, ls=LINES[1])
        ax.plot(f, hashin_shtrikman_high(f, soft, stiff[1]), color=INK, lw=0.9, ls=LINES[1])
        ax.plot(f, percolation(f, soft, stiff[0]), color=INK, lw=0.7, ls=LINES[3])
        _curve(ax, law)
        ax.set(
            yscale="log", xlim=(0, 1), ylim=(0.6 * soft, 2 * stiff[1]), ylabel="shear modulus  (MPa)",
            xlabel=f"volume fraction of {law.curve.stiff} in {law.curve.soft}  (-)",
        )  # fmt: skip
        plain_ticks(ax.yaxis)
        _words(ax, chart, soft)
        return svg(drawn)


def _curve(ax: Axes, law: ResolvedMixingCurve) -> None:
    """The band, the curve and its points."""
    # The points' own ends too: the band steps there.
    ends = [end for point in law.curve.points for end in (point.low, point.high)]
    along = np.unique([*np.linspace(0.0, law.fraction[-1], _COUNT), *(end for end in ends if end <= law.fraction[-1])])
    if law.curve.is_assumed:
        low, high = law.band_at(along)
        ax.fill_between(along, low, high, fc=FAINT, alpha=0.6, ec=MUTED, lw=0.5, zorder=1)
    ax.plot(along, law.modulus_at(along), color=ACCENT, lw=2.0, zorder=4)
    ax.plot(law.fraction, law.modulus, "o", color=INK, mfc="white", ms=4.2, zorder=5, clip_on=False)


def _words(ax: Axes, chart: MixingChart, soft: float) -> None:
    """Names where the lines run."""
    law, stiff = chart.law, chart.stiff
    for name, x, y in zip(chart.names, law.fraction, law.modulus, strict=True):
        ax.annotate(
            name, (x, y), xytext=(6, -4), textcoords="offset points", va="top", fontsize=6.5, color=INK,
            path_effects=halo(), zorder=6, **BOLD,
        )  # fmt: skip
    # Each with a point of its line and a place of its text where nothing else stands.
    said = (
        ("Voigt: equal strain", voigt, stiff[1], 0.12, (0.02, 0.95)),
        ("Hashin and Shtrikman, stiffest isotropic mix", hashin_shtrikman_high, stiff[1], 0.36, (0.3, 0.95)),
        (f"droplets that touch beyond {100 * THRESHOLD:g} %", percolation, stiff[0], 0.2, (0.27, 0.6)),
        ("Hashin and Shtrikman, softest isotropic mix", hashin_shtrikman_low, stiff[0], 0.88, (0.56, 0.5)),
        ("Reuss: equal stress", reuss, stiff[0], 0.88, (0.78, 0.1)),
    )
    for text, line, modulus, x, place in said:
        ax.annotate(
            text, (x, float(line(np.array(x), soft, modulus))), xytext=place, textcoords="axes fraction", va="center",
            ha="left", fontsize=6.5, color=INK, path_effects=halo(), zorder=6,
            arrowprops={"arrowstyle": "-", "lw": 0.4, "color": MUTED, "shrinkA": 1, "shrinkB": 1},
        )  # fmt: skip
    if law.curve.is_assumed:
        ax.annotate(
            "where the curve may be", (0.42, float(law.modulus[-1])), xytext=(0, 4), textcoords="offset points", va="bottom",
            ha="center", fontsize=6.5, color=INK, path_effects=halo(), zorder=6,
        )  # fmt: skip
