"""The tuning chart: how far the driving pressure moves the sensitivity, with its interval."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.evaluation.chart_data import TuningChart
from pneutouch.report.style import ACCENT, BOLD, FAINT, INK, LINES, MUTED, Label, figure, label_ends, note, svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def tuning_chart(tuning: TuningChart, size: tuple[float, float]) -> str:
    """Sensitivity over driving pressure with its band, as SVG; ``size`` is width and height in mm."""
    chosen = tuning.chosen
    with figure(*size) as drawn:
        ax = drawn.add_subplot()
        _band(ax, tuning)
        at = float(chosen.driving_pressure_kPa[-1]), float(chosen.sensitivity_kPa_per_N[-1])
        ends: list[Label] = [(*at, chosen.label, {"fontsize": 6.5, "color": INK, **BOLD})]
        for k, other in enumerate(tuning.others):
            line = other.driving_pressure_kPa, other.sensitivity_kPa_per_N
            ax.plot(*line, color=INK, lw=0.7, ls=LINES[1 + k % 4], zorder=3)
            at = float(other.driving_pressure_kPa[-1]), float(other.sensitivity_kPa_per_N[-1])
            ends.append((*at, other.label, {"fontsize": 6.5, "color": MUTED}))
        ax.plot(chosen.driving_pressure_kPa, chosen.sensitivity_kPa_per_N, color=ACCENT, lw=2.0, zorder=4)
        if tuning.published_kPa_per_N:
            points = np.array(tuning.published_kPa_per_N).T
            ax.plot(*points, "D", color=INK, mfc="white", ms=4.5, zorder=6, clip_on=False)
        highest_kPa_per_N = chosen.sensitivity_kPa_per_N if tuning.high_kPa_per_N is None else tuning.high_kPa_per_N
        most = [float(highest_kPa_per_N.max())]
        most += [float(other.sensitivity_kPa_per_N.max()) for other in tuning.others]
        top = 1.12 * max(most + [value for _, value in tuning.published_kPa_per_N])
        right_kPa = float(max(chosen.driving_pressure_kPa[-1], *tuning.working_kPa_per_N))
        across = "\n".join(["driving pressure  (kPa)", *([tuning.caption] if tuning.caption else [])])
        ax.set(xlabel=across, ylabel="sensitivity  (kPa/N)", ylim=(0, top), xlim=(0, right_kPa))
        _mark(ax, tuning)
        if tuning.others:
            label_ends(ax, ends)
        return svg(drawn)


def _band(ax: Axes, tuning: TuningChart) -> None:
    """The k = 2 interval, where it is known."""
    if tuning.low_kPa_per_N is None or tuning.high_kPa_per_N is None:
        return
    look: dict[str, Any] = {"fc": FAINT, "alpha": 0.55, "ec": "none", "zorder": 1}
    along_kPa = tuning.chosen.driving_pressure_kPa
    ax.fill_between(along_kPa, tuning.low_kPa_per_N, tuning.high_kPa_per_N, **look)
    for edge_kPa_per_N in (tuning.low_kPa_per_N, tuning.high_kPa_per_N):
        ax.plot(along_kPa, edge_kPa_per_N, color=MUTED, lw=0.6, zorder=2)


def _mark(ax: Axes, tuning: TuningChart) -> None:
    """The working pressures on the curve, and words for the band and the diamonds where they stand."""
    for pressure, value in tuning.working_kPa_per_N.items():
        ax.plot([pressure, pressure], [0, value], color=INK, lw=0.6, ls=LINES[4], zorder=2)
        ax.plot(pressure, value, "o", color=INK, mfc="white", ms=4.5, zorder=5, clip_on=False)
    last, value = list(tuning.working_kPa_per_N.items())[-1]
    side = -1.0 if last > 0.5 * ax.get_xlim()[1] else 1.0
    note(ax, f"{value:.2f} kPa/N\nat {last:g} kPa", (last, 0.3 * value), (side, 0.0))
    if tuning.high_kPa_per_N is not None:
        middle = len(tuning.high_kPa_per_N) // 2
        note(ax, "k = 2", (tuning.chosen.driving_pressure_kPa[middle], tuning.high_kPa_per_N[middle]), (1.0, 1.0))
    if tuning.published_kPa_per_N:
        note(ax, "published measurement", tuning.published_kPa_per_N[0], (1.0, 0.5))
