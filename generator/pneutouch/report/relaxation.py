"""The datasheet's section on relaxation, hysteresis and ageing, with its two charts."""

from collections.abc import Sequence
from dataclasses import replace

from pneutouch.evaluation.sheet_data import AgeingData, SheetData
from pneutouch.report.blocks import Items, Plot, Plots, SheetBlock, SheetTable, Text, section
from pneutouch.report.chart import Panel, PlotLine, drawn_svg
from pneutouch.report.numbers import DASH
from pneutouch.report.prose import WORDS
from pneutouch.report.style import ACCENT, INK, LINES, MUTED
from pneutouch.results.behaviour import BySource, Viscous, WholeLoop
from pneutouch.units import KPA

_TONES = (ACCENT, INK, MUTED)


def viscous_section(sheet: SheetData) -> list[SheetBlock]:
    """Section with charts, table and notes, or the reason why there are none; and a line on ageing."""
    viscous, ageing = sheet.viscous, Text(ageing_line(sheet))
    title = "Relaxation and hysteresis"
    if viscous.depth_mm is None:
        return section(title, Text(f"Not predicted: {viscous.unknown}."), ageing)
    rows = [(state.driving_pressure_kPa, j, one) for state in viscous.states for j, one in enumerate(state.by_source)]
    cells = [_cells(*row) for row in rows]
    return section(
        title,
        Plots([] if sheet.viscous_runs is None else _plots(viscous, sheet)),
        SheetTable(cells, WORDS["relaxation"]["head"], numeric=(0, 2, 3, 4, 5, 6), turned=True),
        Items(_notes(viscous, rows)),
        ageing,
    )


def _plots(viscous: Viscous, sheet: SheetData) -> list[Plot]:
    last = viscous.states[-1]
    depth, highest = f"{viscous.depth_mm:.2f} mm", f"at {last.driving_pressure_kPa:g} kPa"
    quick = last.by_source[-1].hysteresis[-1].speed_mm_per_s
    ratio = "force (full) and pressure rise (dashed) over their values at 1 s"
    pressed = f"Pressed to {depth} and let go at {quick:g} mm/s, {highest}: in (full) and out (dashed)."
    return [
        Plot(drawn_svg(_or_words(held_panel(sheet))), f"Held at {depth}, {highest}: {ratio}."),
        Plot(drawn_svg(_or_words(loop_panel(sheet))), pressed),
    ]


def held_panel(sheet: SheetData) -> Panel:
    """Panel of force and rise over time, in percent of their value at 1 s, at the highest driving pressure."""
    lines = [
        PlotLine(run.times, values, f"data {_letter(j)}" if k == 0 else "", tone=_TONES[j % 3], dashes=LINES[k])
        for j, run in enumerate(sheet.viscous_runs.held[-1] if sheet.viscous_runs else ())
        if run.holds
        for k, values in enumerate((run.percent(run.force), run.percent(run.rise)))
    ]
    across, up = "time since the press  (s)", "share of the value at 1 s  (%)"
    return Panel(across, up, tuple(lines), xlim=(0.01, 600.0), ylim=(0, None), log="x")


def loop_panel(sheet: SheetData) -> Panel:
    """Panel of pressure rise over force in the quickest loop at the highest driving pressure."""
    lines = [
        PlotLine(force, rise / KPA, f"data {_letter(j)}" if k == 0 else "", tone=_TONES[j % 3], dashes=LINES[k])
        for j, loop in enumerate(list(sheet.viscous_runs.loops.values())[-1][-1] if sheet.viscous_runs else ())
        if loop.force_out.size > 1
        for k, (force, rise) in enumerate(((loop.force_in, loop.rise_in), (loop.force_out, loop.rise_out)))
    ]
    return Panel("contact force  (N)", "pressure rise  (kPa)", tuple(lines), xlim=(0, None), ylim=(0, None))


def _or_words(panel: Panel) -> Panel:
    """The panel; without a line, because no run could be followed, its title says so."""
    return panel if panel.lines else replace(panel, title="not followed: see the notes")


def _cells(pressure_kPa: float, series: int, one: BySource) -> list[str]:
    held = one.relaxation
    losses = held.force_loss_percent, held.pressure_rise_loss_percent, held.pressure_rise_loss_percent_per_decade
    widths = (loop.width_percent if isinstance(loop, WholeLoop) else None for loop in one.hysteresis)
    percents = [DASH if value is None else f"{value:.1f}" for value in (*losses, *widths)]
    return [f"{pressure_kPa:g}", _letter(series), *percents]


def _notes(viscous: Viscous, rows: Sequence[tuple[float, int, BySource]]) -> list[str]:
    slow, quick = (loop.speed_mm_per_s for loop in rows[0][2].hysteresis)
    lost = [
        loop.contact_lost_at_mm
        for *_, one in rows
        for loop in one.hysteresis
        if isinstance(loop, WholeLoop) and loop.contact_lost_at_mm is not None
    ]
    ended = [
        f"{pressure_kPa:g} kPa, {_letter(series)}, {run}: {why}"
        for pressure_kPa, series, one in rows
        for run, why in [
            *((f"{loop.speed_mm_per_s:g} mm/s", loop.ended) for loop in one.hysteresis),
            ("held", one.relaxation.ended),
        ]
        if why
    ]
    return [
        f"Pressed to {viscous.depth_mm:.2f} mm; held after a press at {viscous.ramp_speed_mm_per_s:g} mm/s; losses "
        f"from 1 s to 600 s over the value at 1 s; loops at {slow:g} (slow) and {quick:g} mm/s (quick), the "
        "greatest difference in pressure rise at equal force over the full-scale rise.",
        *(f"{_letter(j)}: {source}." for j, source in enumerate(viscous.sources)),
        f"Model: {'; '.join(viscous.basis)}.",
        *([WORDS["relaxation"]["contact_lost"].format(min(lost), max(lost))] if lost else []),
        *([f"Not followed to the end. {'; '.join(ended)}."] if ended else []),
    ]


def ageing_line(sheet: SheetData) -> str:
    """Sentence on a year of ageing: change of modulus and sensitivity, predicted and measured, or why unknown."""
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


def _letter(j: int) -> str:
    return chr(ord("A") + j)
