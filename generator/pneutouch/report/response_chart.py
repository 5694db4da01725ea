"""A load and its reading over time, and the gain over frequency."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pneutouch.arrays import Array
from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, MUTED, figure, legend_above, plain_ticks, svg
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SIZE = (180.0, 70.0)
"""Width and height in mm: the text width of A4."""


@dataclass(frozen=True, slots=True)
class TimeCurves:
    """Curves over time (s): pressure rise (MPa) of a slow press, at the gauge, and the gauge's output (times,
    rises)."""

    time: Array
    slow: Array
    gauge: Array
    samples: tuple[Array, Array] | None = None


@dataclass(frozen=True, slots=True)
class GainCurve:
    """A gain over frequency (Hz)."""

    label: str
    frequency: Array
    gain: Array


def response_chart(curves: TimeCurves, gains: Sequence[GainCurve], size: tuple[float, float] = SIZE) -> str:
    """The signal on the left, the gains on the right; SVG."""
    with figure(*size) as drawn:
        left, right = drawn.subplots(1, 2)
        left.plot(curves.time, curves.slow / KPA, color=INK, ls=LINES[1], lw=0.9, label="slow press")
        left.plot(curves.time, curves.gauge / KPA, color=ACCENT, lw=0.9, label="at the gauge")
        if curves.samples is not None:
            time, rise = curves.samples
            left.plot(time, rise / KPA, color=INK, ls="", marker=MARKERS[0], ms=1.8, label="gauge, read")
        left.set(xlabel="time  (s)", ylabel="pressure rise  (kPa)")
        draw_gains(right, gains)
        legend_above(left)
        return svg(drawn)


def gain_chart(gains: Sequence[GainCurve], size: tuple[float, float]) -> str:
    """Gains over frequency alone; SVG."""
    with figure(*size) as drawn:
        ax = drawn.add_subplot()
        draw_gains(ax, gains)
        legend_above(ax)
        return svg(drawn)


def draw_gains(ax: Axes, gains: Sequence[GainCurve]) -> None:
    """Gains on axes of their own, both logarithmic, with the band of 3 dB."""
    ax.axhspan(0.5**0.5, 2.0**0.5, color=MUTED, alpha=0.15, lw=0)
    for k, one in enumerate(gains):
        colour = (INK, ACCENT, MUTED)[k % 3]
        ax.plot(one.frequency, one.gain, color=colour, ls=LINES[k % len(LINES)], lw=1.0, label=one.label)
    ax.set(xscale="log", yscale="log", xlabel="frequency  (Hz)", ylabel="gain over a slow press")
    ax.set_xlim(gains[0].frequency[0], gains[0].frequency[-1])
    plain_ticks(ax.xaxis)
    plain_ticks(ax.yaxis)
