"""A fitted law: data and law over stretch, and their difference.

Residuals of a calibration over travel, by driving pressure: the remaining error of the fitted model.

A load and its reading over time, and the gain over frequency.

Evidence of the reading of a run: the channels over time with the parts that were found in them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.goodness import RunResiduals
from pneutouch.bench.record import MeasuredCurve, SuspectInterval, Trace
from pneutouch.report.style import ACCENT, FAINT, INK, LINES, MARKERS, MUTED, figure, legend_above, plain_ticks, svg
from pneutouch.units import KPA, ML

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_SHADES = (ACCENT, INK)
_BAND = 5.0
"""Per cent within which a law is good enough."""


class LawCurve(NamedTuple):
    """A law: nominal stress (MPa) over stretch, and its relative differences to the data at stretches ``off_at``."""

    label: str
    stretch: Array
    stress: Array
    off_at: Array
    off: Array


def law_chart(data: Sequence[tuple[Array, Array]], laws: Sequence[LawCurve], largest: float) -> str:
    """Nominal stress over stretch, specimens as points and laws as lines with a band of 5 %, and below the difference.

    SVG. Laws differ by line and shade, specimens by marker, so that they can be distinguished in grayscale.
    """
    with figure(120.0, 110.0) as drawn:
        top, bottom = drawn.subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
        for k, (stretch, stress) in enumerate(data):
            label = "measured" if len(data) == 1 else f"specimen {k + 1}"
            marker = MARKERS[k % len(MARKERS)]
            top.plot(stretch, stress, ls="none", marker=marker, ms=2.6, mfc="white", color=MUTED, mew=0.6, label=label)
        for k, law in enumerate(laws):
            look = {"color": _SHADES[k % 2], "ls": LINES[k % len(LINES)], "lw": 1.2, "zorder": 3}
            top.plot(law.stretch, law.stress, label=law.label, **look)
            bottom.plot(law.off_at, 100 * law.off, marker=MARKERS[k], ms=2.0, **{**look, "lw": 0.8})
        chosen = laws[0]
        share = 1.0 + 0.01 * np.array([-_BAND, _BAND])
        top.fill_between(
            chosen.stretch, share[0] * chosen.stress, share[1] * chosen.stress, color=FAINT, lw=0, label="±5 %"
        )
        bottom.axhspan(-_BAND, _BAND, color=FAINT, lw=0, zorder=0)
        bottom.axhline(0.0, color=MUTED, lw=0.6)
        top.set(ylabel="nominal stress  (MPa)")
        bottom.set(ylabel="law less measured\n(%)", xlabel=f"stretch  (tension up to {largest:.3g} fitted)")
        top.legend(loc="best")
        drawn.align_ylabels([top, bottom])
        return svg(drawn)


_SHADE_OF = (INK, ACCENT, MUTED)


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
    shade, marker = _SHADE_OF[k % len(_SHADE_OF)], MARKERS[k % len(MARKERS)]
    look: dict[str, Any] = {"ls": "none", "marker": marker, "ms": 2.8, "color": shade, "mew": 0.6, "zorder": 3}
    look["mfc"] = "white" if k % 2 else shade
    ax.axhline(0.0, color=FAINT, lw=0.8, zorder=1)
    for place, (x, y) in enumerate(zip(at, values, strict=True)):
        ax.plot(x, y, label=label if place == 0 else None, **look)
    shortest = min(at, key=len)
    mean = np.mean([np.interp(shortest, x, y) for x, y in zip(at, values, strict=True)], axis=0)
    ax.plot(shortest, mean, color=shade, ls=LINES[k % len(LINES)], lw=0.9, zorder=2)


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
