"""Write docs/background/voxels.md with its pictures: ``make voxel-page`` (about two minutes)."""

from __future__ import annotations

import json
import resource
import tempfile
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import voxel_dither as dither
from benchmarks import voxel_raster as rasters
from benchmarks.voxel_text import page
from pneutouch.catalogue import Library, load_scene
from pneutouch.export.voxels.read import read_stack
from pneutouch.parts import assemble
from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, MUTED, figure, svg
from pneutouch.workflows.build.voxels import plan_voxels, write_voxels
from pneutouch.workflows.show.voxels import draw

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs" / "background"
SHOWN = 0.19
"""Fraction in the picture of the dithers: what the shipped grade reaches at its rim."""


def main() -> None:
    library = Library((ROOT,))
    assembly = assemble(load_scene("graded-dome", None, library))
    found: dict[str, Any] = {"stacks": [stack(assembly, library, mode) for mode in ("High Mix", "High Quality")]}
    found["dithers"] = [asdict(row) for row in dither.compare()]
    found["rasters"] = [asdict(row) for row in rasters.measure(assembly.solids[0])]
    (DOCS / "voxels.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    (DOCS / "dither.svg").write_text(dithers(), encoding="utf-8")
    (DOCS / "voxels.svg").write_text(chart(found["rasters"]), encoding="utf-8")
    (DOCS / "voxels.md").write_text(page(found), encoding="utf-8")


def stack(assembly: Any, library: Library, mode: str) -> dict[str, Any]:
    """One whole stack: what it took and what came out."""
    start = time.process_time()
    plan = plan_voxels(assembly, mode=mode, library=library)
    with tempfile.TemporaryDirectory() as scratch:
        folder, _ = write_voxels(plan, Path(scratch), "")
        seconds = time.process_time() - start
        start = time.process_time()
        held = read_stack(folder)
        reading = time.process_time() - start
        if mode == "High Mix":
            draw(held, DOCS / "voxels.png")
        return {
            "mode": mode,
            "layer_um": held.manifest["layer_um"],
            "pixels": held.manifest["pixels"],
            "layers": held.manifest["layers"],
            "seconds": seconds,
            "reading_seconds": reading,
            "peak_MB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
            "MB": sum(path.stat().st_size for path in folder.iterdir()) / 1e6,
            "bodies": held.manifest["bodies"],
        }


def dithers() -> str:
    """A layer and an upright section of each dither, and their spectra."""
    from matplotlib.colors import ListedColormap

    two = ListedColormap(["#FFFFFF", INK])
    edges = np.linspace(0.0, 14.0, 36)
    middle = 0.5 * (edges[1:] + edges[:-1])
    blocks = {method: make(SHOWN) for method, make in dither.METHODS.items()}
    with figure(180, 150) as drawn:
        grid = drawn.add_gridspec(3, 3, height_ratios=(1.0, 0.6, 0.9))
        below = drawn.add_subplot(grid[2, :])
        for column, (method, block) in enumerate(blocks.items()):
            layers, rows, columns = (n * step for n, step in zip(block.shape, reversed(dither.PITCH), strict=True))
            views = (
                ("one layer, from above", block[40], (0, columns, 0, rows)),
                ("upright section", block[::-1, 30], (0, columns, 0, layers)),
            )
            for row, (what, picture, extent) in enumerate(views):
                ax = drawn.add_subplot(grid[row, column])
                ax.imshow(picture, cmap=two, extent=extent, interpolation="nearest", aspect="equal", vmin=0, vmax=1)
                ax.grid(False)
                ax.set_xticks([0, 1, 2, 3, 4, 5])
                ax.set_title(f"{method}: {what}", fontsize=7)
                if column == 0:
                    ax.set_ylabel("mm")
            look = {"color": ACCENT if column == 0 else (INK if column == 1 else MUTED), "ls": LINES[column]}
            below.semilogy(middle, np.maximum(dither.radial(block, edges), 1e-3), label=method, **look)
        below.set_xlabel("frequency (1/mm)")
        below.set_ylabel("power over white noise's")
        below.set_title(f"Spectra at a fraction of {SHOWN:g}, averaged over all directions", fontsize=7.5)
        below.legend(loc="lower right")
        return svg(drawn)


def chart(rows: list[dict[str, Any]]) -> str:
    """Error of volume and of surface over time."""
    with figure(180, 80) as drawn:
        axes = drawn.subplots(1, 2)
        for k, method in enumerate(dict.fromkeys(row["method"] for row in rows)):
            mine = sorted((row for row in rows if row["method"] == method), key=lambda row: row["seconds"])
            seconds = [row["seconds"] for row in mine]
            look = {
                "color": ACCENT if k == 0 else (INK if k % 2 else MUTED),
                "marker": MARKERS[k],
                "ls": LINES[k],
                "lw": 2 if k == 0 else 0.9,
                "ms": 3.5,
            }
            axes[0].loglog(seconds, [100 * abs(row["volume"]) for row in mine], label=method, **look)
            axes[1].loglog(seconds, [1e3 * row["mean"] for row in mine], **look)
            axes[1].loglog(seconds, [1e3 * row["most"] for row in mine], **{**look, "lw": 0.4, "mfc": "none"})
        axes[0].set_ylabel("error of volume (%)")
        axes[1].set_ylabel("distance from the surface (µm)")
        axes[1].set_title("Boundary of the voxels: mean, and greatest (hollow)", fontsize=7.5)
        axes[0].set_title("Volume", fontsize=7.5)
        for ax in axes:
            ax.set_xlabel("processor time (s)")
        drawn.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
        return svg(drawn)


if __name__ == "__main__":
    main()
