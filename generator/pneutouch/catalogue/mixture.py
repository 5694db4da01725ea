"""A membrane's material that no file holds: mixed from two base resins by a mixing curve, or at another temperature."""

from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from pneutouch.arrays import Array, hermite
from pneutouch.catalogue.library import Library
from pneutouch.errors import InputError, shown
from pneutouch.shape.dome import DomeShape
from pneutouch.spec.grade import FROM_CURVE, Grade, MixingCurve, MixingPoint
from pneutouch.spec.material import (
    STIFFEST_ELASTOMER_MPA,
    ArcGrading,
    Material,
    MixByCurve,
    Relaxation,
    density_problem,
    elastomer_modulus_problem,
)
from pneutouch.spec.membrane_table import Membrane
from pneutouch.spec.values import Quantity


@dataclass(frozen=True, slots=True)
class ArcProfile:
    """Values (n,) at knots (n,) that rise from 0 at the pole to 1 at the rim; n = 1 is a constant.

    The cubic between two knots has no extremum there: slopes by Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5,
    300-304, 1984, DOI 10.1137/0905021), one-sided at the ends.
    """

    knots: tuple[float, ...]
    values: tuple[float, ...]

    def __call__(self, arc: Array) -> Array:
        """The quantity at arc positions of any shape; constant beyond the first and the last knot."""
        if len(self.knots) == 1:
            return np.full(np.shape(arc), self.values[0])
        x, y = np.array(self.knots), np.array(self.values)
        return hermite(np.clip(arc, x[0], x[-1]), x, y, _slopes(x, y))


def _slopes(x: Array, y: Array) -> Array:
    step, rise = np.diff(x), np.diff(y) / np.diff(x)
    if rise.size == 1:
        return np.repeat(rise, 2)
    inner = np.zeros(rise.size - 1)
    same = rise[:-1] * rise[1:] > 0
    w1, w2 = 2 * step[1:] + step[:-1], step[1:] + 2 * step[:-1]
    inner[same] = (w1 + w2)[same] / (w1[same] / rise[:-1][same] + w2[same] / rise[1:][same])
    return np.concatenate([[_end(step[:2], rise[:2])], inner, [_end(step[:-3:-1], rise[:-3:-1])]])


def _end(step: Array, rise: Array) -> float:
    """Slope at an end from three points, one-sided, limited so that the curve stays monotone."""
    slope = float(((2 * step[0] + step[1]) * rise[0] - step[0] * rise[1]) / (step[0] + step[1]))
    if slope * rise[0] <= 0:
        return 0.0
    if rise[0] * rise[1] <= 0 and abs(slope) > 3 * abs(rise[0]):
        return float(3 * rise[0])
    return slope


_STATIONS = 65
"""Number of arc positions at which a grade's modulus is stored; linear between them it is within 1e-3 of the curve."""

_SLACK = 1e-12
_FINE = 2001
"""Number of fractions among which the stiffest mix that a wall may have is searched."""


@dataclass(frozen=True)
class ResolvedMixingCurve:
    """A mixing curve with arrays (n,) over its points: modulus, spread (MPa) and elongation (%), NaN if unknown."""

    curve: MixingCurve
    fraction: Array
    modulus: Array
    spread: Array
    elongation: Array

    def modulus_at(self, fraction: Array) -> Array:
        """Shear modulus in MPa: monotone cubic in its logarithm through the points."""
        top = float(self.fraction[-1])
        line = ArcProfile(tuple(self.fraction / top), tuple(np.log(self.modulus)))
        return np.asarray(np.exp(line(np.asarray(fraction) / top)))

    @property
    def wall_top(self) -> float:
        """The greatest fraction, to four decimals, at which `stiffest_at` does not exceed the limit for a wall."""
        at = np.linspace(0.0, float(self.fraction[-1]), _FINE)
        stiff = self.stiffest_at(at) > STIFFEST_ELASTOMER_MPA
        if not stiff.any():
            return float(at[-1])
        return float(np.floor(1e4 * at[max(int(np.argmax(stiff)) - 1, 0)]) / 1e4)

    def stiffest_at(self, fraction: Array) -> Array:
        """Greatest modulus in MPa: the upper end of an assumed curve's band, else the curve itself."""
        return self.band_at(fraction)[1] if self.curve.is_assumed else self.modulus_at(fraction)

    def band_at(self, fraction: Array) -> tuple[Array, Array]:
        """Least and greatest modulus in MPa, by curves through the points at their ``high`` and ``low`` fractions.

        The curves are linear in the logarithm. Nothing is known beyond the stiffest point, so no modulus of the band
        exceeds the modulus there.
        """
        middle, logs = self.modulus_at(fraction), np.log(self.modulus)
        far = [np.array([getattr(point, side) for point in self.curve.points]) for side in ("high", "low")]
        low, high = (np.exp(np.interp(fraction, at, logs)) for at in far)
        return np.minimum(low, middle), np.maximum(high, middle)

    def spread_at(self, fraction: Array) -> Array:
        """Standard deviation in MPa, its share of the modulus interpolated linearly; NaN next to an unknown one."""
        return np.asarray(np.interp(fraction, self.fraction, self.spread / self.modulus) * self.modulus_at(fraction))

    def elongation_at(self, fraction: Array) -> Array:
        """Elongation at break in percent, linear between the points where it is known; NaN if none is."""
        known = np.isfinite(self.elongation)
        if not known.any():
            return np.full(np.shape(fraction), np.nan)
        return np.interp(fraction, self.fraction[known], self.elongation[known])


def mixing(
    soft: str,
    stiff: str,
    library: Library,
    *,
    curve: str | None = None,
    file: str | None = None,
    key: str | None = None,
) -> ResolvedMixingCurve:
    """The mixing curve of two base resins: the one named ``curve``, else the one in use.

    Raises InputError if there is none, if it is of another pair, or if its modulus does not rise with the fraction.
    """
    paths = library.paths("mixing")
    if f"{soft}+{stiff}" not in paths:
        turned = f"{stiff}+{soft}" in paths
        hint = f"the soft resin goes first: {stiff}" if turned else f"known: {', '.join(paths) or 'none'}"
        remedy = f"{hint} (printprofiles/mixing)"
        raise InputError(f"no mixing curve of {stiff} in {soft}", file=file, key=key, remedy=remedy)
    content: MixingCurve = library.load("mixing", f"{soft}+{stiff}", file=file, key=key)
    where = str(paths[f"{soft}+{stiff}"])
    if (content.soft, content.stiff) != (soft, stiff):
        raise InputError(
            f"soft = {shown(content.soft)}, stiff = {shown(content.stiff)}: must be {shown(soft)} and "
            f"{shown(stiff)}, as the file's name",
            file=where,
        )
    rows = np.array([_resolved(point, content, library, where) for point in content.points])
    fraction = np.array(content.through(_key(content, curve, file, key)))
    for (f, a), (g, b) in pairwise(zip(fraction, rows[:, 0], strict=True)):
        if b <= a:
            raise InputError(
                f"points: a shear modulus of {b:g} MPa at fraction {g:g} after {a:g} MPa at {f:g}",
                file=where,
                remedy=f"it must rise with the fraction of {stiff}",
            )
    return ResolvedMixingCurve(content, fraction, *rows.T)


def _key(content: MixingCurve, curve: str | None, file: str | None, key: str | None) -> str:
    """Key of a point that holds its fraction on the curve of this name. Raises InputError for an unknown name."""
    known = {} if content.curves is None else content.curves.by_name
    if curve is not None and curve not in known:
        pair = f"{content.soft}+{content.stiff}"
        remedy = f"known: {', '.join(known)}" if known else f"leave it out: {pair} has one curve, without a name"
        raise InputError(
            f"{pair} has no mixing curve of this name",
            file=file,
            key=f"{key or 'membrane.material'}.curve",
            value=curve,
            remedy=remedy,
        )
    return "fraction" if curve is None else known[curve]


def _resolved(point: MixingPoint, curve: MixingCurve, library: Library, where: str) -> tuple[float, float, float]:
    """Modulus and its spread (MPa) and elongation at break (%) of a point; spread and elongation NaN if unknown."""
    if point.material is None:
        assert point.shear_modulus_MPa is not None
        spread, break_percent = point.shear_modulus_spread_MPa, point.elongation_at_break_percent
        return (
            point.shear_modulus_MPa,
            np.nan if spread is None else spread,
            np.nan if break_percent is None else break_percent,
        )
    material: Material = library.load("materials", point.material, file=where, key="points.material")
    foreign = [resin for resin in material.base_resins if resin not in (curve.soft, curve.stiff)]
    if foreign:
        raise InputError(
            f"has {', '.join(foreign)} in it",
            file=where,
            key="points.material",
            value=point.material,
            remedy=f"must be of {curve.soft} and {curve.stiff} alone",
        )
    if material.shear_modulus_MPa is None:
        raise InputError("has no shear_modulus_MPa", file=where, key="points.material", value=point.material)
    known = material.elongation_at_break_percent
    spread = material.shear_modulus_MPa.spread
    return (
        material.shear_modulus_MPa.nominal,
        np.nan if spread is None else spread,
        np.nan if known is None else known.least,
    )


def mixed_material(
    grade: Grade, library: Library, *, file: str | None, key: str = "membrane.material", shape: DomeShape | None = None
) -> Material:
    """The material of a grade. If its mix varies, the modulus is the mean over the wall of a ``shape`` (None: a
    hemisphere), and ``along`` holds the moduli along the arc.

    Raises InputError for resins without a curve, for fractions beyond its last point, and for a mix that is stiffer or
    denser than a membrane may be.
    """
    # The names first: of an unknown resin there is no curve either, and the error would name the pair.
    soft: Material = library.load("materials", grade.from_, file=file, key=f"{key}.from")
    stiff: Material = library.load("materials", grade.to, file=file, key=f"{key}.to")
    law = mixing(grade.from_, grade.to, library, curve=grade.curve, file=file, key=key)
    top = float(law.fraction[-1])
    for value in grade.fractions:
        if value > top + _SLACK:
            problem = f"no modulus is known beyond {top:g} of {grade.to} in {grade.from_} (printprofiles/mixing)"
            label, remedy = f"{key}: fraction", "it must be at most that"
            raise InputError(problem, file=file, key=label, value=value, remedy=remedy)
    arc = np.linspace(0.0, 1.0, _STATIONS)
    fraction = ArcProfile(grade.knots, grade.fractions)(arc)
    weight = (shape or Membrane().dome).weights(arc)
    share = grade.fractions[0] if grade.is_constant else float(np.average(fraction, weights=weight))
    _check_soft(grade, law, fraction, file, key)
    content = _content(grade, soft, stiff, share)
    density = content["density_g_per_cm3"]["value"]
    wrong = density_problem(density)
    if wrong is not None:
        raise InputError(f"a mix of {density:.3g} g/cm3 {wrong}", file=file, key=key, value=grade.label)
    content["shear_modulus_MPa"] = _modulus(law, fraction, weight)
    content["elongation_at_break_percent"] = _elongation(law, fraction)
    content["curves"] = _by_curves(grade, library, law, fraction, weight)
    if not grade.is_constant:
        content["along"] = ArcGrading(
            arc=arc.tolist(), stiff_fraction=fraction.tolist(), shear_modulus_MPa=law.modulus_at(fraction).tolist()
        ).model_dump()
    return Material.model_validate({name: value for name, value in content.items() if value is not None})


def _check_soft(grade: Grade, law: ResolvedMixingCurve, fraction: Array, file: str | None, key: str) -> None:
    """Raise InputError if the modulus of the mix, or its upper bound, is anywhere more than a membrane may have."""
    end = law.stiffest_at(fraction)
    worst = int(np.argmax(end))
    problem = elastomer_modulus_problem(float(end[worst]))
    if problem is not None:
        pair, top = f"{grade.from_}+{grade.to}", law.wall_top
        less = f"take at most {top:g} of {grade.to}, or " if top > 0 else ""
        raise InputError(
            f"by the mixing curve {pair} its shear modulus of {problem}",
            file=file,
            key=f"{key}: fraction",
            value=float(fraction[worst]),
            remedy=f"{less}correct printprofiles/mixing/{pair}.toml",
        )


def _by_curves(
    grade: Grade, library: Library, used: ResolvedMixingCurve, fraction: Array, weight: Array
) -> list[dict[str, Any]]:
    """`MixByCurve` data of each curve of the pair, the softest first; beyond its last point its modulus is constant."""
    names = {} if used.curve.curves is None else used.curve.curves.by_name
    laws = {name: mixing(grade.from_, grade.to, library, curve=name) for name in names}
    entries, last = [], float(used.fraction[-1])
    for name, law in sorted(laws.items(), key=lambda item: -float(item[1].fraction[-1])):
        top = float(law.fraction[-1])
        by_curve = MixByCurve(
            curve=name,
            place="in use" if top == last else "stiffer" if top < last else "softer",
            shear_modulus_MPa=_modulus(law, fraction, weight),
            elongation_at_break_percent=_elongation(law, fraction),
            along_MPa=None if grade.is_constant else law.modulus_at(fraction).tolist(),
            beyond=bool(fraction.max() > top + _SLACK),
        )
        entries.append(by_curve.model_dump(exclude_none=True))
    return entries


def _modulus(law: ResolvedMixingCurve, fraction: Array, weight: Array) -> Quantity:
    """Mean modulus over the wall, with the band of an assumed curve, or the spread of a measured one if it is known.

    The whole wall is at the same end of the band: all of it has the error of the one curve.
    """
    low = high = spread = None
    if law.curve.is_assumed:
        low, high = (float(np.average(end, weights=weight)) for end in law.band_at(fraction))
    elif np.isfinite(law.spread).all():
        spread = float(np.average(law.spread_at(fraction), weights=weight))
    value = float(np.average(law.modulus_at(fraction), weights=weight))
    source = f"{FROM_CURVE} {law.curve.soft}+{law.curve.stiff}: {law.curve.assumption}"
    return Quantity(value=value, low=low, high=high, spread=spread, source=source)


REFERENCE_C, HELD_S = 20.0, 600.0
"""Temperature, about that of the materials' data, and time of a press over which a modulus counts as relaxed."""


def at_temperature(material: Material, celsius: float, where: str) -> Material:
    """The material at a temperature: relaxation times and, of what is not relaxed after `HELD_S`, the modulus shift.

    Raises InputError for a material without a shift, and beyond the temperatures of its table."""
    if celsius == REFERENCE_C:
        return material
    reference = next((series for series in material.relaxation if series.shift), None)
    refused = partial(InputError, file=where, key="environment.temperature_C", value=celsius)
    if reference is None or material.law is not None or material.shear_modulus_MPa is None:
        remedy = f"give {REFERENCE_C:g}, about that of its data"
        raise refused(f"not known how {material.label} changes with temperature", remedy=remedy)
    at, factors = zip(*reference.shift, strict=True)
    if not at[0] <= celsius <= at[-1]:
        raise refused(f"the data of {material.label} do not cover it", remedy=f"give {at[0]:g} to {at[-1]:g}")
    factor = float(np.exp(np.interp(celsius, at, np.log(factors))))
    left, usual = (1.0 - sum(term.share for term in one.terms) for one in (_shifted(reference, factor), reference))
    stiffer = left / usual
    modulus = material.shear_modulus_MPa
    moved = {k: stiffer * v for k in ("value", "low", "high") if (v := getattr(modulus, k)) is not None}
    source = f"{modulus.source}; times {stiffer:.3g} at {celsius:g} C, by what is not relaxed after {HELD_S:g} s"
    return material.model_copy(
        update={
            "title": f"{material.title} at {celsius:g} °C",
            "shear_modulus_MPa": modulus.model_copy(update={**moved, "source": source}),
            "relaxation": [_shifted(series, factor) for series in material.relaxation],
        }
    )


def _shifted(series: Relaxation, factor: float) -> Relaxation:
    """A series with all times multiplied; the part of a term that `HELD_S` does not relax joins the relaxed modulus,
    as far as it differs from that at the temperature of the series."""
    terms = []
    for term in series.terms:
        longer = factor * term.time_s
        kept = 1.0 - float(np.exp(-HELD_S / longer) - np.exp(-HELD_S / term.time_s))
        terms.append(term.model_copy(update={"share": kept * term.share, "time_s": longer}))
    return series.model_copy(update={"terms": terms})


def _content(grade: Grade, soft: Material, stiff: Material, share: float) -> dict[str, Any]:
    fractions = {name: part for name, part in ((grade.from_, 1 - share), (grade.to, share)) if part > 0}
    whole = grade.is_constant and len(fractions) == 2
    return {
        "title": grade.label,
        "code": f"{soft.code}{round(100 * share):02d}{'' if grade.is_constant else 'G'}",
        "kind": "elastomer",
        "base_resins": list(fractions),
        "colour": _between(soft.colour, stiff.colour, share),
        "density_g_per_cm3": {
            "value": (1 - share) * soft.density_g_per_cm3.nominal + share * stiff.density_g_per_cm3.nominal,
            "source": f"by volume from {grade.from_} and {grade.to}",
        },
        "poisson_ratio": None if soft.poisson_ratio is None else soft.poisson_ratio.model_dump(exclude_none=True),
        "mix": {"fractions": fractions, "source": "as designed: printed by voxels"} if whole else None,
    }


def _elongation(law: ResolvedMixingCurve, fraction: Array) -> Quantity | None:
    """Least elongation at break along the arc, %, where the wall tears first; None if unknown."""
    least = float(law.elongation_at(fraction).min())
    if not np.isfinite(least):
        return None
    source = "straight between the resins of the mixing curve, the least along the arc"
    return Quantity(value=least, source=source)


def _between(one: str, other: str, share: float) -> str:
    mixed = [round((1 - share) * int(one[k : k + 2], 16) + share * int(other[k : k + 2], 16)) for k in (1, 3, 5)]
    return "#" + "".join(f"{part:02X}" for part in mixed)
