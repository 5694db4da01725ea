"""Write docs/background/hard-resins.md with its chart: published shear moduli of FLX9985 and FLX9995: ``python -m benchmarks.hard_resins``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from pneutouch.catalogue import Library
from pneutouch.mechanics.atlas.batches import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.uncertainty.hardness import young_modulus
from pneutouch.report.style import ACCENT, FAINT, INK, LINES, MARKERS, MUTED, figure, svg
from pneutouch.spec.material import Material
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes

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
        rows.append(respond(batch, there.protocol.steps).lines.sensitivity_kPa_per_N)
    return np.array(rows)


class PredictedRange(NamedTuple):
    """One row of the table: resin, modulus, and by end of its range the sensitivities (kPa/N) and their relative errors,
    (1 or 2, pressures)."""

    resin: str
    modulus: PublishedModulus
    sensitivity: np.ndarray
    error: np.ndarray


def rows(library: Library) -> list[PredictedRange]:
    """Every published modulus with what it predicts."""
    out = []
    for name in RESINS:
        measured = library.load("materials", name).measured
        known = np.array([measured.sensitivity_0kPa_kPa_per_N.nominal, measured.sensitivity_22kPa_kPa_per_N.nominal])
        for entry in published(name, library):
            ends = [entry.low] if entry.low == entry.high else [entry.low, entry.high]
            values = sensitivities(ends, library)
            out.append(PredictedRange(name, entry, values, values / known - 1))
    return out


def table(found: list[PredictedRange]) -> list[str]:
    """The Markdown table of both resins."""
    lines = [
        "| resin | mu, MPa | source | rate and temperature | S at 0 kPa | S at 22 kPa | error at 0, 22 kPa |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in found:
        entry = row.modulus
        ends = [entry.low] if entry.low == entry.high else [entry.low, entry.high]
        cells = [f"{end:.3g}" for end in ends], *([f"{s:.2f}" for s in row.sensitivity[:, k]] for k in (0, 1))
        mu, first, last = (" to ".join(cell) for cell in cells)
        both = " to ".join(f"{100 * a:+.0f}, {100 * b:+.0f} %" for a, b in row.error)
        lines.append(f"| {row.resin} | {mu} | {entry.origin} | {entry.conditions} | {first} | {last} | {both} |")
    return lines


def page(library: Library) -> str:
    """The whole page."""
    found = rows(library)
    return "\n".join([*_answer(found), *_method(), *table(found), "", *_rest()])


def _answer(found: list[PredictedRange]) -> list[str]:
    """The question, the answer and the chart."""
    by_resin = {name: [row for row in found if row.resin == name] for name in RESINS}
    soft, stiff = (
        f"{min(row.modulus.low for row in by_resin[name]):.3g} to {max(row.modulus.high for row in by_resin[name]):.3g} MPa"
        for name in RESINS
    )
    used = by_resin["FLX9995"][0]
    stiffest = max(by_resin["FLX9995"], key=lambda row: row.modulus.high)
    above, below = 100 * used.error[0], 100 * stiffest.error[-1]
    return [
        "# The moduli of FLX9985 and FLX9995",
        "",
        "Which shear modulus do the two stiffest digital materials have, and does it explain the error of the model for them? "
        f"Published values range over {soft} for FLX9985 and over {stiff} for FLX9995, more than a factor of two each. For FLX9995 the "
        f"paper's {used.modulus.low:g} MPa is the least of them. With it the predicted sensitivity is {above[0]:.0f} % (0 kPa) and "
        f"{above[1]:.0f} % (22 kPa) above the measured one; with the greatest it is {-below[0]:.0f} % and {-below[1]:.0f} % below. The "
        "modulus therefore explains most of the factor of two. For FLX9985 the values lie on both sides of the paper's.",
        "",
        "![Predicted sensitivity over shear modulus for both resins, with each published modulus and the measured sensitivity](hard-resins.svg)",
        "",
        "Sensitivity over the shear modulus: model (curves), published moduli (marks; a line joins the ends of a range) and measured value "
        "(horizontal lines). Solid: 0 kPa. Dashed: 22 kPa.",
        "",
    ]


def _method() -> list[str]:
    return [
        "## Published values and what they predict",
        "",
        "S is the sensitivity (kPa/N) of the paper's sensor by the atlas, without dead volume; its error is against the paper's Table S1.",
        "",
    ]


def _rest() -> list[str]:
    return [
        "- **Hardness:** Gent's relation (1958) gives E; mu is a third of it.",
        "- **Vendor:** the neo-Hookean modulus that has the tensile strength of the data sheet at its elongation at break, at another rate than the "
        "sensor's.",
        "- **Oregon State University:** the fits of the repository OSUrobotics/Material_StressStrain_DataFit (three dumbbells a grade, TangoPlus "
        "with VeroWhite). It states no units; strain and MPa are assumed. With them its softer grades have the moduli of the paper's Table 1 "
        "within a quarter.",
        "",
        "## The values in use",
        "",
        "The material files keep the moduli of the paper's Table 1, so that Table S1 tests the model and not a choice of modulus. `low` and "
        "`high` in the files are the least and the greatest value of the table.",
        "",
        "## Limits",
        "",
        "- No relaxed modulus of either resin is published. These two are quasi-static, those of the other five resins are relaxed.",
        "- The tables of Liu and Li (Eng. Fract. Mech. 199, 372-379, 2018) were not available; their E follows from the paper's mu.",
        "- Not included: E = 11 MPa of an FLX9895 in a structural program (no test, no source, its soft resin is not TangoPlus), and the vendor's "
        "Agilus30 mixes with the same two digits.",
        "",
        "`python -m benchmarks.hard_resins` writes this page.",
        "",
    ]


def draw(library: Library) -> str:
    """Sensitivity over modulus for each resin, with the published moduli and the measured sensitivity."""
    found, moduli = rows(library), np.geomspace(2.0, 13.0, 40)
    curves = sensitivities(list(moduli), library)
    with figure(165, 78) as drawn:
        for ax, name in zip(drawn.subplots(1, 2, sharey=True), RESINS, strict=True):
            measured = library.load("materials", name).measured
            known = (measured.sensitivity_0kPa_kPa_per_N.nominal, measured.sensitivity_22kPa_kPa_per_N.nominal)
            for k, pressure in enumerate(PRESSURES_KPA):
                ax.plot(moduli, curves[:, k], color=FAINT, ls=LINES[k], lw=1.2, label=f"model, {pressure:g} kPa")
                ax.axhline(known[k], color=MUTED, ls=LINES[k], lw=0.9, label=f"measured, {pressure:g} kPa")
            for marker, row in zip(MARKERS, (row for row in found if row.resin == name), strict=False):
                _mark(ax, row, marker)
            ax.set(xscale="log", xlim=(2.0, 13.0), ylim=(0.0, 1.15), xlabel="shear modulus  (MPa)", title=name)
            ax.set_xticks([2, 3, 4, 6, 8, 12], ["2", "3", "4", "6", "8", "12"])
            ax.tick_params(axis="x", which="minor", bottom=False, labelbottom=False)
        drawn.axes[0].set_ylabel("sensitivity  (kPa/N)")
        handles, labels = drawn.axes[0].get_legend_handles_labels()
        drawn.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=6.5)
        return svg(drawn)


def _mark(ax: Axes, row: PredictedRange, marker: str) -> None:
    """One published modulus: on both curves, named by its source."""
    entry = row.modulus
    ends = [entry.low] if entry.low == entry.high else [entry.low, entry.high]
    used = entry.origin.startswith("**")
    for k in (0, 1):
        look = {"color": ACCENT if used else INK, "mfc": (ACCENT if used else INK) if k == 0 else "white"}
        label = entry.name if k == 0 else None
        ax.plot(
            ends, row.sensitivity[:, k], marker=marker, ms=6 if used else 4, lw=0.9, ls=LINES[k], label=label, **look
        )


def main() -> None:
    library = Library((ROOT,))
    PAGE.write_text(page(library), encoding="utf-8")
    PAGE.with_suffix(".svg").write_text(draw(library), encoding="utf-8")
    print("wrote docs/background/hard-resins.md and hard-resins.svg")


if __name__ == "__main__":
    main()
