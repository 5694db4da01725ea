"""Measured points in the predicted band: sensitivity over driving pressure, rise over force, force over indentation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.record import MeasuredCurve
from pneutouch.mechanics.prediction import SensorState
from pneutouch.report.measured.panels import (
    GroupComparison,
    Panel,
    Plot,
    band_of,
    ends_of,
    key,
    lines_of,
    multiples,
    some,
)
from pneutouch.report.style import FAINT, INK, LINES, MARKERS, MUTED
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

SENSITIVITY, STIFFNESS = "sensitivity_kPa_per_N", "stiffness_N_per_mm"
_LEAST_SPAN = 20.0
"""Driving pressures closer together than this, kPa, do not make the slack of an axis smaller."""
_MOST_TICKS = 5


class _Axes(NamedTuple):
    """Axes of a plot: of a run, of a state, and the figure whose band the state's curve has."""

    measured: Callable[[MeasuredCurve], tuple[Array, Array]]
    predicted: Callable[[SensorState], tuple[Array, Array]]
    figure: str


def sensitivities(panels: Sequence[Panel]) -> Plot | None:
    """Sensitivity over driving pressure, means of the specimens with their intervals in the predicted band."""
    panels = [p for p in panels if any(SENSITIVITY in b.group.figures for b in p.comparisons)]
    if not panels:
        return None
    from matplotlib.lines import Line2D

    known = any(SENSITIVITY in b.predicted for p in panels for b in p.comparisons)
    legend: dict[str, Artist] = {"predicted": Line2D([], [], color=INK, lw=1.0), **band_of()} if known else {}
    for k, age in enumerate(_ages(panels)):
        legend[f"measured, {age}"] = Line2D([], [], ls="", **_spot(k))
    pressures_kPa = panels[0].campaign_pressures_kPa
    span_kPa = pressures_kPa[-1] - pressures_kPa[0]
    slack = 0.08 * max(span_kPa, _LEAST_SPAN)
    apart = min(np.diff(pressures_kPa), default=span_kPa) > 0.15 * span_kPa
    top = 1.12 * max(_greatest(comparison) for panel in panels for comparison in panel.comparisons)
    bottom = min(
        0.0,
        *(b.group.figures[SENSITIVITY].value for p in panels for b in p.comparisons if SENSITIVITY in b.group.figures),
    )

    def draw(ax: Axes, panel: Panel) -> None:
        _predicted_sensitivity(ax, panel, 0.5 * slack)
        _measured_sensitivity(ax, panel, _ages(panels), 0.18 * slack)
        ax.set(xlim=(pressures_kPa[0] - slack, pressures_kPa[-1] + slack), ylim=(1.12 * bottom, top or 1.0))
        if span_kPa == 0 or (apart and len(pressures_kPa) <= _MOST_TICKS):
            ax.set_xticks(pressures_kPa)

    labels = "driving pressure  (kPa)", "sensitivity  (kPa/N)"
    return multiples(panels, draw, labels, legend, shared=True)


def _ages(panels: Sequence[Panel]) -> list[str]:
    """Ages in words, the youngest first."""
    return list(
        {b.group.key.age_days: b.group.key.age for p in panels for b in sorted(p.comparisons, key=_age)}.values()
    )


def _age(comparison: GroupComparison) -> float:
    return comparison.group.key.age_days


def _spot(k: int) -> dict[str, Any]:
    return {"marker": MARKERS[k % len(MARKERS)], "ms": 3.6, "mec": INK, "mfc": INK if k == 0 else "white", "color": INK}


def _greatest(comparison: GroupComparison) -> float:
    """Upper end of the drawn range of a group."""
    measured, predicted = comparison.group.figures.get(SENSITIVITY), comparison.predicted.get(SENSITIVITY)
    ends = [] if measured is None else [measured.value, measured.high]
    return max((end for end in (*ends, *(predicted or ())) if end is not None), default=0.0)


def _predicted_sensitivity(ax: Axes, panel: Panel, half: float) -> None:
    """The band between driving pressures; of one alone a bar of ``half`` its width."""
    known = {
        b.group.key.driving_pressure_kPa: b.predicted[SENSITIVITY]
        for b in reversed(panel.comparisons)
        if SENSITIVITY in b.predicted
    }
    pressures = np.array(sorted(known))
    if not pressures.size:
        return
    value = np.array([known[p][0] for p in pressures])
    if pressures.size == 1:
        pressures, value = pressures[0] + half * np.array([-1.0, 1.0]), np.repeat(value, 2)
    ax.plot(pressures, value, color=INK, lw=1.0, zorder=2)
    ends = [bounds for bounds in (known[p][1:] for p in sorted(known)) if None not in bounds]
    if len(ends) == len(known):
        low, high = np.broadcast_to(np.array(ends, float).T, (2, len(ends)))
        low, high = (np.resize(end, pressures.size) for end in (low, high))
        ax.fill_between(pressures, low, high, fc=FAINT, alpha=0.55, ec="none", zorder=1)
        for end in (low, high):
            ax.plot(pressures, end, color=MUTED, lw=0.5, zorder=1)


def _measured_sensitivity(ax: Axes, panel: Panel, ages: list[str], aside: float) -> None:
    """Means with error bars; ages stand next to one another."""
    for comparison in panel.comparisons:
        estimate = comparison.group.figures.get(SENSITIVITY)
        if estimate is None:
            continue
        k = ages.index(comparison.group.key.age)
        place_kPa = comparison.group.key.driving_pressure_kPa + aside * (k - 0.5 * (len(ages) - 1))
        low, high = (estimate.value if end is None else end for end in (estimate.low, estimate.high))
        # Drawn by hand: caps of an error bar that is a point would hide the marker.
        ax.plot([place_kPa, place_kPa], [low, high], color=INK, lw=0.9, marker="_", ms=4 if high > low else 0, zorder=4)
        ax.plot(place_kPa, estimate.value, ls="", zorder=5, **_spot(k))


def responses(panels: Sequence[Panel]) -> Plot | None:
    """Pressure rise over force: every run's points over the predicted curves and their bands."""
    over = _Axes(
        lambda curve: (curve.force, curve.rise / KPA),
        lambda state: (state.force, state.pressure_rise / KPA),
        SENSITIVITY,
    )
    return _curves(panels, over, ("contact force  (N)", "pressure rise  (kPa)"))


def indentations(panels: Sequence[Panel]) -> Plot | None:
    """Force over indentation in the same way; the band is that of the stiffness."""
    over = _Axes(
        lambda curve: (curve.indentation, curve.force), lambda state: (state.indentation, state.force), STIFFNESS
    )
    return _curves(panels, over, ("indentation  (mm)", "contact force  (N)"))


def _curves(panels: Sequence[Panel], over: _Axes, labels: tuple[str, str]) -> Plot | None:
    panels = [panel for panel in panels if panel.has("steps")]
    if not panels:
        return None
    drawn = [b for p in panels for b in p.comparisons if b.group.of_kind("steps")]
    pressures_kPa = sorted({b.group.key.driving_pressure_kPa for b in drawn})
    legend: dict[str, Artist] = {**key(panels), **lines_of(panels, pressures_kPa)}
    if any(b.state is not None and b.relative_band(over.figure) for b in drawn):
        legend |= band_of()
    return multiples(panels, lambda ax, panel: _draw(ax, panel, over), labels, legend)


def _draw(ax: Axes, panel: Panel, over: _Axes) -> None:
    """Bands of two driving pressures at most: more cover one another. Of several ages the youngest's prediction."""
    shaded_kPa = ends_of(panel.driving_pressures_kPa)
    done: set[float] = set()
    for comparison in panel.comparisons:
        runs, pressure_kPa = some(comparison.group.of_kind("steps")), comparison.group.key.driving_pressure_kPa
        color, line = panel.tone(comparison)
        for curve in runs:
            joined = {"ls": line, "lw": 0.5, "color": color} if comparison.state is None else {}
            ax.plot(*over.measured(curve), zorder=4, **{**panel.spots(comparison, curve), **joined})
        if runs and comparison.state is not None and pressure_kPa not in done:
            done.add(pressure_kPa)
            _predicted(ax, panel, comparison, comparison.state, over, shade=pressure_kPa in shaded_kPa)
    ax.set(xlim=(0, None), ylim=(0, None))


def _predicted(
    ax: Axes, panel: Panel, comparison: GroupComparison, state: SensorState, over: _Axes, *, shade: bool
) -> None:
    """The predicted curve up to the end of its range, and its band where it is to be shaded."""
    kept = state.indentation <= state.range_end * (1 + 1e-12)
    x, y = (values[kept] for values in over.predicted(state))
    color, line = panel.tone(comparison)
    ax.plot(x, y, color=color, ls=line, lw=1.0, zorder=3)
    ends = comparison.relative_band(over.figure)
    if shade and ends:
        ax.fill_between(x, ends[0] * y, ends[1] * y, fc=FAINT, alpha=0.45, ec="none", zorder=1)
        for end in ends:
            ax.plot(x, end * y, color=color, ls=LINES[0], lw=0.35, zorder=2)
