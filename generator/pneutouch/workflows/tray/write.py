"""Writing of a tray's folder, after the print rules: 3MF, STL, label lists, views from above and the manifest."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneutouch import __version__
from pneutouch.export.scene import stl
from pneutouch.export.threemf import TRAY_RECIPE, TrayItem, threemf_tray
from pneutouch.output.files import check_writable, short_digest, with_manifest, write_folder
from pneutouch.output.recipe import scene_parts
from pneutouch.parts.lettering.mark import EXPLAINED, shape_of
from pneutouch.printability import check, refuse
from pneutouch.printability.subject import PrintItem, PrintSubject
from pneutouch.report.pages import filled
from pneutouch.report.section import loops_path
from pneutouch.report.style import BOLD, INK, MM, MUTED, figure, halo, svg
from pneutouch.results.printing import TrayFinding
from pneutouch.results.record import extended
from pneutouch.results.tray import LabelRow, TrayJobRecord, TrayRecord
from pneutouch.spec.printer import Mode, Printer
from pneutouch.tables.csv_table import csv_bytes
from pneutouch.units import grams
from pneutouch.wording import counted
from pneutouch.workflows.tray.lay import StepReport, TrayJob, TrayLayout, TrayPart, fill, layers, outline

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_WIDTH = 170.0
"""Width of the drawing, mm."""


def tray_svg(layout: TrayLayout, job: TrayJob) -> bytes:
    """SVG drawing of one job, seen from above."""
    envelope = layout.printer.envelope
    head = layout.order.tray.tray
    with figure(_WIDTH, _WIDTH * envelope.y / envelope.x + 6.0) as drawn:
        ax = drawn.add_subplot()
        _table(ax, envelope.x, envelope.y, head.margin_mm)
        outlines: dict[Any, Any] = {}
        for part in job.parts:
            key = (tuple(map(shape_of, part.solids)), part.marks[0].raised)
            if key not in outlines:
                outlines[key] = outline(part.bodies).to_polygons()
            _part(ax, part, outlines[key], envelope.x)
        ax.set_title(
            f"{layout.printer.title}, seen from above: {layout.name(job)}, {counted(len(job.parts), 'part')}, "
            f"{' + '.join(job.resins)}",
            loc="left",
            fontsize=7.5,
            color=INK,
        )
        return svg(drawn).encode()


def _table(ax: "Axes", width: float, depth: float, margin: float) -> None:
    """Draw the envelope's footprint and, dashed, its free border."""
    from matplotlib.patches import Rectangle

    ax.add_patch(Rectangle((0, 0), width, depth, fill=False, edgecolor=INK, linewidth=1.0))
    inner = (width - 2 * margin, depth - 2 * margin)
    ax.add_patch(Rectangle((margin, margin), *inner, fill=False, edgecolor=MUTED, linewidth=0.5, linestyle=(0, (4, 3))))
    ax.set_xlim(-0.02 * width, 1.02 * width)
    ax.set_ylim(-0.02 * depth, 1.02 * depth)
    ax.set_aspect("equal")
    ax.set_xlabel("x, mm")
    ax.set_ylabel("y, mm")


def _part(ax: "Axes", part: TrayPart, polygons: list[Any], width: float) -> None:
    """Draw one part: its resin's colour, its outline, and its label as large as fits."""
    from matplotlib.patches import PathPatch

    axes, shift = part.transform[:2, :2], part.transform[3, :2]
    path = loops_path([line @ axes + shift for line in polygons])
    ax.add_patch(PathPatch(path, facecolor=part.solids[0].material.colour, alpha=0.55, edgecolor="none"))
    ax.add_patch(PathPatch(path, fill=False, edgecolor=INK, linewidth=0.7))
    across, along = part.footprint
    middle = (part.place.x + 0.5 * across, part.place.y + 0.5 * along)
    space = min(across, along) * 0.86 * _WIDTH * MM / width * 72  # points
    ax.text(
        *middle,
        part.label,
        ha="center",
        va="bottom",
        fontsize=min(9.0, 0.34 * space),
        color=INK,
        path_effects=halo(),
        gid=part.name,
        **BOLD,
    )
    names = " + ".join(solid.role for solid in part.solids)
    resins = " + ".join(dict.fromkeys(solid.material.title for solid in part.solids))
    small = min(5.5, 1.6 * space / max(len(resins), len(names), 8))
    ax.text(*middle, f"{resins}\n{names}", ha="center", va="top", fontsize=small, color=INK, linespacing=1.15)


def write_tray(layout: TrayLayout, folder: Path, progress: StepReport = lambda step: None) -> TrayRecord:
    """Write a tray into ``folder``. Raises RuleBrokenError, with nothing written, if a part breaks a print rule."""
    check_writable(folder)
    progress("rules")
    checked = findings(layout)
    refuse((replace(one, body=one.parts) for one in checked), layout.order.where)
    files: dict[str, bytes] = {}
    follows_from, record = inputs(layout), tray_record(layout, folder)
    recipe = json.dumps(follows_from, sort_keys=True, allow_nan=False, separators=(",", ":"))
    for job in layout.jobs:
        name = layout.name(job)
        progress("3MF")
        files[f"{name}.3mf"] = threemf_tray(name, [_item(part) for part in job.parts], _metadata(layout, job, recipe))
        progress("STL")
        files |= {f"stl/{body.name}.stl": stl(body) for part in job.parts for body in part.on_tray()}
        progress("view")
        files["tray.svg" if len(layout.jobs) == 1 else f"tray-{layout.jobs.index(job) + 1}.svg"] = tray_svg(layout, job)
    names = [field.name for field in fields(LabelRow)]
    files["labels.csv"] = csv_bytes(names, [[getattr(row, name) for name in names] for row in record.labels])
    files["labels.md"] = _labels_md(layout, record, checked)
    progress("files")
    about = with_manifest(
        files,
        record.tray,
        follows_from,
        # The version is among the inputs of a tray.
        input_hash=short_digest(follows_from),
        jobs=record.jobs,
        left_out=record.left_out,
        resin_changes=record.resin_changes,
        findings=tuple(one.stated for one in checked),
    )
    write_folder(folder, about)
    return record


def tray_record(layout: TrayLayout, folder: Path) -> TrayRecord:
    """Record of the tray, as ``pneutouch tray`` states it."""
    return TrayRecord(
        tray=layout.order.name,
        folder=str(folder),
        printer=layout.printer.title,
        parts=len(layout.parts),
        resin_changes=layout.resin_note,
        left_out=layout.expanded.left_out,
        jobs=tuple(_job(layout, job) for job in layout.jobs),
        labels=rows(layout),
    )


def inputs(layout: TrayLayout) -> Mapping[str, Any]:
    """All that a tray depends on: the tray file or options, the printer, and the resolved design of each variant.

    ``values`` names, by letter, the entries of ``things`` that each design consists of; designs share most of them.
    """
    values = {piece.value.letter: piece.value for piece in layout.expanded.pieces}
    things: dict[str, Any] = {}

    def kept(model: Any) -> str | None:
        if model is None:
            return None
        content = model.model_dump(mode="json")
        name = short_digest(content)
        things[name] = content
        return name

    scenes = {
        letter: {key: kept(part) for key, part in scene_parts(value.assembly.scene).items()}
        for letter, value in values.items()
    }
    return {
        "tray": layout.order.tray.model_dump(mode="json"),
        "overrides": list(layout.order.overrides),
        "printer": kept(layout.printer),
        "version": __version__,
        "values": scenes,
        "things": things,
    }


def _item(part: TrayPart) -> TrayItem:
    """3MF item of a part; copies without marks share one object, named by the variant's letter instead of the label."""
    if any(mark.kind != "none" for mark in part.marks):
        return TrayItem(part.name, part.name, part.bodies, part.transform)
    letter = part.value.letter
    pairs = zip(part.bodies, part.solids, strict=True)
    bodies = tuple(replace(body, name=f"{letter}-{solid.name}") for body, solid in pairs)
    return TrayItem(part.name, bodies[0].name, bodies, part.transform)


def _metadata(layout: TrayLayout, job: TrayJob, recipe: str) -> dict[str, str]:
    return {
        "Title": layout.order.tray.tray.title,
        "Application": f"pneutouch {__version__}",
        "Description": f"Tray {layout.name(job)} for the {layout.printer.title}: {counted(len(job.parts), 'part')}, "
        f"mode {job.mode.name}",
        TRAY_RECIPE: recipe,
        "resins": " + ".join(job.resins),
        "mesh-tolerance-mm": f"{layout.printer.finest_step(job.mode):g}",
    }


def _job(layout: TrayLayout, job: TrayJob) -> TrayJobRecord:
    return TrayJobRecord(
        name=layout.name(job),
        mode=job.mode.name,
        layer_height_um=job.mode.layer_um,
        layers=job.layers,
        height_mm=round(job.height, 3),
        resins=job.resins,
        parts=len(job.parts),
        mesh_tolerance_mm=layout.printer.finest_step(job.mode),
        fill={key: round(share, 4) for key, share in fill(job, layout.printer).items()},
    )


def subject(part: TrayPart, printer: Printer, mode: Mode) -> PrintSubject:
    """Marked bodies of a part in the job's mode, for the print rules; without exact shapes, which have no marks."""
    items = (PrintItem(body, printer, mode, job=part.label if len(part.bodies) > 1 else "") for body in part.bodies)
    return PrintSubject(tuple(items), name=part.name)


def findings(layout: TrayLayout) -> tuple[TrayFinding, ...]:
    """Findings, errors first. Of copies, and of equal shapes in resins of one kind, only the first is judged."""
    listed: list[TrayFinding] = []
    for job in layout.jobs:
        alike: dict[object, list[int]] = {}
        for k, part in enumerate(job.parts):
            kinds = tuple((shape_of(solid), solid.material.kind) for solid in part.solids)
            alike.setdefault(kinds, []).append(k)
        for places in alike.values():
            labels = tuple(job.parts[k].label for k in places)
            judged = check(subject(job.parts[places[0]], layout.printer, job.mode))
            listed += [extended(TrayFinding, finding, labels=labels) for finding in judged]
    return tuple(sorted(listed, key=lambda one: one.rank))


def rows(layout: TrayLayout) -> tuple[LabelRow, ...]:
    """Rows of the label list, one a body, in the order of the labels within each job."""
    return tuple(row for job in layout.jobs for part in job.parts for row in _rows(layout, job, part))


def _labels_md(layout: TrayLayout, record: TrayRecord, findings: tuple[TrayFinding, ...]) -> bytes:
    """Label list to print and stick on: a head, a table a job, a legend of marks, and findings of the rules."""
    jobs = [
        (job, _coarser(layout, job), [row for row in record.labels if row.job == number])
        for number, job in enumerate(layout.jobs, start=1)
    ]
    kinds = {mark.kind for part in layout.parts for mark in part.marks}
    letters = {part.value.index: part.value.letter for part in layout.parts}
    about = {"letters": letters, "explained": EXPLAINED, "fill": fill, "counted": counted}
    return filled(
        "labels.md.j2", layout=layout, record=record, jobs=jobs, kinds=kinds, findings=findings, **about
    ).encode()


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


def _coarser(layout: TrayLayout, job: TrayJob) -> list[tuple[str, Mode]]:
    """Materials that alone would print in a finer mode than that of their job, with that mode."""
    modes = {
        solid.material.label: layout.printer.mode_for(*(s.material for s in part.solids))
        for part in job.parts
        for solid in part.solids
    }
    return [(label, mode) for label, mode in modes.items() if mode is not None and mode.layer_um < job.mode.layer_um]
