"""The plots of the datasheet. Every axis carries its quantity and unit; line style and marker tell curves apart."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.mechanics import Prediction, Sensor
from pneutouch.mechanics.inflation import LIMIT_HEIGHT, membrane_stretch, pressure
from pneutouch.meridian.segments import Array
from pneutouch.report.style import ACCENT, BOLD, FAINT, INK, LINES, MARKERS, MUTED, figure, label_ends, svg
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SIZE = (86.0, 62.0)
"""Width and height of a plot in mm: two in a row on A4."""


def inflation(sensor: Sensor, prediction: Prediction) -> str:
    """Driving pressure over inner apex height, both branches, with the limit point and the other limits."""
    x = np.concatenate([np.linspace(1.0, LIMIT_HEIGHT, 120), np.linspace(LIMIT_HEIGHT, 3.2, 120)[1:]])
    height = x * sensor.inner_radius
    p = pressure(x, sensor.inner_radius, sensor.wall_thickness, sensor.shear_modulus) / KPA
    point = prediction.limit_point
    with figure(*SIZE) as drawn:
        ax = drawn.add_subplot()
        rising = x <= LIMIT_HEIGHT
        ax.plot(height[rising], p[rising], color=ACCENT, lw=1.6)
        ax.plot(height[~rising], p[~rising], color=MUTED, ls=LINES[1])
        for state in prediction.states:
            label = "driving pressures of this design" if state is prediction.states[0] else None
            ax.plot(
                state.apex_inner,
                state.driving_pressure / KPA,
                "o",
                color=INK,
                ms=3.5,
                mfc="white",
                zorder=3,
                label=label,
            )
        ax.plot(point.apex_inner, point.driving_pressure / KPA, "D", color=INK, ms=4.5, zorder=4)
        ax.annotate(
            f"limit point\n{point.driving_pressure / KPA:.1f} kPa, {point.apex_inner:.2f} mm",
            (point.apex_inner, point.driving_pressure / KPA), xytext=(0, 7), textcoords="offset points", ha="center",
        )  # fmt: skip
        _mark_limits(ax, sensor, height, p)
        ax.set(xlabel="inner apex height  (mm)", ylabel="driving pressure  (kPa)", ylim=(0, 1.28 * p.max()))
        ax.legend(loc="lower right", handletextpad=0.2)
        return svg(drawn)


def _mark_limits(ax: Axes, sensor: Sensor, height: Array, p: Array) -> None:
    gauge = sensor.gauge_limit / KPA
    if gauge < 1.2 * p.max():
        ax.axhline(gauge, color=MUTED, lw=0.8, ls=LINES[4])
        ax.text(height[-1], gauge, f"gauge range {gauge:g} kPa", ha="right", va="bottom", color=MUTED, fontsize=6.5)
    stretch = membrane_stretch(height / sensor.inner_radius)
    if sensor.break_stretch is not None and stretch[-1] > sensor.break_stretch:
        k = int(np.argmax(stretch > sensor.break_stretch))
        ax.plot(height[k], p[k], "X", color=INK, ms=5)
        ax.annotate("break strain", (height[k], p[k]), xytext=(0, -11), textcoords="offset points", ha="center", fontsize=6.5)


def response(prediction: Prediction) -> str:
    """Pressure rise over contact force at each driving pressure, with the fitted lines."""
    with figure(*SIZE) as drawn:
        ax = drawn.add_subplot()
        for k, state in enumerate(prediction.states):
            kept = state.indentation <= state.range_end * (1 + 1e-12)
            force, rise = state.force, state.pressure_rise / KPA
            look: dict[str, Any] = {"color": INK if k % 2 == 0 else ACCENT, "ls": LINES[k % len(LINES)]}
            ax.plot(force[kept], rise[kept], marker=MARKERS[k % len(MARKERS)], mfc="white", mew=0.8,
                    label=f"{state.driving_pressure / KPA:g} kPa", **look)  # fmt: skip
            if state.figures is not None:
                line = state.figures.intercept + state.figures.sensitivity * force[kept]
                ax.plot(force[kept], line, color=FAINT, lw=0.8, zorder=1)
        ax.set(xlabel="contact force  (N)", ylabel="pressure rise  (kPa)", xlim=(0, None), ylim=(0, None))
        ax.legend(title="driving pressure", title_fontsize=7, loc="upper left", handlelength=3)
        return svg(drawn)


def indentation(prediction: Prediction) -> str:
    """Contact force over indentation at each driving pressure."""
    with figure(*SIZE) as drawn:
        ax = drawn.add_subplot()
        for k, state in enumerate(prediction.states):
            kept = state.indentation <= state.range_end * (1 + 1e-12)
            ax.plot(
                state.indentation[kept], state.force[kept], marker=MARKERS[k % len(MARKERS)], mfc="white", mew=0.8,
                color=INK if k % 2 == 0 else ACCENT, ls=LINES[k % len(LINES)], label=f"{state.driving_pressure / KPA:g} kPa",
            )  # fmt: skip
        ax.set(xlabel="indentation  (mm)", ylabel="contact force  (N)", xlim=(0, None), ylim=(0, None))
        ax.legend(title="driving pressure", title_fontsize=7, loc="upper left", handlelength=3)
        return svg(drawn)


def sensitivities(curves: dict[str, tuple[Array, Array]], chosen: str, published: dict[float, float]) -> str:
    """Sensitivity over driving pressure for every resin, the chosen one picked out.

    ``curves`` maps a label to driving pressures and sensitivities (kPa, kPa/N); ``published`` maps driving
    pressures to measured sensitivities of this very sensor, where there are any.
    """
    with figure(*SIZE) as drawn:
        ax = drawn.add_subplot()
        ends = []
        for k, (label, (pressures, values)) in enumerate(curves.items()):
            mine = label == chosen
            look: dict[str, Any] = {
                "color": ACCENT if mine else MUTED,
                "lw": 2.0 if mine else 0.8,
                "ls": LINES[0] if mine else LINES[k % 4],
            }
            ax.plot(pressures, values, zorder=3 if mine else 2, **look)
            style = {"fontsize": 6.5, "color": INK, **BOLD} if mine else {"fontsize": 6.5, "color": MUTED}
            ends.append((float(values[-1]), label, style))
        if published:
            ax.plot(list(published), list(published.values()), "D", color=INK, mfc="white", ms=4.5, zorder=5,
                    label="published measurement")  # fmt: skip
            ax.legend(loc="lower left")
        right = max(float(pressures[-1]) for pressures, _ in curves.values())
        highest = max([float(np.max(values)) for _, values in curves.values()] + list(published.values()))
        ax.set(
            xlabel="driving pressure  (kPa)",
            ylabel="sensitivity  (kPa/N)",
            xlim=(0, 1.02 * right),
            ylim=(0, 1.1 * highest),
        )
        label_ends(ax, ends, right, 0.062 * 1.1 * highest)
        return svg(drawn)
