"""Write docs/background/hard-resins.md, published shear moduli of FLX9985 and FLX9995: ``python -m benchmarks.hard_resins``."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from pneutouch.catalogue import Library
from pneutouch.mechanics.atlas.batches import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.uncertainty.hardness import young_modulus
from pneutouch.spec.material import Material
from pneutouch.units import KPA

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "background" / "hard-resins.md"
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


class PublishedModulus(NamedTuple):
    """A published shear modulus, or two ends of one: MPa, its origin, what is stated of rate and temperature."""

    low: float
    high: float
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
            "**the file: paper, Table 1, from E of Liu and Li 2018**",
            "quasi-static; no temperature",
        ),
        PublishedModulus(
            *pulled, f"FLX97{name[-2:]} pulled, secants at {at} % strain (Oregon State University)", "not stated"
        ),
        PublishedModulus(
            by_hardness,
            by_hardness,
            f"Shore A {shore.nominal:g} (paper, Table 1) by Gent 1958, a third of E",
            "seconds; room temperature",
        ),
        PublishedModulus(
            *at_break, "vendor's strength over elongation at break, secant", "ASTM D412, 500 mm/min; no temperature"
        ),
    ]


def sensitivities(moduli: list[float], library: Library) -> np.ndarray:
    """Sensitivity of the paper's sensor by the atlas, kPa/N: (moduli, pressures)."""
    sensor = material_sensor(library.load("materials", "FLX9995"))
    rows = []
    for modulus in moduli:
        there = sensor.replace(shear_modulus=modulus)
        batch = batch_of(there, [p * KPA for p in PRESSURES_KPA])
        rows.append(respond(batch, there.protocol.steps).lines.sensitivity_kPa_per_N)
    return np.array(rows)


def table(library: Library) -> list[str]:
    """The Markdown table of both resins."""
    lines = [
        "| resin | mu, MPa | from | rate and temperature | S at 0 kPa | S at 22 kPa | off Table S1 at 0, 22 kPa |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in RESINS:
        measured = library.load("materials", name).measured
        known = np.array([measured.sensitivity_0kPa_kPa_per_N.nominal, measured.sensitivity_22kPa_kPa_per_N.nominal])
        for entry in published(name, library):
            ends = [entry.low] if entry.low == entry.high else [entry.low, entry.high]
            values = sensitivities(ends, library)
            off = 100 * (values / known - 1)
            cells = [f"{end:.3g}" for end in ends], *([f"{s:.2f}" for s in values[:, k]] for k in (0, 1))
            mu, first, last = (" to ".join(cell) for cell in cells)
            both = " to ".join(f"{a:+.0f}, {b:+.0f} %" for a, b in off)
            lines.append(f"| {name} | {mu} | {entry.origin} | {entry.conditions} | {first} | {last} | {both} |")
    return lines


def page(library: Library) -> str:
    """The whole page."""
    lines = [
        "# The moduli of FLX9985 and FLX9995",
        "",
        "`python -m benchmarks.hard_resins` writes this page. Every published shear modulus of the two stiffest digital "
        "materials that could be read, and the sensitivity of the paper's sensor with it (kPa/N, by the atlas, no dead volume):",
        "",
        *table(library),
        "",
        "**Which one is used, and why.** The files keep the values of the paper's Table 1: its Table S1 then tests the "
        "model, not our choice of a modulus. Their `low` and `high` are the least and the greatest of this table.",
        "",
        "**What follows for the model.** For FLX9995 the paper's 5.33 MPa is the least of all published values. The others "
        "are greater, and with them most of the factor of two between model and measurement is gone: the modulus "
        "explains it, not the model alone. For FLX9985 the values lie on both sides of the paper's. The other five resins have relaxed "
        "moduli, these two a quasi-static one. No relaxed modulus of either is published.",
        "",
        "**How they were read.** Hardness: Gent's relation (1958) and a third of E. Vendor: the neo-Hookean modulus with the "
        "sheet's strength at its elongation at break, so at another rate than the sensor's. Oregon State University: the "
        "fits of the repository OSUrobotics/Material_StressStrain_DataFit (three dumbbells a grade, TangoPlus with "
        "VeroWhite), strain and MPa assumed, since it states neither; so read its softer grades have the moduli of the "
        "paper's Table 1 within a quarter.",
        "",
        "**Not counted.** E = 11 MPa of an FLX9895 in a structural program, without test or source; its soft resin is not "
        "TangoPlus. The vendor's Agilus30 mixes with the same two digits. The tables of Liu and Li (Eng. Fract. Mech. 199, "
        "372-379, 2018) were not within reach; their E follows from the paper's mu.",
        "",
    ]
    return "\n".join(lines)


def main() -> None:
    PAGE.write_text(page(Library((ROOT,))), encoding="utf-8")
    print("wrote docs/background/hard-resins.md")


if __name__ == "__main__":
    main()
