"""Contents of a datasheet as plain data: both the page and the PDF are set from it."""

from typing import Any

from pneutouch import __version__
from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.mechanics.prediction import SensorState
from pneutouch.report import print_sheet, prose
from pneutouch.report.anywhere import contact_section
from pneutouch.report.certainty import interval, uncertainty_section
from pneutouch.report.conditions import (
    CAPTION,
    NOT_TESTED,
    OFF_AXIS,
    SHEAR,
    SHEAR_CAPTION,
    curves_section,
    detection,
    environment,
    gauge_range,
    gauge_volume,
    off_axis_rows,
    shear_rows,
    speed_rows,
)
from pneutouch.report.print_sheet import body_rows, making, making_title
from pneutouch.units import KPA, ML

DASH = "–"

PERFORMANCE = (
    "Driving\nkPa",
    "Apex inside\nmm",
    "Apex outside\nmm",
    "Sensitivity\nkPa/N",
    "k = 2\nkPa/N",
    "Published\nkPa/N",
    "R²",
    "Non-linearity\n% FS",
    "Stiffness\nN/mm",
    "Force range\nN",
    "Range ends at",
)
"""Columns of the table of performance."""


def content_of(sheet: SheetData) -> dict[str, Any]:
    """The sections of the sheet; every leaf is text, ready to be printed."""
    document = sheet.scene.design.document
    date = document.date.isoformat() if document.date else "undated"
    return {
        "title": document.title,
        "name": sheet.scene.name,
        "part_number": print_sheet.part_number(sheet.scene),
        "revision": document.revision,
        "date": date,
        "tool": f"pneutouch {__version__}",
        "input_hash": sheet.input_hash,
        "status": prose.status(sheet.scene),
        "description": prose.description(sheet.scene),
        "limits_of_use": prose.limits_of_use(sheet.scene),
        "warnings": _warnings(sheet),
        "key_figures": _key_figures(sheet),
        "ratings": _ratings(sheet),
        "rating_note": _rating_note(sheet),
        "operating": _operating(sheet),
        "performance_head": PERFORMANCE,
        "performance": _performance(sheet),
        "off_axis": {"head": OFF_AXIS, "rows": off_axis_rows(sheet.prediction.states), "caption": CAPTION},
        "contact": contact_section(sheet.contact),
        "shear": {"head": SHEAR, "rows": shear_rows(sheet.prediction.states), "caption": SHEAR_CAPTION},
        "model_error": _model_error(sheet),
        "mixing_curves": curves_section(sheet),
        "uncertainty": uncertainty_section(sheet),
        "captions": _captions(sheet),
        "limits": _limits(sheet),
        "environment": [*detection(sheet), *environment(sheet)],
        "speed": speed_rows(sheet),
        "reliability": [[what, NOT_TESTED] for what in prose.RELIABILITY],
        "bodies": body_rows(sheet),
        "making": {"title": making_title(sheet.pour), "lines": making(sheet.scene, sheet.pour)},
        "method": prose.method(sheet.scene),
        "ordering": print_sheet.code_table(sheet.scene),
        "handling": prose.HANDLING,
        "definitions": prose.DEFINITIONS,
        "assumptions": list(sheet.prediction.assumptions),
        "findings": [[f.severity, f.rule, f.message, f.fix] for f in sheet.findings],
        "sources": _sources(sheet),
        "revisions": [[document.revision, date, "As predicted; first issue of this revision."]],
    }


def _key_figures(sheet: SheetData) -> list[list[str]]:
    """Tiles of the first page: name, value, unit, condition."""
    first, last = sheet.prediction.states[0], sheet.prediction.states[-1]
    mass = sum(solid.mass for solid in sheet.assembly.solids)
    wide = 2 * sheet.assembly.layout.plate_radius
    return [
        ["Sensitivity", _sensitivity(first), "kPa/N", _condition(sheet, 0)],
        ["Sensitivity", _sensitivity(last), "kPa/N", _condition(sheet, -1)],
        ["Force range", _range(last), "N", f"at {last.driving_pressure / KPA:g} kPa"],
        ["Max. driving pressure", f"{sheet.rating.pressure_kPa:.1f}", "kPa", sheet.rating.summary],
        [
            "Dead volume",
            f"{sheet.prediction.dead_volume / ML:.2f}",
            "mL",
            sheet.assembly.dead_volume_note or "behind the cavity",
        ],
        ["Size", f"Ø{wide:.1f}", "mm", f"{mass:.1f} g without tube"],
    ]


def _warnings(sheet: SheetData) -> list[str]:
    """Driving pressures of the design that the rating does not allow, and where a pressed dome leaves its axis."""
    judged = ((sheet.rating.severity(s.driving_pressure), s.driving_pressure) for s in sheet.prediction.states)
    above = [f"{severity.capitalize()}: {sheet.rating.excess(p)}." for severity, p in judged if severity is not None]
    left = [(state.driving_pressure / KPA, event) for state in sheet.prediction.states for event in state.off_axis]
    return above + [f"Warning: {e.kind} at {e.indentation:.2f} mm and {p:g} kPa: {e.message}." for p, e in left]


def _condition(sheet: SheetData, k: int) -> str:
    """Condition and interval of a state's sensitivity."""
    text = f"{width} (k = 2)" if (width := interval(sheet.uncertainty[k])) else "interval not known, see Uncertainty"
    return f"at {sheet.prediction.states[k].driving_pressure / KPA:g} kPa; {text}"


def _captions(sheet: SheetData) -> dict[str, str]:
    """Captions of the figures that depend on the prediction, and words in the place of those left out."""
    resin, why = sheet.scene.membrane_material, "the prediction has no figures at the highest driving pressure"
    if sheet.prediction.states[-1].figures is not None:
        why = "the atlas does not answer for the sensor"
    graded = "the atlas has no graded membranes" if resin.along is not None else ""
    unknown = (one.unknown for one in sheet.uncertainty if one.unknown is not None)
    why = graded or next(unknown, why if resin.law is None else "the atlas has no fitted laws")
    absent = f"Trade-off and tuning charts are not drawn: {why}."
    chart = sheet.tradeoff
    return {
        "tradeoff": absent
        if chart is None
        else prose.tradeoff(
            chart.driving_pressure_kPa, sheet.prediction.dead_volume / ML, sheet.assembly.dead_volume_note, chart.errors
        ),
        "tuning": "" if sheet.tuning is None else prose.tuning(sheet.other_contact),
        "shapes": _shapes(sheet.prediction.states[0]),
        "view": "" if sheet.scene.membrane_material.along is None else prose.GRADE,
        **prose.CAPTIONS,
        "drawing": prose.drawing(sheet.object_section is not None),
    }


def _shapes(state: SensorState) -> str:
    if state.shapes:
        return prose.SHAPES
    return prose.NO_SHAPES if state.beyond_axis is None else prose.NO_SHAPES_OFF_AXIS


def _ratings(sheet: SheetData) -> list[list[str]]:
    """Absolute maximum ratings: quantity, value, unit, basis."""
    basis = f"{sheet.rating.summary} (model {sheet.prediction.model})"
    gauge = f"{NOT_TESTED}; the pressure gauge ({sheet.gauge.title}) reads to {sheet.gauge.reads_to_kPa:.4g} kPa"
    return [
        ["Driving pressure", f"{sheet.rating.pressure_kPa:.1f}", "kPa gauge", basis],
        ["Cavity pressure while pressed", DASH, "kPa gauge", gauge],
        ["Overload force", DASH, "N", NOT_TESTED],
        ["Burst pressure", DASH, "kPa", NOT_TESTED],
        ["Temperature", DASH, "°C", NOT_TESTED + "; the paper's tests ran at 18 to 26 °C"],
    ]


def _rating_note(sheet: SheetData) -> str:
    """Advice that would raise the rated pressure; empty if it does not follow from the modulus."""
    rating = sheet.rating
    return (
        ""
        if rating.remedy is None
        else f"To raise the rated pressure of {rating.pressure_kPa:.1f} kPa: {rating.remedy}."
    )


def _operating(sheet: SheetData) -> list[list[str]]:
    """Operating conditions that the figures hold for."""
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


def _performance(sheet: SheetData) -> list[list[str]]:
    """One row a driving pressure."""
    return [
        [
            f"{s.driving_pressure / KPA:g}",
            f"{s.apex_inner:.2f}",
            f"{s.apex_outer:.2f}",
            _sensitivity(s),
            interval(document) or DASH,
            _published(sheet, s.driving_pressure / KPA),
            f"{s.figures.r_squared:.4f}" if s.figures else DASH,
            f"{100 * s.figures.nonlinearity:.1f}" if s.figures else DASH,
            f"{s.figures.stiffness:.2f}" if s.figures else DASH,
            _range(s),
            _ends(s),
        ]
        for s, document in zip(sheet.prediction.states, sheet.uncertainty, strict=True)
    ]


def _published(sheet: SheetData, pressure_kPa: float) -> str:
    value = sheet.published_kPa_per_N.get(round(pressure_kPa, 9))
    return DASH if value is None else f"{value:.3f}"


def _model_error(sheet: SheetData) -> list[str]:
    """Sentences on how far the model is off."""
    return list(sheet.prediction.error_estimate.summary)


def _limits(sheet: SheetData) -> list[list[str]]:
    """The limits of the driving pressure and which of them the rating follows from."""
    limits, point, fitted = sheet.prediction.limits, sheet.prediction.limit_point, sheet.prediction.limits.law_range
    broken = DASH if limits.break_strain is None else f"{limits.break_strain / KPA:.1f}"
    where = "the resin's least elongation at break" + ("; not met before the limit point" if broken == DASH else "")
    reach = "none: the pressure goes on rising"
    if point is not None:
        reach = f"dome snaps at {point.apex_inner:.2f} mm inside, {point.apex_outer:.2f} mm outside"
    rows = [
        ["limit point", DASH if limits.limit_point is None else f"{limits.limit_point / KPA:.2f}", reach],
        ["break strain", broken, where],
        *(
            []
            if fitted is None
            else [["law range", f"{fitted / KPA:.1f}", "stretched further than its law was fitted"]]
        ),
        ["gauge range", f"{limits.gauge / KPA:.4g}", f"what the {sheet.gauge.title} reads"],
    ]
    spread = {limit.name: limit for limit in sheet.rating.limits if limit.low < limit.nominal}
    for row in rows:
        if row[0] in spread:
            limit = spread[row[0]]
            row[2] = f"{limit.low / KPA:.1f} to {limit.high / KPA:.1f} kPa at k = 2; {row[2]}"
    return [[*row, "binds" if row[0] == sheet.rating.limit.name else ""] for row in rows]


def _sources(sheet: SheetData) -> list[list[str]]:
    """Sources of the resin's numbers: quantity, value, source."""
    m = sheet.scene.membrane_material
    entries = [
        ("Shear modulus, MPa", m.shear_modulus_MPa),
        ("Poisson ratio", m.poisson_ratio),
        ("Density, g/cm³", m.density_g_per_cm3),
        ("Shore A", m.shore_a),
        ("Tensile strength, MPa", m.tensile_strength_MPa),
        ("Elongation at break, %", m.elongation_at_break_percent),
    ]
    rows = [[what, quantity.text(), quantity.source] for what, quantity in entries if quantity is not None]
    if m.measured is not None:
        rows.append(
            ["Hysteresis at 0 kPa, %", m.measured.hysteresis_percent.text(), m.measured.hysteresis_percent.source]
        )
    accuracy = sheet.scene.printer.accuracy_mm
    return [
        ["The paper", "", prose.PAPER],
        *rows,
        [f"Accuracy of the {sheet.scene.printer.title}, mm", f"±{accuracy.nominal:g}", accuracy.source],
    ]


def _sensitivity(state: SensorState) -> str:
    return f"{state.figures.sensitivity_kPa_per_N:.2f}" if state.figures else DASH


def _range(state: SensorState) -> str:
    return f"0 to {state.figures.force_range[1]:.1f}" if state.figures else DASH


def _ends(state: SensorState) -> str:
    kinds = [event.kind for event in state.events if event.ends_range]
    return f"{kinds[0] if kinds else 'depth'}, {state.range_end:.2f} mm"
