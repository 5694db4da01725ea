"""Write a tray's folder: 3MF, STL, label lists, views from above and the manifest, whole or not at all."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

from pneutouch import __version__
from pneutouch.body import Body
from pneutouch.export.scene import stl
from pneutouch.export.threemf_tray import TRAY_RECIPE, TrayItem, threemf_tray
from pneutouch.output.files import check_writable, write_folder
from pneutouch.output.manifest import short_digest, with_manifest
from pneutouch.output.recipe import scene_parts
from pneutouch.printability import refuse
from pneutouch.wording import counted
from pneutouch.workflows.tray.labels import labels_csv, labels_md, rows
from pneutouch.workflows.tray.lay import StepReport, TrayJob, TrayLayout, TrayPart, fill
from pneutouch.workflows.tray.rules import TrayFinding, findings
from pneutouch.workflows.tray.view import tray_svg


def write_tray(layout: TrayLayout, folder: Path, progress: StepReport = lambda step: None) -> Path:
    """Write everything of a tray into ``folder`` and return it. The same input gives the same bytes.

    Raises RuleBrokenError, with nothing written, where a part breaks a print rule.
    """
    check_writable(folder)
    progress("rules")
    checked = findings(layout)
    refuse((replace(one.finding, body=one.parts) for one in checked), layout.order.where)
    files: dict[str, bytes] = {}
    recipe = json.dumps(inputs(layout), sort_keys=True, allow_nan=False, separators=(",", ":"))
    for job in layout.jobs:
        name = layout.name(job)
        progress("3MF")
        files[f"{name}.3mf"] = threemf_tray(name, [_item(part) for part in job.parts], _metadata(layout, job, recipe))
        progress("STL")
        files |= {f"stl/{body.name}.stl": stl(body) for part in job.parts for body in part.on_tray()}
        progress("view")
        files["tray.svg" if len(layout.jobs) == 1 else f"tray-{layout.jobs.index(job) + 1}.svg"] = tray_svg(layout, job)
    files["labels.csv"], files["labels.md"] = labels_csv(layout), labels_md(layout, checked)
    progress("files")
    content = inputs(layout)
    # The version is among the inputs of a tray.
    short = short_digest(content)
    write_folder(folder, with_manifest(files, layout.order.name, content, input_hash=short, **_jobs(layout, checked)))
    return folder


def document(layout: TrayLayout, folder: Path) -> dict[str, Any]:
    """Document that ``pneutouch tray --json`` prints."""
    return {
        "tray": layout.order.name,
        "folder": str(folder),
        "printer": layout.printer.title,
        "parts": len(layout.parts),
        "resin_changes": layout.resin_note,
        "left_out": list(layout.expanded.left_out),
        "jobs": [_job_document(layout, job) for job in layout.jobs],
        "labels": rows(layout),
    }


def inputs(layout: TrayLayout) -> dict[str, Any]:
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


def _job_document(layout: TrayLayout, job: TrayJob) -> dict[str, Any]:
    return {
        "name": layout.name(job),
        "mode": job.mode.name,
        "layer_height_um": job.mode.layer_um,
        "layers": job.layers,
        "height_mm": round(job.height, 3),
        "resins": list(job.resins),
        "parts": len(job.parts),
        "mesh_tolerance_mm": layout.printer.finest_step(job.mode),
        "fill": {key: round(share, 4) for key, share in fill(job, layout.printer).items()},
    }


def _jobs(layout: TrayLayout, checked: tuple[TrayFinding, ...]) -> dict[str, Any]:
    """Entries of the manifest on jobs and findings."""
    return {
        "jobs": [_job_document(layout, job) for job in layout.jobs],
        "left_out": list(layout.expanded.left_out),
        "resin_changes": layout.resin_note,
        "findings": [{"labels": list(one.labels), **one.finding.document()} for one in checked],
    }
