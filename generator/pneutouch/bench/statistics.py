"""Statistics of readings: mean, standard deviation, and the fits and formulas of the coupons."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array


@dataclass(frozen=True, slots=True)
class Mean:
    """Mean of ``count`` values and their standard deviation (of one value, n - 1 below the sum)."""

    value: float
    spread: float
    count: int

    @property
    def error(self) -> float:
        """Standard error of the mean."""
        return self.spread / math.sqrt(self.count)


def mean(values: Sequence[float]) -> Mean:
    """Mean of at least two values. Raises ValueError for fewer."""
    if len(values) < 2:
        raise ValueError("a spread needs at least two values")
    readings = np.asarray(values, float)
    return Mean(float(readings.mean()), float(readings.std(ddof=1)), len(values))


def neo_hookean(stretch: Array, stress: Array) -> tuple[float, float]:
    """Shear modulus in MPa and its standard error: least squares of stress = mu (stretch - stretch^-2).

    ``stress`` is force over the undeformed cross-section, MPa; both (n,), n >= 2. Uniaxial tension of an incompressible
    neo-Hookean solid (Treloar, The Physics of Rubber Elasticity, 3rd ed., eq. 5.12).
    """
    shape = stretch - stretch**-2
    modulus = float(shape @ stress / (shape @ shape))
    rest = stress - modulus * shape
    return modulus, float(np.sqrt(rest @ rest / (len(stress) - 1) / (shape @ shape)))


def secant_modulus(stretch: Array, stress: Array, strain: float) -> float | None:
    """Stress over strain in MPa at a strain, between the points of a curve from the origin; None beyond its end."""
    strains = np.concatenate([[0.0], stretch - 1])
    if strains.max() < strain:
        return None
    order = np.argsort(strains, kind="stable")
    return float(np.interp(strain, strains[order], np.concatenate([[0.0], stress])[order]) / strain)


def shear_from_young(modulus: float, poisson_ratio: float) -> float:
    """Shear modulus E / (2 (1 + nu)), MPa, as the paper's Table 1."""
    return modulus / (2 * (1 + poisson_ratio))


def dead_volume(cavity: Mean, over_cap_kPa: Mean, over_plug_kPa: Mean, gauge_kPa: float = 0.0) -> Mean:
    """Dead volume from the pressures that the same push of air makes over a cap and over a plug with a cavity.

    Boyle: p_a V_d = p_b (V_d + V_c), so V_d = V_c p_b / (p_a - p_b); syringe and ambient pressure cancel. Volumes in
    one unit, gauge pressures in one unit, ``gauge_kPa`` the gauge's own standard uncertainty. ``spread`` is the
    standard uncertainty of the result, by the derivatives (JCGM 100, 5.1.2). Raises ValueError if the plug's is not
    the lower."""
    a, b, volume = over_cap_kPa.value, over_plug_kPa.value, cavity.value
    if b >= a:
        raise ValueError("the pressure over the plug must be lower than over the cap")
    gap = a - b
    by_volume = b / gap * cavity.error
    by_cap = volume * b / gap**2 * math.hypot(over_cap_kPa.error, gauge_kPa)
    by_plug = volume * a / gap**2 * math.hypot(over_plug_kPa.error, gauge_kPa)
    return Mean(volume * b / gap, math.hypot(by_volume, by_cap, by_plug), 1)
