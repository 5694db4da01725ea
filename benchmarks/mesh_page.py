"""Write docs/background/meshing.md with its chart: ``make chart-meshes``."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

from benchmarks.meshing import MANIFOLD, OURS, TOLERANCES, Row, measure, same_error
from pneutouch.catalogue import Library, load_scene
from pneutouch.parts import assemble
from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, MUTED, figure, svg
from pneutouch.spec.read import parse_changes

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs" / "background"

BODIES = {
    "membrane": ("paper-dome", []),
    "connector": ("paper-dome", []),
    "connector, side port": ("stiff-dome", ["connector.port=thread-M5", "connector.mount=robot-50-4-M6"]),
}


def main() -> None:
    library = Library((ROOT,))
    found: dict[str, list[Row]] = {}
    for label, (design, chosen) in BODIES.items():
        assembly = assemble(load_scene(design, parse_changes(chosen), library))
        found[label] = measure(assembly.solid(label.split(",")[0]))
    (DOCS / "meshing.svg").write_text(chart(found), encoding="utf-8")
    content = {label: [asdict(row) for row in rows] for label, rows in found.items()}
    (DOCS / "meshing.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    (DOCS / "meshing.md").write_text("\n".join(page(found)), encoding="utf-8")
    for line in summary(found):
        print(line)


def summary(found: dict[str, list[Row]]) -> list[str]:
    """One line a body: the ratios that the page is about."""
    lines = []
    for label, rows in found.items():
        ours = {row.tolerance: row for row in rows if row.method == OURS}
        alone = [ours[r.tolerance].milliseconds / r.milliseconds for r in rows if r.method == MANIFOLD]
        kernels = [ratio for t in TOLERANCES if (ratio := same_error(rows, t, "CadQuery")) is not None]
        lines.append(
            f"{label}: {min(alone):.2f} to {max(alone):.2f} of the time of manifold3d alone; CadQuery takes "
            f"{min(kernels):.0f} to {max(kernels):.0f} times as long at the same measured error"
        )
    return lines


def page(found: dict[str, list[Row]]) -> list[str]:
    """The lines of the page."""
    lines = [
        "# Print meshes: time against deviation",
        "",
        "How many triangles and how much time does a print mesh of a stated accuracy take? pneutouch keeps every tolerance with the fewest triangles of all methods that "
        f"keep it, and takes {_least_most(found)} of the time of manifold3d, the fastest other kernel. *Deviation* is the greatest distance of dense points on the mesh "
        "from the exact surface.",
        "",
        "![Measured deviation over processor time and over triangles, three bodies](meshing.svg)",
        "",
        "*Greatest deviation over processor time (above) and over triangles (below), for three bodies.*",
        "",
        *[f"- {line}" for line in summary(found)],
        "",
        "Each ring has only as many vertices as its radius requires, and the error is split between inside and outside so that the volume is kept. *manifold3d alone* does the same operations "
        "on inscribed outlines: its revolve, its cylinders and one batch boolean for union and one for difference. CadQuery passes its tolerance to Open CASCADE as a relative one and misses an "
        "absolute one; its meshes are open by index until vertices are merged.",
        "",
        "In the tables time is processor time over that of pneutouch in the same run (median of seven, taken in turn), and deviation is over the tolerance requested. `make chart-meshes` writes this page.",
        "",
    ]
    for label, rows in found.items():
        lines += [f"## {label.capitalize()}", "", *_table(rows), ""]
    return [
        *lines,
        "## Limits",
        "",
        "Two designs, three bodies and four tolerances. Times are of one machine: only their ratios are comparable.",
        "",
    ]


def _least_most(found: dict[str, list[Row]]) -> str:
    """Least and greatest time of pneutouch over that of manifold3d alone, all bodies and tolerances."""
    shares = []
    for rows in found.values():
        ours = {row.tolerance: row for row in rows if row.method == OURS}
        shares += [ours[r.tolerance].milliseconds / r.milliseconds for r in rows if r.method == MANIFOLD]
    return f"{min(shares):.2f} to {max(shares):.2f}"


def _table(rows: list[Row]) -> list[str]:
    """Every method at every tolerance."""
    ours = {row.tolerance: row for row in rows if row.method == OURS}
    return [
        "| tolerance mm | method | time / pneutouch | triangles | deviation / tolerance | volume error |",
        "|---|---|---|---|---|---|",
        *(
            f"| {row.tolerance:g} | {row.method} | {row.milliseconds / ours[row.tolerance].milliseconds:.1f} | {row.triangles} | "
            f"{row.deviation / row.tolerance:.2f} | {row.volume_error:+.1e} |"
            for row in sorted(rows, key=lambda r: -r.tolerance)
            if row.tolerance in ours
        ),
    ]


def chart(found: dict[str, list[Row]]) -> str:
    """Measured deviation over processor time above, over triangles below; one column a body."""
    with figure(180, 125) as drawn:
        axes = drawn.subplots(2, len(found), sharey=True, sharex="row")
        for column, (label, rows) in enumerate(found.items()):
            for k, method in enumerate(dict.fromkeys(row.method for row in rows)):
                mine = sorted((row for row in rows if row.method == method), key=lambda row: row.deviation)
                colour = ACCENT if method == OURS else (INK if k % 2 else MUTED)
                look = {
                    "color": colour,
                    "marker": MARKERS[k % len(MARKERS)],
                    "ls": LINES[k % len(LINES)],
                    "ms": 3.5,
                    "lw": 2 if method == OURS else 0.9,
                    "label": method,
                }
                error = [1e3 * row.deviation for row in mine]
                axes[0, column].loglog([row.milliseconds for row in mine], error, **look)
                axes[1, column].loglog([row.triangles for row in mine], error, **look)
            axes[0, column].set_title(label.capitalize(), fontsize=7.5)
            axes[0, column].set_xlabel("processor time (ms)")
            axes[1, column].set_xlabel("triangles")
        for row in axes:
            row[0].set_ylabel("greatest deviation (µm)")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        drawn.legend(handles, labels, loc="outside lower center", ncols=3)
        return svg(drawn)


if __name__ == "__main__":
    main()
