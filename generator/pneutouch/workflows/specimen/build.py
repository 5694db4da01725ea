"""Build of a specimen: 3MF, STL, GLB, STEP of exact shapes, drawing, print sheet, true patterns and manifest.

The print rules check the bodies, and the block as one body, as bodies that fill one another leave no open space.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch import __version__
from pneutouch.arrays import Array, Indices
from pneutouch.body import Body, Bore, Feature, Prism, Solid
from pneutouch.body.solid import mesh_of
from pneutouch.catalogue import Library
from pneutouch.export.scene import glb, stl
from pneutouch.export.threemf import threemf
from pneutouch.formats import versioned
from pneutouch.output.files import check_writable, input_hash, json_bytes, versions, with_manifest, write_folder
from pneutouch.parts.specimen import Box
from pneutouch.parts.specimen.plate import holes, outline
from pneutouch.printability import Finding, check, refuse
from pneutouch.printability.subject import Joint, PrintItem, PrintSubject
from pneutouch.results.folder import BodyMesh
from pneutouch.results.record import plain
from pneutouch.shape.meridian import lines_around
from pneutouch.spec.read import Changes
from pneutouch.spec.values import plain_name
from pneutouch.wording import data_of
from pneutouch.workflows.specimen.draw import ResolvedSpecimen, SpecimenBodies, draw, load_specimen
from pneutouch.workflows.specimen.sheet import drawing_svg, sheet, specimen_record

OPEN = frozenset({"holes", "channels", "gaps", "hollows", "cleaning", "emboss", "matte"})
"""Rules on open space, applied to the block as a whole: a space that one body leaves open is filled by another."""

BONDED = frozenset({"walls", "pins"})
"""Rules on free-standing features: here these are bonded to the other resin, which the limits do not consider."""

_MOST_CHECKED = 40_000
"""Number of triangles up to which a body is measured by rays; more take a minute or longer."""

_HINTS: dict[str, str] = data_of(__file__)

_JOB = "specimen"


def findings(drawn: SpecimenBodies) -> list[Finding]:
    """Findings on the bodies, and on the block as one body with its frame, by rank."""
    alone = [
        _bonded(finding)
        for finding in check(bodies_of(drawn))
        if finding.rule not in OPEN and not _rounding(drawn, finding)
    ]
    whole = [finding for finding in check(block_of(drawn)) if finding.rule in OPEN]
    return sorted([*alone, *whole, *_unmeasured(drawn)], key=lambda finding: finding.rank)


def bodies_of(drawn: SpecimenBodies) -> PrintSubject:
    """Subject of the bodies as one job, with the faces that they must share; without those too large to measure."""
    measured = [body for body in drawn.bodies if len(body.triangles) <= _MOST_CHECKED]
    names = {body.name for body in measured}
    joints = (_joint(drawn),) if {"matrix", "inclusion"} <= names else ()
    return PrintSubject(tuple(_item(drawn, body) for body in measured), joints, drawn.scene.name)


def block_of(drawn: SpecimenBodies) -> PrintSubject:
    """Subject of the block as one body, and the frame."""
    rest = [body for body in drawn.bodies if body.name == "frame"]
    block = _box(drawn.scene.block)
    whole = replace(drawn.bodies[0], name="block", role="block", vertices=block[0], triangles=block[1])
    return PrintSubject(tuple(_item(drawn, body) for body in (whole, *rest)), (), drawn.scene.name)


def _item(drawn: SpecimenBodies, body: Body) -> PrintItem:
    return PrintItem(body, drawn.scene.printer, drawn.scene.mode, job=_JOB, hints=_HINTS)


def _joint(drawn: SpecimenBodies) -> Joint:
    """Joint of matrix and inclusion: the inclusion's surface without its faces on the sides of the block."""
    inclusion = drawn.bodies[1]
    corners, block = inclusion.corners, drawn.scene.block
    ends = np.array([block.low, block.high])
    outside = (corners[:, :, None, :] == ends[None, None]).all(axis=1).any(axis=(1, 2))
    a, b, c = np.moveaxis(corners[~outside], 1, 0)
    area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    x, y, z = (float(value) for value in a[0])
    return Joint("matrix", "inclusion", area, (x, y, z))


def _rounding(drawn: SpecimenBodies, finding: Finding) -> bool:
    """True if a finding is an overlap due to the kernel's rounding on faces that coincide by construction."""
    excess = finding.excess
    if finding.rule != "contact faces" or excess is None or excess.unit != "mm3":
        return False
    return excess.measured < 1e-6 * drawn.scene.block.volume


def _bonded(finding: Finding) -> Finding:
    """The finding, as a warning for a thin place of a bonded body: the limit is for free-standing features."""
    if finding.rule not in BONDED or finding.body == "frame":
        return finding
    severity = "warning" if finding.severity == "error" else finding.severity
    other = "inclusion" if finding.body == "matrix" else "matrix"
    text = f"{finding.message} (a limit of free-standing features; here it is bonded to the {other})"
    return replace(finding, severity=severity, message=text)


def _unmeasured(drawn: SpecimenBodies) -> list[Finding]:
    return [
        Finding(
            "mesh",
            "note",
            body.name,
            f"{len(body.triangles)} triangles: closed, but thin places were not measured",
            "see the struts and sheets in the layer table, which were checked before drawing",
            "own: rays take a minute and more",
            None,
            None,
        )
        for body in drawn.bodies
        if len(body.triangles) > _MOST_CHECKED
    ]


def _box(box: Box) -> tuple[Array, Indices]:
    from manifold3d import Manifold

    size = np.array(box.high) - np.array(box.low)
    return mesh_of(Manifold.cube(size.tolist()).translate(box.low))


StepReport = Callable[[str], None]

STEPS = ("bodies", "rules", "3MF", "STL", "GLB", "STEP", "drawing", "files")
"""Steps that a build reports, in order."""


def build_specimen(
    name: str,
    out: Path,
    changes: Changes | None = None,
    library: Library | None = None,
    progress: StepReport = lambda step: None,
    *,
    called: str | None = None,
) -> tuple[Path, list[Finding]]:
    """Write all files of a specimen, given by name or path, into ``out/<name>/``; return that folder and the findings.

    ``called`` names the folder and its files in place of the specimen's own name.

    Raises InputError for what cannot be drawn or written, and RuleBrokenError, with nothing written, if a rule is
    broken. The same input gives the same bytes.
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
    follows_from = inputs(scene)
    files, left_out = _files(drawn, checked, input_hash(follows_from), progress)
    progress("files")
    made = with_manifest(
        files,
        scene.name,
        follows_from,
        print_frame_offset_mm=tuple(drawn.offset.tolist()),
        mesh={
            body.name: BodyMesh(len(body.triangles), round(body.volume, 3), tolerance_mm=scene.tolerance)
            for body in drawn.bodies
        },
        findings=tuple(finding.stated for finding in checked),
        left_out=left_out or None,
    )
    write_folder(folder, made)
    return folder, checked


def check_specimen(
    name: str, changes: Changes | None = None, library: Library | None = None, *, deep: bool = False
) -> list[Finding]:
    """Findings on a specimen; with ``deep`` those of pymeshlab too. Raises InputError for what cannot be drawn."""
    drawn = draw(load_specimen(name, changes, library))
    checked = findings(drawn)
    if deep:
        from pneutouch.printability.inspection import inspect

        checked += [finding for body in drawn.bodies for finding in inspect(body)]
    return checked


def inputs(scene: ResolvedSpecimen) -> Mapping[str, Any]:
    """All that the result depends on, as data."""
    return {
        "specimen": scene.specimen.model_dump(mode="json"),
        "matrix": scene.matrix.model_dump(mode="json"),
        "inclusion": scene.inclusion.model_dump(mode="json"),
        "frame": None if scene.frame is None else scene.frame.model_dump(mode="json"),
        "printer": scene.printer.model_dump(mode="json"),
    }


def solids(drawn: SpecimenBodies) -> tuple[Solid, ...]:
    """Exact shapes of block, patterns and frame in the block's coordinates; none if a pattern has no exact shape."""
    bars = [solid for pattern in drawn.patterns for solid in pattern.solids]
    if not all(pattern.solids for pattern in drawn.patterns):
        return ()
    (x0, y0, low), (x1, y1, high) = drawn.scene.block.low, drawn.scene.block.high
    around = lines_around([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    cuts = tuple(Feature(bar.base, bar.volume) for bar in bars if isinstance(bar.base, Prism))
    block = Solid("matrix", "matrix", drawn.scene.matrix, Prism(around, low, high), cuts=cuts)
    return (block, *bars, *_frame_solid(drawn))


def _frame_solid(drawn: SpecimenBodies) -> tuple[Solid, ...]:
    """Exact shape of the frame, without its letters; none without a frame."""
    frame, material, block = drawn.scene.specimen.frame, drawn.scene.frame, drawn.scene.block
    if frame is None or material is None:
        return ()
    top, radius = block.low[2], 0.5 * frame.hole_diameter_mm
    low = top - frame.thickness_mm
    bores = tuple(Bore(x, y, radius, low, top) for x, y in holes(block, frame.border_mm))
    corners = [(float(x), float(y)) for x, y in outline(block, frame.border_mm)]
    return (Solid("frame", "frame", material, Prism(lines_around(corners), low, top), bores),)


def _files(
    drawn: SpecimenBodies, checked: list[Finding], whole: str, progress: StepReport
) -> tuple[dict[str, bytes], dict[str, str]]:
    """Files by path, and those left out with the reasons; ``whole`` is the hash of the inputs."""
    scene, bodies = drawn.scene, drawn.printed
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
    files["specimen.json"] = json_bytes(versioned("specimen-report", plain(specimen_record(drawn))))
    return files, left_out


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
