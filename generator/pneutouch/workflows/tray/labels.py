"""The label list: the value, place and material of each part, and the meaning of its mark.

The print rules over a tray: each distinct shape once, in the mode of its job, with its mark.

A part of a tray as the print rules look at it, its mark included.
"""

from collections.abc import Iterator, Sequence
from dataclasses import fields

from pneutouch.parts.lettering.mark import EXPLAINED, shape_of
from pneutouch.printability import check
from pneutouch.printability.subject import PrintItem, PrintSubject
from pneutouch.results.printing import Finding, TrayFinding
from pneutouch.results.tray import LabelRow, TrayRecord
from pneutouch.spec.printer import Mode, Printer
from pneutouch.tables.csv_table import csv_bytes
from pneutouch.units import grams
from pneutouch.wording import counted
from pneutouch.workflows.tray.lay import TrayJob, TrayLayout, TrayPart, fill, layers


def subject(part: TrayPart, printer: Printer, mode: Mode) -> PrintSubject:
    """The bodies of a part in its own frame, marked, in the mode of the tray's job.

    They carry no exact shape: that stands in the design frame and has no marks.
    """
    items = (PrintItem(body, printer, mode, job=part.label if len(part.bodies) > 1 else "") for body in part.bodies)
    return PrintSubject(tuple(items), name=part.name)


def findings(layout: TrayLayout) -> tuple[TrayFinding, ...]:
    """The findings, errors first. Copies, and resins of one kind in one shape, are judged by the first of them."""
    listed, names = [], [field.name for field in fields(Finding)]
    for job in layout.jobs:
        alike: dict[object, list[int]] = {}
        for k, part in enumerate(job.parts):
            kinds = tuple((shape_of(solid), solid.material.kind) for solid in part.solids)
            alike.setdefault(kinds, []).append(k)
        for places in alike.values():
            labels = tuple(job.parts[k].label for k in places)
            judged = check(subject(job.parts[places[0]], layout.printer, job.mode))
            listed += [TrayFinding(**{name: getattr(f, name) for name in names}, labels=labels) for f in judged]
    return tuple(sorted(listed, key=lambda one: one.rank))


def rows(layout: TrayLayout) -> tuple[LabelRow, ...]:
    """One row a body, in the order of the labels within each job."""
    return tuple(row for job in layout.jobs for part in job.parts for row in _rows(layout, job, part))


def labels_csv(listed: Sequence[LabelRow]) -> bytes:
    """The list for a spreadsheet or a label printer."""
    names = [field.name for field in fields(LabelRow)]
    return csv_bytes(names, [[getattr(row, name) for name in names] for row in listed])


def labels_md(layout: TrayLayout, record: TrayRecord, findings: tuple[TrayFinding, ...] = ()) -> bytes:
    """The label list to print and stick: a head, a table a job, and the findings of the print rules."""
    printer, head = layout.printer, layout.order.tray.tray
    lines = [
        f"# {_escaped(head.title)}",
        "",
        f"{record.printer}: {counted(record.parts, 'part')}, **{record.resin_changes}**. Support: {printer.support}.",
        "",
        *(f"Not on this tray: {_escaped(note)}." for note in record.left_out),
    ]
    for number, job in enumerate(layout.jobs, start=1):
        lines += ["", *_job_lines(layout, job, record, number)]
    lines += ["", "## Reading the marks", "", *_marks(layout), ""]
    lines += ["## Findings of the rules", "", *([f"- {_escaped(one.text)}." for one in findings] or ["- none"]), ""]
    return "\n".join(lines).encode()


def _rows(layout: TrayLayout, job: TrayJob, part: TrayPart) -> Iterator[LabelRow]:
    across, along = part.footprint
    for solid, body, mark in zip(part.solids, part.bodies, part.marks, strict=True):
        value, low, high = part.value, *body.bounds
        yield LabelRow(
            label=part.label,
            body=solid.name,
            file=f"stl/{body.name}.stl",
            design=value.design,
            varied=value.key or "",
            value="" if value.value is None else value.value,
            copy=part.copy,
            material=solid.material.title,
            base_resins=" + ".join(solid.material.base_resins),
            job=layout.jobs.index(job) + 1,
            mode=job.mode.name,
            layers=layers(float(high[2]), job.mode),
            x_mm=round(part.place.x + 0.5 * across, 3),
            y_mm=round(part.place.y + 0.5 * along, 3),
            turned_deg=90 if part.place.turned else 0,
            size_x_mm=round(float(high[0] - low[0]), 2),
            size_y_mm=round(float(high[1] - low[1]), 2),
            height_mm=round(float(high[2] - low[2]), 2),
            mass_g=round(grams(body.volume, solid.material.density_g_per_cm3.nominal), 3),
            mark=f"{mark.kind}, raised" if mark.raised else mark.kind,
            mark_face=mark.face,
            mark_depth_mm=round(mark.depth, 3),
            mark_stroke_mm=round(mark.stroke, 3),
            mark_note=mark.note,
        )


def _job_lines(layout: TrayLayout, job: TrayJob, record: TrayRecord, number: int) -> list[str]:
    shares = fill(job, layout.printer)
    listed = [row for row in record.labels if row.job == number]
    table = [
        f"| **{row.label}** | {row.body} | {_value(row)} | {_resin(row)} | "
        f"{row.x_mm:.1f}, {row.y_mm:.1f} | {row.mass_g:.2f} | {_mark(row)} |"
        for row in listed
    ]
    mass = sum(row.mass_g for row in listed)
    return [
        f"## Job {number}: `{layout.name(job)}.3mf`",
        "",
        f"Load {' and '.join(job.resins)}. Mode {job.mode.label}, {job.layers} layers, "
        f"{job.height:.1f} mm; {mass:.1f} g of model material. Bounding boxes take {shares['bounding_boxes']:.1%} of "
        f"the envelope's footprint, outlines {shares['outlines']:.1%}.",
        "",
        *(line for note in _coarser(layout, job) for line in (note, "")),
        "| label | body | design | resin | middle x, y mm | mass g | mark |",
        "|---|---|---|---|---|---|---|",
        *table,
    ]


def _value(row: LabelRow) -> str:
    varied = f", {row.varied.partition('.')[2]} = {row.value}" if row.varied else ""
    return _escaped(f"{row.design}{varied}, copy {row.copy}")


def _resin(row: LabelRow) -> str:
    """The resin with the base resins, without which a digital material's code is ambiguous."""
    return f"{row.material} ({row.base_resins})" if " + " in row.base_resins else row.material


def _coarser(layout: TrayLayout, job: TrayJob) -> list[str]:
    """Materials that a job of their own would print in a finer mode."""
    modes = {
        solid.material.label: layout.printer.mode_for(*(s.material for s in part.solids))
        for part in job.parts
        for solid in part.solids
    }
    return [
        f"{label} alone would print in {mode.label}: the other resins of the job take that from it."
        for label, mode in modes.items()
        if mode is not None and mode.layer_um < job.mode.layer_um
    ]


def _mark(row: LabelRow) -> str:
    where = f"{row.mark}, {row.mark_face}" if row.mark_face else row.mark
    return f"{where}; {row.mark_note}" if row.mark_note else where


def _marks(layout: TrayLayout) -> list[str]:
    """Legend of the kinds of mark that are on the tray."""
    marks = [mark for part in layout.parts for mark in part.marks]
    kinds = {mark.kind for mark in marks}
    lines = []
    if "tally" in kinds:
        lines.append(f"- Membranes carry a tally on the flange. {EXPLAINED}")
        counts = ", ".join(
            f"{letter} {index}" for index, letter in {p.value.index: p.value.letter for p in layout.parts}.items()
        )
        lines.append(f"- Letters as numbers: {counts}.")
    if "text" in kinds:
        lines.append("- Rigid bodies carry the label in letters; all parts of one sensor carry the same.")
    if "none" in kinds:
        lines.append(
            "- Parts without a mark differ by their place on the tray alone: bag and label them as they come off."
        )
    return lines


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;")
