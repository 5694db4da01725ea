"""Yeoh law, W = c10 (I1 - 3) + c20 (I1 - 3)^2 + c30 (I1 - 3)^3, mu = 2 c10."""

from functools import partial

from pneutouch.mechanics.laws.hyperelastic import Hyperelastic
from pneutouch.mechanics.laws.strain import Jet, Strain


def energy(s: Strain, c10: float, c20: float, c30: float) -> Jet:
    """Strain energy density W in MPa."""
    x = s.first - 3.0
    return c10 * x + c20 * (x * x) + c30 * (x * (x * x))


def yeoh(c10: float, c20: float, c30: float = 0.0, poisson_ratio: float = 0.49) -> Hyperelastic:
    """The law with constants in MPa; without ``c30`` it has two terms."""
    return Hyperelastic(partial(energy, c10=c10, c20=c20, c30=c30), poisson_ratio, "sum ci0(I1-3)^i")
