"""What the pages on mixes and on the two hard resins state, from the catalogue: ``python -m benchmarks.mixing`` (seconds).

Writes docs/background/mixing.json: the named curves of the shipped pair, how far sensitivities by them differ, and what
every published shear modulus of FLX9985 and FLX9995 predicts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from release.tables.mixing_laws import (
    HARDNESS_READ,
    LONG_TERM,
    SOFT_HARDNESS,
    TENSION_INTERCEPT,
    TENSION_SLOPE,
    THRESHOLD,
    VOXEL_THRESHOLD,
    stiff_moduli,
)

from benchmarks.store import LIBRARY, store
from pneutouch.arrays import Array
from pneutouch.catalogue import Library
from pneutouch.catalogue.mixture import ResolvedMixingCurve, mixing
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.paper_sensor import material_sensor, young_modulus
from pneutouch.selection.mixes import LEVELS, levels
from pneutouch.spec.material import Material
from pneutouch.units import KPA
from pneutouch.workflows.coupons.order import FRACTIONS

SOFT, STIFF = "TangoPlus", "VeroClear"
WHERE = (0.03, 0.06, 0.1, 0.15, 0.2, 0.3)
WHOLE_LEVELS = 24
"""Fractions to the end of the mixture tool's curve, about as far apart as those that are offered."""

RESINS = ("FLX9985", "FLX9995")
PRESSURES_KPA = (0.0, 22.0)

OGDEN = {
    "FLX9985": (-0.0259, 0.6187, 5.3627, 0.5087, 4.0625, -0.2482),
    "FLX9995": (-0.0001, 1.7301, 11.3944, 0.2749, 5.0433, -0.1789),
}
"""Constants c, a of three terms c (x^a - 2^(a-1) x^(-a/2)) of the nominal stress over x, fitted to three dumbbells each of
FLX9785 and FLX9795, the same grades with VeroWhite (repository OSUrobotics/Material_StressStrain_DataFit, of a master's
thesis at Oregon State University). x is read as the strain and the stress as in MPa, which the repository does not state:
so read, its TangoPlus, 40- to 70-DM have 0.15, 0.28, 0.46, 0.84 and 1.3 MPa at 50 to 100 % strain, near the paper's
Table 1, and the curves begin near zero stress."""

STRAINS = {"FLX9985": (0.1, 0.5), "FLX9995": (0.1, 0.4)}
"""Strains of the secants: small, and near the least elongation at break."""


@dataclass(frozen=True)
class MixingCurves:
    """Every curve of a pair.

    Attributes:
        laws: The curves by name, the one in use first.
        stiff: Least shear modulus of the stiff resin, MPa.
        names: Labels of the points.
    """

    laws: dict[str, ResolvedMixingCurve]
    stiff: float
    names: tuple[str, ...]


def curves(library: Library) -> MixingCurves:
    """The shipped curves, the one in use first, and the names of their points."""
    used = mixing(SOFT, STIFF, library)
    assert used.curve.curves is not None
    laws = {name: mixing(SOFT, STIFF, library, curve=name) for name in used.curve.curves.by_name}
    materials: list[Material] = [library.load("materials", str(point.material)) for point in used.curve.points]
    names = tuple(material.title.removesuffix("-DM") for material in materials)
    return MixingCurves(laws, stiff_moduli(library.load("materials", STIFF))[0], names)


class PublishedModulus(NamedTuple):
    """A published shear modulus, or two ends of one: MPa, a short name, its source, what is stated of rate and temperature."""

    low: float
    high: float
    name: str
    origin: str
    conditions: str


def secant(stress: float, strain: float) -> float:
    """Shear modulus of the incompressible neo-Hookean law with this nominal stress at a strain: s/(l - 1/l^2)."""
    stretch = 1.0 + strain
    return stress / (stretch - stretch**-2)


def fitted_stress(name: str, x: float) -> float:
    """The nominal stress of the fit of `OGDEN`, MPa."""
    c = OGDEN[name]
    return sum(c[k] * (x ** c[k + 1] - 2 ** (c[k + 1] - 1) * x ** (-0.5 * c[k + 1])) for k in (0, 2, 4))


def published(name: str, library: Library) -> list[PublishedModulus]:
    """Every published modulus of a resin, that of the material file first."""
    material: Material = library.load("materials", name)
    modulus, shore = material.shear_modulus_MPa, material.shore_a
    strength, elongation = material.tensile_strength_MPa, material.elongation_at_break_percent
    assert modulus is not None and shore is not None and strength is not None and elongation is not None
    pulled = sorted(secant(fitted_stress(name, x), x) for x in STRAINS[name])
    by_hardness = young_modulus(shore.nominal) / 3
    at_break = (secant(strength.least, elongation.most / 100), secant(strength.most, elongation.least / 100))
    at = " and ".join(f"{100 * x:g}" for x in STRAINS[name])
    return [
        PublishedModulus(
            modulus.nominal,
            modulus.nominal,
            "paper, Table 1 (in use)",
            "**the file: paper, Table 1, from E of Liu and Li 2018**",
            "quasi-static; no temperature",
        ),
        PublishedModulus(
            *pulled,
            "tensile test",
            f"FLX97{name[-2:]} pulled, secants at {at} % strain (Oregon State University)",
            "not stated",
        ),
        PublishedModulus(
            by_hardness,
            by_hardness,
            "hardness",
            f"Shore A {shore.nominal:g} (paper, Table 1) by Gent 1958, a third of E",
            "seconds; room temperature",
        ),
        PublishedModulus(
            *at_break,
            "strength at break",
            "vendor's strength over elongation at break, secant",
            "ASTM D412, 500 mm/min; no temperature",
        ),
    ]


def sensitivities(moduli: list[float], library: Library) -> np.ndarray:
    """Sensitivity of the paper's sensor by the atlas, kPa/N: (moduli, pressures)."""
    sensor = material_sensor(library.load("materials", "FLX9995"))
    rows = []
    for modulus in moduli:
        there = sensor.replace(shear_modulus=modulus)
        batch = batch_of(there, [p * KPA for p in PRESSURES_KPA])
        rows.append(respond(batch, there.protocol.steps).lines.sensitivity)
    return np.array(rows)


def hard_resins(library: Library) -> list[dict[str, Any]]:
    """Every published modulus of both resins with the sensitivities that it predicts and their errors, by end of its range."""
    found = []
    for name in RESINS:
        measured = library.load("materials", name).measured
        known = np.array([measured.sensitivity_0kPa_kPa_per_N.nominal, measured.sensitivity_22kPa_kPa_per_N.nominal])
        for entry in published(name, library):
            ends = [entry.low] if entry.low == entry.high else [entry.low, entry.high]
            values = sensitivities(ends, library)
            errors = (values / known - 1).tolist()
            row = {"resin": name, **entry._asdict(), "ends_MPa": ends, "kPa_per_N": values.tolist(), "errors": errors}
            found.append(row)
    return found


def spread(name: str, at: Array, found: MixingCurves, used: str, library: Library) -> dict[str, Any]:
    """How far the sensitivity by one curve is off that by the farthest of the others, over some fractions."""
    known = at <= next(iter(found.laws.values())).curve.common_top + 1e-9
    inside = at[known]
    by_curve = {key: sensitivities(law.modulus_at(inside).tolist(), library)[:, 0] for key, law in found.laws.items()}
    off = np.max([np.abs(np.log(values / by_curve[used])) for values in by_curve.values()], axis=0)
    row = {"fractions": name, "number": int(at.size), "to": float(at[-1]), "unknown": int((~known).sum())}
    return {**row, "median": float(np.exp(np.median(off))), "worst": float(np.exp(off.max()))}


def spreads(found: MixingCurves, library: Library) -> list[dict[str, Any]]:
    """Of all fractions of the mixture tool's curve, and of those that are offered."""
    (name, used), tool = next(iter(found.laws.items())), found.laws["mixture-tool"]
    fine = np.linspace(0.0, float(tool.fraction[-1]), 2001)
    logs = np.log(tool.modulus_at(fine))
    whole = np.interp(np.linspace(logs[0], logs[-1], WHOLE_LEVELS), logs, fine)
    return [
        spread("all of `mixture-tool`", whole, found, "mixture-tool", library),
        spread("offered", levels(used, LEVELS), found, name, library),
    ]


def band(law: ResolvedMixingCurve) -> list[dict[str, float]]:
    """Least modulus, that in use and the greatest at some fractions (MPa), and the standard uncertainty of its logarithm."""
    f = np.array(WHERE)
    low, high = law.band_at(f)
    columns = {"fraction": f, "least": low, "used": law.modulus_at(f), "greatest": high}
    columns["uncertainty"] = np.log(high / low) / np.sqrt(12)
    return [dict(zip(columns, map(float, row), strict=True)) for row in zip(*columns.values(), strict=True)]


def hardness_slopes(library: Library) -> list[float]:
    """Rise of log10 E by Gent's relation from the hardness of mixes, for a fraction of 1."""
    base = young_modulus(SOFT_HARDNESS)
    shores = {name: library.load("materials", name).shore_a.nominal for name in HARDNESS_READ}
    return [float(np.log10(young_modulus(shores[name]) / base)) / f for name, f in HARDNESS_READ.items()]


def measure(library: Library) -> dict[str, Any]:
    """All numbers of both pages."""
    found = curves(library)
    used = next(iter(found.laws.values()))
    points = zip(found.names, used.modulus, used.curve.points, strict=True)
    return {
        "points": [[name, float(mu), p.fraction, p.low, p.high] for name, mu, p in points],
        "tension": [TENSION_INTERCEPT, TENSION_SLOPE],
        "long_term": [list(pair) for pair in LONG_TERM],
        "hardness_read": HARDNESS_READ,
        "hardness_slopes": hardness_slopes(library),
        "thresholds": [THRESHOLD, VOXEL_THRESHOLD],
        "common_top": used.curve.common_top,
        "spreads": spreads(found, library),
        "band": band(used),
        "coupons": list(FRACTIONS),
        "hard_resins": hard_resins(library),
    }


def main() -> None:
    store("mixing", measure(LIBRARY))


if __name__ == "__main__":
    main()
