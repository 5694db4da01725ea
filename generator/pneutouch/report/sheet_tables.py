"""Tables of a datasheet: figures that count, performance, ratings, conditions of use, limits and sources."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from pneutouch.arrays import grouped
from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.mechanics.prediction import SensorState
from pneutouch.report import prose
from pneutouch.report.blocks import SheetBlock, SheetTable, Tile, section
from pneutouch.report.certainty import interval
from pneutouch.report.conditions import NOT_TESTED, gauge_range, gauge_volume
from pneutouch.report.numbers import DASH
from pneutouch.results.record import SENSITIVITY_KEY
from pneutouch.units import KPA, ML
from pneutouch.wording import held_by, unknown_at


def key_figures(sheet: SheetData) -> list[Tile]:
    """The six tiles with the key figures on the first page, at the least and greatest rated pressure with figures."""
    states = sheet.prediction.states
    rated = [k for k, state in enumerate(states) if state.figures and not _is_above(sheet, state)] or [0]
    first, last = rated[0], rated[-1]
    mass = sum(solid.mass for solid in sheet.assembly.solids)
    wide, dead_volume_mL = 2 * sheet.assembly.layout.plate_radius, sheet.prediction.dead_volume / ML
    behind = sheet.assembly.dead_volume_note or "behind the cavity"
    reach = f"{_condition(sheet, last, 'force_at_range_end_N')}{_drawn(sheet, last, _range)}"
    if sheet.as_drawn is None:
        reach += f"; with {dead_volume_mL:.2f} mL behind the cavity"
    return [
        *(
            Tile("Sensitivity", _sensitivity(states[k]), "kPa/N", _condition(sheet, k) + _drawn(sheet, k, _sensitivity))
            for k in (first, last)
        ),
        Tile("Force range", _range(states[last]), "N", reach),
        Tile("Max. driving pressure", f"{sheet.rating.pressure_kPa:.1f}", "kPa", sheet.rating.summary),
        Tile("Dead volume", f"{dead_volume_mL:.2f}", "mL", behind),
        Tile("Size", f"Ø{wide:.1f}", "mm", f"{mass:.1f} g without tube"),
    ]


def _is_above(sheet: SheetData, state: SensorState) -> bool:
    return sheet.rating.severity(state.driving_pressure) is not None


def _star(sheet: SheetData, state: SensorState) -> str:
    """Mark of a pressure above the rated one."""
    return " *" if _is_above(sheet, state) else ""


def _drawn(sheet: SheetData, k: int, figure: Callable[[SensorState], str]) -> str:
    """A figure of state ``k`` with the gas as drawn, after that of a dead volume of zero; empty without one."""
    if sheet.as_drawn is None:
        return ""
    volume_mL = sheet.assembly.drawn_volume / ML
    return f"; with the {volume_mL:.2f} mL as drawn: {figure(sheet.as_drawn.states[k])}"


def quiet_events(sheet: SheetData) -> list[str]:
    """Sentences on events that do not end the range, a kind each: travel and force from which they hold."""
    seen: dict[tuple[str, str], list[str]] = {}
    for state in sheet.prediction.states:
        for event in state.events:
            if not event.ends_range and event not in state.warned and event.indentation <= state.range_end:
                force = sheet.force_at(state, event.indentation)
                place = f"{event.indentation:.2f} mm and {force:.1f} N at {state.driving_pressure / KPA:g} kPa"
                seen.setdefault((event.kind, event.message), []).append(place)
    return [f"Within the range, {kind} from {', '.join(at)}: {words}." for (kind, words), at in seen.items()]


def unknown_intervals(sheet: SheetData) -> list[str]:
    """Reasons for the states without interval, if others have one; else the section Uncertainty gives the reason."""
    states = zip(sheet.prediction.states, sheet.uncertainty, strict=True)
    reasons = [(state.driving_pressure / KPA, one.unknown) for state, one in states]
    known = any(why is None for _, why in reasons)
    return [f"{text[:1].upper()}{text[1:]}." for text in unknown_at(reasons) if known]


def warnings(sheet: SheetData) -> list[str]:
    """Sentences on driving pressures above the rating, and on depths at which the pressed dome leaves its axis."""
    states = sheet.prediction.all_states
    judged = ((sheet.rating.severity(s.driving_pressure), s.driving_pressure) for s in states)
    above = [f"{severity.capitalize()}: {sheet.rating.excess(p)}." for severity, p in judged if severity is not None]
    left = grouped(
        ((event.kind, event.message), f"{event.indentation:.2f} mm at {state.driving_pressure / KPA:.4g} kPa")
        for state in states
        for event in state.warned
    )
    if any(not _is_above(sheet, state) for state in sheet.prediction.states):
        above = [f"{text[:-1]}; its figures stand in the annex alone, marked *." for text in above]
    return above + [f"Warning: {kind} from {', '.join(found)}: {words}." for (kind, words), found in left.items()]


def _condition(sheet: SheetData, k: int, key: str = SENSITIVITY_KEY) -> str:
    """Driving pressure of state ``k`` and the interval of its figure ``key``, in words."""
    width = interval(sheet.uncertainty[k], key)
    text = f"{width} (k = 2)" if width else "interval not known, see Uncertainty"
    return f"at {sheet.prediction.states[k].driving_pressure / KPA:g} kPa; {text}"


def as_drawn(sheet: SheetData) -> list[SheetBlock]:
    """Figures with the gas of connector and tube as drawn, if the design states a dead volume of zero; else none."""
    if sheet.as_drawn is None:
        return []
    rows = [
        [
            f"{state.driving_pressure / KPA:g}{_star(sheet, state)}",
            _sensitivity(state),
            _stiffness(state),
            _range(state),
            _ends(state),
        ]
        for state in sheet.as_drawn.states
    ]
    volume_mL, model = sheet.assembly.drawn_volume / ML, sheet.as_drawn.model
    title = f"With the {volume_mL:.2f} mL that connector and tube hold as drawn ({model})"
    return section(title, SheetTable(rows, ("Driving\nkPa", *_PRESSED), numeric=range(4), small=True), level=3)


def filled(sheet: SheetData) -> list[SheetBlock]:
    """Figures of the states given by their filling, and what holds them before contact; empty if there are none."""
    rows = [
        [
            f"{state.held.injected / ML:.3g}",
            f"{state.driving_pressure / KPA:.2f}{_star(sheet, state)}",
            interval(known, "driving_pressure_kPa") or DASH,
            f"{state.apex_outer:.2f}",
            held_by(*state.held[1:]),
            interval(known, SENSITIVITY_KEY) or DASH,
            *(cell(state) for cell in (_sensitivity, _stiffness, _range, _ends)),
        ]
        for state, known in zip(sheet.prediction.filled, sheet.filled_uncertainty, strict=True)
        if state.held is not None
    ]
    head = ("Injected\nmL", "Pressure\nkPa", "k = 2\nkPa", "Apex\noutside\nmm", "Held by", "k = 2\nkPa/N", *_PRESSED)
    title = "By injected gas (mL at ambient pressure) or height"
    return section(title, SheetTable(rows, head, numeric=(0, 1, 2, 3, 5, 6, 7, 8), small=True), level=3) if rows else []


_PRESSED = "Sensitivity\nkPa/N", "Stiffness\nN/mm", "Force range\nN", "Range ends at"


def ratings(sheet: SheetData) -> list[list[str]]:
    """Absolute maximum ratings: quantity, value, unit, basis."""
    basis = f"{sheet.rating.summary} (model {sheet.prediction.model})"
    gauge = f"{NOT_TESTED}; the pressure gauge ({sheet.gauge.title}) reads to {sheet.gauge.reads_to_kPa:.4g} kPa"
    return [
        ["Driving pressure", f"{sheet.rating.pressure_kPa:.1f}", "kPa gauge", basis],
        *(
            [["Vacuum", f"{sheet.rating.least / KPA:.1f}", "kPa gauge", sheet.rating.vacuum_basis]]
            if sheet.rating.vacuum
            else []
        ),
        ["Cavity pressure while pressed", DASH, "kPa gauge", gauge],
        ["Overload force", DASH, "N", NOT_TESTED],
        ["Burst pressure", DASH, "kPa", NOT_TESTED],
        ["Temperature", DASH, "°C", NOT_TESTED + "; the paper's tests ran at 18 to 26 °C"],
    ]


def connections(sheet: SheetData) -> list[list[str]]:
    """Rows (name, text) on port, tube, gauge, mount, and the driving pressures."""
    scene = sheet.scene
    pneumatics, tube = scene.design.pneumatics, scene.tube
    rated_kPa = [s.driving_pressure / KPA for s in sheet.prediction.states if not _is_above(sheet, s)]
    pressures = f"{', '.join(f'{p:g}' for p in rated_kPa)} kPa, at most" if rated_kPa else "below"
    return [
        ["Port", scene.port.title],
        ["Tube", f"{pneumatics.tube_length_mm:g} mm, {tube.outer_diameter:g} x {tube.inner_diameter:g} mm"],
        ["Gauge", sheet.gauge.title if scene.gauge is not None else f"none named; assumed: {sheet.gauge.title}"],
        ["Mount", scene.mount.title],
        ["Driving", f"{pressures} {sheet.rating.pressure_kPa:.1f}; set it, then close the line"],
    ]


def operating(sheet: SheetData) -> list[list[str]]:
    """Rows (quantity, value, unit, note) on the operating conditions that the figures hold for."""
    design = sheet.scene.design
    pressures = ", ".join(f"{p:g}" for p in design.pneumatics.driving_pressures_kPa)
    note = sheet.assembly.dead_volume_note
    stated = f"given in the design, {note}" if note else "given in the design"
    if design.pneumatics.dead_volume_mL is None:
        tube = f"{sheet.scene.tube.outer_diameter:g} x {sheet.scene.tube.inner_diameter:g} mm tube"
        length = f"{design.pneumatics.tube_length_mm:g} mm of {tube}"
        stated = f"connector {sheet.assembly.internal_volume / ML:.3f} mL and {length}"
        stated += gauge_volume(sheet)
    return [
        ["Driving pressure", pressures, "kPa gauge", "before contact"],
        ["Medium", "air", "", "trapped, isothermal"],
        ["Ambient pressure", f"{design.pneumatics.ambient_pressure_kPa:g}", "kPa", "absolute"],
        ["Dead volume", f"{sheet.prediction.dead_volume / ML:.3f}", "mL", stated],
        *([] if sheet.scene.gauge is None else [["Pressure gauge", *gauge_range(sheet)]]),
        ["Contact object", *prose.contact_body(sheet.scene)],
        ["Indentation", f"0 to {design.depth_mm:.2f}", "mm", f"{design.indentation.steps} steps from first contact"],
    ]


def performance(sheet: SheetData) -> SheetTable:
    """Table of performance, with one row per driving pressure."""
    pairs = zip(sheet.prediction.states, sheet.uncertainty, strict=True)
    rows = [_state(sheet, state, interval(document) or DASH) for state, document in pairs]
    return SheetTable(rows, prose.WORDS["performance"]["head"], numeric=range(10), turned=True)


def _state(sheet: SheetData, s: SensorState, width: str) -> list[str]:
    f, pressure_kPa = s.figures, s.driving_pressure / KPA
    line = (DASH, DASH) if f is None else (f"{f.r_squared:.4f}", f"{100 * f.nonlinearity:.1f}")
    heights = f"{s.apex_inner:.2f}", f"{s.apex_outer:.2f}"
    beside = width, _published(sheet, pressure_kPa)
    driving = f"{pressure_kPa:g}{_star(sheet, s)}"
    shallow = [DASH if np.isnan(k) else f"{k:.2f}" for k in (() if f is None else (f.stiffness_1mm, f.stiffness_3mm))]
    stiffness = "; ".join([_stiffness(s), *([", ".join(shallow)] if shallow else [])])
    return [driving, *heights, _sensitivity(s), *beside, *line, stiffness, _range(s), _ends(s)]


def _published(sheet: SheetData, pressure_kPa: float) -> str:
    value = sheet.published_kPa_per_N.get(round(pressure_kPa, 9))
    return DASH if value is None else f"{value:.3f}"


def limits(sheet: SheetData) -> SheetTable:
    """Table of the limits of the driving pressure; the one that the rated pressure follows from is in bold."""
    limits, point, fitted = sheet.prediction.limits, sheet.prediction.limit_point, sheet.prediction.limits.law_range
    broken = DASH if limits.break_strain is None else f"{limits.break_strain / KPA:.1f}"
    where = "the resin's least elongation at break" + ("; not met before the limit point" if broken == DASH else "")
    reach = "none: the pressure goes on rising"
    if point is not None:
        reach = f"dome snaps at {point.apex_inner:.2f} mm inside, {point.apex_outer:.2f} mm outside"
    rows = [
        ["limit point", DASH if limits.limit_point is None else f"{limits.limit_point / KPA:.2f}", reach],
        ["break strain", broken, where],
        ["law range", "" if fitted is None else f"{fitted / KPA:.1f}", "stretched further than its law was fitted"],
        ["gauge range", f"{limits.gauge / KPA:.4g}", f"what the {sheet.gauge.title} reads"],
    ]
    spread = {limit.name: limit for limit in sheet.rating.limits if limit.low < limit.nominal}
    rows = [row for row in rows if row[1]]
    for row in rows:
        if row[0] in spread:
            limit = spread[row[0]]
            row[2] = f"{limit.low / KPA:.1f} to {limit.high / KPA:.1f} kPa at k = 2; {row[2]}"
        row.append("binds" if row[0] == sheet.rating.limit.name else "")
    binding = [k for k, row in enumerate(rows) if row[3]]
    return SheetTable(rows, ("Limit", "kPa", "Meaning", "Binds"), numeric=(1,), strong=binding, small=True)


def sources(sheet: SheetData) -> list[list[str]]:
    """Sources of the resin's numbers: quantity, value, source."""
    m = sheet.scene.membrane_material
    entries = [
        ("Shear modulus, MPa", m.shear_modulus_MPa),
        ("Poisson ratio", m.poisson_ratio),
        ("Density, g/cm³", m.density_g_per_cm3),
        ("Shore A", m.shore_a),
        ("Tensile strength, MPa", m.tensile_strength_MPa),
        ("Elongation at break, %", m.elongation_at_break_percent),
        ("Glass transition, °C", m.glass_transition_C),
        ("Hysteresis at 0 kPa, %", None if m.measured is None else m.measured.hysteresis_percent),
    ]
    rows = [[what, quantity.text(), quantity.source] for what, quantity in entries if quantity is not None]
    for above, row in reversed([*pairwise(rows)]):
        row[2] = "as above" if row[2] == above[2] else row[2]
    shifts = [series.shift for series in m.relaxation if series.shift]
    known = {"relaxation": m.relaxation, "change with temperature": shifts, "Mullins softening": []}
    rows.append(["Not known", DASH, ", ".join(what for what, data in known.items() if not data)])
    accuracy = sheet.scene.printer.accuracy_mm
    return [
        ["The paper", "", prose.WORDS["datasheet"]["paper"]],
        *rows,
        ["Accuracy of the printer, mm", f"±{accuracy.nominal:g}", accuracy.source],
    ]


def _sensitivity(state: SensorState) -> str:
    return f"{state.figures.sensitivity:.2f}" if state.figures else DASH


def _stiffness(state: SensorState) -> str:
    return f"{state.figures.stiffness:.2f}" if state.figures else DASH


def _range(state: SensorState) -> str:
    return f"0 to {state.figures.force_range[1]:.1f}" if state.figures else DASH


def _ends(state: SensorState) -> str:
    kinds = [event.kind for event in state.events if event.ends_range]
    return f"{kinds[0] if kinds else 'depth'}, {state.range_end:.2f} mm"
