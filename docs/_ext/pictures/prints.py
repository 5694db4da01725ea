"""Charts of print files, drawn from the stored measurements: meshes, voxels and the dithers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from benchmarks.voxels import METHODS, PITCH, radial
from stored_pages import stored

from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, MUTED, figure, svg

OURS = "pneutouch"
SHOWN = 0.19
"""Fraction in the picture of the dithers: what the shipped grade reaches at its rim."""


def meshing() -> str:
    """Measured deviation over processor time above, over triangles below; one column a body."""
    found = stored("meshing")["bodies"]
    with figure(180, 125) as drawn:
        axes = drawn.subplots(2, len(found), sharey=True, sharex="row")
        for column, (label, rows) in enumerate(found.items()):
            for k, method in enumerate(dict.fromkeys(row["method"] for row in rows)):
                mine = sorted((row for row in rows if row["method"] == method), key=lambda row: row["deviation"])
                colour = ACCENT if method == OURS else (INK if k % 2 else MUTED)
                look = {
                    "color": colour,
                    "marker": MARKERS[k % len(MARKERS)],
                    "ls": LINES[k % len(LINES)],
                    "ms": 3.5,
                    "lw": 2 if method == OURS else 0.9,
                    "label": method,
                }
                error = [1e3 * row["deviation"] for row in mine]
                axes[0, column].loglog([row["milliseconds"] for row in mine], error, **look)
                axes[1, column].loglog([row["triangles"] for row in mine], error, **look)
            axes[0, column].set_title(label.capitalize(), fontsize=7.5)
            axes[0, column].set_xlabel("processor time (ms)")
            axes[1, column].set_xlabel("triangles")
        for row in axes:
            row[0].set_ylabel("greatest deviation (µm)")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        drawn.legend(handles, labels, loc="outside lower center", ncols=3)
        return svg(drawn)


def dither() -> str:
    """A layer and an upright section of each dither, and their spectra."""
    from matplotlib.colors import ListedColormap

    two = ListedColormap(["#FFFFFF", INK])
    edges = np.linspace(0.0, 14.0, 36)
    middle = 0.5 * (edges[1:] + edges[:-1])
    blocks = {method: make(SHOWN) for method, make in METHODS.items()}
    with figure(180, 150) as drawn:
        grid = drawn.add_gridspec(3, 3, height_ratios=(1.0, 0.6, 0.9))
        below = drawn.add_subplot(grid[2, :])
        for column, (method, block) in enumerate(blocks.items()):
            layers, rows, columns = (n * step for n, step in zip(block.shape, reversed(PITCH), strict=True))
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
            below.semilogy(middle, np.maximum(radial(block, edges), 1e-3), label=method, **look)
        below.set_xlabel("frequency (1/mm)")
        below.set_ylabel("power over white noise's")
        below.set_title(f"Spectra at a fraction of {SHOWN:g}, averaged over all directions", fontsize=7.5)
        below.legend(loc="lower right")
        return svg(drawn)


def voxels() -> str:
    """Error of volume and of surface over time."""
    rows: list[dict[str, Any]] = stored("voxels")["rasters"]
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


CHARTS: dict[str, Callable[[], str]] = {"meshing": meshing, "dither": dither, "voxels": voxels}
