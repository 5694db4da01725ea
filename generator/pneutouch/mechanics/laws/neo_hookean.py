"""Neo-Hookean law, W = (mu/2)(I1 - 3): the law of the paper, eq. 7 with C1 = mu/2."""

from functools import partial

from pneutouch.mechanics.laws.hyperelastic import Hyperelastic
from pneutouch.mechanics.laws.strain import Jet, Strain


def energy(s: Strain, c1: float) -> Jet:
    """Strain energy density W in MPa."""
    return c1 * (s.first - 3.0)


def neo_hookean(mu: float, poisson_ratio: float = 0.49) -> Hyperelastic:
    """The law with shear modulus ``mu`` (MPa)."""
    return Hyperelastic(partial(energy, c1=0.5 * mu), poisson_ratio, "(mu/2)(I1-3)")
