"""Write a tray's folder: 3MF, STL, label lists, views from above and the manifest, whole or not at all.

The tray seen from above: envelope, parts in outline with their labels, axes in mm.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch import __version__
from pneutouch.body import Body
from pneutouch.export.scene import stl
from pneutouch.export.threemf import TRAY_RECIPE, TrayItem, threemf_tray
from pneutouch.output.files import check_writable, short_digest, with_manifest, write_folder
from pneutouch.output.recipe import scene_parts
from pneutouch.parts.lettering.mark import shape_of
from pneutouch.printability import refuse
from pneutouch.report.style import BOLD, INK, MM, MUTED, figure, halo, svg
from pneutouch.results.tray import TrayJobRecord, TrayRecord
from pneutouch.wording import counted
from pneutouch.workflows.tray.labels import findings, labels_csv, labels_md, rows
from pneutouch.workflows.tray.lay import StepReport, TrayJob, TrayLayout, TrayPart, fill, outline

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_WIDTH = 170.0
"""Width of the drawing, mm."""


def tray_svg(layout: TrayLayout, job: TrayJob) -> bytes:
    """SVG of one job."""
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


def _table(ax: Axes, width: float, depth: float, margin: float) -> None:
    """The envelope's footprint and, dashed, its free border."""
    from matplotlib.patches import Rectangle

    ax.add_patch(Rectangle((0, 0), width, depth, fill=False, edgecolor=INK, linewidth=1.0))
    inner = (width - 2 * margin, depth - 2 * margin)
    ax.add_patch(Rectangle((margin, margin), *inner, fill=False, edgecolor=MUTED, linewidth=0.5, linestyle=(0, (4, 3))))
    ax.set_xlim(-0.02 * width, 1.02 * width)
    ax.set_ylim(-0.02 * depth, 1.02 * depth)
    ax.set_aspect("equal")
    ax.set_xlabel("x, mm")
    ax.set_ylabel("y, mm")


def _part(ax: Axes, part: TrayPart, polygons: list[Any], width: float) -> None:
    """One part: its resin's colour, its outline, its label as large as it fits."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    axes, shift = part.transform[:2, :2], part.transform[3, :2]
    moved = [np.vstack([line, line[:1]]) @ axes + shift for line in polygons]
    path = Path.make_compound_path(*(Path(line, closed=True) for line in moved))
    ax.add_patch(PathPatch(path, facecolor=part.solids[0].material.colour, alpha=0.55, edgecolor="none"))
    ax.add_patch(PathPatch(path, fill=False, edgecolor=INK, linewidth=0.7))
    across, along = part.footprint
    middle = (part.place.x + 0.5 * across, part.place.y + 0.5 * along)
    space = min(across, along) * 0.86 * _WIDTH * MM / width * 72  # points
    size = min(9.0, 0.34 * space)
    ax.text(
        *middle,
        part.label,
        ha="center",
        va="bottom",
        fontsize=size,
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
    """Write everything of a tray into ``folder``. The same input gives the same bytes.

    Raises RuleBrokenError, with nothing written, where a part breaks a print rule.
    """
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
    files["labels.csv"], files["labels.md"] = labels_csv(record.labels), labels_md(layout, record, checked)
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
    """The tray as ``pneutouch tray`` states it."""
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
    """Everything that a tray depends on: the tray file or options, the printer, and each value's scene resolved.

    ``values`` state by letter which of ``things`` each scene is made of: they share most of them.
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
    """Copies without marks are one shape: their object carries the value's letter instead of the label."""
    if any(mark.kind != "none" for mark in part.marks):
        return TrayItem(part.name, part.name, part.bodies, part.transform)
    letter = part.value.letter
    bodies = tuple(_named(body, f"{letter}-{solid.name}") for body, solid in zip(part.bodies, part.solids, strict=True))
    return TrayItem(part.name, bodies[0].name, bodies, part.transform)


def _named(body: Body, name: str) -> Body:
    return Body(name, body.role, body.material, body.vertices, body.triangles)


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
