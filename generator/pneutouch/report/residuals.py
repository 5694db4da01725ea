"""Residuals of a calibration over travel, by driving pressure: the remaining error of the fitted model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.goodness import RunResiduals
from pneutouch.report.style import ACCENT, FAINT, INK, LINES, MARKERS, MUTED, figure, svg
from pneutouch.units import KPA, ML

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SHADES = (INK, ACCENT, MUTED)


def residual_chart(runs: Sequence[RunResiduals], size: tuple[float, float]) -> str:
    """Model less measured: force and pressure over indentation, and pressure over injected volume where there are
    injections.

    Pressures differ by marker, line and shade, so that they can be distinguished in grayscale. SVG, ``size`` in mm.
    """
    curves, pushed = [run for run in runs if run.force.size], [run for run in runs if not run.force.size]
    panels = 2 * bool(curves) + bool(pushed)
    with figure(*size) as drawn:
        axes = np.atleast_1d(np.asarray(drawn.subplots(panels, 1)))
        if curves:
            _curves(axes[0], axes[1], curves)
            axes[0].sharex(axes[1])
        if pushed:
            _injections(axes[-1], pushed)
        drawn.align_ylabels(list(axes))
        return svg(drawn)


def _curves(top: Axes, bottom: Axes, curves: Sequence[RunResiduals]) -> None:
    pressures_kPa = sorted({run.driving_pressure_kPa for run in curves})
    for k, pressure_kPa in enumerate(pressures_kPa):
        group = [run for run in curves if run.driving_pressure_kPa == pressure_kPa]
        at = [run.at for run in group]
        _group(top, k, at, [run.force for run in group], f"{pressure_kPa:g} kPa")
        _group(bottom, k, at, [run.rise / KPA for run in group], None)
    top.set(ylabel="force, model less\nmeasured  (N)")
    bottom.set(ylabel="pressure, model less\nmeasured  (kPa)", xlabel="indentation  (mm)")
    top.legend(loc="best", ncols=min(len(pressures_kPa), 4), title="driving pressure", title_fontsize=7)


def _injections(ax: Axes, runs: Sequence[RunResiduals]) -> None:
    for k, run in enumerate(runs):
        _group(ax, k, [run.at / ML], [run.rise / KPA], run.label)
    ax.set(ylabel="pressure, model less\nmeasured  (kPa)", xlabel="injected volume  (mL)")
    ax.legend(loc="best")


def _group(ax: Axes, k: int, at: Sequence[Array], values: Sequence[Array], label: str | None) -> None:
    """Runs as points; the first carries the label, and a line joins their mean where they share their travels."""
    shade, marker = _SHADES[k % len(_SHADES)], MARKERS[k % len(MARKERS)]
    look: dict[str, Any] = {"ls": "none", "marker": marker, "ms": 2.8, "color": shade, "mew": 0.6, "zorder": 3}
    look["mfc"] = "white" if k % 2 else shade
    ax.axhline(0.0, color=FAINT, lw=0.8, zorder=1)
    for place, (x, y) in enumerate(zip(at, values, strict=True)):
        ax.plot(x, y, label=label if place == 0 else None, **look)
    shortest = min(at, key=len)
    mean = np.mean([np.interp(shortest, x, y) for x, y in zip(at, values, strict=True)], axis=0)
    ax.plot(shortest, mean, color=shade, ls=LINES[k % len(LINES)], lw=0.9, zorder=2)
