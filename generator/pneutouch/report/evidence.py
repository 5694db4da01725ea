"""Evidence of the reading of a run: the channels over time with the parts that were found in them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pneutouch.bench.record import MeasuredCurve, SuspectInterval
from pneutouch.bench.trace import Trace
from pneutouch.report.style import ACCENT, FAINT, INK, MUTED, figure, svg
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SIZE = (180.0, 110.0)


def evidence_svg(curve: MeasuredCurve, thinned: Trace, simulated: bool) -> str:
    """Position, force and pressure over time; contact, the stretch read, and doubtful parts marked in each."""
    channels = (
        ("position  (mm)", thinned.position),
        ("force  (N)", thinned.force),
        ("pressure  (kPa)", thinned.pressure / KPA),
    )
    with figure(*_SIZE) as drawn:
        axes = drawn.subplots(3, 1, sharex=True)
        for ax, (label, values) in zip(axes, channels, strict=True):
            ax.plot(thinned.time, values, color=INK, lw=0.6)
            ax.set_ylabel(label)
            _mark(ax, curve)
        axes[0].set_title(
            f"{curve.run.label}: {curve.run.file}{'  (SIMULATED)' if simulated else ''}", fontsize=7.5, loc="left"
        )
        axes[2].set_xlabel("time  (s)")
        _key(axes[0], curve)
        return svg(drawn)


def _mark(ax: Axes, curve: MeasuredCurve) -> None:
    for indent in curve.indents:
        ax.axvspan(*indent.read, color=ACCENT, alpha=0.35, lw=0)
        if np.isfinite(indent.contact):
            ax.axvline(indent.contact, color=MUTED, lw=0.5, ls=":")
    for interval in _marked(curve):
        ax.axvspan(
            interval.start,
            max(interval.end, interval.start + 1e-3),
            facecolor="none",
            edgecolor=INK,
            hatch="////",
            lw=0.3,
        )


def _marked(curve: MeasuredCurve) -> list[SuspectInterval]:
    """Intervals to mark: a note applies to all the run, and would hide it."""
    return [interval for interval in curve.warnings if interval.kind != "note"]


def _key(ax: Axes, curve: MeasuredCurve) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles = [
        Patch(facecolor=ACCENT, alpha=0.35, label="read"),
        Line2D([], [], color=MUTED, lw=0.8, ls=":", label="first contact"),
    ]
    if _marked(curve):
        handles.append(Patch(facecolor="none", edgecolor=FAINT, hatch="////", label="doubtful"))
    ax.legend(handles=handles, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.2)
