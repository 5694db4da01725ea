"""The plots of the datasheet. Every axis carries its quantity and unit; curves differ by line style and marker.

The datasheet's section on relaxation, hysteresis and ageing, with its two plots.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.evaluation.sheet_data import AgeingData, ResinCurve, SheetData, ViscousCurves
from pneutouch.mechanics.prediction import DeformedShape, SensorPrediction, SensorState
from pneutouch.report.style import (
    ACCENT,
    BOLD,
    FAINT,
    INK,
    LINES,
    MARKERS,
    MUTED,
    figure,
    label_ends,
    legend_above,
    note,
    plain_ticks,
    svg,
)
from pneutouch.results.behaviour import BySource, Viscous, WholeLoop
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable


SIZE = (86.0, 62.0)
"""Width and height of a plot in mm: two in a row on A4."""


def inflation(prediction: SensorPrediction) -> str:
    """Driving pressure over inner apex height, both branches, with the limit point and the other limits."""
    curve, point = prediction.inflation, prediction.limit_point
    height, p = curve.apex_inner, curve.pressure / KPA
    with figure(*SIZE) as drawn:
        ax = drawn.add_subplot()
        peak = int(np.argmax(p))
        ax.plot(height[: peak + 1], p[: peak + 1], color=ACCENT, lw=1.6)
        ax.plot(height[peak:], p[peak:], color=MUTED, ls=LINES[1])
        for state in prediction.states:
            label = "driving pressures of this design" if state is prediction.states[0] else None
            at = (state.apex_inner, state.driving_pressure / KPA)
            ax.plot(*at, "o", color=INK, ms=3.5, mfc="white", zorder=3, label=label)
        if point is not None:
            at = (point.apex_inner, point.driving_pressure / KPA)
            ax.plot(*at, "D", color=INK, ms=4.5, zorder=4)
            note(ax, f"limit point\n{at[1]:.1f} kPa, {at[0]:.2f} mm", at, fontsize=7)
        _mark_limits(ax, prediction)
        ax.set(xlabel="inner apex height  (mm)", ylabel="driving pressure  (kPa)", ylim=(0, 1.28 * p.max()))
        legend_above(ax)
        return svg(drawn)


def _mark_limits(ax: Axes, prediction: SensorPrediction) -> None:
    curve = prediction.inflation
    p, gauge_kPa = curve.pressure / KPA, prediction.limits.gauge / KPA
    if gauge_kPa < 1.2 * p.max():
        ax.axhline(gauge_kPa, color=MUTED, lw=0.8, ls=LINES[4])
        middle = float(np.median(curve.apex_inner))
        note(ax, f"gauge range {gauge_kPa:g} kPa", (middle, gauge_kPa), color=MUTED)
    rising = slice(0, int(np.argmax(p)) + 1)
    for name, pressure, marker in (
        ("break strain", prediction.limits.break_strain, "X"),
        ("law range", prediction.limits.law_range, "D"),
    ):
        if pressure is not None:
            height = float(np.interp(pressure / KPA, p[rising], curve.apex_inner[rising]))
            ax.plot(height, pressure / KPA, marker, color=INK, ms=5)
            note(ax, name, (height, pressure / KPA), (0, -1))


def shapes(prediction: SensorPrediction) -> list[str]:
    """Half sections of the deformed wall at the lowest and the highest driving pressure, shaded by stretch.

    They have one frame, which is laid out once.
    """
    from matplotlib.cm import ScalarMappable

    states = prediction.states[:1] + prediction.states[1:][-1:]
    drawn_shapes = [(state, shape) for state in states for shape in state.shapes[1:]]
    top = max(float(shape.stretch.max()) for _, shape in drawn_shapes)
    every = np.concatenate([shape.cells.reshape(-1, 2) for _, shape in drawn_shapes])
    (right, high), low = 1.06 * every.max(axis=0), min(0.0, float(every[:, 1].min())) - 0.05 * float(every[:, 1].max())
    if any(shape.body is not None for _, shape in drawn_shapes):
        # So much of an object is shown above the wall.
        high *= 1.3
    texts = []
    with figure(SIZE[0], 0.75 * SIZE[1]) as drawn:
        # The axes are narrower than the figure: they stand in its middle, next to their colour scale.
        drawn.set_layout_engine("compressed")
        ax = drawn.add_subplot()
        # The base plane is drawn: a second line just below it would be read as part of the sensor.
        ax.axhline(0, color=INK, lw=0.8)
        ax.spines["bottom"].set_visible(False)
        ax.set(aspect="equal", xlabel="radius  (mm)", ylabel="height  (mm)", xlim=(0, right), ylim=(low, high))
        ax.grid(False)
        colours = ScalarMappable(cmap="cividis_r")
        colours.set_clim(1.0, top)
        drawn.colorbar(colours, ax=ax, label="greatest stretch  (-)", shrink=0.9)
        for state, shape in drawn_shapes:
            artists = _shape(ax, state, shape, colours)
            texts.append(svg(drawn))
            for artist in artists:
                artist.remove()
    return texts


def _shape(ax: Axes, state: SensorState, shape: DeformedShape, colours: ScalarMappable) -> list[Artist]:
    """One deformed half section over the unloaded one, drawn into its frame; returns the artists that were added."""
    from matplotlib.collections import PolyCollection

    look: dict[str, Any] = {"cmap": colours.cmap, "norm": colours.norm, "edgecolors": "face", "lw": 0.2}
    wall = PolyCollection(list(shape.cells), array=shape.stretch, **look)
    rest = PolyCollection(list(state.shapes[0].cells), facecolors="none", edgecolors=FAINT, lw=0.3, zorder=0)
    added: list[Artist] = [ax.add_collection(rest), ax.add_collection(wall)]
    if shape.body is not None:
        added += ax.plot(*shape.body.T, color=INK, lw=1.6)
    elif shape.indentation:
        added.append(ax.axhline(float(shape.cells[..., 1].max()), xmax=0.97, color=INK, lw=1.6))
    pressed = f", pressed {shape.indentation:.2f} mm" if shape.indentation else ""
    ax.set_title(f"{state.driving_pressure / KPA:g} kPa{pressed}", fontsize=7)
    return added


def response(prediction: SensorPrediction) -> str:
    """Pressure rise over contact force at each driving pressure, with the fitted lines."""
    with figure(*SIZE) as drawn:
        ax = drawn.add_subplot()
        _plot_states(ax, prediction, lambda state: (state.force, state.pressure_rise / KPA))
        for state in prediction.states:
            if state.figures is not None:
                force = np.array(state.figures.force_range)
                fit_kPa = state.figures.intercept_kPa + state.figures.sensitivity_kPa_per_N * force
                ax.plot(force, fit_kPa, color=FAINT, lw=0.8, zorder=1)
        ax.set(xlabel="contact force  (N)", ylabel="pressure rise  (kPa)", xlim=(0, None), ylim=(0, None))
        return svg(drawn)


def indentation(prediction: SensorPrediction) -> str:
    """Contact force over indentation at each driving pressure."""
    with figure(*SIZE) as drawn:
        ax = drawn.add_subplot()
        _plot_states(ax, prediction, lambda state: (state.indentation, state.force))
        ax.set(xlabel="indentation  (mm)", ylabel="contact force  (N)", xlim=(0, None), ylim=(0, None))
        return svg(drawn)


def _plot_states(ax: Axes, prediction: SensorPrediction, curve: Callable[[SensorState], tuple[Array, Array]]) -> None:
    """One curve a driving pressure, up to the end of its range."""
    for k, state in enumerate(prediction.states):
        kept = state.indentation <= state.range_end * (1 + 1e-12)
        x, y = curve(state)
        look: dict[str, Any] = {"marker": MARKERS[k % len(MARKERS)], "mfc": "white", "mew": 0.8}
        look |= {"color": INK if k % 2 == 0 else ACCENT, "ls": LINES[k % len(LINES)]}
        ax.plot(x[kept], y[kept], label=f"{state.driving_pressure / KPA:g} kPa", **look)
    legend_above(ax)


def sensitivities(
    curves: dict[str, ResinCurve], prediction: SensorPrediction, chosen: str, published_kPa_per_N: Mapping[float, float]
) -> str:
    """Sensitivity over driving pressure for every resin, with the predicted states of the design on its curve.

    ``curves`` are by label; where that of the design's resin, ``chosen``, is missing or does not hold its states (a
    graded or a calibrated membrane), a curve through its states is drawn as well.
    ``published_kPa_per_N`` maps driving pressures (kPa) to measured sensitivities (kPa/N) of this very sensor, where
    there are any.
    """
    states = [(s.driving_pressure / KPA, s.figures.sensitivity_kPa_per_N) for s in prediction.states if s.figures]
    states_kPa, predicted = np.array(states).reshape(-1, 2).T
    every = dict(curves)
    if len(predicted) and not (chosen in every and _holds(every[chosen], states_kPa, predicted)):
        every["this design"] = ResinCurve(states_kPa, predicted, prediction.model)
        chosen = "this design"
    with figure(*SIZE) as drawn:
        ax = drawn.add_subplot()
        ends = []
        for k, (label, (pressures, values, _)) in enumerate(every.items()):
            picked = label == chosen
            look: dict[str, Any] = {"color": MUTED, "lw": 0.8, "ls": LINES[k % 4], "zorder": 2}
            if picked:
                look = {"color": ACCENT, "lw": 2.0, "ls": LINES[0], "zorder": 3}
            ax.plot(pressures, values, **look)
            style = {"fontsize": 6.5, "color": INK, **BOLD} if picked else {"fontsize": 6.5, "color": MUTED}
            ends.append((float(pressures[-1]), float(values[-1]), label, style))
        ax.plot(
            states_kPa,
            predicted,
            "o",
            color=ACCENT,
            mfc="white",
            mew=1.2,
            ms=4,
            zorder=4,
            clip_on=False,
            label="this design",
        )
        if published_kPa_per_N:
            points = list(published_kPa_per_N), list(published_kPa_per_N.values())
            ax.plot(
                *points, "D", color=INK, mfc="white", ms=4.5, zorder=5, clip_on=False, label="published measurement"
            )
        legend_above(ax)
        right = max([float(pressures[-1]) for pressures, *_ in every.values()] + states_kPa.tolist(), default=0.0)
        highest = max([float(np.max(values)) for _, values, _ in every.values()] + predicted.tolist(), default=1.0)
        highest = max([highest, *published_kPa_per_N.values()])
        ax.set(xlabel="driving pressure  (kPa)", ylabel="sensitivity  (kPa/N)")
        # A design that is not driven, off the axis, where no resin has a curve: the only point is at 0 kPa.
        ax.set(xlim=(0, 1.02 * right or 1.0), ylim=(0, 1.1 * highest))
        label_ends(ax, ends)
        return svg(drawn)


_OFF = 0.03
"""Share that a resin's curve may be off the design's states, for its model's error, and still be that of the design."""


def _holds(curve: ResinCurve, pressures_kPa: Array, sensitivities_kPa_per_N: Array) -> bool:
    """True if a curve runs through points."""
    at = np.interp(pressures_kPa, curve.driving_pressure_kPa, curve.sensitivity_kPa_per_N)
    return bool((np.abs(at - sensitivities_kPa_per_N) <= _OFF * sensitivities_kPa_per_N).all())


def drawn_by(curves: dict[str, ResinCurve]) -> str:
    """Models that drew the curves, with their resins, in words."""
    models = sorted({curve.model for curve in curves.values()})
    if not models:
        return "no curve of a resin was computed"
    if len(models) == 1:
        return f"drawn by the {models[0]}"
    solid = ", ".join(title for title, curve in curves.items() if curve.model == "solid")
    looked_up = next(model for model in models if model != "solid")
    return f"drawn by the {looked_up}, {solid} by the solid"


HEAD = (
    "Driving\nkPa",
    "Data",
    "Force, 1 to 600 s\n%",
    "Pressure rise\n%",
    "per decade\n%",
    "Hysteresis, slow\n% of full scale",
    "Hysteresis, quick\n% of full scale",
)
_DASH = "–"
_CONTACT_LOST = (
    "The dome returns more slowly than the plate: contact is lost {:.1f} to {:.1f} mm before the plate is back, "
    "and the loop ends there."
)
_COLOURS = (ACCENT, INK, MUTED)


def section(viscous: Viscous, ageing: str) -> dict[str, Any]:
    """The section as text: a table and its notes, or why it is missing; and the line on ageing."""
    if viscous.depth_mm is None:
        return {"known": False, "why": viscous.unknown, "ageing": ageing}
    last = viscous.states[-1]
    depth, highest = f"{viscous.depth_mm:.2f} mm", f"at {last.driving_pressure_kPa:g} kPa"
    quick = last.by_source[-1].hysteresis[-1].speed_mm_per_s
    ratio = "force (full) and pressure rise (dashed) over their values at 1 s"
    rows = [(state.driving_pressure_kPa, j, one) for state in viscous.states for j, one in enumerate(state.by_source)]
    return {
        "known": True,
        "head": list(HEAD),
        "rows": [_cells(*row) for row in rows],
        "notes": _notes(viscous, rows),
        "ageing": ageing,
        "held": f"Held at {depth}, {highest}: {ratio}.",
        "loop": f"Pressed to {depth} and let go at {quick:g} mm/s, {highest}: in (full) and out (dashed).",
    }


def _cells(pressure_kPa: float, series: int, one: BySource) -> list[str]:
    held = one.relaxation
    losses = held.force_loss_percent, held.pressure_rise_loss_percent, held.pressure_rise_loss_percent_per_decade
    widths = (loop.width_percent if isinstance(loop, WholeLoop) else None for loop in one.hysteresis)
    percents = [_DASH if value is None else f"{value:.1f}" for value in (*losses, *widths)]
    return [f"{pressure_kPa:g}", _letter(series), *percents]


def _notes(viscous: Viscous, rows: Sequence[tuple[float, int, BySource]]) -> list[str]:
    slow, quick = (loop.speed_mm_per_s for loop in rows[0][2].hysteresis)
    lost = [
        loop.contact_lost_at_mm
        for *_, one in rows
        for loop in one.hysteresis
        if isinstance(loop, WholeLoop) and loop.contact_lost_at_mm is not None
    ]
    ended = []
    for pressure_kPa, series, one in rows:
        runs = [
            *((f"{loop.speed_mm_per_s:g} mm/s", loop.ended) for loop in one.hysteresis),
            ("held", one.relaxation.ended),
        ]
        ended += [f"{pressure_kPa:g} kPa, {_letter(series)}, {run}: {why}" for run, why in runs if why]
    return [
        f"Pressed to {viscous.depth_mm:.2f} mm; held after a press at {viscous.ramp_speed_mm_per_s:g} mm/s; losses "
        f"from 1 s to 600 s over the value at 1 s; loops at {slow:g} (slow) and {quick:g} mm/s (quick), the "
        "greatest difference in pressure rise at equal force over the full-scale rise.",
        *(f"{_letter(j)}: {source}." for j, source in enumerate(viscous.sources)),
        f"Model: {'; '.join(viscous.basis)}.",
        *([_CONTACT_LOST.format(min(lost), max(lost))] if lost else []),
        *([f"Not followed to the end. {'; '.join(ended)}."] if ended else []),
    ]


def ageing_line(sheet: SheetData) -> str:
    """Effect of a year on the modulus and by it on the sensitivity, and the measured change."""
    material, ageing = sheet.scene.membrane_material, sheet.ageing
    if not isinstance(ageing, AgeingData):
        return f"Ageing: {ageing}."
    assert material.shore_a is not None and material.shore_a_one_year is not None
    line = (
        f"Ageing: Shore A {material.shore_a.nominal:g} to {material.shore_a_one_year.nominal:g} in a year of light and "
        f"air is a modulus of {ageing.modulus_ratio - 1:+.1%} by Gent's relation"
    )
    changes = [f"{change:+.1%} at {pressure / KPA:g} kPa" for pressure, change in ageing.sensitivity_change]
    if changes:
        line += f" and a sensitivity of {', '.join(changes)}"
    measured = material.measured.sensitivity_change_one_year_percent if material.measured is not None else None
    known = "" if measured is None else f"; measured on the paper's sensors: {measured.nominal:g} %, sign not given"
    return f"{line}{known}."


def held_chart(viscous: ViscousCurves, size: tuple[float, float]) -> str:
    """Force and pressure rise over time at the highest driving pressure; ``size`` in mm."""
    with figure(*size) as drawn:
        ax = drawn.add_subplot()
        for j, curve in enumerate(viscous.held):
            if curve is not None:
                ax.plot(curve.time, curve.force, color=_COLOURS[j % 3], ls=LINES[0], label=f"data {_letter(j)}")
                ax.plot(curve.time, curve.rise, color=_COLOURS[j % 3], ls=LINES[1])
        ax.set(
            xlabel="time since the press  (s)", ylabel="share of the value at 1 s  (%)", xscale="log", ylim=(0, None)
        )
        ax.set_xlim(0.01, 600.0)
        plain_ticks(ax.xaxis)
        _label(ax)
        return svg(drawn)


def loop_chart(viscous: ViscousCurves, size: tuple[float, float]) -> str:
    """Pressure rise over force in the quicker loop at the highest driving pressure; ``size`` in mm."""
    with figure(*size) as drawn:
        ax = drawn.add_subplot()
        for j, loop in enumerate(viscous.loops):
            if loop is not None:
                ax.plot(loop.force_in, loop.rise_in / KPA, color=_COLOURS[j % 3], label=f"data {_letter(j)}")
                ax.plot(loop.force_out, loop.rise_out / KPA, color=_COLOURS[j % 3], ls=LINES[1])
        ax.set(xlabel="contact force  (N)", ylabel="pressure rise  (kPa)", xlim=(0, None), ylim=(0, None))
        _label(ax)
        return svg(drawn)


def _label(ax: Axes) -> None:
    """A legend of the sources, or the note that no run could be followed."""
    if ax.lines:
        legend_above(ax)
    else:
        ax.text(0.5, 0.5, "not followed: see the notes", transform=ax.transAxes, ha="center", color=MUTED)


def _letter(j: int) -> str:
    return chr(ord("A") + j)
