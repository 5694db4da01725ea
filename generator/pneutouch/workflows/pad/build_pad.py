"""Build of a pad: 3MF, STL, GLB, STEP, drawing, print sheet, record and manifest, in one folder."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from pneutouch import __version__
from pneutouch.catalogue import Library
from pneutouch.export.scene import glb, stl
from pneutouch.export.step import step_files
from pneutouch.export.threemf import threemf
from pneutouch.formats import versioned
from pneutouch.output.files import check_writable, input_hash, json_bytes, versions, with_manifest, write_folder
from pneutouch.output.recipe import scene_parts
from pneutouch.printability import Finding, refuse
from pneutouch.printability.estimate import estimate
from pneutouch.results.folder import BodyMesh
from pneutouch.results.record import plain
from pneutouch.spec.read import Changes
from pneutouch.spec.values import plain_name
from pneutouch.workflows.build import StepReport, job_files
from pneutouch.workflows.pad.findings import pad_findings, subject_of
from pneutouch.workflows.pad.load import ResolvedPad, load_pad
from pneutouch.workflows.pad.pad_sheet import drawing_svg, pad_record, sheet

STEPS = ("bodies", "rules", "3MF", "STL", "GLB", "STEP", "drawing", "files")
"""Steps that a build reports, in order."""


def build_pad(
    name: str,
    out: Path,
    changes: Changes | None = None,
    library: Library | None = None,
    progress: StepReport = lambda step: None,
    *,
    called: str | None = None,
) -> tuple[Path, list[Finding]]:
    """Write all files of a pad, given by name or path, into ``out/<name>/``; return that folder and the findings.

    ``called`` names the folder and its files in place of the pad's own name. Raises InputError for what cannot be drawn
    or written, and RuleBrokenError, with nothing written, if a rule is broken. The same input gives the same bytes."""
    pad = load_pad(name, changes, library)
    pad = pad if called is None else replace(pad, name=plain_name(called))
    folder = out / pad.name
    check_writable(folder)
    progress("bodies")
    bodies = tuple(body.moved(pad.print_offset) for body in pad.bodies)
    progress("rules")
    findings = pad_findings(pad)
    refuse(findings, pad.where)
    follows_from = inputs(pad)
    shared = _metadata(pad, input_hash(follows_from))
    progress("3MF")
    files = {f"{pad.name}.3mf": threemf(pad.name, bodies, shared)} | job_files(pad.name, pad, shared)
    progress("STL")
    files |= {f"stl/{body.name}.stl": stl(body) for body in bodies}
    progress("GLB")
    files[f"{pad.name}.glb"] = glb(bodies)
    progress("STEP")
    exact, left_out = step_files(pad.name, pad.solids, pad.print_offset)
    files |= exact
    progress("drawing")
    files["drawing.svg"] = drawing_svg(pad)
    record, jobs = pad_record(pad), tuple(estimate(subject_of(pad)))
    files["print-sheet.md"] = sheet(pad, record, findings, jobs, input_hash(follows_from), left_out).encode()
    files["pad.json"] = json_bytes(versioned("pad-report", plain(record)))
    progress("files")
    made = with_manifest(
        files,
        pad.name,
        follows_from,
        print_frame_offset_mm=tuple(pad.print_offset.tolist()),
        mesh={
            body.name: BodyMesh(
                len(body.triangles),
                round(body.volume, 3),
                exact_volume_mm3=round(solid.volume, 3),
                tolerance_mm=pad.scene.mesh_tolerance,
            )
            for body, solid in zip(bodies, pad.solids, strict=True)
        },
        findings=tuple(finding.stated for finding in findings),
        estimates=jobs,
        left_out=left_out or None,
    )
    write_folder(folder, made)
    return folder, findings


def check_pad(
    name: str, changes: Changes | None = None, library: Library | None = None, *, deep: bool = False
) -> list[Finding]:
    """Findings on a pad; with ``deep`` those of pymeshlab too. Raises InputError for what cannot be drawn."""
    pad = load_pad(name, changes, library)
    findings = pad_findings(pad)
    if deep:
        from pneutouch.printability.inspection import inspect

        pairs = zip(pad.bodies, pad.solids, strict=True)
        findings += [one for body, solid in pairs for one in inspect(body, solid, pad.scene.mesh_tolerance)]
    return findings


def inputs(pad: ResolvedPad) -> Mapping[str, Any]:
    """All that the result depends on, as data."""
    parts = scene_parts(pad.scene).items()
    return {
        "pad": pad.file.model_dump(mode="json"),
        **{key: None if part is None else part.model_dump(mode="json", by_alias=True) for key, part in parts},
    }


def _metadata(pad: ResolvedPad, whole: str) -> dict[str, str]:
    return {
        "Title": pad.file.document.title,
        "Application": f"pneutouch {__version__}",
        "Description": f"Pad {pad.name}: {len(pad.layout.places)} cells on one membrane, and the manifold",
        "versions": json_bytes(versions()).decode(),
        "input-hash": whole,
        "mesh-tolerance-mm": f"{pad.scene.mesh_tolerance:g}",
    }
