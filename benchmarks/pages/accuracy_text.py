"""The parts of docs/background/accuracy.md that no benchmark of its own writes: the answer, Table S1, the cap, the limits."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from typing import Any

from benchmarks.pages import off_axis_speed, speed
from benchmarks.pages.speed_chart import DEFAULT, of, sizes
from benchmarks.theory import METHODS, Cell
from pneutouch.mechanics.exact_membrane import RISING_BRANCH, limit_point_errors
from pneutouch.mechanics.inflation import LIMIT_PRESSURE, relative_height

OTHER_SOURCE = "FLX9995-DM"
"""Left out of the medians: its modulus comes from another source."""

QUASI_STATIC = ("FLX9985-DM", OTHER_SOURCE)
"""Both moduli of another source than the other five: a quasi-static E."""


def medians(cells: list[Cell], without: Sequence[str] = (OTHER_SOURCE,)) -> dict[str, float]:
    """Median absolute error of each method over the cells but those of some resins."""
    kept = [cell for cell in cells if cell.material not in without]
    return {method: statistics.median(abs(cell.errors[method]) for cell in kept) for method in METHODS}


def answer(
    cells: list[Cell], speeds: dict[str, Any], peers: dict[str, Any], off_axis: list[dict[str, Any]]
) -> list[str]:
    """The question, the answer and the chart."""
    rows = of(speeds["rows"], DEFAULT)
    worst = max(sizes(rows, "sensitivity_error"))
    seconds = statistics.median(row["processor_s"] for row in rows)
    pairs = [pair for scene in off_axis_speed.measured(off_axis) for pair in off_axis_speed.shares(scene)]
    around = max(chosen.seconds / theirs.seconds for theirs, chosen in pairs)
    found = medians(cells)
    return [
        "# Accuracy and cost",
        "",
        "How accurate is each model, and what does it cost? Against twelve sensitivities measured in the paper the solid has a median error of "
        f"{found['solid']:.1%}, the membrane model {found['variational']:.0%}; nothing is fitted. Against refined meshes the solid's default mesh is "
        f"within {worst:.2%} in sensitivity in each of {len(speeds['scenes'])} scenes, for {seconds:.3f} s of processor time (median). "
        f"{speed.atlas_words(speeds)} {speed.peer_words(peers)} For contact off the axis the harmonic solid takes at most {around:.3f} of "
        "CalculiX's time at equal error.",
        "",
        "![Error over processor time of each model, mesh and program, with the Pareto front](speed-accuracy.svg)",
        "",
        "Upper left: error of the sensitivity; mark at the median scene, line up to the worst. Hollow marks end the range of more than a quarter of "
        "the scenes by an event that the reference does not have. Upper right: limit pressure of the paper's sensor in TangoPlus, against "
        "[other programs](#other-programs). Lower row: [contact off the axis](#contact-off-the-axis-time-at-equal-error).",
        "",
        "All times are processor times of one run on one core: only their ratios are comparable. Raw numbers: "
        "`speed-accuracy.json`, `peers.json`, `full-depth.json`.",
        "",
    ]


def contact_section(cells: list[Cell]) -> list[str]:
    """State II against Table S1."""
    found = medians(cells)
    rows = [
        f"| {c.material} | {c.pressure:g} | {c.measured:.3f} | "
        + " | ".join(f"{c.value(m):.2f} | {c.errors[m]:+.0%}" for m in ("solid", "variational", "printed"))
        + f" | {c.range_end:.2f}, {c.ends} |"
        for c in cells
    ]
    return [
        "## Contact: every model against the paper's Table S1",
        "",
        "Sensitivity in kPa/N of the paper's sensor without dead volume, fitted up to the first event that ends the range. Median absolute error of "
        f"the twelve cells from TangoPlus to FLX9985-DM: solid **{found['solid']:.1%}**, membrane variational {found['variational']:.0%}, "
        f"printed {found['printed']:.0%}. *Variational* and *printed* are two closures of the membrane's contact equations, which are ambiguous "
        f"as printed. The solid's median of all fourteen cells is {medians(cells, ())['solid']:.0%}, and that of the ten whose moduli are relaxed ones "
        f"{medians(cells, QUASI_STATIC)['solid']:.1%}.",
        "",
        "| resin | driving kPa | measured | solid | error | variational | error | printed | error | solid's range ends, mm |",
        "|---|---|---|---|---|---|---|---|---|---|",
        *rows,
        "",
        "- **FLX9995-DM** is predicted at up to twice its measured sensitivity, FLX9985-DM a little too low. Both moduli come from another source than the "
        "other five: a quasi-static E, not a relaxed modulus. Other published moduli of FLX9995-DM are greater ([hard-resins.md](hard-resins.md)).",
        "- **The membrane** has no bending stiffness, so that the resin has little effect on its sensitivity. At zero driving pressure F = p pi rho^2 "
        "bounds S from below by 1/(pi R0^2) = 3.72 kPa/N, above every measured value. Use the membrane for inflation, limits and trends, and the "
        "solid to choose a resin.",
        "- **Friction, rim, dead volume and fitted range:** [table-s1.md](table-s1.md) has their effect on each cell.",
        "",
    ]


def inflation_section() -> list[str]:
    """State I against the exact membrane."""
    pressure, height = limit_point_errors()
    known = RISING_BRANCH[1:][RISING_BRANCH[1:, 0] <= LIMIT_PRESSURE]
    cap = relative_height(known[:, 0], 1.0, 1.0, 1.0)
    lines = [f"| {p:.4f} | {h:.4f} | {x:.4f} | {x / h - 1:+.1%} |" for (p, h), x in zip(known, cap, strict=True)]
    return [
        "## Inflation: the cap against the exact membrane",
        "",
        "The paper's theory takes the inflated membrane as a cap of constant curvature. The exact neo-Hookean membrane, solved by shooting, has its "
        f"limit point at p R0/(mu t0) = {RISING_BRANCH[-1, 0]:.5f}, h/R0 = {RISING_BRANCH[-1, 1]:.5f}: the cap is off by "
        f"**{pressure:+.1%} in pressure and {height:+.1%} in height** there.",
        "",
        "| p R0/(mu t0) | exact h/R0 | cap h/R0 | error |",
        "|---|---|---|---|",
        *lines,
        "",
    ]


LIMITS = [
    "## Limits",
    "",
    "- Errors against refined meshes are those of the discretisation. They do not contain what is wrong in the equations, the moduli or the geometry; only "
    "Table S1 tests these, for one geometry.",
    "- Where an event ends the range, the default mesh locates it a part of a cell off. A figure over the full range then differs by more than the "
    "errors above, which are over one range (last column of the table of scenes).",
    "",
    "`make chart` computes this page and [validation.md](validation.md); `python -m benchmarks.chart stored` writes this page from what is stored. "
    "The print meshes are compared with other kernels in [meshing.md](meshing.md).",
    "",
]
