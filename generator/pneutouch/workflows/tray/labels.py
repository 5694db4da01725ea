"""The label list: the value, place and material of each part, and the meaning of its mark.

The print rules over a tray: each distinct shape once, in the mode of its job, with its mark.

A part of a tray as the print rules look at it, its mark included.
"""

from dataclasses import dataclass
from typing import Any

from pneutouch.parts.lettering.mark import EXPLAINED, shape_of
from pneutouch.printability import Finding, check
from pneutouch.printability.subject import PrintItem, PrintSubject
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


@dataclass(frozen=True, slots=True)
class TrayFinding:
    """A finding on a part, and the labels of all parts of the same shape."""

    labels: tuple[str, ...]
    finding: Finding

    @property
    def parts(self) -> str:
        """The labels in short."""
        return self.labels[0] if len(self.labels) == 1 else f"{self.labels[0]} and {len(self.labels) - 1} more"

    @property
    def text(self) -> str:
        """One line: the place, the problem and the remedy."""
        finding = self.finding
        return f"{finding.severity}: {self.parts}: {finding.rule}: {finding.message}; {finding.fix}"


def findings(layout: TrayLayout) -> tuple[TrayFinding, ...]:
    """The findings, errors first. Copies, and resins of one kind in one shape, are judged by the first of them."""
    listed = []
    for job in layout.jobs:
        alike: dict[object, list[int]] = {}
        for k, part in enumerate(job.parts):
            kinds = tuple((shape_of(solid), solid.material.kind) for solid in part.solids)
            alike.setdefault(kinds, []).append(k)
        for places in alike.values():
            labels = tuple(job.parts[k].label for k in places)
            judged = check(subject(job.parts[places[0]], layout.printer, job.mode))
            listed += [TrayFinding(labels, finding) for finding in judged]
    return tuple(sorted(listed, key=lambda one: one.finding.rank))


def rows(layout: TrayLayout) -> list[dict[str, Any]]:
    """One row a body, in the order of the labels within each job; x and y are the middle of the part on the tray."""
    return [row for job in layout.jobs for part in job.parts for row in _rows(layout, job, part)]


def labels_csv(layout: TrayLayout) -> bytes:
    """The list for a spreadsheet or a label printer."""
    listed = rows(layout)
    return csv_bytes(list(listed[0]), [list(row.values()) for row in listed])


def labels_md(layout: TrayLayout, findings: tuple[TrayFinding, ...] = ()) -> bytes:
    """The label list to print and stick: a head, a table a job, and the findings of the print rules."""
    printer, head = layout.printer, layout.order.tray.tray
    lines = [
        f"# {_escaped(head.title)}",
        "",
        f"{printer.title}: {counted(len(layout.parts), 'part')}, **{layout.resin_note}**. Support: {printer.support}.",
        "",
        *(f"Not on this tray: {_escaped(note)}." for note in layout.expanded.left_out),
    ]
    for number, job in enumerate(layout.jobs, start=1):
        lines += ["", *_job_lines(layout, job, number)]
    lines += ["", "## Reading the marks", "", *_marks(layout), ""]
    lines += ["## Findings of the rules", "", *([f"- {_escaped(one.text)}." for one in findings] or ["- none"]), ""]
    return "\n".join(lines).encode()


def _rows(layout: TrayLayout, job: TrayJob, part: TrayPart) -> list[dict[str, Any]]:
    across, along = part.footprint
    rows = []
    for solid, body, mark in zip(part.solids, part.bodies, part.marks, strict=True):
        value, low, high = part.value, *body.bounds
        row = {
            "label": part.label,
            "body": solid.name,
            "file": f"stl/{body.name}.stl",
            "design": value.design,
            "varied": value.key or "",
            "value": "" if value.value is None else value.value,
            "copy": part.copy,
            "material": solid.material.title,
            "base_resins": " + ".join(solid.material.base_resins),
            "job": layout.jobs.index(job) + 1,
            "mode": job.mode.name,
            "layers": layers(float(high[2]), job.mode),
            "x_mm": round(part.place.x + 0.5 * across, 3),
            "y_mm": round(part.place.y + 0.5 * along, 3),
            "turned_deg": 90 if part.place.turned else 0,
            "size_x_mm": round(float(high[0] - low[0]), 2),
            "size_y_mm": round(float(high[1] - low[1]), 2),
            "height_mm": round(float(high[2] - low[2]), 2),
            "mass_g": round(grams(body.volume, solid.material.density_g_per_cm3.nominal), 3),
            "mark": f"{mark.kind}, raised" if mark.raised else mark.kind,
            "mark_face": mark.face,
            "mark_depth_mm": round(mark.depth, 3),
            "mark_stroke_mm": round(mark.stroke, 3),
            "mark_note": mark.note,
        }
        rows.append(row)
    return rows


def _job_lines(layout: TrayLayout, job: TrayJob, number: int) -> list[str]:
    shares = fill(job, layout.printer)
    table = [
        f"| **{row['label']}** | {row['body']} | {_value(row)} | {_resin(row)} | "
        f"{row['x_mm']:.1f}, {row['y_mm']:.1f} | {row['mass_g']:.2f} | {_mark(row)} |"
        for part in job.parts
        for row in _rows(layout, job, part)
    ]
    mass = sum(row["mass_g"] for part in job.parts for row in _rows(layout, job, part))
    return [
        f"## Job {number}: `{layout.name(job)}.3mf`",
        "",
        f"Load {' and '.join(job.resins)}. Mode {job.mode.label}, {job.layers} layers, "
        f"{job.height:.1f} mm; {mass:.1f} g of model material. Bounding boxes take {shares['bounding_boxes']:.1%} of "
        "the "
        f"envelope's footprint, outlines {shares['outlines']:.1%}.",
        "",
        *(line for note in _coarser(layout, job) for line in (note, "")),
        "| label | body | design | resin | middle x, y mm | mass g | mark |",
        "|---|---|---|---|---|---|---|",
        *table,
    ]


def _value(row: dict[str, Any]) -> str:
    varied = f", {row['varied'].partition('.')[2]} = {row['value']}" if row["varied"] else ""
    return _escaped(f"{row['design']}{varied}, copy {row['copy']}")


def _resin(row: dict[str, Any]) -> str:
    """The resin with the base resins, without which a digital material's code is ambiguous."""
    mixed = " + " in row["base_resins"]
    return f"{row['material']} ({row['base_resins']})" if mixed else str(row["material"])


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


def _mark(row: dict[str, Any]) -> str:
    where = f"{row['mark']}, {row['mark_face']}" if row["mark_face"] else row["mark"]
    return f"{where}; {row['mark_note']}" if row["mark_note"] else where


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
