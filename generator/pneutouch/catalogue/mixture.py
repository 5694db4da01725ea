"""A material mixed from two base resins: what a mixing curve and the catalogue's materials make of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from pneutouch.catalogue.along import Along, Array
from pneutouch.catalogue.library import Library
from pneutouch.errors import InputError
from pneutouch.spec.grade import Grade
from pneutouch.spec.material import AlongArc, Material
from pneutouch.spec.mixing import MixingCurve

_STATIONS = 65
"""Places along the arc at which a grade's modulus is stored; straight between them it is within 1e-3 of the curve."""

_SLACK = 1e-12


@dataclass(frozen=True)
class Mixing:
    """A curve with its moduli resolved; arrays (n,) over its points."""

    curve: MixingCurve
    fraction: Array
    modulus: Array
    elongation: Array

    def modulus_at(self, fraction: Array) -> Array:
        """Shear modulus in MPa: monotone cubic in its logarithm through the points."""
        top = float(self.fraction[-1])
        line = Along(tuple(self.fraction / top), tuple(np.log(self.modulus)))
        return np.asarray(np.exp(line(np.asarray(fraction) / top)))

    def elongation_at(self, fraction: Array) -> Array:
        """Elongation at break in percent, straight between the points where it is known; NaN where none is."""
        known = np.isfinite(self.elongation)
        if not known.any():
            return np.full(np.shape(fraction), np.nan)
        return np.interp(fraction, self.fraction[known], self.elongation[known])


def mixing(soft: str, stiff: str, library: Library, *, asked_by: str = "") -> Mixing:
    """The curve of two base resins. Raises InputError where there is none."""
    curve: MixingCurve = library.load("mixing", f"{soft}+{stiff}", asked_by=asked_by)
    moduli, elongations = [], []
    for point in curve.points:
        if point.material is None:
            moduli.append(point.shear_modulus_MPa)
            elongations.append(point.elongation_at_break_percent or np.nan)
            continue
        material: Material = library.load(
            "materials", point.material, asked_by=f"mixing {soft}+{stiff}: points.material"
        )
        if material.shear_modulus_MPa is None:
            raise InputError(f"mixing {soft}+{stiff}: {point.material} has no shear_modulus_MPa")
        moduli.append(material.shear_modulus_MPa.nominal)
        known = material.elongation_at_break_percent
        elongations.append(np.nan if known is None else known.least)
    return Mixing(
        curve, np.array([p.fraction for p in curve.points]), np.array(moduli, float), np.array(elongations, float)
    )


def mixed_material(grade: Grade, library: Library, where: str) -> Material:
    """The material of a grade; of one that varies the mean over the dome's wall, with its course ``along`` the arc.

    Raises InputError for resins without a curve and for fractions beyond its last point.
    """
    key = f"{where}: membrane.material"
    law = mixing(grade.from_, grade.to, library, asked_by=key)
    top = float(law.fraction[-1])
    for value in grade.fractions:
        if value > top + _SLACK:
            raise InputError(
                f"{key}: fraction = {value:g}: no modulus is known beyond {top:g} of {grade.to} in {grade.from_} "
                f"(printprofiles/mixing); it must be at most that"
            )
    soft: Material = library.load("materials", grade.from_, asked_by=f"{key}.from")
    stiff: Material = library.load("materials", grade.to, asked_by=f"{key}.to")
    arc = np.linspace(0.0, 1.0, _STATIONS)
    fraction = Along(grade.knots, grade.fractions)(arc)
    modulus = law.modulus_at(fraction)
    # The dome's wall has its area even over the height: the weight of an arc position is the cosine of its latitude.
    weight = np.sin(0.5 * np.pi * arc)
    share, mean = float(np.average(fraction, weights=weight)), float(np.average(modulus, weights=weight))
    if grade.is_constant:
        share, mean = grade.fractions[0], float(law.modulus_at(np.array(share)))
    content = _content(grade, soft, stiff, law, share, mean)
    content["elongation_at_break_percent"] = _elongation(law, fraction)
    if not grade.is_constant:
        content["along"] = AlongArc(
            arc=arc.tolist(), stiff_fraction=fraction.tolist(), shear_modulus_MPa=modulus.tolist(),
        ).model_dump()  # fmt: skip
    return Material.model_validate({name: value for name, value in content.items() if value is not None})


def _content(
    grade: Grade, soft: Material, stiff: Material, law: Mixing, share: float, modulus: float
) -> dict[str, Any]:
    source = f"mixing curve {law.curve.soft}+{law.curve.stiff}: {law.curve.assumption}"
    fractions = {name: part for name, part in ((grade.from_, 1 - share), (grade.to, share)) if part > 0}
    whole = grade.is_constant and len(fractions) == 2
    return {
        "title": grade.label, "code": f"{soft.code}{round(100 * share):02d}{'' if grade.is_constant else 'G'}", "kind": "elastomer",
        "base_resins": list(fractions), "colour": _between(soft.colour, stiff.colour, share),
        "density_g_per_cm3": {
            "value": (1 - share) * soft.density_g_per_cm3.nominal + share * stiff.density_g_per_cm3.nominal,
            "source": f"by volume from {grade.from_} and {grade.to}",
        },
        "poisson_ratio": None if soft.poisson_ratio is None else soft.poisson_ratio.model_dump(exclude_none=True),
        "shear_modulus_MPa": {"value": modulus, "source": source},
        "mix": {"fractions": fractions, "source": "asked for: printed by voxels"} if whole else None,
    }  # fmt: skip


def _elongation(law: Mixing, fraction: Array) -> dict[str, Any] | None:
    """The least along the arc: the wall tears where it is stiffest first."""
    least = float(law.elongation_at(fraction).min())
    if not np.isfinite(least):
        return None
    return {"value": least, "source": "straight between the resins of the mixing curve, the least along the arc"}


def _between(one: str, other: str, share: float) -> str:
    mixed = [round((1 - share) * int(one[k : k + 2], 16) + share * int(other[k : k + 2], 16)) for k in (1, 3, 5)]
    return "#" + "".join(f"{part:02X}" for part in mixed)
