"""The datasheet's section on relaxation, hysteresis and ageing, with its two plots."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pneutouch.evaluation.sheet_data import AgeingData, SheetData, ViscousData, ViscousRow
from pneutouch.report.style import ACCENT, INK, LINES, MUTED, figure, legend_above, plain_ticks, svg
from pneutouch.units import KPA

if TYPE_CHECKING:
    from matplotlib.axes import Axes

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


def section(viscous: ViscousData | str, ageing: str) -> dict[str, Any]:
    """The section as text: a table and its notes, or why it is missing; and the line on ageing."""
    if isinstance(viscous, str):
        return {"known": False, "why": viscous, "ageing": ageing}
    depth, highest = f"{viscous.depth:.2f} mm", f"at {viscous.rows[-1].driving_pressure / KPA:g} kPa"
    quick = list(viscous.rows[-1].hysteresis)[-1]
    ratio = "force (full) and pressure rise (dashed) over their values at 1 s"
    return {
        "known": True,
        "head": list(HEAD),
        "rows": [_cells(row) for row in viscous.rows],
        "notes": _notes(viscous),
        "ageing": ageing,
        "held": f"Held at {depth}, {highest}: {ratio}.",
        "loop": f"Pressed to {depth} and let go at {quick:g} mm/s, {highest}: in (full) and out (dashed).",
    }


def _cells(row: ViscousRow) -> list[str]:
    values = [*(row.losses or (None,) * 3), *row.hysteresis.values()]
    percents = [_DASH if value is None else f"{100 * value:.1f}" for value in values]
    return [f"{row.driving_pressure / KPA:g}", _letter(row.series), *percents]


def _notes(viscous: ViscousData) -> list[str]:
    slow, quick = viscous.rows[0].hysteresis
    lost = [travel for row in viscous.rows for travel in row.contact_lost]
    ended = [
        f"{row.driving_pressure / KPA:g} kPa, {_letter(row.series)}, {run if run == 'held' else f'{run:g} mm/s'}: {why}"
        for row in viscous.rows
        for run, why in row.ended.items()
    ]
    return [
        f"Pressed to {viscous.depth:.2f} mm; held after a press at {viscous.ramp_speed:g} mm/s; losses from 1 s to 600 "
        f"s over the value at 1 s; loops at {slow:g} (slow) and {quick:g} mm/s (quick), the greatest difference in "
        "pressure rise at equal force over the full-scale rise.",
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


def held_chart(viscous: ViscousData, size: tuple[float, float]) -> str:
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


def loop_chart(viscous: ViscousData, size: tuple[float, float]) -> str:
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
