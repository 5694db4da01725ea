"""Mixes of two resins in known fractions, to be printed as coupons."""

from dataclasses import dataclass

from pneutouch.catalogue import Library
from pneutouch.catalogue.mixture import mixed_material, mixing
from pneutouch.errors import InputError
from pneutouch.spec.grade import Grade
from pneutouch.spec.material import Material

FRACTIONS = (0.0, 0.03, 0.06, 0.1, 0.15, 0.2, 0.27, 0.35)
"""Volume fractions of the stiff resin that are printed: our own choice for TangoPlus with VeroClear, whose curve ends
at 35.6 %. By each curve of that pair the modulus rises by less than 2.5 times from one to the next, as far as the curve
is known (docs/background/mixing.md)."""


@dataclass(frozen=True, slots=True)
class CouponMix:
    """One fraction of a pair ``SOFT+STIFF`` and its resins."""

    pair: str
    fraction: float
    material: Material

    @property
    def about(self) -> str:
        """Name of its pieces: ``TangoPlus+VeroClear-15``."""
        return f"{self.pair}-{100 * self.fraction:g}"


def resins_of(pair: str, *, file: str | None = None, key: str) -> tuple[str, str]:
    """The soft and the stiff resin of ``SOFT+STIFF``. Raises InputError for anything else."""
    names = [name.strip() for name in pair.split("+")]
    if len(names) != 2 or not all(names) or names[0] == names[1]:
        raise InputError("write two resins, SOFT+STIFF, such as TangoPlus+VeroClear", file=file, key=key, value=pair)
    return names[0], names[1]


def blends(pair: str, library: Library) -> list[CouponMix]:
    """Mixes of a pair to print, up to the end of its mixing curve or to the stiffness that a membrane may have.

    Raises InputError if there is no curve."""
    soft, stiff = resins_of(pair, key="mixing")
    for name in (soft, stiff):
        library.load("materials", name, key="mixing")
    top = mixing(soft, stiff, library, key="mixing").wall_top
    grades = [
        Grade.model_validate({"from": soft, "to": stiff, "fraction": fraction})
        for fraction in FRACTIONS
        if fraction <= top
    ]
    pair = f"{soft}+{stiff}"
    return [CouponMix(pair, g.fractions[0], mixed_material(g, library, file=None, key="mixing")) for g in grades]
