"""The datasheet: its sections in order, and the table of its charts."""

from collections.abc import Callable

from pneutouch import __version__
from pneutouch.evaluation.sheet_data import SheetData
from pneutouch.export.scene import view_data
from pneutouch.report import conditions, curves, graded, print_sheet, prose, sheet_charts, sheet_tables
from pneutouch.report.anywhere import contact_line, contact_section
from pneutouch.report.blocks import (
    Columns,
    Heading,
    Items,
    Plot,
    Plots,
    Sheet,
    SheetBlock,
    SheetTable,
    Text,
    Tiles,
    View,
    section,
)
from pneutouch.report.certainty import uncertainty_section, uncertainty_shares
from pneutouch.report.drawing import section_drawing
from pneutouch.report.mould import mould_section_blocks
from pneutouch.report.pages import set_sheet
from pneutouch.report.pictures import picture, pressed_blocks, shown
from pneutouch.report.relaxation import viscous_section

CHARTS: tuple[tuple[str, Callable[[SheetData], Plot | None]], ...] = (
    ("performance", sheet_charts.sensitivity),
    ("performance", sheet_charts.inflation),
    ("performance", sheet_charts.response),
    ("performance", sheet_charts.indentation),
    ("performance", sheet_charts.tuning),
    ("performance", sheet_charts.tradeoff),
    ("graded", graded.grade_section),
    ("graded", graded.grade_share),
    ("graded", graded.grade_modulus),
    ("graded", graded.graded_sensitivity),
    ("graded", graded.graded_response),
    ("uncertainty", uncertainty_shares),
)
"""Section and drawing function of every chart, in the sheet's order; a function returns None without data."""

_PIXELS = (900, 640)
"""Width and height of the picture, pixels."""


def datasheet(sheet: SheetData) -> dict[str, bytes]:
    """Files by name: ``datasheet.html``, with a 3D view (a picture where no script runs), and ``datasheet.pdf``."""
    return set_sheet(described(sheet), "datasheet")


def described(sheet: SheetData) -> Sheet:
    """The datasheet with its charts drawn."""
    document = sheet.scene.design.document
    date = document.date.isoformat() if document.date else "undated"
    number, tool, status = print_sheet.part_number(sheet.scene), f"pneutouch {__version__}", prose.status(sheet.scene)
    facts = ("Part number", number), ("Revision", f"{document.revision}, {date}"), ("Made by", tool)
    return Sheet(
        title=document.title,
        subtitle="Pneumatic touch sensor with tunable stiffness",
        name=f"{number} – {document.title}",
        facts=(*facts, ("Input", sheet.input_hash)),
        tool=tool,
        foot=f"{tool}, input {sheet.input_hash}. {status}",
        date=document.date,
        blocks=(
            Text(status, "status"),
            *(Text(line, "warning") for line in sheet_tables.warnings(sheet)),
            *_front(sheet),
            Heading("Annex: what the figures rest on, how to make and to use it", 1),
            *_performance(sheet),
            *contact_section(sheet.contact),
            *section("Graded membrane", Plots(_charts("graded", sheet))),
            *conditions.mixing_section(sheet),
            *uncertainty_section(sheet, _charts("uncertainty", sheet)),
            *viscous_section(sheet),
            *_conditions(sheet),
            *_making(sheet),
            *_use(sheet, date),
        ),
    )


def _charts(name: str, sheet: SheetData) -> list[Plot]:
    """The plots of the section ``name`` in `CHARTS` that have data."""
    drawn = (draw(sheet) for place, draw in CHARTS if place == name)
    return [plot for plot in drawn if plot is not None]


def _front(sheet: SheetData) -> list[SheetBlock]:
    """The first page: description, picture, the figures that count, drawing, ratings, and how to connect it."""
    bodies, scene = shown(sheet.assembly, _PIXELS[0]), sheet.scene
    grade = "" if scene.membrane_material.along is None else " The darker the membrane, the more of the stiff resin."
    words = "The sensor, cut open, from above and in front"
    view = View("view", view_data(bodies), picture(bodies, *_PIXELS), words, f"The sensor, cut open.{grade}")
    said = Text(prose.description(scene)), Text(prose.limits_of_use(scene), "muted")
    words = "Lengths in mm; tolerances are the stated accuracies of the printers; bracketed sizes are for reference"
    body = sheet.object_section
    held = "; dashed above the dome: the object that presses it, at first contact" if body is not None else ""
    drawings = [Plot(text) for text in section_drawing(sheet.assembly, body).values()]
    ratings = section("Absolute maximum ratings", SheetTable(sheet_tables.ratings(sheet), numeric=(1,)))
    connected = section("How to connect it", SheetTable(sheet_tables.connections(sheet)))
    contact = section("Contact that is not central", Text(contact_line(sheet.contact, sheet.rating.pressure_kPa)))
    return [
        Columns(([*said, *connected], (view,))),
        Tiles(sheet_tables.key_figures(sheet)),
        *section("Mechanical drawing", Plots(drawings, (112, 68), f"{words}{held}.")),
        Columns((ratings, contact), (3, 2)),
    ]


def _performance(sheet: SheetData) -> list[SheetBlock]:
    errors = [f"Model error. {line}" for line in sheet.prediction.error_estimate.summary]
    return section(
        "Performance",
        sheet_tables.performance(sheet),
        Text(prose.WORDS["performance"]["note"], "muted"),
        Items(sheet_tables.unknown_intervals(sheet)),
        Items(sheet_tables.quiet_events(sheet)),
        *sheet_tables.as_drawn(sheet),
        *sheet_tables.filled(sheet),
        *conditions.off_axis(sheet.prediction.states),
        Items(errors),
        Plots(_charts("performance", sheet)),
        Text(sheet_charts.no_tradeoff(sheet), "muted"),
        _shapes(sheet),
        *([] if sheet.pressed is None else pressed_blocks(sheet.pressed)),
    )


def _shapes(sheet: SheetData) -> SheetBlock:
    """Half sections of the deformed wall, or a sentence on why there are none."""
    state = sheet.prediction.states[0]
    if state.shapes:
        words = "Half sections of the deformed wall, shaded by the greatest principal stretch; thin outlines at rest."
        return Plot(curves.shapes(sheet.prediction), words, mm=curves.SHAPES_WIDE)
    if state.beyond_axis is not None:
        return Text("No half sections are drawn: off the axis they do not show the deformed wall.", "muted")
    words = "The deformed wall and the contact pressure on it are drawn by the solid alone: build with model solid."
    return Text(words, "muted")


def _conditions(sheet: SheetData) -> list[SheetBlock]:
    """Blocks on operating conditions, limits of the driving pressure, speed of reading, and environment."""
    rated = sheet.rating
    raised = rated.remedy and f"To raise the rated pressure of {rated.pressure_kPa:.1f} kPa: {rated.remedy}."
    left = section("Operating conditions", SheetTable(sheet_tables.operating(sheet), numeric=(1,)))
    right = [
        *section("What limits the driving pressure", sheet_tables.limits(sheet), Text(raised or "")),
        *section("Speed of reading", SheetTable(conditions.speed_rows(sheet))),
    ]
    surroundings = SheetTable([*conditions.detection(sheet), *conditions.environment(sheet)])
    return [Columns((left, right)), *section("Environment", surroundings)]


def _making(sheet: SheetData) -> list[SheetBlock]:
    """Blocks on the mould, on how the sensor is made, and on the findings of the print rules."""
    bodies = ("Body", "Material", "Volume, mass", "Machine, mode, layer")
    head = ("Severity", "Rule", "Body", "Finding", "Remedy")
    findings = [[f.severity, f.rule, f.body, f.message, f.fix] for f in sheet.findings]
    return [
        *([] if sheet.assembly.mould is None else mould_section_blocks(sheet.assembly.mould)),
        *section(
            print_sheet.making_title(sheet.pour),
            SheetTable(print_sheet.body_rows(sheet), bodies),
            Items([step.replace("`", "") for step in print_sheet.steps(sheet)], numbered=True),
        ),
        *section("Findings of the print rules", SheetTable(findings, head)),
    ]


def _use(sheet: SheetData, date: str) -> list[SheetBlock]:
    """Blocks on reliability, ordering, measuring and handling, then on what the figures rest on."""
    untested = SheetTable([[what, conditions.NOT_TESTED] for what in prose.WORDS["datasheet"]["reliability"]])
    revisions = SheetTable(
        [[sheet.scene.design.document.revision, date, "As predicted; first issue of this revision."]]
    )
    return [
        Columns(
            (
                [*section("Reliability", untested), *section("Revisions", revisions)],
                section(
                    "Ordering code",
                    SheetTable([[code, meaning] for code, meaning in print_sheet.code_fields(sheet.scene)]),
                ),
            )
        ),
        Columns(
            (
                section("How to measure it", Items(prose.method(sheet.scene), numbered=True)),
                section("Handling", Items(prose.WORDS["datasheet"]["handling"])),
            )
        ),
        *section("Assumptions of the prediction", Items(sheet.prediction.assumptions)),
        *section("Definitions", SheetTable(prose.WORDS["datasheet"]["definitions"])),
        *section("Sources of the resin's numbers", SheetTable(sheet_tables.sources(sheet))),
    ]
