"""Build a specimen: 3MF, STL, GLB, STEP of exact shapes, drawing, print sheet, true patterns and manifest."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

from pneutouch import __version__
from pneutouch.body import Bore, Feature, Prism, Solid
from pneutouch.catalogue import Library
from pneutouch.export.scene import glb, stl
from pneutouch.export.threemf import threemf
from pneutouch.formats import versioned
from pneutouch.meridian import Line
from pneutouch.output.files import check_writable, json_bytes, write_folder
from pneutouch.output.manifest import input_hash, versions, with_manifest
from pneutouch.parts.specimen.plate import holes, outline
from pneutouch.printability import Finding, refuse
from pneutouch.spec.names import plain_name
from pneutouch.spec.read import Changes
from pneutouch.workflows.specimen.draw import SpecimenBodies, draw
from pneutouch.workflows.specimen.drawing import drawing_svg
from pneutouch.workflows.specimen.findings import findings
from pneutouch.workflows.specimen.load import ResolvedSpecimen, load_specimen
from pneutouch.workflows.specimen.sheet import sheet
from pneutouch.workflows.specimen.truth import truth

StepReport = Callable[[str], None]

STEPS = ("bodies", "rules", "3MF", "STL", "GLB", "STEP", "drawing", "files")
"""The steps that a build reports, in order."""


def build_specimen(
    name: str,
    out: Path,
    changes: Changes | None = None,
    library: Library | None = None,
    progress: StepReport = lambda step: None,
    *,
    called: str | None = None,
) -> tuple[Path, list[Finding]]:
    """Write everything a specimen, by name or path, gives into ``out/<name>/``; that folder and the findings.

    ``called`` is the name of the folder and its files where it is not the specimen's own.

    Raises InputError if that is impossible, and RuleBrokenError, with nothing written, if a rule is broken. The same
    input gives the same bytes.
    """
    scene = load_specimen(name, changes, library)
    scene = scene if called is None else replace(scene, name=plain_name(called))
    folder = out / scene.name
    check_writable(folder)
    progress("bodies")
    drawn = draw(scene)
    progress("rules")
    checked = findings(drawn)
    refuse(checked, scene.where)
    files, left_out = _files(drawn, checked, progress)
    progress("files")
    write_folder(folder, with_manifest(files, scene.name, inputs(scene), **_measured(drawn, checked), **left_out))
    return folder, checked


def check_specimen(
    name: str, changes: Changes | None = None, library: Library | None = None, *, deep: bool = False
) -> list[Finding]:
    """The findings on a specimen; with ``deep`` those of pymeshlab too. Raises InputError if that is impossible."""
    drawn = draw(load_specimen(name, changes, library))
    checked = findings(drawn)
    if deep:
        from pneutouch.printability.deep import inspect

        checked += [finding for body in drawn.bodies for finding in inspect(body)]
    return checked


def inputs(scene: ResolvedSpecimen) -> dict[str, Any]:
    """Everything that the result depends on, as data."""
    return {
        "specimen": scene.specimen.model_dump(mode="json"),
        "matrix": scene.matrix.model_dump(mode="json"),
        "inclusion": scene.inclusion.model_dump(mode="json"),
        "frame": None if scene.frame is None else scene.frame.model_dump(mode="json"),
        "printer": scene.printer.model_dump(mode="json"),
    }


def solids(drawn: SpecimenBodies) -> tuple[Solid, ...]:
    """The exact shapes of block and patterns in the block's frame; none where a pattern has no exact shape."""
    bars = [solid for pattern in drawn.patterns for solid in pattern.solids]
    if not all(pattern.solids for pattern in drawn.patterns):
        return ()
    (x0, y0, low), (x1, y1, high) = drawn.scene.block.low, drawn.scene.block.high
    around = _polygon([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    cuts = tuple(Feature(bar.base, bar.volume) for bar in bars if isinstance(bar.base, Prism))
    block = Solid("matrix", "matrix", drawn.scene.matrix, Prism(around, low, high), cuts=cuts)
    return (block, *bars, *_frame_solid(drawn))


def _frame_solid(drawn: SpecimenBodies) -> tuple[Solid, ...]:
    """The frame without its letters."""
    frame, material, block = drawn.scene.specimen.frame, drawn.scene.frame, drawn.scene.block
    if frame is None or material is None:
        return ()
    top, radius = block.low[2], 0.5 * frame.hole_diameter_mm
    low = top - frame.thickness_mm
    bores = tuple(Bore(x, y, radius, low, top) for x, y in holes(block, frame.border_mm))
    corners = [(float(x), float(y)) for x, y in outline(block, frame.border_mm)]
    return (Solid("frame", "frame", material, Prism(_polygon(corners), low, top), bores),)


def _polygon(corners: list[tuple[float, float]]) -> tuple[Line, ...]:
    return tuple(Line(a, b, "") for a, b in pairwise([*corners, corners[0]]))


def _files(
    drawn: SpecimenBodies, checked: list[Finding], progress: StepReport
) -> tuple[dict[str, bytes], dict[str, Any]]:
    """The files, and the manifest's entry on the parts left out."""
    scene, bodies = drawn.scene, drawn.printed
    whole = input_hash(inputs(scene))
    progress("3MF")
    files = {f"{scene.name}.3mf": threemf(scene.name, bodies, _metadata(drawn, whole))}
    progress("STL")
    files |= {f"stl/{body.name}.stl": stl(body) for body in bodies}
    progress("GLB")
    files[f"{scene.name}.glb"] = glb(bodies)
    progress("STEP")
    exact = solids(drawn)
    left_out: dict[str, str] = {}
    if exact:
        from pneutouch.export.step import step_files

        written, left_out = step_files(scene.name, exact, drawn.offset)
        files |= written
    progress("drawing")
    files["drawing.svg"] = drawing_svg(drawn)
    files["print-sheet.md"] = sheet(drawn, checked, whole, left_out).encode()
    files["specimen.json"] = json_bytes(versioned("specimen-report", truth(drawn)))
    return files, {"left_out": left_out} if left_out else {}


def _metadata(drawn: SpecimenBodies, whole: str) -> dict[str, str]:
    scene = drawn.scene
    return {
        "Title": scene.specimen.document.title,
        "Application": f"pneutouch {__version__}",
        "Description": f"Texture specimen {scene.name}: assembly of {', '.join(body.name for body in drawn.bodies)}",
        "versions": json_bytes(versions()).decode(),
        "input-hash": whole,
        "mesh-tolerance-mm": f"{scene.tolerance:g}",
    }


def _measured(drawn: SpecimenBodies, checked: list[Finding]) -> dict[str, Any]:
    """Entries of the manifest on the bodies."""
    scene = drawn.scene
    return {
        "print_frame_offset_mm": drawn.offset.tolist(),
        "mesh": {
            body.name: {
                "tolerance_mm": scene.tolerance,
                "triangles": len(body.triangles),
                "volume_mm3": round(body.volume, 3),
            }
            for body in drawn.bodies
        },
        "findings": [finding.document() for finding in checked],
    }
