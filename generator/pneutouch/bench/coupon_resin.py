"""Pucks and dumbbells: hardness, density and shear modulus of a resin, and moduli of mixes of two resins."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from pneutouch.bench.coupons import DIGITS, MARK, CouponFindings, ReadingSource
from pneutouch.bench.statistics import Mean, mean, neo_hookean, secant_modulus, shear_from_young
from pneutouch.errors import InputError
from pneutouch.mechanics.paper_sensor import logarithmic_slope, young_modulus
from pneutouch.spec.coupon import LEAST_READINGS, Dumbbell, DumbbellSpecimen, MixedCoupons, Puck
from pneutouch.spec.grade import MixingPoint
from pneutouch.spec.material import STIFFEST_ELASTOMER_MPA, Material, density_problem
from pneutouch.spec.values import Quantity
from pneutouch.wording import rounded

_SECANT = 0.1
"""Strain of the secant modulus."""

_LEAST_POINTS = 3

_FAR_SHORE = 25.0
"""Difference from the shipped hardness, in points, beyond which a note asks for another resin: our choice. Makers state
ranges of 3 to 5 points, and the seven elastomers of the paper lie about 10 apart."""

_MODULI = (0.01, STIFFEST_ELASTOMER_MPA)
"""Range of moduli, MPa, outside which a reading is wrong: our choice; the shipped elastomers have 0.17 to 5.33."""

_FAR_MODULUS = 5.0
"""Ratio to the shipped shear modulus, or its inverse, beyond which a note is given: our choice; published estimates of
one resin differ by a factor of 3 (TangoPlus.toml)."""


def puck(name: str, material: Material, measured: Puck, source: ReadingSource, results: CouponFindings) -> None:
    """Add hardness and density of a resin to ``results``. Raises InputError for a density that no resin has."""
    for key, scale in (("shore_a", "Shore A"), ("shore_d", "Shore D")):
        readings = getattr(measured, key)
        if readings:
            how = f"{scale} of pucks 20 mm x 3 mm, standard deviation over the readings"
            _add(results, source, name, key, mean(readings), how, f"{scale} hardness")
            _compare_hardness(name, key, readings, getattr(material, key), results)
    if measured.shore_a:
        _one_year(name, material, mean(measured.shore_a).value, results)
    if not measured.mass_g:
        return
    mass, diameter, thickness = (np.array(v) for v in (measured.mass_g, measured.diameter_mm, measured.thickness_mm))
    densities = 4e3 * mass / (np.pi * diameter**2 * thickness)
    for place, density in enumerate(densities, start=1):
        problem = density_problem(density, thousandfold="is mass_g in mg?")
        if problem is not None:
            raise InputError(
                f"puck.{name}: puck {place}: mass_g = {mass[place - 1]:g}, diameter_mm = {diameter[place - 1]:g} "
                f"and thickness_mm = {thickness[place - 1]:g} make {density:.3g} g/cm3",
                file=source.where,
                remedy=problem,
            )
    how = "mass over measured volume of pucks"
    _add(results, source, name, "density_g_per_cm3", mean(densities.tolist()), how, "density, g/cm3")


def _compare_hardness(
    name: str, key: str, readings: list[float], shipped: Quantity | None, results: CouponFindings
) -> None:
    if shipped is None:
        return
    farthest = max(readings, key=lambda reading: abs(reading - shipped.nominal))
    if (off := abs(farthest - shipped.nominal)) > _FAR_SHORE:
        results.notes.append(
            f"{name}: {key} = {farthest:g} is {off:.3g} points off the shipped {shipped.nominal:g}; "
            "was another resin measured, or on the other scale?"
        )


def _one_year(name: str, material: Material, fresh: float, results: CouponFindings) -> None:
    """Add the one-year hardness as the measured one plus the published change, so that the ageing stays the same."""
    before, aged = material.shore_a, material.shore_a_one_year
    if before is None or aged is None:
        return
    change = aged.nominal - before.nominal
    kept = aged.model_dump(exclude_none=True, exclude={"low", "high"})
    text = f"hardness {MARK} and a change of {change:+.3g} in a year: {aged.source}"
    results.change(
        "materials", name, ("shore_a_one_year",), **{**kept, "value": rounded(fresh + change, DIGITS), "source": text}
    )


def _add(
    results: CouponFindings, source: ReadingSource, name: str, key: str, value: Mean, how: str, title: str
) -> None:
    text, spread = source.source(how, value.count), rounded(value.spread, DIGITS)
    results.change("materials", name, (key,), value=rounded(value.value, DIGITS), spread=spread, source=text)
    results.figure(name, title, value.value, value.spread, value.count)


@dataclass(frozen=True, slots=True)
class DumbbellModuli:
    """Dumbbells, MPa: mean shear modulus, moduli, spread, their errors, secant Young's moduli; and the method."""

    over: Mean
    moduli: tuple[float, ...]
    spread: float
    errors: tuple[float, ...]
    secants: tuple[float, ...]
    how: str


def pulled(measured: Dumbbell, where: str) -> DumbbellModuli | None:
    """Neo-Hookean shear modulus of the specimens that have a curve; None if none has.

    Raises InputError for too few specimens or points; ``where`` names file and table.
    """
    curves = [specimen for specimen in measured.specimen if specimen.force_N]
    if not curves:
        return None
    if len(curves) < LEAST_READINGS:
        problem = f"{where}: {len(curves)} specimen with a curve"
        raise InputError(problem, remedy=f"at least {LEAST_READINGS}, for a standard deviation")
    most = measured.largest_strain
    fits = [_fit(specimen, most, f"{where}.specimen[{k}]") for k, specimen in enumerate(curves, start=1)]
    moduli, errors = tuple(fit[0] for fit in fits), tuple(fit[1] for fit in fits)
    over = mean(moduli)
    spread = max(over.spread, float(np.sqrt(np.mean(np.square(errors)))))
    secants = tuple(young for _, _, young in fits if young is not None)
    how = f"ASTM D412 die C, neo-Hookean fit to {100 * most:g} % strain, forces after {measured.hold_s:g} s of hold"
    return DumbbellModuli(over, moduli, spread, errors, secants, how)


def dumbbell(name: str, material: Material, measured: Dumbbell, source: ReadingSource, results: CouponFindings) -> None:
    """Add the shear modulus of dumbbells to ``results``. Raises InputError for readings that cannot be used."""
    where = f"{source.where}: dumbbell.{name}"
    if material.kind != "elastomer" and any(specimen.force_N for specimen in measured.specimen):
        raise InputError(f"{material.label} is rigid", file=where, remedy="die C is for an elastomer")
    fit = pulled(measured, where)
    if fit is None:
        return
    over = fit.over
    ratio = 0.5 if material.poisson_ratio is None else material.poisson_ratio.nominal
    secants = [shear_from_young(young, ratio) for young in fit.secants]
    compared = f"; E at 10 % over 2(1+nu) gives {np.mean(secants):.3g} MPa" if secants else ""
    how = (
        f"dumbbells {fit.how}; low and high: least and greatest dumbbell; standard error of the mean {over.error:.2g} "
        f"MPa, of the fits {max(fit.errors):.2g} MPa at most{compared}"
    )
    value, low, high, spread = (rounded(x, DIGITS) for x in (over.value, min(fit.moduli), max(fit.moduli), fit.spread))
    text, keys = source.source(how, over.count), ("shear_modulus_MPa",)
    results.change("materials", name, keys, value=value, low=low, high=high, spread=spread, source=text)
    results.figure(name, "shear modulus, MPa (neo-Hookean)", over.value, fit.spread, over.count)
    if secants:
        results.figure(name, "shear modulus, MPa (secant E at 10 %)", float(np.mean(secants)), None, len(secants))
    _compare_modulus(name, over.value, material.shear_modulus_MPa, results)
    if material.law is not None:
        results.notes.append(
            f"{name} has a hyperelastic law ({material.law.name}), which predictions use; the shear modulus does not "
            "change it"
        )


def _compare_modulus(name: str, modulus: float, shipped: Quantity | None, results: CouponFindings) -> None:
    if shipped is None:
        return
    times = modulus / shipped.nominal
    if not 1 / _FAR_MODULUS <= times <= _FAR_MODULUS:
        results.notes.append(
            f"{name}: shear_modulus_MPa = {modulus:.3g} is {times:.2g} times the shipped {shipped.nominal:g}; "
            "was another resin measured, or in other units than N and mm?"
        )


def _check_rising(specimen: DumbbellSpecimen, where: str) -> None:
    """Raise InputError unless forces rise with extension; neighbours may be equal, the first and last not."""
    points = sorted(zip(specimen.extension_mm, specimen.force_N, strict=True))
    pairs = [*pairwise(points), (points[0], points[-1])]
    for k, ((before, lower), (after, higher)) in enumerate(pairs, start=1):
        if higher < lower or (k == len(pairs) and higher == lower):
            raise InputError(
                f"{where}.force_N: {lower:g} N at extension_mm = {before:g}, {higher:g} N at {after:g}; it must rise "
                "with extension_mm; give the points of the loading, none after a break"
            )


def _fit(specimen: DumbbellSpecimen, most: float, where: str) -> tuple[float, float, float | None]:
    """Shear modulus, its standard error, secant Young's modulus at 10 % strain (None if not reached), MPa."""
    _check_rising(specimen, where)
    area = float(np.median(specimen.width_mm) * np.median(specimen.thickness_mm))
    stretch = 1 + np.array(specimen.extension_mm) / specimen.gauge_length_mm
    stress = np.array(specimen.force_N) / area
    near = stretch - 1 <= most * (1 + 1e-9)
    if near.sum() < _LEAST_POINTS:
        raise InputError(
            f"{near.sum()} points up to a strain of {most:g} (extension_mm = {most * specimen.gauge_length_mm:g})",
            file=where,
            remedy=f"at least {_LEAST_POINTS}",
        )
    modulus, error = neo_hookean(stretch[near], stress[near])
    if not _MODULI[0] <= modulus <= _MODULI[1]:
        raise InputError(
            f"force_N over width_mm and thickness_mm makes a shear modulus of {modulus:.4g} MPa; an elastomer "
            f"has from {_MODULI[0]:g} to {_MODULI[1]:g} MPa; must be forces in N and lengths in mm",
            file=where,
        )
    return modulus, error, secant_modulus(stretch, stress, _SECANT)


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

    def point(self, source: ReadingSource) -> MixingPoint:
        """Point of a mixing curve, not validated: the curve's file is checked as a whole."""
        return MixingPoint.model_construct(
            fraction=self.fraction,
            shear_modulus_MPa=rounded(self.modulus, DIGITS),
            shear_modulus_spread_MPa=rounded(self.spread, DIGITS),
            source=source.source(self.how, self.count),
        )


def stiffness(
    pair: str, soft: Material, stiff: Material, measured: Sequence[MixedCoupons], source: ReadingSource
) -> list[MixModulus]:
    """Modulus of each measured fraction, in ascending order.

    From dumbbells, else from hardness: Gent's relation (1958) is used only for ratios, so the modulus is that of the
    soft resin, measured or from the catalogue, times the ratio to the modulus at fraction 0 of the same set. Raises
    InputError for readings that cannot be used, and where the modulus does not rise with the fraction."""
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
    _check_rising_curve(moduli, where, soft, stiff)
    return moduli


@dataclass(frozen=True, slots=True)
class _Base:
    """The soft resin: its hardness in this set, its modulus with standard deviation (MPa), and the modulus's origin."""

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


def _check_rising_curve(moduli: Sequence[MixModulus], where: str, soft: Material, stiff: Material) -> None:
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
