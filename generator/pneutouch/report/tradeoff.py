"""The trade-off chart: what sensitivity costs in force range, resin by resin.

The tuning chart: how far the driving pressure moves the sensitivity, with its interval.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.evaluation.sheet_data import ChartPoint, TradeOff, TuningChart
from pneutouch.report.style import (
    ACCENT,
    BOLD,
    FAINT,
    INK,
    LINES,
    MUTED,
    Label,
    figure,
    label_corner,
    label_ends,
    legend_above,
    note,
    plain_ticks,
    svg,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def tradeoff_chart(tradeoff: TradeOff, size: tuple[float, float]) -> str:
    """Greatest force range over sensitivity, both logarithmic, as SVG; ``size`` is width and height in mm."""
    chosen = tradeoff.spots[0].resin if tradeoff.spots else ""
    with figure(*size) as drawn:
        ax = drawn.add_subplot()
        sensitivity = f"sensitivity at {tradeoff.driving_pressure_kPa:g} kPa  (kPa/N)"
        sensitivity += f"\n{tradeoff.caption}" if tradeoff.caption else ""
        ax.set(xscale="log", yscale="log", xlabel=sensitivity, ylabel="greatest force range  (N)", **_limits(tradeoff))
        _window(ax, tradeoff)
        _gauge(ax, tradeoff)
        _spots(ax, tradeoff.spots)
        starts: list[Label] = []
        for k, front in enumerate(tradeoff.known):
            s, force, title = front.sensitivity_kPa_per_N, front.force, front.resin.material.title
            picked = title == chosen
            colour, line = ACCENT if picked else INK, LINES[0] if picked else LINES[k % len(LINES)]
            ax.plot(s, force, color=colour, lw=2.0 if picked else 0.8, zorder=4 if picked else 3, ls=line)
            ax.plot(s[0], force[0], "o", color=colour, ms=2.2, zorder=4)
            look: dict[str, Any] = {"color": INK, **(BOLD if picked else {})}
            starts.append((float(s[0]), float(force[0]), f"{title}  {s[0]:.2g} to {s[-1]:.2g}", look))
        label_corner(ax, starts)
        legend_above(ax)
        for axis in (ax.xaxis, ax.yaxis):
            plain_ticks(axis)
        return svg(drawn)


def _spots(ax: Axes, spots: tuple[ChartPoint, ...]) -> None:
    for k, (_, label, sensitivity, force) in enumerate(spots):
        ax.plot(sensitivity, force, "o", color=INK, mfc=INK if k == 0 else "white", ms=4.5, zorder=6 + (k == 0))
        note(ax, label, (sensitivity, force), (-1.0, -1.0), color=INK, **(BOLD if k == 0 else {}))


def _limits(tradeoff: TradeOff) -> dict[str, tuple[float, float]]:
    """Limits that hold the fronts, the designs and the window, with a margin and with space for the labels."""
    x = [float(value) for front in tradeoff.known for value in front.sensitivity_kPa_per_N]
    y = [float(value) for front in tradeoff.known for value in front.force]
    x += [spot.sensitivity_kPa_per_N for spot in tradeoff.spots] + list(tradeoff.window_kPa_per_N or ())
    y += [spot.force for spot in tradeoff.spots] + ([] if tradeoff.force is None else [tradeoff.force])
    left, right = min(x, default=0.1) / 1.3, max(x, default=10.0) * 1.3
    low, high = min(y, default=0.1) / 1.4, max(y, default=10.0) * 1.4
    # The labels stand in the upper right corner, above the gauge's limit: it has to leave them the half of the height.
    limit = tradeoff.gauge_kPa / (left * right) ** 0.5
    return {"xlim": (left, right), "ylim": (low, max(high, low * (limit / low) ** 2))}


def _window(ax: Axes, tradeoff: TradeOff) -> None:
    """The target's window: from its least to its greatest sensitivity, upwards of its force range."""
    if tradeoff.window_kPa_per_N is None and tradeoff.force is None:
        return
    from matplotlib.patches import Rectangle

    low, high = tradeoff.window_kPa_per_N or ax.get_xlim()
    least, top = tradeoff.force or ax.get_ylim()[0], ax.get_ylim()[1]
    look: dict[str, Any] = {"fc": FAINT, "alpha": 0.6, "ec": INK, "lw": 0.6, "zorder": 1}
    ax.add_patch(Rectangle((low, least), high - low, top - least, gid="target-window", **look))
    middle = (low * high) ** 0.5
    note(ax, "target", (middle, top), (0.0, -1.0), **BOLD)


def _gauge(ax: Axes, tradeoff: TradeOff) -> None:
    """Draw the line at which the cavity pressure reaches the end of the pressure sensor's range: no design is
    beyond."""
    low, high = ax.get_xlim()
    label = f"end of the gauge's range: force × sensitivity = {tradeoff.gauge_kPa:g} kPa"
    edge = [tradeoff.gauge_kPa / low, tradeoff.gauge_kPa / high]
    # Cut off straight: so wide a line would run into its own text in the legend.
    ax.plot([low, high], edge, color=FAINT, lw=5, zorder=2, label=label, solid_capstyle="butt")


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
