"""Coupons of two resins in known fractions: the modulus of each mix, by dumbbells or by hardness ratio."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from pneutouch.bench.finding import ReadingSource, rounded
from pneutouch.bench.resin import pulled
from pneutouch.bench.statistics import Mean, mean
from pneutouch.errors import InputError
from pneutouch.mechanics.uncertainty.hardness import logarithmic_slope, young_modulus
from pneutouch.spec.coupon import MixedCoupons
from pneutouch.spec.material import Material

_HARDEST = 95.0
"""Greatest Shore A that a modulus is derived from: above it the scale is compressed and Gent's relation diverges. ASTM
D2240 uses the D scale for readings above 90 A; our choice allows for the scatter of a puck of 90."""

_DUMBBELLS, _HARDNESS = "dumbbells", "hardness, by ratio"


@dataclass(frozen=True, slots=True)
class MixModulus:
    """Shear modulus of one mix in MPa with its standard deviation, the number of measurements and the method."""

    fraction: float
    modulus: float
    spread: float
    count: int
    by: str
    how: str

    def content(self, source: ReadingSource) -> dict[str, Any]:
        """The point of a mixing curve."""
        return {
            "fraction": self.fraction,
            "shear_modulus_MPa": rounded(self.modulus),
            "shear_modulus_spread_MPa": rounded(self.spread),
            "source": source.source(self.how, self.count),
        }


def stiffness(
    pair: str, soft: Material, stiff: Material, measured: Sequence[MixedCoupons], source: ReadingSource
) -> list[MixModulus]:
    """Modulus of every fraction that was measured.

    By its dumbbells, else by its hardness: Gent's relation (1958) is used for ratios alone, so the modulus is that of
    the soft resin, measured or from the catalogue, times the ratio to the modulus at fraction 0 of the same set. Raises
    InputError for readings that cannot be used, and where the modulus falls with the fraction."""
    where = f"{source.where}: mixing.{pair}"
    moduli, by_hardness = [], []
    for k, one in enumerate(measured, start=1):
        place = f"{where}[{k}]"
        dumbbells = pulled(one.dumbbell, f"{place}.dumbbell")
        if dumbbells is not None:
            how = f"dumbbells of {100 * one.fraction:g} % {stiff.title}, {dumbbells.how}"
            over = dumbbells.over
            moduli.append(MixModulus(one.fraction, over.value, dumbbells.spread, over.count, _DUMBBELLS, how))
        elif one.shore_a:
            by_hardness.append((place, one))
    if by_hardness:
        base = _base(soft, measured, moduli, where)
        moduli += [_by_hardness(place, one, base) for place, one in by_hardness]
    moduli.sort(key=lambda point: point.fraction)
    _check_rising(moduli, where, soft, stiff)
    return moduli


@dataclass(frozen=True, slots=True)
class _Base:
    """The soft resin: its hardness in this set, its modulus, and the origin of that."""

    shore: Mean
    modulus: float
    spread: float
    origin: str


def _base(soft: Material, measured: Sequence[MixedCoupons], moduli: Sequence[MixModulus], where: str) -> _Base:
    at_zero = next((one for one in measured if one.fraction == 0 and one.shore_a), None)
    if at_zero is None:
        raise InputError(
            "hardness gives a modulus by its ratio to the soft resin's alone; shore_a at fraction = 0 is "
            "missing; measure it on the same day, or pull dumbbells",
            file=where,
        )
    shore = mean(at_zero.shore_a)
    if moduli and moduli[0].fraction == 0:
        return _Base(shore, moduli[0].modulus, moduli[0].spread, "the dumbbells of it")
    known = soft.shear_modulus_MPa
    assert known is not None
    return _Base(shore, known.nominal, known.spread or 0.0, f"{soft.title} in the catalogue")


def _by_hardness(place: str, one: MixedCoupons, base: _Base) -> MixModulus:
    shore = mean(one.shore_a)
    for value in (shore.value, base.shore.value):
        if value > _HARDEST:
            raise InputError(
                f"{place}.shore_a: {value:.3g} on average; a modulus follows from at most {_HARDEST:g} on the A scale; "
                "pull dumbbells of this mix"
            )
    ratio = young_modulus(shore.value) / young_modulus(base.shore.value)
    modulus = base.modulus * ratio
    # Of the soft resin itself the ratio is one, whatever its hardness.
    relative = [base.spread / base.modulus]
    if one.fraction > 0:
        relative += [logarithmic_slope(each.value) * each.spread for each in (shore, base.shore)]
    how = (
        f"Shore A {shore.value:.3g} over {base.shore.value:.3g} of the soft resin by Gent 1958, ratio {ratio:.3g}, "
        f"times {base.modulus:.3g} MPa, {base.origin}; weaker than dumbbells"
    )
    return MixModulus(one.fraction, modulus, modulus * math.hypot(*relative), shore.count, _HARDNESS, how)


def _check_rising(moduli: Sequence[MixModulus], where: str, soft: Material, stiff: Material) -> None:
    points = [(point.fraction, point.modulus, point.by) for point in moduli]
    if points and points[0][0] > 0 and soft.shear_modulus_MPa is not None:
        points.insert(0, (0.0, soft.shear_modulus_MPa.nominal, "the catalogue"))
    for (f, low, by), (g, high, how) in pairwise(points):
        if high <= low:
            raise InputError(
                f"{high:.3g} MPa at fraction = {g:g} ({how}) after {low:.3g} MPa at {f:g} ({by})",
                file=where,
                remedy=(
                    f"it must rise with {stiff.title}: were two mixes changed over? Leave the worse reading out where "
                    "they differ by scatter alone"
                ),
            )
