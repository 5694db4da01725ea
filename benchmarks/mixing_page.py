"""Write docs/background/mixing.md with its chart: ``python -m benchmarks.mixing_page`` (seconds)."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks import hard_resins
from benchmarks.mixing_chart import MixingChart, mixing_chart
from benchmarks.mixing_laws import (
    HARDNESS_READ,
    LONG_TERM,
    SOFT_HARDNESS,
    TENSION_INTERCEPT,
    TENSION_SLOPE,
    stiff_moduli,
)
from benchmarks.mixing_theory import THRESHOLD, VOXEL_THRESHOLD
from pneutouch.arrays import Array
from pneutouch.catalogue import Library
from pneutouch.catalogue.mixture import ResolvedMixingCurve, mixing
from pneutouch.mechanics.uncertainty.hardness import young_modulus
from pneutouch.selection.mixes import LEVELS, levels
from pneutouch.spec.material import Material
from pneutouch.workflows.coupons.blends import FRACTIONS

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs" / "background"
SOFT, STIFF = "TangoPlus", "VeroClear"
WHERE = (0.03, 0.06, 0.1, 0.15, 0.2, 0.3)
WHOLE_LEVELS = 24
"""Fractions to the end of the mixture tool's curve, about as far apart as those that are offered."""


def measure(library: Library) -> MixingChart:
    """The shipped curves, the one in use first, and the names of their points."""
    used = mixing(SOFT, STIFF, library)
    assert used.curve.curves is not None
    laws = {name: mixing(SOFT, STIFF, library, curve=name) for name in used.curve.curves.by_name}
    materials: list[Material] = [library.load("materials", str(point.material)) for point in used.curve.points]
    names = tuple(material.title.removesuffix("-DM") for material in materials)
    return MixingChart(laws, stiff_moduli(library.load("materials", STIFF))[0], names)


def page(chart: MixingChart, library: Library) -> str:
    """The whole page."""
    parts = (
        _answer(chart), _curves(chart), _why(library), _step(), _spread(chart, library), band(chart), _lab()
    )  # fmt: skip
    return "\n".join(line for part in parts for line in (*part, ""))


def _used(chart: MixingChart) -> ResolvedMixingCurve:
    return next(iter(chart.laws.values()))


def _answer(chart: MixingChart) -> list[str]:
    used, *others = chart.laws
    low, high = (float(bound[0]) for bound in _used(chart).band_at(np.array([0.1])))
    return [
        "# Stiffness of a mix of two resins",
        "",
        "Which shear modulus has a wall printed from two base resins, mixed droplet by droplet? No vendor publishes the fractions of its digital materials. "
        f"Three curves from two published sources bound it: 10 % {STIFF} in {SOFT} has {low:.2g} to {high:.3g} MPa, and {float(_used(chart).modulus_at(np.array([0.1]))[0]):.2g} MPa by the "
        "curve in use.",
        "",
        "![Shear modulus over fraction by every curve, with the catalogue's resins](mixing.svg)",
        "",
        f"*Shear modulus over the volume fraction of {STIFF} by the three curves, with the bounds of the next sections. Dots: the catalogue's resins; thin lines reach from curve to curve.*",
        "",
        "```toml",
        "[membrane]",
        f'material = {{ from = "{SOFT}", to = "{STIFF}", fraction = 0.1 }}',
        "```",
        "",
        f'The fraction is what is printed, and exact. `{used}` is in use; `curve = "{others[0]}"` or `curve = "{others[1]}"` inside the braces selects another. `check`, the datasheet '
        "and their JSON (`mixing_curves`) state sensitivity, force range and rated pressure by each. `python -m benchmarks.mixing_page` writes this page.",
    ]


def _curves(chart: MixingChart) -> list[str]:
    used = _used(chart)
    names = used.curve.curves
    assert names is not None
    rows = [
        f"| {name} | {mu:g} | {100 * point.fraction:.3g} | {100 * point.low:.3g} | {100 * point.high:.3g} |"
        for name, mu, point in zip(chart.names, used.modulus, used.curve.points, strict=True)
    ]
    series = ", ".join(f"{mu:.2f}" for _, mu in LONG_TERM)
    shares = ", ".join(f"{100 * f:g}" for f, _ in LONG_TERM)
    read = ", ".join(f"{name} at {100 * f:g}" for name, f in HARDNESS_READ.items())
    return [
        "## The three curves",
        "",
        f"Percent of {STIFF} by volume at which each curve has the modulus of a catalogue resin:",
        "",
        f"| resin | mu, MPa | {names.fraction} | {names.fraction_low} | {names.fraction_high} |",
        "|---|---|---|---|---|",
        *rows,
        "",
        f"- **`{names.fraction}`**: Agilus30 with Vero, printed by a J750 in stated fractions and pulled, log10 E = "
        f"{TENSION_INTERCEPT:g} + {TENSION_SLOPE:g} f (E in MPa) from 5 to 40 %, relative to the soft resin. Source: the J750 "
        "conversions of OpenVCAD, package `pyvcad-attribute-resolver`, Matter Assembly Computation Lab, University of "
        "Colorado Boulder ([OpenVCAD](https://github.com/MacCurdyLab/OpenVCAD-Public): Wade et al., Additive "
        "Manufacturing, DOI 10.1016/j.addma.2023.103912). Its licence is noncommercial: cited, nothing copied.",
        f"- **`{names.fraction_low}`**: the same mixes have the hardness of {read} %, to about a percent. Below, straight "
        "in ln mu from the soft resin; beyond, by the last slope.",
        f"- **`{names.fraction_high}`**: Agilus30 Black with VeroWhite, an input file of an Abaqus/MATLAB mixture tool "
        f"(`HELPER_MaterialsFE.m`), long-term moduli {series} MPa at {shares} %, relative to the soft resin, straight in "
        "ln mu; beyond 50 % by the last slope.",
    ]


def _why(library: Library) -> list[str]:
    base = young_modulus(SOFT_HARDNESS)
    rows, slopes = [], []
    for name, f in HARDNESS_READ.items():
        shore = library.load("materials", name).shore_a.nominal
        slopes.append(float(np.log10(young_modulus(shore) / base)) / f)
        rows.append(f"{slopes[-1]:.1f}")
    return [
        "## Why the tensile line is in use",
        "",
        "- Its fractions were printed and its moduli measured. The mixture tool's numbers are inputs of a program without "
        "measurements, and two of the seven resins lie beyond its last mix.",
        "- Two properties of the same mixes agree. By Gent's relation the hardness gives a rise of log10 E over the soft "
        f"resin's of {', '.join(rows)} for a fraction of 1, at {', '.join(f'{100 * f:g}' for f in HARDNESS_READ.values())} %; "
        f"tension gives {TENSION_SLOPE:g}. All seven resins lie within its stated 40 %.",
        f"- The hardness curve is the stiff end: that soft resin has {SOFT_HARDNESS:g} Shore A, {SOFT} 27.6, and a "
        "softer base needs more of the stiff resin for the same hardness.",
        "",
        f"None of the three is of {SOFT} and {STIFF}, and for the J750's mixes neither rate nor temperature is stated.",
    ]


def _step() -> list[str]:
    return [
        "## A step from soft to rigid?",
        "",
        f"A step from rubber to plastic between {100 * THRESHOLD:.0f} and {100 * VOXEL_THRESHOLD:.0f} % is a bound from "
        "percolation, not an observation: glassy droplets in random places touch throughout the wall from "
        f"{100 * THRESHOLD:g} % (Scher and Zallen 1970, DOI 10.1063/1.1674565), voxels that touch by faces from "
        f"{100 * VOXEL_THRESHOLD:g} %. The J750's tensile modulus rises smoothly from 5 to 40 %. "
        "Sections of printed mixes show particles of one resin in the other (DOI 10.1089/3dp.2017.0038). The chart "
        "draws the bound, and the softest isotropic mix (Hashin and Shtrikman 1963, DOI 10.1016/0022-5096(63)90060-7).",
    ]


def _spread(chart: MixingChart, library: Library) -> list[str]:
    used, tool = _used(chart), chart.laws["mixture-tool"]
    fine = np.linspace(0.0, float(tool.fraction[-1]), 2001)
    logs = np.log(tool.modulus_at(fine))
    whole = np.interp(np.linspace(logs[0], logs[-1], WHOLE_LEVELS), logs, fine)
    rows = [
        _spread_row("all of `mixture-tool`", whole, chart, "mixture-tool", library),
        _spread_row("offered", levels(used, LEVELS), chart, next(iter(chart.laws)), library),
    ]
    return [
        "## Grades that are useful by every curve",
        "",
        f"`select --mix` and `--graded` offer fractions up to {100 * used.curve.common_top:.3g} %, where the stiffest curve "
        "ends. Beyond it a wall may be rigid if that curve is true; for a stiffer wall choose a catalogue resin, whose "
        "modulus was measured. The paper's sensor at 0 kPa by the atlas, in the fractions that are offered and in "
        f"{WHOLE_LEVELS} to the end of the mixture tool's curve:",
        "",
        "| fractions | number | to | no modulus by some curve | S off by the farthest curve, median | worst |",
        "|---|---|---|---|---|---|",
        *rows,
    ]


def _spread_row(name: str, at: Array, chart: MixingChart, used: str, library: Library) -> str:
    """How far the sensitivity by the curve in use is off that by the farthest of the others, over some fractions."""
    known = at <= _used(chart).curve.common_top + 1e-9
    inside = at[known]
    by_curve = {
        key: hard_resins.sensitivities(law.modulus_at(inside).tolist(), library)[:, 0]
        for key, law in chart.laws.items()
    }
    off = np.max([np.abs(np.log(values / by_curve[used])) for values in by_curve.values()], axis=0)
    median, worst = np.exp(np.median(off)), np.exp(off.max())
    unknown = int((~known).sum())
    return f"| {name} | {at.size} | {100 * at[-1]:.3g} % | {unknown} | {median:.2f} times | {worst:.2f} times |"


def band(chart: MixingChart) -> list[str]:
    """How far off the modulus of a mix may be."""
    law, f = _used(chart), np.array(WHERE)
    rows = [
        f"| {100 * x:g} | {low:.3g} | {mu:.3g} | {high:.3g} | {np.log(high / low) / np.sqrt(12):.0%} |"
        for x, low, mu, high in zip(f, law.band_at(f)[0], law.modulus_at(f), law.band_at(f)[1], strict=True)
    ]
    return [
        "## Uncertainty",
        "",
        "The source `mixing fraction` of every [budget](uncertainty.md) reaches from the softest curve to the stiffest, straight in ln mu "
        "between the resins (JCGM 100, 4.3.7), in addition to `published modulus`. No modulus above the "
        "stiffest resin's is taken; those of the two stiffest are themselves doubtful ([hard-resins.md](hard-resins.md)).",
        "",
        f"| % {STIFF} | least, MPa | in use, MPa | greatest, MPa | standard uncertainty of ln mu |",
        "|---|---|---|---|---|",
        *rows,
    ]


def _lab() -> list[str]:
    steps = ", ".join(f"{100 * f:g}" for f in FRACTIONS)
    return [
        "## What to measure",
        "",
        "A curve from coupons of your own printer comes before all three; two dumbbells of each mix are enough:",
        "",
        "```",
        f"pneutouch coupons --mixing {SOFT}+{STIFF} --profile j735 --only puck,dumbbell",
        "# print, measure, fill in results.toml",
        f"pneutouch coupons --results outputs/coupons-j735-{SOFT}+{STIFF}/results.toml   # writes printprofiles/mixing/{SOFT}+{STIFF}.toml",
        "```",
        "",
        f"It prints {len(FRACTIONS)} fractions: {steps} %. By every curve the modulus rises by less than 2.5 times from one to the next, as "
        "far as the curve reaches. Without dumbbells the modulus is the soft resin's times the ratio of Gent's relation "
        "between the two hardnesses: right in order, inaccurate in size, not used above 95 A. A curve whose modulus falls "
        "with the fraction is refused. A measured curve has a `spread` in place of the band, and the assumption leaves check, datasheet and budget.",
    ]


def main() -> None:
    library = Library((ROOT,))
    chart = measure(library)
    for name, text in (("mixing.svg", mixing_chart(chart, (178, 105))), ("mixing.md", page(chart, library))):
        (DOCS / name).write_text(text, encoding="utf-8")
        print(f"wrote docs/background/{name}")


if __name__ == "__main__":
    main()
