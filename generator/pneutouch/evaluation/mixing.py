"""The lines of the mixing chart: bounds on the modulus of a mix over its fraction."""

from __future__ import annotations

import numpy as np

from pneutouch.catalogue.mixture import ResolvedMixingCurve
from pneutouch.evaluation.chart_data import MixingChart, MixingLine
from pneutouch.mechanics.mixing import (
    THRESHOLD,
    Law,
    hashin_shtrikman_high,
    hashin_shtrikman_low,
    percolation,
    reuss,
    voigt,
)

_COUNT = 601


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
