"""Charts of presses, predicted or measured, and of the sensitivity, inflation and deformed wall of a prediction."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.sheet_data import SensitivityCurve
from pneutouch.mechanics.prediction import DeformedShape, SensorPrediction, SensorState
from pneutouch.report.chart import Note, Panel, PlotLine
from pneutouch.report.style import ACCENT, FAINT, INK, LINES, MARKERS, MUTED, figure, svg
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable

_ROUNDING = 1 + 1e-9

BandEnds = tuple[float, float]


@dataclass(frozen=True)
class Press:
    """A predicted or measured press: curves over the same points, (n,) each, and their look.

    Attributes:
        indentation: Indentation, mm.
        force: Contact force, N.
        rise_kPa: Pressure rise, kPa.
        look: PlotLine whose style the curves take; its points are ignored.
        rise_band: Lower and upper end of the rise's band, divided by the rise; None for no band.
        force_band: Lower and upper end of the force's band, divided by the force; None for no band.
    """

    indentation: Array
    force: Array
    rise_kPa: Array
    look: PlotLine = PlotLine()  # noqa: RUF009 (a frozen record)
    rise_band: BandEnds | None = None
    force_band: BandEnds | None = None


def predicted_press(
    state: SensorState, look: PlotLine, rise_band: BandEnds | None = None, force_band: BandEnds | None = None
) -> Press:
    """The press of a predicted state up to the end of its range, with the bands as in `Press`."""
    kept = state.indentation <= state.range_end * _ROUNDING
    curves = state.indentation[kept], state.force[kept], state.pressure_rise[kept] / KPA
    return Press(*curves, look, rise_band, force_band)


def state_look(k: int, pressure_kPa: float) -> PlotLine:
    """Style of the curve of state number ``k`` of a design; its driving pressure stands in the legend."""
    marker, tone = MARKERS[k % len(MARKERS)], INK if k % 2 == 0 else ACCENT
    return PlotLine(label=f"{pressure_kPa:g} kPa", tone=tone, dashes=LINES[k % len(LINES)], marker=marker)


def rises(presses: Sequence[Press]) -> Panel:
    """Panel of pressure rise over contact force, a line for each press."""
    lines = tuple(_banded(one.look, one.force, one.rise_kPa, one.rise_band) for one in presses)
    return Panel("contact force  (N)", "pressure rise  (kPa)", lines, xlim=(0, None), ylim=(0, None))


def forces(presses: Sequence[Press]) -> Panel:
    """Panel of contact force over indentation, a line for each press."""
    lines = tuple(_banded(one.look, one.indentation, one.force, one.force_band) for one in presses)
    return Panel("indentation  (mm)", "contact force  (N)", lines, xlim=(0, None), ylim=(0, None))


def _banded(look: PlotLine, x: Array, y: Array, ends: BandEnds | None) -> PlotLine:
    low, high = (None, None) if ends is None else (ends[0] * y, ends[1] * y)
    return replace(look, x=x, y=y, low=low, high=high)


def sensitivities(lines: Sequence[PlotLine], notes: Sequence[Note] = (), caption: str = "") -> Panel:
    """Panel of sensitivity (kPa/N) over driving pressure (kPa), with limits that hold all lines and bands."""
    heights = [value for one in lines for values in (one.y, one.high) if values is not None for value in values]
    at = [0.0, *(float(value) for one in lines for value in one.x)]
    across = "\n".join(["driving pressure  (kPa)", *([caption] if caption else [])])
    # A design that is not driven, off the axis, where no resin has a curve: the only point is at 0 kPa.
    limits = (1.02 * min(at), 1.02 * max(at) or 1.0), (0, 1.1 * max(map(float, heights), default=1.0))
    return Panel(across, "sensitivity  (kPa/N)", tuple(lines), tuple(notes), xlim=limits[0], ylim=limits[1])


def published_points(published_kPa_per_N: Mapping[float, float]) -> list[PlotLine]:
    """Points of published sensitivities, given by driving pressure in kPa; none if there are none."""
    x, y = list(published_kPa_per_N), list(published_kPa_per_N.values())
    look = PlotLine(x, y, "published measurement", dashes="", marker="D", size=4.5, over=5)
    return [look] if x else []


def resin_sensitivities(
    curves: Mapping[str, SensitivityCurve],
    prediction: SensorPrediction,
    chosen: str,
    published_kPa_per_N: Mapping[float, float],
) -> Panel:
    """Sensitivity over driving pressure for every resin, with the predicted states of the design on its curve.

    ``curves`` are by label. If the curve of the design's resin, ``chosen``, is missing or does not pass the design's
    states (a graded or calibrated membrane), a curve through these states is drawn as well. ``published_kPa_per_N``
    maps driving pressures (kPa) to sensitivities measured on this very sensor; it may be empty.
    """
    states = [(s.driving_pressure / KPA, s.figures.sensitivity) for s in prediction.states if s.figures]
    states_kPa, predicted = np.array(states).reshape(-1, 2).T
    every = dict(curves)
    if len(predicted) and not (chosen in every and _holds(every[chosen], states_kPa, predicted)):
        chosen = "this design"
        every[chosen] = SensitivityCurve(states_kPa, predicted, prediction.model)
    lines = [_compared(k, label, label == chosen, *curve[:2]) for k, (label, curve) in enumerate(every.items())]
    own = PlotLine(states_kPa, predicted, "this design", tone=ACCENT, dashes="", marker="o", size=4, over=4)
    return sensitivities([*lines, own, *published_points(published_kPa_per_N)])


def _compared(k: int, label: str, picked: bool, x: Array, y: Array) -> PlotLine:
    """Curve number ``k`` among others with its label at its end; thick if it is ``picked``."""
    if picked:
        return PlotLine(x, y, end=label, tone=ACCENT, width=2.0, picked=True, over=3.5)
    return PlotLine(x, y, end=label, tone=MUTED, width=0.8, dashes=LINES[k % 4])


_OFF = 0.03
"""Greatest relative distance of a design's states from a resin's curve that still counts as theirs (model error)."""


def _holds(curve: SensitivityCurve, pressures_kPa: Array, sensitivities_kPa_per_N: Array) -> bool:
    """True if a curve passes all points, (n,) each, within the share `_OFF`."""
    at = np.interp(pressures_kPa, curve.driving_pressure_kPa, curve.sensitivity)
    return bool((np.abs(at - sensitivities_kPa_per_N) <= _OFF * sensitivities_kPa_per_N).all())


def inflation(prediction: SensorPrediction) -> Panel:
    """Panel of driving pressure over inner apex height before and beyond the limit point, with the limits."""
    curve, point, states = prediction.inflation, prediction.limit_point, prediction.states
    height, p = curve.apex_inner, curve.pressure / KPA
    peak, gauge_kPa = int(np.argmax(p)), prediction.limits.gauge / KPA
    own = [state.apex_inner for state in states], [state.driving_pressure / KPA for state in states]
    lines = [
        PlotLine(height[: peak + 1], p[: peak + 1], tone=ACCENT, width=1.6),
        PlotLine(height[peak:], p[peak:], tone=MUTED, dashes=LINES[1]),
        PlotLine(*own, label="driving pressures of this design", dashes="", marker="o", size=3.5),
    ]
    notes = []
    if point is not None:
        at = (point.apex_inner, point.driving_pressure / KPA)
        lines.append(_point(at, "D", 4.5))
        notes.append(Note(f"limit point\n{at[1]:.1f} kPa, {at[0]:.2f} mm", at))
    if gauge_kPa < 1.2 * p.max():
        lines.append(PlotLine((height[0], height[-1]), (gauge_kPa, gauge_kPa), tone=MUTED, width=0.8, dashes=LINES[4]))
        notes.append(Note(f"gauge range {gauge_kPa:g} kPa", (float(np.median(height)), gauge_kPa), tone=MUTED))
    limits = ("break strain", prediction.limits.break_strain, "X"), ("law range", prediction.limits.law_range, "D")
    for name, pressure, marker in limits:
        if pressure is not None:
            at = float(np.interp(pressure / KPA, p[: peak + 1], height[: peak + 1])), pressure / KPA
            lines.append(_point(at, marker, 5))
            notes.append(Note(name, at, (0, -1)))
    ends = 1.28 * min(0.0, float(p.min()), *own[1]), 1.28 * float(p.max())
    return Panel("inner apex height  (mm)", "driving pressure  (kPa)", tuple(lines), tuple(notes), ylim=ends)


def _point(at: tuple[float, float], marker: str, size: float) -> PlotLine:
    return PlotLine((at[0],), (at[1],), dashes="", marker=marker, size=size, filled=True, over=4)


SHAPES_WIDE = 104.0
"""Width of the half sections with their scale, mm: their letters can be read on a narrow screen."""


def shapes(prediction: SensorPrediction) -> str:
    """Half sections of the wall at the lowest and highest driving pressure, shaded by stretch, as SVG to one scale."""
    from matplotlib.cm import ScalarMappable

    states = prediction.states[:1] + prediction.states[1:][-1:]
    drawn_shapes = [(state, shape) for state in states for shape in state.shapes[1:]]
    top = max(float(shape.stretch.max()) for _, shape in drawn_shapes)
    every = np.concatenate([shape.cells.reshape(-1, 2) for _, shape in drawn_shapes])
    (right, high), low = 1.06 * every.max(axis=0), min(0.0, float(every[:, 1].min())) - 0.05 * float(every[:, 1].max())
    if any(shape.body is not None for _, shape in drawn_shapes):
        # So much of an object is shown above the wall.
        high *= 1.3
    rows = len(states)
    with figure(SHAPES_WIDE, 42.0 * rows) as drawn:
        drawn.set_layout_engine("compressed")
        axes = drawn.subplots(rows, len(drawn_shapes) // rows, sharex=True, sharey=True, squeeze=False)
        colours = ScalarMappable(cmap="cividis_r")
        colours.set_clim(1.0, top)
        for ax, (state, shape) in zip(axes.flat, drawn_shapes, strict=True):
            # The base plane is drawn: a second line just below it would be read as part of the sensor.
            ax.axhline(0, color=INK, lw=0.8)
            ax.spines["bottom"].set_visible(False)
            ax.set(aspect="equal", xlim=(0, right), ylim=(low, high))
            ax.grid(False)
            _shape(ax, state, shape, colours)
        for ax in axes[-1]:
            ax.set_xlabel("radius  (mm)")
        for ax in axes[:, 0]:
            ax.set_ylabel("height  (mm)")
        drawn.colorbar(colours, ax=axes, label="greatest stretch  (-)", shrink=0.9)
        return svg(drawn)


def _shape(ax: "Axes", state: SensorState, shape: DeformedShape, colours: "ScalarMappable") -> None:
    """Draw one deformed half section over the unloaded one, with the object that presses it."""
    from matplotlib.collections import PolyCollection

    look: dict[str, Any] = {"cmap": colours.cmap, "norm": colours.norm, "edgecolors": "face", "lw": 0.2}
    wall = PolyCollection(list(shape.cells), array=shape.stretch, **look)
    rest = PolyCollection(list(state.shapes[0].cells), facecolors="none", edgecolors=FAINT, lw=0.3, zorder=0)
    ax.add_collection(rest)
    ax.add_collection(wall)
    if shape.body is not None:
        ax.plot(*shape.body.T, color=INK, lw=1.6)
    elif shape.indentation:
        ax.axhline(float(shape.cells[..., 1].max()), xmax=0.97, color=INK, lw=1.6)
    pressed = f", pressed {shape.indentation:.2f} mm" if shape.indentation else ""
    ax.set_title(f"{state.driving_pressure / KPA:g} kPa{pressed}", fontsize=7)
