"""Mooney-Rivlin law, W = c10 (I1 - 3) + c01 (I2 - 3), mu = 2 (c10 + c01)."""

from functools import partial

from pneutouch.mechanics.laws.hyperelastic import Hyperelastic
from pneutouch.mechanics.laws.strain import Jet, Strain


def energy(s: Strain, c10: float, c01: float) -> Jet:
    """Strain energy density W in MPa."""
    return c10 * (s.first - 3.0) + c01 * (s.second - 3.0)


def mooney_rivlin(c10: float, c01: float, poisson_ratio: float = 0.49) -> Hyperelastic:
    """The law with the constants ``c10`` and ``c01`` in MPa."""
    return Hyperelastic(partial(energy, c10=c10, c01=c01), poisson_ratio, "c10(I1-3)+c01(I2-3)")
