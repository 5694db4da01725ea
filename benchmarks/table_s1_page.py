"""Write docs/background/table-s1.md with its chart: ``python -m benchmarks.table_s1_page`` (some 10 minutes of processor time)."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from benchmarks.table_s1_cells import ALL, FRICTIONS, Assumptions, CellRow, cells
from benchmarks.table_s1_chart import draw
from pneutouch.arrays import Array
from pneutouch.catalogue import Library
from pneutouch.wording import counted

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs" / "background"

OTHER_SOURCE = "FLX9995-DM"
"""Left out of the summary figures, as in docs/background/accuracy.md: twice its measured sensitivity under every assumption."""

FACTORS = {
    "friction 0.3": Assumptions(friction=0.3),
    "friction 0.6": Assumptions(friction=0.6),
    "friction 1": Assumptions(friction=1.0),
    "grip": Assumptions(friction=np.inf),
    "rim as printed": Assumptions(rim="as printed"),
    "no base": Assumptions(rim="no base"),
    "dead volume 0.2 mL": Assumptions(dead_volume_mL=0.2),
    "range to depth": Assumptions(range="depth"),
}
"""One assumption changed at a time."""

SHOWN = 12


def errors(rows: list[CellRow], assumed: Assumptions) -> Array:
    """Relative errors of the cells under assumptions, (n_rows,); NaN where there is no figure."""
    return np.array([row.sensitivity[assumed] / row.measured - 1 for row in rows])


def root_mean_square(values: Array) -> float:
    """Infinite where a cell has no figure: a set of assumptions must answer for the whole table."""
    return float(np.sqrt(np.mean(values**2))) if np.isfinite(values).all() else float("inf")


def ranked(rows: list[CellRow]) -> list[Assumptions]:
    """All sets of assumptions, the one with the least root mean square error first."""
    return sorted(rows[0].sensitivity, key=lambda assumed: root_mean_square(errors(rows, assumed)))


def within(rows: list[CellRow], assumed: Assumptions) -> int:
    """How many cells are met within twice their repeatability."""
    return sum(abs(row.sensitivity[assumed] - row.measured) <= 2 * row.repeatability for row in rows)


def spread(row: CellRow) -> tuple[float, float]:
    """Least and greatest sensitivity of a cell over all assumptions, kPa/N."""
    values = np.array(list(row.sensitivity.values()))
    return float(np.nanmin(values)), float(np.nanmax(values))


def page(rows: list[CellRow]) -> str:
    """The whole page."""
    summed = [row for row in rows if row.material != OTHER_SOURCE]
    parts = [_answer(summed), _method(), _moves(rows), _cells(rows), _combinations(summed), _stated(summed), _limits()]
    return "\n".join(line for part in parts for line in part)


def _answer(rows: list[CellRow]) -> list[str]:
    """The question, the answer and the chart."""
    order = ranked(rows)
    rms, share = root_mean_square(errors(rows, Assumptions())), open_share(rows)
    best = max(within(rows, assumed) for assumed in order)
    return [
        "# Table S1 and what the paper leaves open",
        "",
        "How much of the model's error against the paper's Table S1 can come from what the paper does not state? With the default "
        f"assumptions the root mean square error of {len(rows)} cells is {rms:.1%}. Friction of the plate, the rim of the membrane, the dead "
        f"volume and the fitted range move a cell by {share:.1%} (standard deviation): {(share / rms) ** 2:.0%} of the square of that error. No "
        f"combination of them fits the table; the best of {len(order)} meets {best} of {len(rows)} cells within twice its repeatability.",
        "",
        "![Sensitivity of each cell over friction, with the measured value](table-s1.svg)",
        "",
        "Sensitivity over the friction of the plate for each resin (curves, other assumptions at their default), measured values "
        "(diamonds) and the span over all combinations (bars).",
        "",
    ]


def _method() -> list[str]:
    return [
        "## Method",
        "",
        "Table S1 has a sensitivity for seven resins at two driving pressures, and a repeatability for each resin. The solid computes every "
        "cell for every combination of four assumptions. Nothing is fitted.",
        "",
        "| assumption | values | default |",
        "|---|---|---|",
        "| friction | 0, 0.3, 0.6, 1, grip | 0, as in the paper's finite elements |",
        "| rim | clamped at the base plane, on which the wall can lie down; clamped as printed, on a flange of 2.25 mm; clamped at a "
        "plane through which the wall passes (no base) | base plane |",
        "| dead volume | 0, 0.2 mL (a tube of 2 mm bore and 64 mm length) | 0 |",
        "| range | to the first event that ends it, the gauge's 100 kPa among them; or beyond the gauge, to the depth of 6.94 mm or the "
        "buckling of the wall | to the first event |",
        "",
        f"Summary figures leave out {OTHER_SOURCE}: its modulus comes from another source, and its prediction is far off under every "
        "assumption ([hard-resins.md](hard-resins.md)).",
        "",
    ]


def _moves(rows: list[CellRow]) -> list[str]:
    """Which assumption moves which cell by how much."""
    lines = [
        f"| {row.material} | {row.pressure_kPa:g} | {row.sensitivity[Assumptions()]:.3f} | "
        + " | ".join(_move(row, assumed) for assumed in FACTORS.values())
        + " |"
        for row in rows
    ]
    return [
        "## Effect of each assumption",
        "",
        "Change of the sensitivity, in percent of the default's, when one assumption is changed. Friction, air and the rim matter more the "
        "stiffer the resin is.",
        "",
        f"| resin | driving kPa | default kPa/N | {' | '.join(FACTORS)} |",
        "|---|---|---|" + "---|" * len(FACTORS),
        *lines,
        "",
    ]


def _move(row: CellRow, assumed: Assumptions) -> str:
    change = 100 * (row.sensitivity[assumed] / row.sensitivity[Assumptions()] - 1)
    return f"{change:+.1f}" if np.isfinite(change) else "no figure"


def _cells(rows: list[CellRow]) -> list[str]:
    """Each cell by friction, and where its range ends."""
    lines = []
    for row in rows:
        values = [row.sensitivity[Assumptions(friction=f)] / row.measured - 1 for f in FRICTIONS]
        slip, grip = (row.ends[Assumptions(friction=f)] for f in (0.0, np.inf))
        low, high = spread(row)
        lines.append(
            f"| {row.material} | {row.pressure_kPa:g} | {row.measured:.3f} | "
            + " | ".join(f"{value:+.0%}" if np.isfinite(value) else "–" for value in values)
            + f" | {slip[0]:.2f}, {slip[1]} | {grip[0]:.2f}, {grip[1]} | {low:.2f} to {high:.2f} |"
        )
    names = " | ".join("grip" if f == np.inf else f"friction {f:g}" for f in FRICTIONS)
    return [
        "## Error of each cell by friction",
        "",
        "Predicted over measured less one; other assumptions at their default. The last column is the span over all combinations.",
        "",
        f"| resin | driving kPa | measured kPa/N | {names} | range ends, friction 0, mm | range ends, grip, mm | all, kPa/N |",
        "|---|---|---|" + "---|" * (len(FRICTIONS) + 3),
        *lines,
        "",
    ]


def _combinations(rows: list[CellRow]) -> list[str]:
    """The combinations that come nearest to the whole table."""
    order = ranked(rows)
    default = order.index(Assumptions()) + 1
    best = max(within(rows, assumed) for assumed in order)
    lines = [_ranked_line(rows, k + 1, assumed) for k, assumed in enumerate(order[:SHOWN])]
    if default > SHOWN:
        lines.append(_ranked_line(rows, default, Assumptions()))
    return [
        "## Which combinations fit the table",
        "",
        "A combination fits where every cell is within twice the repeatability of its resin (0.002 to 0.014 kPa/N). "
        f"**None of the {len(order)} combinations does; the best of them meets {counted(best, 'cell')}.** The nearest by root mean square error "
        f"of the {len(rows)} cells:",
        "",
        "| rank | combination | median error | root mean square | worst | cells met |",
        "|---|---|---|---|---|---|",
        *lines,
        "",
    ]


def _ranked_line(rows: list[CellRow], rank: int, assumed: Assumptions) -> str:
    error = np.abs(errors(rows, assumed))
    return (
        f"| {rank} | {assumed.change()} | {np.nanmedian(error):.1%} | {root_mean_square(error):.1%} | {np.nanmax(error):.1%} | "
        f"{within(rows, assumed)} |"
    )


def open_share(rows: list[CellRow]) -> float:
    """Standard deviation of the logarithm of a cell over all assumptions, each equally likely; root mean square over the cells."""
    table = np.array([np.log1p(errors(rows, assumed)) for assumed in ranked(rows)])
    return root_mean_square(np.nanstd(table, axis=0, ddof=1))


def _stated(rows: list[CellRow]) -> list[str]:
    """What the open assumptions explain of the model's stated error."""
    inside = sum(low <= row.measured <= high for row, (low, high) in ((row, spread(row)) for row in rows))
    rms, share = root_mean_square(errors(rows, Assumptions())), open_share(rows)
    return [
        "## What follows for the error of the model",
        "",
        "The uncertainty budget takes the model's error from this table: for each resin from its own two cells, for others from all "
        f"{len(rows)}. It keeps the whole {rms:.1%} and names no cause, because the open assumptions explain only a part "
        f"({share:.1%}, each combination taken as equally likely): {inside} of {len(rows)} measured values lie within the span of "
        "the combinations.",
        "",
    ]


def _limits() -> list[str]:
    return [
        "## Limits",
        "",
        "- The table has one geometry, seven resins and two driving pressures.",
        "- Two further causes are not varied: the moduli, which are from other laboratories' prints, and the wall thickness as printed, "
        "which the paper did not measure.",
        "",
        "`make table-s1-page` writes this page.",
        "",
    ]


def raw(rows: list[CellRow]) -> list[dict[str, object]]:
    """The rows as JSON: sensitivities in kPa/N and ends in mm, in the order of `ALL`."""
    return [
        {
            "material": row.material,
            "driving_pressure_kPa": row.pressure_kPa,
            "measured_kPa_per_N": row.measured,
            "repeatability_kPa_per_N": row.repeatability,
            "cells": {
                assumed.change(): [
                    round(row.sensitivity[assumed], 5),
                    round(row.ends[assumed][0], 3),
                    row.ends[assumed][1],
                ]
                for assumed in ALL
            },
        }
        for row in rows
    ]


def read(text: str) -> list[CellRow]:
    """The rows that `raw` wrote."""
    names = {assumed.change(): assumed for assumed in ALL}
    return [
        CellRow(
            one["material"],
            one["driving_pressure_kPa"],
            one["measured_kPa_per_N"],
            one["repeatability_kPa_per_N"],
            {names[key]: value[0] for key, value in one["cells"].items()},
            {names[key]: (value[1], value[2]) for key, value in one["cells"].items()},
        )
        for one in json.loads(text)
    ]


def write(rows: list[CellRow]) -> None:
    """The chart and the page of rows that were read from the stored ones."""
    (DOCS / "table-s1.svg").write_text(draw(rows), encoding="utf-8")
    (DOCS / "table-s1.md").write_text(page(rows), encoding="utf-8")


def main() -> None:
    stored = DOCS / "table-s1.json"
    stored.write_text(json.dumps(raw(cells(Library((ROOT,)))), indent=1) + "\n", encoding="utf-8")
    write(read(stored.read_text(encoding="utf-8")))
    print("wrote docs/background/table-s1.md")


if __name__ == "__main__":
    main()
