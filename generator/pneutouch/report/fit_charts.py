"""Charts of fits and records: a fitted law, residuals of a calibration, a load and its reading, a run's evidence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.calibrate.goodness import RunResiduals
from pneutouch.bench.record import MeasuredCurve, Trace
from pneutouch.report.chart import WIDE, Chart, Panel, PlotLine, Span, drawn_svg
from pneutouch.report.style import ACCENT, INK, LINES, MARKERS, MUTED
from pneutouch.units import KPA, ML

_BAND = 5.0
"""Per cent within which a law is good enough."""

_TONES = (INK, ACCENT, MUTED)


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
    point = PlotLine(dashes="", tone=MUTED, size=2.6)
    top = [
        replace(
            point,
            x=stretch,
            y=stress,
            marker=MARKERS[k % len(MARKERS)],
            label="measured" if len(data) == 1 else f"specimen {k + 1}",
        )
        for k, (stretch, stress) in enumerate(data)
    ]
    bottom = []
    for k, law in enumerate(laws):
        look = PlotLine(tone=(ACCENT, INK)[k % 2], dashes=LINES[k % len(LINES)])
        top.append(replace(look, x=law.stretch, y=law.stress, label=law.label))
        off = replace(look, marker=MARKERS[k], size=2.0, filled=True, width=0.8)
        bottom.append(replace(off, x=law.off_at, y=100 * law.off))
    chosen, share = laws[0], 0.01 * _BAND
    ends = (1 - share) * chosen.stress, (1 + share) * chosen.stress
    top.append(PlotLine(chosen.stretch, label=f"±{_BAND:g} %", dashes="", low=ends[0], high=ends[1]))
    panels = (
        Panel(y="nominal stress  (MPa)", lines=tuple(top)),
        Panel(
            f"stretch  (tension up to {largest:.3g} fitted)",
            "law less measured\n(%)",
            tuple(bottom),
            spans=(Span(-_BAND, _BAND, "y"),),
            zero="y",
        ),
    )
    return drawn_svg(Chart(panels, (120.0, 110.0), shared="x", heights=(2.2, 1.0)))


def residual_chart(runs: Sequence[RunResiduals], size: tuple[float, float]) -> str:
    """Model less measured: force and pressure over indentation, and pressure over injected volume where there are
    injections.

    Pressures differ by marker, line and shade, so that they can be distinguished in grayscale. SVG, ``size`` in mm.
    """
    curves, pushed = [run for run in runs if run.force.size], [run for run in runs if not run.force.size]
    pressure, force = "pressure, model less\nmeasured  (kPa)", "force, model less\nmeasured  (N)"
    top, bottom = [], []
    for k, pressure_kPa in enumerate(sorted({run.driving_pressure_kPa for run in curves})):
        group = [run for run in curves if run.driving_pressure_kPa == pressure_kPa]
        top += _scattered(k, [(run.at, run.force) for run in group], f"driven at {pressure_kPa:g} kPa")
        bottom += _scattered(k, [(run.at, run.rise / KPA) for run in group], "")
    panels = []
    if curves:
        panels += [
            Panel("", force, tuple(top), zero="y"),
            Panel("indentation  (mm)", pressure, tuple(bottom), zero="y"),
        ]
    if pushed:
        each = [_scattered(k, [(run.at / ML, run.rise / KPA)], run.label) for k, run in enumerate(pushed)]
        lines = tuple(line for some in each for line in some)
        panels.append(Panel("injected volume  (mL)", pressure, lines, zero="y"))
    return drawn_svg(Chart(tuple(panels), size))


def _scattered(k: int, runs: Sequence[tuple[Array, Array]], label: str) -> list[PlotLine]:
    """Runs as points; the first carries the label, and a line joins their mean where they share their travels."""
    look = PlotLine(tone=_TONES[k % 3], dashes="", marker=MARKERS[k % len(MARKERS)], size=2.8, filled=k % 2 == 0)
    points = [replace(look, x=x, y=y, label="" if place else label) for place, (x, y) in enumerate(runs)]
    shortest = min((x for x, _ in runs), key=len)
    mean = np.mean([np.interp(shortest, x, y) for x, y in runs], axis=0)
    return [*points, PlotLine(shortest, mean, tone=look.tone, dashes=LINES[k % len(LINES)], width=0.9, over=2)]


@dataclass(frozen=True, slots=True)
class TimeCurves:
    """Curves over time (s): pressure rise (MPa) of a slow press, at the gauge, and its output (times, rises)."""

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


def response_chart(curves: TimeCurves, gains: Sequence[GainCurve]) -> str:
    """The signal on the left, the gains on the right; SVG."""
    lines = [
        PlotLine(curves.time, curves.slow / KPA, "slow press", dashes=LINES[1], width=0.9),
        PlotLine(curves.time, curves.gauge / KPA, "at the gauge", tone=ACCENT, width=0.9),
    ]
    if curves.samples is not None:
        time, rise = curves.samples
        lines.append(PlotLine(time, rise / KPA, "gauge, read", dashes="", marker=MARKERS[0], size=1.8, filled=True))
    left = Panel("time  (s)", "pressure rise  (kPa)", tuple(lines))
    return drawn_svg(Chart((left, gain_panel(gains)), (WIDE, 70.0), across=2))


def gain_panel(gains: Sequence[GainCurve]) -> Panel:
    """Gains over frequency, both logarithmic, with the band of 3 dB."""
    lines = [
        PlotLine(one.frequency, one.gain, one.label, tone=_TONES[k % 3], dashes=LINES[k % len(LINES)], width=1.0)
        for k, one in enumerate(gains)
    ]
    band = Span(0.5**0.5, 2.0**0.5, "y")
    ends = float(gains[0].frequency[0]), float(gains[0].frequency[-1])
    return Panel("frequency  (Hz)", "gain over a slow press", tuple(lines), xlim=ends, log="xy", spans=(band,))


def evidence_svg(curve: MeasuredCurve, thinned: Trace, simulated: bool) -> str:
    """Position, force and pressure over time; contact, the stretch read, and doubtful parts marked in each."""
    channels = (
        ("position  (mm)", thinned.position),
        ("force  (N)", thinned.force),
        ("pressure  (kPa)", thinned.pressure / KPA),
    )
    spans = [Span(*indent.read, tone=ACCENT, label="read") for indent in curve.indents]
    # A note applies to all the run, and would hide it.
    spans += [
        Span(one.start, max(one.end, one.start + 1e-3), tone=INK, hatched=True, label="doubtful")
        for one in curve.warnings
        if one.kind != "note"
    ]
    touched = [indent.contact for indent in curve.indents if np.isfinite(indent.contact)]
    panels = []
    for label, values in channels:
        ends = float(np.nanmin(values)), float(np.nanmax(values))
        lines = [PlotLine(thinned.time, values, width=0.6)]
        look = PlotLine(label="first contact", tone=MUTED, dashes=LINES[4], width=0.5)
        lines += [replace(look, x=(at, at), y=ends) for at in touched]
        panels.append(Panel("", label, tuple(lines), spans=tuple(spans)))
    words = f"{curve.run.label}: {curve.run.file}{'  (SIMULATED)' if simulated else ''}"
    panels[0], panels[-1] = replace(panels[0], title=words), replace(panels[-1], x="time  (s)")
    return drawn_svg(Chart(tuple(panels), (WIDE, 110.0), shared="x"))
