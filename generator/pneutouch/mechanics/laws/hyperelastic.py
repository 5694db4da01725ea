"""A hyperelastic material: an isochoric energy with Poisson's ratio; its modulus is read off the energy."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from pneutouch.errors import InputError
from pneutouch.mechanics.laws.strain import BY_A, Jet, Strain

Energy = Callable[[Strain], Jet]


@dataclass(frozen=True)
class Hyperelastic:
    """An isochoric energy (MPa) and Poisson's ratio of the small-strain solid.

    `convention` states the energy the parameters belong to; `mu` is read off the energy itself, so a wrong convention
    shows as a wrong modulus.
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
        """K/mu of the small-strain solid."""
        nu = self.poisson_ratio
        return 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu))
