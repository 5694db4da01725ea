"""Charts as SVG: a fitted law, residuals of a calibration, the response to a load, and a measured run."""

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
"""Difference from the data, %, up to which a law is good enough; drawn as a band."""

_TONES = (INK, ACCENT, MUTED)


class LawCurve(NamedTuple):
    """A law: nominal stress (MPa) over stretch, (n,), and its relative difference ``off`` from data at ``off_at``."""

    label: str
    stretch: Array
    stress: Array
    off_at: Array
    off: Array


def law_chart(data: Sequence[tuple[Array, Array]], laws: Sequence[LawCurve], largest: float) -> str:
    """SVG of nominal stress over stretch: specimens as points, laws as lines; below, law less measured in percent.

    ``data``: stretch and stress of each specimen. The first law has a band of 5 %; tension was fitted up to
    ``largest``.
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
    """SVG, ``size`` in mm, of model less measured: force and pressure over indentation, pressure over injected volume.

    Panels without runs are left out. Driving pressures differ by marker, line and shade, also in grayscale.
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
    """Runs (x, y) as points, the first one labelled, and a line through their mean at x of the run of fewest points."""
    look = PlotLine(tone=_TONES[k % 3], dashes="", marker=MARKERS[k % len(MARKERS)], size=2.8, filled=k % 2 == 0)
    points = [replace(look, x=x, y=y, label="" if place else label) for place, (x, y) in enumerate(runs)]
    shortest = min((x for x, _ in runs), key=len)
    mean = np.mean([np.interp(shortest, x, y) for x, y in runs], axis=0)
    return [*points, PlotLine(shortest, mean, tone=look.tone, dashes=LINES[k % len(LINES)], width=0.9, over=2)]


@dataclass(frozen=True, slots=True)
class TimeCurves:
    """Pressure rise (MPa) over time (s), (n,) each: slow press, at the gauge; ``samples``: times, rises, or None."""

    time: Array
    slow: Array
    gauge: Array
    samples: tuple[Array, Array] | None = None


@dataclass(frozen=True, slots=True)
class GainCurve:
    """A gain over frequency (Hz), (n,) each."""

    label: str
    frequency: Array
    gain: Array


def response_chart(curves: TimeCurves, gains: Sequence[GainCurve]) -> str:
    """SVG: pressure rise over time on the left, gains over frequency on the right."""
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
    """Panel of gains over frequency, both logarithmic, with the band within 3 dB shaded."""
    lines = [
        PlotLine(one.frequency, one.gain, one.label, tone=_TONES[k % 3], dashes=LINES[k % len(LINES)], width=1.0)
        for k, one in enumerate(gains)
    ]
    band = Span(0.5**0.5, 2.0**0.5, "y")
    ends = float(gains[0].frequency[0]), float(gains[0].frequency[-1])
    return Panel("frequency  (Hz)", "gain over a slow press", tuple(lines), xlim=ends, log="xy", spans=(band,))


def evidence_svg(curve: MeasuredCurve, thinned: Trace, simulated: bool) -> str:
    """SVG of position, force and pressure over time; first contacts, parts read and doubtful parts marked in each."""
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
