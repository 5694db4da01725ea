"""Ogden law of one to three terms, W = sum (2 mu_i/alpha_i^2)(l1^alpha_i + l2^alpha_i + l3^alpha_i - 3).

In this convention mu = sum mu_i. Sets in Ogden's 1972 form (mu_i/alpha_i) convert by mu_i -> mu_i alpha_i/2.
"""

from functools import partial, reduce

from pneutouch.errors import InputError
from pneutouch.mechanics.laws.hyperelastic import Hyperelastic
from pneutouch.mechanics.laws.strain import Jet, Strain

Terms = tuple[tuple[float, float], ...]


def energy(s: Strain, terms: Terms) -> Jet:
    """Strain energy density W in MPa; ``terms`` are (mu_i in MPa, alpha_i)."""
    parts = ((2.0 * mu / alpha**2) * (s.power_sum(alpha) - 3.0) for mu, alpha in terms)
    return reduce(Jet.__add__, parts)


def ogden(terms: Terms, poisson_ratio: float = 0.49) -> Hyperelastic:
    """The law with 1 to 3 pairs (mu_i, alpha_i), mu_i in MPa. Raises InputError for other numbers or alpha_i = 0."""
    if not 1 <= len(terms) <= 3 or any(alpha == 0.0 for _, alpha in terms):
        raise InputError("law ogden: give one to three (mu, alpha) pairs with alpha other than 0")
    return Hyperelastic(partial(energy, terms=terms), poisson_ratio, "sum 2mu/alpha^2(sum l^alpha-3)")
