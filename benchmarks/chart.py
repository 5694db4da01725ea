"""Write docs/background/accuracy.md with its charts: ``python -m benchmarks.chart``."""

from __future__ import annotations

import json
import statistics
from pathlib import Path

import numpy as np

from benchmarks import full_depth, laws, off_axis_calculix, peers, shares, speed_accuracy, validation, validity
from benchmarks.pages import off_axis_speed, speed
from benchmarks.pages.speed_chart import chart
from benchmarks.scenes import SCENES
from benchmarks.theory import METHODS, Cell, ship_errors, table_s1
from pneutouch.catalogue import Library
from pneutouch.mechanics.exact_membrane import RISING_BRANCH, limit_point_errors
from pneutouch.mechanics.inflation import LIMIT_PRESSURE, relative_height

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs" / "background"

HEAD = [
    "# Accuracy and cost, measured",
    "",
    "`make chart` writes this page and [validation.md](validation.md). Nothing is fitted; every cell is listed, including the bad ones. "
    "Times are processor times of one run on one core: only their ratios are comparable.",
    "",
]


def main() -> None:
    library = Library((ROOT,))
    ship_errors(library)
    cells = table_s1(library)
    speeds = speed_accuracy.measure()
    paper = next(scene for scene in speeds["scenes"] if scene["scene"] == SCENES[1].name)
    programs = peers.measure(1e-3 * paper["reference"]["limit_pressure_kPa"])
    off_axis = json.loads(off_axis_calculix.STORED.read_text(encoding="utf-8"))
    map_rows, law_curves = validity.measure(), laws.curves()
    _write("speed-accuracy.svg", chart(speeds, programs, off_axis))
    _write("validity.svg", validity.draw(map_rows))
    _write("laws.svg", laws.draw(law_curves))
    for name, data in (("speed-accuracy.json", speeds), ("peers.json", programs), ("validity.json", map_rows)):
        _write(name, json.dumps(data, indent=1) + "\n")
    sections = [
        *contact_section(cells),
        *full_depth.section(),
        *speed.section(speeds, programs, shares.shares()),
        *off_axis_speed.section(off_axis),
        *validity.section(map_rows),
        *inflation_section(),
        *laws.section(law_curves),
        "The print meshes compared with other kernels: [meshing.md](meshing.md).",
        "",
    ]
    _write("accuracy.md", "\n".join([*HEAD, *sections]))
    _write("validation.md", validation.page())


def _write(name: str, text: str) -> None:
    (DOCS / name).write_text(text, encoding="utf-8")
    print(f"wrote docs/background/{name}")


def inflation_section() -> list[str]:
    """State I against the exact membrane."""
    pressure, height = limit_point_errors()
    known = RISING_BRANCH[1:][RISING_BRANCH[1:, 0] <= LIMIT_PRESSURE]
    cap = relative_height(known[:, 0], 1.0, 1.0, 1.0)
    lines = [f"| {p:.4f} | {h:.4f} | {x:.4f} | {x / h - 1:+.1%} |" for (p, h), x in zip(known, cap, strict=True)]
    return [
        "## Inflation: the cap against the exact membrane",
        "",
        "The paper assumes a cap of constant curvature. The exact neo-Hookean membrane, solved by shooting, has its limit "
        f"point at p R0/(mu t0) = {RISING_BRANCH[-1, 0]:.5f}, h/R0 = {RISING_BRANCH[-1, 1]:.5f}: the cap is off by "
        f"**{pressure:+.1%} in pressure and {height:+.1%} in height** there.",
        "",
        "| p R0/(mu t0) | exact h/R0 | cap h/R0 | error |",
        "|---|---|---|---|",
        *lines,
        "",
    ]


def contact_section(cells: list[Cell]) -> list[str]:
    """State II against Table S1."""
    ours = [cell for cell in cells if cell.material != "FLX9995-DM"]
    median = {m: statistics.median(abs(cell.errors[m]) for cell in ours) for m in METHODS}
    rows = [
        f"| {c.material} | {c.pressure:g} | {c.measured:.3f} | "
        + " | ".join(f"{c.value(m):.2f} | {c.errors[m]:+.0%}" for m in ("solid", "variational", "printed"))
        + f" | {c.range_end:.2f}, {c.ends} |"
        for c in cells
    ]
    return [
        "## Contact: every model against the paper's Table S1",
        "",
        "Sensitivity in kPa/N on the paper's sensor, no dead volume, fitted up to the first event that ends the range; every "
        "cell, nothing fitted. Median absolute error of the twelve cells from TangoPlus to FLX9985-DM: "
        f"solid **{median['solid']:.1%}**, membrane variational {median['variational']:.0%}, printed {median['printed']:.0%}.",
        "",
        "| resin | driving kPa | measured | solid | error | variational | error | printed | error | solid's range ends, mm |",
        "|---|---|---|---|---|---|---|---|---|---|",
        *rows,
        "",
        "Possible reasons for the bad cells: the moduli of FLX9985-DM and FLX9995-DM come from another source than the other five (a "
        "quasi-static E, not a relaxed modulus). The model computes twice the sensitivity for FLX9995-DM, as if its wall were stiffer than "
        "that modulus, as the other published moduli of it are ([hard-resins.md](hard-resins.md)), and a slightly low sensitivity for FLX9985-DM. The membrane has no bending "
        "stiffness, so the resin has little effect on "
        "its sensitivity; at zero driving pressure F = p pi rho^2 even bounds S from below by 1/(pi R0^2) = 3.72 kPa/N, above "
        "every measured value. Use the membrane for inflation, limits and trends; choose a resin by the solid. What friction, the "
        "rim, dead volume and the fitted range change in each cell: [table-s1.md](table-s1.md).",
        "",
    ]


if __name__ == "__main__":
    np.seterr(all="raise", under="ignore")
    main()
