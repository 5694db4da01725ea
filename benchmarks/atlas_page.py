"""Write docs/background/atlas.md with its map of errors: ``python -m benchmarks.atlas_page`` (minutes, every core)."""

from __future__ import annotations

import json
import os
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.atlas_presses import Gap, compare_all, random_cases
from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.recipe import RECIPE, axes
from pneutouch.mechanics.atlas.table import SHIPPED
from pneutouch.report.style import INK, figure, svg

DOCS = Path(__file__).resolve().parents[1] / "docs" / "background"
COUNT, SEED = 500, 2000
KEYS = ("wall", "share", "ambient", "dead", "depth")
ERRORS = {
    "force": "force at the worst state of a press, over its greatest force",
    "pressure": "pressure at the worst state of a press, over its greatest rise",
    "gauge": "the same, over its greatest gauge pressure",
    "common": "sensitivity over the common range",
    "own": "sensitivity, each over its range",
    "limit": "limit pressure",
}
LEVELS = (0.001, 0.002, 0.005)
_DIGITS = 4


def measure() -> dict[str, Any]:
    """Errors of random presses, as columns; the presses of `make check-slow`."""
    os.environ["OMP_NUM_THREADS"] = "1"
    gaps = [gap for gap in compare_all(random_cases(COUNT, SEED), os.cpu_count() or 1) if gap is not None]

    def column(values: list[float]) -> list[float]:
        return [float(f"{value:.{_DIGITS}g}") for value in values]

    return {
        "requested": COUNT,
        **{key: column([getattr(gap.case, key) for gap in gaps]) for key in KEYS},
        **{name: column([getattr(gap, name) for gap in gaps]) for name in ERRORS},
        "end_off": column([gap.positions[1] - gap.positions[0] for gap in gaps]),
        "states": {name: _states(gaps, f"every_{name}") for name in ("force", "pressure")},
        "ends": dict(Counter(" / ".join(gap.ends) for gap in gaps).most_common()),
    }


def _states(gaps: list[Gap], name: str) -> list[float]:
    """Count, median, 99th percentile and greatest over all states of all presses."""
    errors = np.concatenate([getattr(gap, name) for gap in gaps])
    return [float(errors.size), *(float(f"{x:.{_DIGITS}g}") for x in np.quantile(errors, [0.5, 0.99, 1.0]))]


def page(data: dict[str, Any]) -> str:
    """The whole page from stored numbers."""
    return "\n".join([*_answer(data), *_contents(), *_made(), *_accuracy(data), *_worst(data), *_outside()])


def _answer(data: dict[str, Any]) -> list[str]:
    force, common = (np.abs(np.array(data[key])) for key in ("force", "common"))
    return [
        "# The atlas",
        "",
        "How far may the table of results, the atlas, replace the finite elements, the `solid`? In "
        f"{len(force):,} random presses within its limits the sensitivity differs by {np.median(common):.3%} in the median and {common.max():.2%} at most, the force by "
        f"at most {force.max():.2%} of full scale. In bulk a state takes a tenth of a millisecond instead of a tenth of a second ([accuracy.md](accuracy.md)). "
        "`pneutouch predict DESIGN --model atlas` selects it; `--model auto` takes it where its stated error meets the tolerance.",
        "",
        "![Greatest error in force over wall ratio and driving pressure, and over wall ratio and depth](atlas.svg)",
        "",
        "*Greatest error in force of the random presses in each cell, over wall ratio and driving pressure, and over wall ratio and depth.*",
        "",
    ]


def _contents() -> list[str]:
    grid = axes(RECIPE)
    return [
        "## What it contains",
        "",
        "With a neo-Hookean wall everything scales with the shear modulus mu and the inner radius R0. A dome under a plate is then described by its elastic energy "
        "E(t0/R0, V, h): wall ratio, cavity volume, plate height. Pressure and force are its slopes,",
        "",
        "$$",
        r"p = \frac{\partial E}{\partial V} , \qquad F = -\frac{\partial E}{\partial h} ,",
        "$$",
        "",
        "so a closed path does no work. Gas, dead volume, ambient pressure, modulus and size are not in the table. They enter afterwards and exactly, by "
        "Boyle's law: (p + pa)(V + Vd) keeps its value at first contact.",
        "",
        "| coordinate | meaning | limits | coefficients |",
        "|---|---|---|---|",
        f"| t0/R0 | wall ratio, in its logarithm | {RECIPE.thinnest:g} to {RECIPE.thickest:g} | {grid.wall.size}, cubic |",
        f"| nu | volume above the unloaded one over the same at the limit point | {RECIPE.lowest_volume:g} to {RECIPE.highest_volume:g} | "
        f"{grid.volume.size}, degree {RECIPE.degree} |",
        f"| w | plate below the free apex at that volume, over R0 | 0 to {RECIPE.deepest:g} of travel | "
        f"{grid.depth.size}, degree {RECIPE.degree} |",
        "",
        f"Ambient pressure up to {RECIPE.stiffest:g} mu, any dead volume, Poisson ratio {RECIPE.poisson_ratio:g}, base clamped, any "
        "driving pressure below the limit point. The table also holds what defines events: contact radius, greatest stretch and stress, the fold of a face, the inner apex.",
        "",
    ]


def _made() -> list[str]:
    return [
        "## How it is made",
        "",
        f"`make atlas` solves the solid at its default mesh for {RECIPE.walls} walls, a little beyond the limits. Volume and plate height are "
        "prescribed; energy, pressure, force and their derivatives are stored for every state that is stable with some trapped gas. Presses with "
        "trapped gas cover the edge at zero pressure and locate the buckling of the wall. A least-squares fit makes one energy in B-splines of all states. It takes "
        f"minutes on two cores and writes `atlas.npz` ({SHIPPED.stat().st_size / 1e6:.1f} MB). The file carries a fingerprint of the solid's results, "
        "and a test fails when the solid no longer gives them.",
        "",
    ]


def _row(name: str, words: str, data: dict[str, Any]) -> str:
    errors = np.abs(np.array(data[name]))
    middle, most, worst = np.quantile(errors, [0.5, 0.99, 1.0])
    return f"| {words} | {middle:.3%} | {most:.2%} | {worst:.2%} | {(errors > LEVELS[-1]).sum()} |"


def _accuracy(data: dict[str, Any]) -> list[str]:
    off = np.abs(np.array(data["end_off"]))
    same = sum(count for kinds, count in data["ends"].items() if len(set(kinds.split(" / "))) == 1)
    count = len(data["wall"])
    states = [
        f"| {name} at every one of {values[0]:,.0f} states, over the press's greatest | {values[1]:.3%} | {values[2]:.2%} | {values[3]:.2%} | |"
        for name, values in data["states"].items()
    ]
    return [
        "## Error against the solid",
        "",
        f"{data['requested']:,} random presses within the limits, none of them used to make the atlas: walls and gas stiffness uniform in their "
        f"logarithm, driving pressure 0 to 97 % of the limit, dead volume 0 to several R0^3, depth 0.2 to 0.75 R0, some with a gauge limit "
        f"or a break strain ({count:,} have a range to compare). `make check-slow` repeats them.",
        "",
        "| error | median | 99 of 100 | greatest | above 0.5 % |",
        "|---|---|---|---|---|",
        *(_row(name, words, data) for name, words in ERRORS.items()),
        *states,
        "",
        f"The event that ends the range is the same in {same:,} of {count:,} presses; its position differs by at most {off.max():.4f} R0 (the solid itself "
        "locates a jump to 0.0005 R0). The error of the solid against a refined mesh comes in addition, see [accuracy](accuracy.md).",
        "",
    ]


def _worst(data: dict[str, Any]) -> list[str]:
    order = np.argsort(-np.abs(np.array(data["force"])))[:6]
    rows = [
        f"| {data['wall'][i]:.3f} | {data['share'][i]:.0%} | {data['ambient'][i]:.2g} | {data['dead'][i]:.2g} | {data['depth'][i]:.2f} | "
        f"{data['force'][i]:.2%} | {data['pressure'][i]:.2%} | {data['common'][i]:+.2%} |"
        for i in order
    ]
    return [
        "## Where the error is greatest, and why",
        "",
        "- **No pressure.** Without pressure in the cavity the force of the solid oscillates as the contact edge moves over the elements one by one: at t0/R0 = 0.06 by up to "
        "0.6 % of full scale against a mesh twice as fine, at 0.2 by 0.3 %. The atlas smooths this.",
        "- **Shortly before buckling.** The stiffness goes to zero along an edge whose position changes with the wall. Between two tabulated walls "
        "the table shows a bend instead.",
        "- **Just below the limit point.** The pressure is flat there: a small error in pressure is a large one in volume.",
        "",
        "The six greatest errors in force:",
        "",
        "| t0/R0 | driving, of the limit | ambient/mu | dead volume/R0^3 | depth/R0 | force | pressure | sensitivity |",
        "|---|---|---|---|---|---|---|---|",
        *rows,
        "",
    ]


def _outside() -> list[str]:
    return [
        "## What it does not cover",
        "",
        "In these cases the atlas gives no figures and reports the reason; `--model auto` uses the solid and reports this under `error_estimate`:",
        "",
        "- another law or Poisson ratio, friction or another object than the plate, a flange held as printed, a wall that passes through its base (`contact.base = false`);",
        "- walls or depths outside the limits, very soft resin in high ambient pressure, a press that leaves the tabulated states;",
        "- a contact that reaches the edge of the plate, whose shape is not in the table.",
        "",
        "`auto` also uses the solid for ranges that end by buckling or at the break strain, because the solid locates the end more exactly. The deformed "
        "shapes of the wall and the event `wall on its base` come only from the solid.",
        "",
        "**The ring of a clamped flange** is not in the table; the atlas answers such designs as if the wall lay on the plane alone. "
        "A wall of more than about 0.15 R0 does not reach the ring. A thinner one reaches it in presses deeper than 0.6 R0 at low driving pressure. "
        "At 0.75 R0 and 0 kPa the solid with the ring gives a sensitivity that is lower by 2 % for a wall of 0.13 R0, by 3 to 6 % for 0.1 R0 and by 6 to 9 % for 0.07 R0; at "
        "0.8 of the limit pressure by at most 0.3 %. Where the wall can reach the ring (otherwise it changes less than 0.3 %), `auto` takes the solid, and the atlas selected by "
        "name reports it. Searches, intervals and charts use the atlas all the same; `select` confirms its first designs with the solid.",
        "",
    ]


def draw(data: dict[str, Any]) -> str:
    """Greatest error in force in each cell of two maps, darker for more."""
    from matplotlib.colors import BoundaryNorm, ListedColormap

    wall, error = np.array(data["wall"]), 100 * np.abs(np.array(data["force"]))
    edges = np.geomspace(RECIPE.thinnest, RECIPE.thickest, 13)
    bounds = [0.0, *(100 * level for level in LEVELS), max(1.0, float(error.max()))]
    norm, shades = BoundaryNorm(bounds, 4), ListedColormap(["#F1F4F6", "#B9C3CB", "#6C7A86", INK])
    with figure(178, 78) as drawn:
        axes = drawn.subplots(1, 2)
        for ax, key, steps, label in zip(
            axes,
            ("share", "depth"),
            (np.linspace(0.0, 0.97, 11), np.linspace(0.2, 0.75, 12)),
            ("driving pressure / limit  (-)", "depth / R0  (-)"),
            strict=True,
        ):
            mesh = ax.pcolormesh(
                edges, steps, _greatest(wall, np.array(data[key]), error, edges, steps), norm=norm, cmap=shades
            )
            ax.set(xscale="log", xlabel="wall / R0  (-)", ylabel=label)
            ax.set_xticks([0.06, 0.1, 0.15, 0.2, 0.3], ["0.06", "0.1", "0.15", "0.2", "0.3"])
            ax.minorticks_off()
        bar = drawn.colorbar(mesh, ax=axes, ticks=bounds, spacing="uniform")
        bar.set_label("greatest error in force, of full scale  (%)")
        bar.ax.set_yticklabels([f"{bound:g}" for bound in (*bounds[:-1], round(bounds[-1], 1))])
        return svg(drawn)


def _greatest(x: Array, y: Array, error: Array, x_edges: Array, y_edges: Array) -> Array:
    """The greatest error in each cell (rows: y), NaN where there is none."""
    i = np.clip(np.searchsorted(x_edges, x, side="right") - 1, 0, x_edges.size - 2)
    k = np.clip(np.searchsorted(y_edges, y, side="right") - 1, 0, y_edges.size - 2)
    found = np.full((y_edges.size - 1, x_edges.size - 1), -1.0)
    np.maximum.at(found, (k, i), error)
    return np.where(found < 0.0, np.nan, found)


def main() -> None:
    data = measure()
    for name, text in (("atlas.json", json.dumps(data) + "\n"), ("atlas.svg", draw(data)), ("atlas.md", page(data))):
        (DOCS / name).write_text(text, encoding="utf-8")
        print(f"wrote docs/background/{name}")


if __name__ == "__main__":
    main()
