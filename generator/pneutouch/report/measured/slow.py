"""Effects of time and direction: hysteresis loops, relaxation, ageing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.figure import FIRST
from pneutouch.bench.record import MeasuredCurve
from pneutouch.report.measured.comparison import CampaignReport
from pneutouch.report.measured.panels import NARROW, TONES, Panel, Plot, ends_of, key, multiples, some
from pneutouch.report.style import INK, LINES, MARKERS, MUTED, figure, plain_ticks, svg
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_POINTS = 120
"""Points of a branch that are drawn."""
_PER_DECADE = 8
"""Points of a relaxation a decade of time."""


def loops(panels: Sequence[Panel]) -> Plot | None:
    """Rise over force in and out, of one run at the lowest and at the highest driving pressure.

    More loops in a panel, or those of several specimens, would hide one another.
    """
    from matplotlib.lines import Line2D

    panels = [
        panel for panel in panels if any(_loop_of(panel, pressure_kPa) for pressure_kPa in panel.driving_pressures_kPa)
    ]
    if not panels:
        return None
    pressures_kPa = sorted(
        {
            pressure_kPa
            for panel in panels
            for pressure_kPa in ends_of(panel.driving_pressures_kPa)
            if _loop_of(panel, pressure_kPa)
        }
    )
    tones = {pressure_kPa: TONES[k % len(TONES)] for k, pressure_kPa in enumerate(pressures_kPa)}
    legend: dict[str, Any] = {
        **{f"{p:g} kPa": Line2D([], [], ls="", marker="s", ms=5, color=tone) for p, tone in tones.items()},
        "loading": Line2D([], [], color=INK, lw=0.9),
        "unloading": Line2D([], [], color=INK, lw=0.9, ls=LINES[1]),
    }

    def draw(ax: Axes, panel: Panel) -> None:
        for pressure_kPa in ends_of(panel.driving_pressures_kPa):
            curve = _loop_of(panel, pressure_kPa)
            for force_up, rise_up, force_down, rise_down in curve.loop if curve else ():
                ax.plot(*_thin(force_up, rise_up / KPA), color=tones[pressure_kPa], lw=0.9)
                ax.plot(*_thin(force_down, rise_down / KPA), color=tones[pressure_kPa], lw=0.9, ls=LINES[1])
        ax.set(xlim=(0, None), ylim=(0, None))

    return multiples(panels, draw, ("contact force  (N)", "pressure rise  (kPa)"), legend)


def _loop_of(panel: Panel, driving_pressure_kPa: float) -> MeasuredCurve | None:
    """The first loop run at a driving pressure."""
    runs = (
        curve
        for comparison in panel.comparisons
        if comparison.group.key.driving_pressure_kPa == driving_pressure_kPa
        for curve in comparison.group.of_kind("loop")
        if curve.loop
    )
    return next(runs, None)


def _thin(x: Array, y: Array) -> tuple[Array, Array]:
    step = max(len(x) // _POINTS, 1)
    return x[::step], y[::step]


def relaxations(panels: Sequence[Panel]) -> Plot | None:
    """Force and pressure rise over the logarithm of time, in percent of their value at `FIRST`; every run."""
    from matplotlib.lines import Line2D

    panels = [panel for panel in panels if any(curve.relaxation is not None for curve in _relaxed(panel))]
    if not panels:
        return None
    legend: dict[str, Any] = {
        **key(panels),
        "force": Line2D([], [], color=INK, lw=0.9),
        "pressure rise": Line2D([], [], color=MUTED, lw=0.9, ls=LINES[1]),
    }

    def draw(ax: Axes, panel: Panel) -> None:
        ax.set_xscale("log")
        for comparison in panel.comparisons:
            for curve in some(comparison.group.of_kind("relaxation")):
                _relaxation(ax, curve, panel.spots(comparison, curve))
        plain_ticks(ax.xaxis)

    return multiples(
        panels, draw, ("time in the hold  (s)", f"share of the value at {FIRST:g} s  (%)"), legend, shared=True
    )


def _relaxed(panel: Panel) -> list[MeasuredCurve]:
    return [curve for comparison in panel.comparisons for curve in comparison.group.of_kind("relaxation")]


def _relaxation(ax: Axes, curve: MeasuredCurve, look: dict[str, Any]) -> None:
    if curve.relaxation is None:
        return
    time, *channels = curve.relaxation
    if time.size == 0 or time[-1] <= FIRST:
        return
    edges = np.geomspace(FIRST, time[-1], max(int(_PER_DECADE * np.log10(time[-1] / FIRST)), 2) + 1)
    later = time >= FIRST
    which = np.digitize(time[later], edges[1:-1])
    count = np.bincount(which)
    seconds, *means = (
        np.bincount(which, weights=part[later])[count > 0] / count[count > 0] for part in (time, *channels)
    )
    for values, color, line in zip(means, (INK, MUTED), LINES[:2], strict=True):
        style = {
            **look,
            "ls": line,
            "color": color,
            "mec": color,
            "lw": 0.7,
            "markevery": 3,
            "mfc": color if look["mfc"] != "white" else "white",
        }
        ax.plot(seconds, 100 * values / values[0], **style)


def ageings(measured: CampaignReport) -> Plot | None:
    """Change of sensitivity between ages with its interval, one row a group; and the paper's change in a year."""
    rows = measured.ageing
    if not rows:
        return None
    with figure(NARROW, 22 + 5.2 * len(rows)) as drawn:
        ax = drawn.add_subplot()
        for k, (_, _, _, change, low, high, paper) in enumerate(rows):
            if low is not None and high is not None:
                ax.plot([low, high], [k, k], color=INK, lw=0.9, marker="|", ms=4)
            ax.plot(change, k, ls="", marker="o", color=INK, ms=3.6, label="measured" if k == 0 else None)
            if paper is not None:
                first = all(row[6] is None for row in rows[:k])
                ax.plot(
                    [-paper, paper],
                    [k, k],
                    ls="",
                    marker=MARKERS[3],
                    color=INK,
                    mfc="white",
                    ms=4.2,
                    label="paper, one year (sign not given)" if first else None,
                )
        ax.axvline(0, color=INK, lw=0.6)
        ax.set_yticks(range(len(rows)), [_short(row) for row in rows])
        ax.set(xlabel="change of sensitivity  (%)", ylim=(len(rows) - 0.4, -0.6))
        ax.grid(visible=False, axis="y")
        drawn.legend(loc="outside upper left", ncols=2, handletextpad=0.2)
        return Plot(svg(drawn), wide=False)


def _short(row: tuple[Any, ...]) -> str:
    return f"{row[0]}, {row[1]:g} kPa, {row[2]}".replace("$", r"\$")
