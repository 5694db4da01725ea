"""The trade-off chart: what sensitivity costs in force range, resin by resin."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pneutouch.evaluation.chart_data import ChartPoint, TradeOff
from pneutouch.report.style import (
    ACCENT,
    BOLD,
    FAINT,
    INK,
    LINES,
    Label,
    figure,
    label_corner,
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
