"""Write docs/mixing.md with its chart: ``python -m benchmarks.mixing_page`` (a second)."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.mixing_chart import mixing_chart, mixing_data
from benchmarks.mixing_laws import LONG_TERM, PLACING, VOXEL_THRESHOLD, placings, stiff_moduli
from benchmarks.mixing_theory import THRESHOLD, hashin_shtrikman_low, percolation
from pneutouch.catalogue import Library
from pneutouch.catalogue.mixture import ResolvedMixingCurve, mixing
from pneutouch.spec.material import Material

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
SOFT, STIFF = "TangoPlus", "VeroClear"
WHERE = (0.05, 0.1, 0.15, 0.2, 0.3, 0.45, 0.6)


def measure(library: Library) -> tuple[ResolvedMixingCurve, tuple[float, float], tuple[str, ...]]:
    """The shipped curve, the stiff resin's least and greatest modulus, and the names of the points."""
    law = mixing(SOFT, STIFF, library)
    materials: list[Material] = [library.load("materials", str(point.material)) for point in law.curve.points]
    return (
        law,
        stiff_moduli(library.load("materials", STIFF)),
        tuple(material.title.removesuffix("-DM") for material in materials),
    )


def page(law: ResolvedMixingCurve, stiff: tuple[float, float], names: tuple[str, ...]) -> str:
    """The whole page."""
    return "\n".join([*_what(), *placed(law, stiff, names), *bounds(law, stiff), *band(law), *_lab()])


def _what() -> list[str]:
    return [
        "# Stiffness of a mix of two resins",
        "",
        "`python -m benchmarks.mixing_page` writes this page. A membrane may be printed from two base resins mixed droplet by droplet, at one fraction or "
        "graded along its arc:",
        "",
        "```toml",
        "[membrane]",
        f'material = {{ from = "{SOFT}", to = "{STIFF}", fraction = 0.1 }}',
        "```",
        "",
        "The fraction is exact: it is what is printed. The modulus is uncertain. No vendor publishes the mixing ratio of a digital "
        "material, so **the seven stiffnesses of the catalogue are placed at assumed fractions**, and every prediction of a mix carries "
        "this as a separate uncertainty, `mixing fraction`. `pneutouch list mixing` shows the available curves.",
        "",
        "![Shear modulus over fraction: bounds, curve, band and the seven resins](mixing.svg)",
        "",
    ]


def placed(law: ResolvedMixingCurve, stiff: tuple[float, float], names: tuple[str, ...]) -> list[str]:
    """Where each law puts each resin."""
    soft, rows = float(law.modulus[0]), []
    for name, modulus, point in zip(names, law.modulus, law.curve.points, strict=True):
        ends = [placings(float(modulus), soft, end) for end in stiff]
        cells = [_range([100 * end[key] for end in ends]) for key in PLACING]
        rows.append(f"| {name} | {modulus:g} | {' | '.join(cells)} | {100 * point.low:g} to {100 * point.high:g} |")
    series = ", ".join(f"{mu:.2f}" for _, mu in LONG_TERM)
    shares = ", ".join(f"{100 * f:g}" for f, _ in LONG_TERM)
    return [
        "## The fractions of the seven resins",
        "",
        f"Percent of {STIFF} by volume at which each law has the modulus of the resin; a range where the modulus of {STIFF}, "
        f"{stiff[0]:.0f} to {stiff[1]:.0f} MPa (a third of its E), has an influence.",
        "",
        f"| resin | mu, MPa | {' | '.join(PLACING)} | assumed range |",
        "|---|---|" + "---|" * (len(PLACING) + 1),
        *rows,
        "",
        "The curve uses the first law. It is a series of Agilus30 Black with VeroWhite from an Abaqus/MATLAB mixture tool "
        f"(`HELPER_MaterialsFE.m`): long-term moduli {series} MPa at {shares} %. Each catalogue resin is placed where that series has "
        "the same modulus relative to its soft resin, with ln modulus linear between the points. Limitations:",
        "",
        "- It is another pair of resins, from the input file of a program whose measurements are not available.",
        "- Its long-term moduli are of the rubbery state (pure VeroWhite: 8.47 MPa); those of FLX9985 and FLX9995 are quasi-static.",
        "- Between 50 and 100 % it rises slowly, to 28 times its soft resin; FLX9995 has 31 times TangoPlus. Beyond 50 % the curve "
        "is extrapolated with the last slope before it. With the point at 100 %, FLX9985 would be at 80 %, and FLX9995 would have no fraction.",
        "",
    ]


def _range(values: list[float]) -> str:
    low, high = (f"{value:.1f}" for value in sorted(values))
    return low if low == high else f"{low} to {high}"


def bounds(law: ResolvedMixingCurve, stiff: tuple[float, float]) -> list[str]:
    """The curve against the bounds, and the step where droplets touch."""
    soft, f = float(law.modulus[0]), np.array(WHERE)
    curve, low = law.modulus_at(f), hashin_shtrikman_low(f, soft, stiff[0])
    touch, later = percolation(f, soft, stiff[0]), percolation(f, soft, stiff[0], VOXEL_THRESHOLD)
    rows = [
        f"| {100 * x:g} | {a:.3g} | {c:.3g} | {c / a:.1f} | {p:.3g} | {q:.3g} |"
        for x, a, c, p, q in zip(f, low, curve, touch, later, strict=True)
    ]
    return [
        "## Bounds, and the step from soft to rigid",
        "",
        "For any arrangement of the droplets a mix of two incompressible solids is stiffer than at equal stress (Reuss) and "
        "softer than at equal strain (Voigt); an isotropic one lies between the bounds of Hashin and Shtrikman (1963, DOI "
        "10.1016/0022-5096(63)90060-7). The curve lies between all of them. This restricts it little: the two resins are a factor of "
        f"{stiff[0] / soft:,.0f} or more apart, and so are the bounds.",
        "",
        f"| % {STIFF} | softest isotropic mix, MPa | curve, MPa | curve over softest | touching beyond {100 * THRESHOLD:g} % | "
        f"touching beyond {100 * VOXEL_THRESHOLD:g} % |",
        "|---|---|---|---|---|---|",
        *rows,
        "",
        "If the assumed fractions are right, the stiff droplets are not isolated, since the curve is well above the softest mix. They "
        "form no network of glassy resin either, since the curve is far below the modulus of droplets that touch throughout the wall (Takayanagi's model "
        "with the connected share after Ouali, Cavaillé and Perez 1991). The two resins would have to blend before they "
        "cure. If the droplets stay separate, the catalogue's resins have other fractions, anywhere from "
        f"{100 * THRESHOLD:g} % to those of isolated inclusions. That threshold is the one of the mixture tool; it "
        "is the filling of spheres on a cubic lattice at its site threshold, pi/6 x 0.3116 (Scher and Zallen 1970, DOI "
        f"10.1063/1.1674565). Voxels that fill their cells and touch by faces do so at {100 * VOXEL_THRESHOLD:g} %. Where droplets stay "
        f"separate, expect the step from rubber to plastic between {100 * THRESHOLD:.0f} and {100 * VOXEL_THRESHOLD:.0f} %, not a slope: "
        "**a graded wall that crosses it may be rigid there.**",
        "",
    ]


def band(law: ResolvedMixingCurve) -> list[str]:
    """How far off the modulus of a mix may be."""
    f = np.array(WHERE)
    rows = [
        f"| {100 * x:g} | {low:.3g} | {mu:.3g} | {high:.3g} | {np.log(high / low) / np.sqrt(12):.0%} |"
        for x, low, mu, high in zip(f, law.band_at(f)[0], law.modulus_at(f), law.band_at(f)[1], strict=True)
    ]
    return [
        "## Uncertainty",
        "",
        "`fraction_low` and `fraction_high` of each point are the least and the greatest of the table above. The band is the curve with "
        "its points at one or the other end. No modulus above the curve's stiffest is used, because no data exist beyond it; "
        "a wall of touching droplets would be stiffer still, and not an elastomer.",
        "",
        f"| % {STIFF} | least, MPa | curve, MPa | greatest, MPa | standard uncertainty of ln mu |",
        "|---|---|---|---|---|",
        *rows,
        "",
        "The uncertainty is that of a logarithm anywhere between the ends (JCGM 100, 4.3.7). It counts in addition to `published modulus`: also "
        "at the fraction of a catalogue resin a mix is less certain than that resin.",
        "",
    ]


def _lab() -> list[str]:
    return [
        "## What to measure",
        "",
        "Print mixes of known fraction and test them in tension; two dumbbells of each are enough for a new curve:",
        "",
        "```",
        f"pneutouch coupons --mixing {SOFT}+{STIFF} --profile j735 --only puck,dumbbell",
        "# print, measure, fill in results.toml",
        f"pneutouch coupons --results results.toml   # writes printprofiles/mixing/{SOFT}+{STIFF}.toml",
        "```",
        "",
        "The command prints eight fractions, 0 to 60 %, with small steps near the threshold. It prints only pucks unless dumbbells are requested; pucks and dumbbells together need a tray "
        "larger than that of an Objet260. The modulus comes from the dumbbells. With pucks only, it is "
        "the modulus of the soft resin times the ratio of Gent's relation between the two hardnesses: reliable for the order, inaccurate in size, not used "
        "above 95 A. A curve whose modulus falls with the fraction is refused. The measured curve comes before the shipped one; it has a `spread` "
        "in place of the band, and the assumption leaves the budget.",
        "",
    ]


def main() -> None:
    found = measure(Library((ROOT,)))
    chart = mixing_chart(mixing_data(*found), (178, 110))
    for name, text in (("mixing.svg", chart), ("mixing.md", page(*found))):
        (DOCS / name).write_text(text, encoding="utf-8")
        print(f"wrote docs/{name}")


if __name__ == "__main__":
    main()
