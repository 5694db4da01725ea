"""A hyperelastic material: an isochoric energy, from which its shear modulus is computed, and Poisson's ratio.

Also the first invariant of uniaxial tension and its inverse, which compare other states of strain with tension.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.mechanics.laws.strain import BY_A, Jet, Strain

Energy = Callable[[Strain], Jet]


@dataclass(frozen=True)
class Hyperelastic:
    """An isochoric energy (MPa) and Poisson's ratio of the small-strain solid.

    `convention` is the form of the energy in words; `mu`, the shear modulus (MPa), is computed from the energy itself,
    so constants of another convention show as a wrong modulus. Raises InputError unless 0 < nu < 0.5 and `mu` > 0.
    """

    energy: Energy
    poisson_ratio: float
    convention: str
    mu: float = field(init=False)

    def __post_init__(self) -> None:
        if not 0.0 < self.poisson_ratio < 0.5:
            text = "must lie between 0 and 0.5, both excluded"
            raise InputError(text, key="poisson_ratio", value=self.poisson_ratio)
        one = np.ones(1)
        # In pure shear j = h = 1 and a = l^2 + l^-2, whose second derivative is 8: W'' = 8 W_a = 4 mu.
        mu = 2.0 * float(self.energy(Strain(2.0 * one, one, one)).data[BY_A, 0])
        if not mu > 0.0:
            raise InputError(
                f"law {self.convention}: its small-strain shear modulus is {mu:g} MPa; it must be positive"
            )
        object.__setattr__(self, "mu", mu)

    @property
    def bulk_ratio(self) -> float:
        """Bulk modulus over shear modulus of the small-strain solid, K/mu."""
        nu = self.poisson_ratio
        return 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu))


def first_invariant(stretch: Array | float) -> Array:
    """First invariant I1 = l^2 + 2/l of an incompressible solid in uniaxial tension at the stretch l."""
    lengths = np.asarray(stretch, float)
    return np.asarray(lengths**2 + 2.0 / lengths)


def same_invariant(first: Array | float) -> Array:
    """Stretch l >= 1 of uniaxial tension with the first invariant ``first``: l^3 - I1 l + 2 = 0; 1 for I1 below 3.

    It compares other states, such as the biaxial state of an inflated dome, with a tensile test: the laws in use depend
    only, or nearly only, on the first invariant.
    """
    invariant = np.maximum(np.asarray(first, float), 3.0)
    # The largest of three real roots, by the cosine of a third of an angle.
    third = np.arccos(np.clip(-np.sqrt(27.0 / invariant**3), -1.0, 1.0)) / 3.0
    return np.asarray(2.0 * np.sqrt(invariant / 3.0) * np.cos(third))
