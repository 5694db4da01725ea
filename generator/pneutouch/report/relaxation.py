"""What a datasheet says of relaxation, hysteresis and ageing, with its two plots."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from pneutouch.mechanics import Sensor, SensorPrediction
from pneutouch.mechanics.viscous.known import ageing_unknown, unknown
from pneutouch.report.style import ACCENT, INK, LINES, MUTED, figure, plain_ticks, svg
from pneutouch.spec.material import Material
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from pneutouch.mechanics.viscous.describe import ViscousRuns
    from pneutouch.mechanics.viscous.runs import LoopRun, RelaxationRun

HEAD = (
    "Driving\nkPa", "Data", "Force, 1 to 600 s\n%", "Pressure rise\n%", "per decade\n%",
    "Hysteresis, slow\n% of full scale", "Hysteresis, quick\n% of full scale",
)  # fmt: skip
_DASH = "–"
_LOST = "The dome returns more slowly than the plate: contact is lost {:.1f} to {:.1f} mm before the plate is back, and the loop ends there."
_COLOURS = (ACCENT, INK, MUTED)


def runs_of(prediction: SensorPrediction, material: Material, sensor: Sensor) -> ViscousRuns | str:
    """The runs of every state of a prediction, or why there are none."""
    why = unknown(sensor, material, prediction.model)
    if why is not None:
        return why
    from pneutouch.mechanics.viscous.describe import chosen_depth, describe

    depth = chosen_depth(sensor, [state.range_end for state in prediction.states])
    if not depth > 0:
        return "a state has no range"
    return describe(sensor, material, [state.driving_pressure for state in prediction.states], depth)


def section(runs: ViscousRuns | str, ageing: str) -> dict[str, Any]:
    """The section as text: a table and its notes, or why it is missing; and the line on ageing."""
    if isinstance(runs, str):
        return {"known": False, "why": runs, "ageing": ageing}
    from pneutouch.mechanics.viscous.describe import BASIS, RAMP_SPEED

    rows, ended, lost = [], [], []
    for i, pressure in enumerate(runs.driving_pressures):
        for j in range(len(runs.sources)):
            loops = {speed: of[i][j] for speed, of in runs.loops.items()}
            rows.append([f"{pressure / KPA:g}", _letter(j), *_held(runs.held[i][j]), *map(_wide, loops.values())])
            ended += [
                f"{pressure / KPA:g} kPa, {_letter(j)}, {v:g} mm/s: {one.ended}"
                for v, one in loops.items()
                if one.ended
            ]
            ended += [f"{pressure / KPA:g} kPa, {_letter(j)}, held: {end}" for end in [runs.held[i][j].ended] if end]
            lost += [one.contact_lost for one in loops.values() if one.contact_lost is not None]
    slow, quick = runs.loops
    notes = [
        f"Pressed to {runs.depth:.2f} mm; held after a press at {RAMP_SPEED:g} mm/s; losses from 1 s to 600 s over the value at 1 s; loops at "
        f"{slow:g} (slow) and {quick:g} mm/s (quick), the greatest difference in pressure rise at equal force over the full-scale rise.",
        *(f"{_letter(j)}: {source}." for j, source in enumerate(runs.sources)),
        f"Model: {'; '.join(BASIS)}.",
        *([_LOST.format(min(lost), max(lost))] if lost else []),
        *([f"Not followed to the end. {'; '.join(ended)}."] if ended else []),
    ]  # fmt: skip
    highest = f"at {runs.driving_pressures[-1] / KPA:g} kPa"
    return {
        "known": True, "head": list(HEAD), "rows": rows, "notes": notes, "ageing": ageing,
        "held": f"Held at {runs.depth:.2f} mm, {highest}: force (full) and pressure rise (dashed) over their values at 1 s.",
        "loop": f"Pressed to {runs.depth:.2f} mm and let go at {quick:g} mm/s, {highest}: in (full) and out (dashed).",
    }  # fmt: skip


def ageing_line(prediction: SensorPrediction, material: Material, sensor: Sensor) -> str:
    """What a year does to the modulus, to the sensitivity by it, and what was measured."""
    why = ageing_unknown(material)
    if why is not None:
        return f"Ageing: {why}."
    from pneutouch.mechanics.atlas_states import outside_atlas
    from pneutouch.mechanics.viscous.describe import ageing_shift
    from pneutouch.mechanics.viscous.known import ageing_ratio

    assert material.shore_a is not None and material.shore_a_one_year is not None
    said = (
        f"Ageing: Shore A {material.shore_a.nominal:g} to {material.shore_a_one_year.nominal:g} in a year of light and air is a "
        f"modulus of {ageing_ratio(material) - 1:+.1%} by Gent's relation"
    )
    if outside_atlas(sensor) is None:
        ends = [state.driving_pressure for state in prediction.states]
        shift = ageing_shift(sensor, material, [ends[0], ends[-1]])[1]
        if np.isfinite(shift).all():
            said += f" and a sensitivity of {shift[0]:+.1%} at {ends[0] / KPA:g} kPa, {shift[1]:+.1%} at {ends[-1] / KPA:g} kPa"
    measured = material.measured.sensitivity_change_one_year_percent if material.measured is not None else None
    known = "" if measured is None else f"; measured on the paper's sensors: {measured.nominal:g} %, sign not given"
    return f"{said}{known}."


def held_chart(runs: ViscousRuns, size: tuple[float, float]) -> str:
    """Force and pressure rise over time at the highest driving pressure; ``size`` in mm."""
    with figure(*size) as drawn:
        ax = drawn.add_subplot()
        for j, run in enumerate(runs.held[-1]):
            late = run.times >= 1.0 - 1e-9
            if late.sum() < 2:
                continue
            for values, line in ((run.force, LINES[0]), (run.rise, LINES[1])):
                ax.plot(
                    run.times, 100 * values / values[late][0], color=_COLOURS[j % 3], ls=line,
                    label=_letter(j) if line == LINES[0] else None,
                )  # fmt: skip
        ax.set(
            xlabel="time since the press  (s)", ylabel="share of the value at 1 s  (%)", xscale="log", ylim=(0, None)
        )
        ax.set_xlim(0.01, 600.0)
        plain_ticks(ax.xaxis)
        _label(ax, "lower left")
        return svg(drawn)


def loop_chart(runs: ViscousRuns, size: tuple[float, float]) -> str:
    """Pressure rise over force in the quicker loop at the highest driving pressure; ``size`` in mm."""
    quick = list(runs.loops.values())[-1][-1]
    with figure(*size) as drawn:
        ax = drawn.add_subplot()
        for j, run in enumerate(quick):
            if run.force_out.size < 2:
                continue
            ax.plot(run.force_in, run.rise_in / KPA, color=_COLOURS[j % 3], label=_letter(j))
            ax.plot(run.force_out, run.rise_out / KPA, color=_COLOURS[j % 3], ls=LINES[1])
        ax.set(xlabel="contact force  (N)", ylabel="pressure rise  (kPa)", xlim=(0, None), ylim=(0, None))
        _label(ax, "lower right")
        return svg(drawn)


def _label(ax: Axes, where: Literal["lower left", "lower right"]) -> None:
    """Tell the sources apart, or say that no run could be followed."""
    if ax.lines:
        ax.legend(title="data", title_fontsize=7, loc=where, handlelength=3)
    else:
        ax.text(0.5, 0.5, "not followed: see the notes", transform=ax.transAxes, ha="center", color=MUTED)


def _letter(j: int) -> str:
    return chr(ord("A") + j)


def _held(run: RelaxationRun) -> list[str]:
    if run.ended is not None:
        return [_DASH, _DASH, _DASH]
    (force, _), (rise, decade) = run.drop(run.force), run.drop(run.rise)
    return [f"{100 * force:.1f}", f"{100 * rise:.1f}", f"{100 * decade:.1f}"]


def _wide(run: LoopRun) -> str:
    found = run.hysteresis()
    return _DASH if found is None else f"{100 * found[0]:.1f}"
