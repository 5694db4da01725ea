"""Charts of the texture page: the scan, its sweeps, and the reduced model beside finite elements."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from stored_pages import stored

from pneutouch.catalogue import Library
from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, MUTED, figure, svg
from pneutouch.workflows.scan import run_scan
from pneutouch.workflows.scanned import spectra

ROOT = Path(__file__).resolve().parents[3]


def scan() -> str:
    """Pressure less its mean over the path, and its scalogram, in both states."""
    return spectra(run_scan("texture-specimen", "paper-dome", library=Library((ROOT,))))


def texture() -> str:
    """Amplitudes over driving pressure, depth, pitch and preload."""
    sweeps = stored("texture")["sweeps"]
    names = {
        "pressure": ("driving pressure  (kPa)", ["3 mm, surface", "6 mm, 2 mm deep", "6 mm, 4 mm deep"]),
        "depth": ("depth  (mm)", ["3 mm, 0 kPa", "3 mm, 22 kPa", "6 mm, 0 kPa", "6 mm, 22 kPa"]),
        "pitch": ("pitch  (mm)", ["surface, 0 kPa", "surface, 22 kPa", "2 mm deep, 0 kPa", "2 mm deep, 22 kPa"]),
        "preload": (
            "preload  (N)",
            ["3 mm surface, 0 kPa", "3 mm surface, 22 kPa", "6 mm, 2 mm deep, 0 kPa", "6 mm, 2 mm deep, 22 kPa"],
        ),
    }
    colours = [INK, ACCENT, MUTED, "#3D8FBF"]
    with figure(180, 130) as drawn:
        axes = drawn.subplots(2, 2)
        for ax, (key, (label, labels)) in zip(axes.ravel(), names.items(), strict=True):
            for k, (values, name) in enumerate(zip(sweeps[key]["y"], labels, strict=True)):
                ax.semilogy(sweeps[key]["x"], np.array(values, float), color=colours[k], ls=LINES[k], label=name)
            ax.axhline(sweeps["noise"][0], color=MUTED, lw=0.6, ls=LINES[4])
            ax.set(xlabel=label, ylabel="pressure amplitude  (Pa)", ylim=(0.02, None))
            ax.legend(loc="best", frameon=True, facecolor="white", edgecolor="none", framealpha=1.0)
        return svg(drawn)


def check() -> str:
    """The reduced model over the finite elements, sign and all."""
    data = stored("texture")["single"]
    with figure(180, 78) as drawn:
        axes = drawn.subplots(1, 2)
        for ax, pitch in zip(axes, (3.0, 6.0), strict=True):
            rows = [row for row in data if row["pitch"] == pitch]
            for k, radius in enumerate(sorted({row["radius"] for row in rows})):
                mine = [row for row in rows if row["radius"] == radius]
                depth, look = [row["depth"] for row in mine], {"color": (ACCENT, INK)[k], "marker": MARKERS[k]}
                ax.semilogy(
                    depth,
                    [1e3 * abs(row["fe"]) for row in mine],
                    ls=LINES[0],
                    label=f"finite elements, patch {radius:.2f} mm",
                    **look,
                )
                ax.semilogy(
                    depth,
                    [1e3 * abs(row["reduced"]) for row in mine],
                    ls=LINES[2],
                    mfc="white",
                    label=f"reduced, patch {radius:.2f} mm",
                    **look,
                )
            ax.set(xlabel="depth of the bars  (mm)", ylabel="compliance amplitude  (µm/N)")
            ax.set_title(f"pitch {pitch:g} mm", fontsize=7.5)
        drawn.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
        return svg(drawn)


CHARTS: dict[str, Callable[[], str]] = {"texture-scan": scan, "texture": texture, "texture-check": check}
