"""A design to its output folder.

Build a design: print files, prediction, datasheet, print sheet and manifest, in one folder.

Description of the files of a build, in words.

Name of a build if none is given.
"""

from collections.abc import Callable, Iterable
from fnmatch import fnmatchcase
from pathlib import Path

from pneutouch import __version__
from pneutouch.body import Body
from pneutouch.catalogue import DesignSource
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.evaluation.result import predicted_in_full
from pneutouch.evaluation.sheet import sheet_data
from pneutouch.export.scene import glb, stl
from pneutouch.export.step import step_files
from pneutouch.export.threemf import threemf
from pneutouch.export.threemf_read import RECIPE
from pneutouch.formats import versioned
from pneutouch.output.files import check_writable, json_bytes, versions, with_manifest, write_folder
from pneutouch.output.files import input_hash as hash_of
from pneutouch.output.recipe import BuildRecipe
from pneutouch.printability import refuse
from pneutouch.report.datasheet import datasheet
from pneutouch.report.pictures import picture, pressed_files, shown
from pneutouch.report.print_sheet import print_sheet
from pneutouch.results.folder import BodyMesh
from pneutouch.results.record import plain
from pneutouch.spec.design import CALIBRATION, NO_CALIBRATION
from pneutouch.spec.read import Changes
from pneutouch.units import ML
from pneutouch.workflows.build_mould import mould_files, mould_record

StepReport = Callable[[str], None]

STEPS = ("rules", "meshes", "3MF", "STL", "GLB", "STEP", "datasheet", "files")
"""The steps that a build reports, in order."""

_THUMBNAIL_PIXELS = 256
"""Width and height of the picture in the 3MF."""


def build(evaluation: Evaluation, out: Path, progress: StepReport = lambda step: None) -> Path:
    """Write everything a design gives into ``out/<name>/`` and return that folder.

    Raises RuleBrokenError, with nothing written, where a rule is broken. The same input gives the same bytes.
    """
    scene, assembly = evaluation.scene, evaluation.assembly
    if evaluation.options.aged:
        raise InputError("an aged prediction is for reading", file=scene.where, remedy="a build is of a fresh print")
    folder = out / scene.name
    check_writable(folder)
    progress("rules")
    refuse(evaluation.findings, scene.where)
    progress("meshes")
    bodies = tuple(body.moved(assembly.print_offset) for body in assembly.bodies)
    files: dict[str, bytes] = {
        "prediction.json": json_bytes(versioned("prediction", plain(predicted_in_full(evaluation))))
    }
    progress("3MF")
    files[f"{scene.name}.3mf"] = threemf(scene.name, bodies, _metadata(evaluation, bodies), _thumbnail(evaluation))
    progress("STL")
    files |= {f"stl/{body.name}.stl": stl(body) for body in bodies}
    progress("GLB")
    files[f"{scene.name}.glb"] = glb(bodies)
    progress("STEP")
    exact, left_out = step_files(scene.name, assembly.solids, assembly.print_offset)
    files |= exact
    if assembly.mould is not None:
        made, absent = mould_files(assembly.mould)
        files, left_out = files | made, left_out | absent
    progress("datasheet")
    sheet = sheet_data(evaluation, input_hash(evaluation))
    files |= datasheet(sheet)
    if sheet.pressed is not None:
        files |= pressed_files(sheet.pressed, scene.name)
    files["print-sheet.md"] = print_sheet(sheet, left_out).encode()
    progress("files")
    made = with_manifest(
        files,
        scene.name,
        BuildRecipe.of(evaluation).inputs(),
        print_frame_offset_mm=tuple(assembly.print_offset.tolist()),
        mesh=_meshes(evaluation, bodies),
        findings=tuple(finding.stated for finding in evaluation.findings),
        estimates=evaluation.estimates,
        glue_mL=assembly.glue_volume / ML,
        left_out=left_out or None,
        mould=None if assembly.mould is None else mould_record(assembly.mould),
    )
    write_folder(folder, made)
    return folder


def input_hash(evaluation: Evaluation) -> str:
    """First twelve digits of the SHA-256 of the inputs and the version."""
    return hash_of(BuildRecipe.of(evaluation).inputs())


def _metadata(evaluation: Evaluation, bodies: tuple[Body, ...]) -> dict[str, str]:
    scene = evaluation.scene
    return {
        "Title": scene.design.document.title,
        "Application": f"pneutouch {__version__}",
        "Description": f"Pneumatic touch sensor {scene.name}: assembly of {_and(bodies)}",
        RECIPE: BuildRecipe.of(evaluation).text(),
        "versions": json_bytes(versions()).decode(),
        "input-hash": input_hash(evaluation),
        "mesh-tolerance-mm": f"{scene.mesh_tolerance:g}",
    }


def _and(bodies: tuple[Body, ...]) -> str:
    *first, last = [body.name for body in bodies]
    return f"{', '.join(first)} and {last}" if first else last


def _thumbnail(evaluation: Evaluation) -> bytes:
    """PNG of the bodies cut open."""
    return picture(shown(evaluation.assembly, _THUMBNAIL_PIXELS), _THUMBNAIL_PIXELS, _THUMBNAIL_PIXELS)


def _meshes(evaluation: Evaluation, bodies: tuple[Body, ...]) -> dict[str, BodyMesh]:
    assembly = evaluation.assembly
    return {
        body.name: BodyMesh(
            triangles=len(body.triangles),
            volume_mm3=round(body.volume, 3),
            exact_volume_mm3=round(solid.volume, 3),
            tolerance_mm=evaluation.scene.mesh_tolerance,
            measured_deviation_mm=round(assembly.deviation(original), 6),
        )
        for body, original, solid in zip(bodies, assembly.bodies, assembly.solids, strict=True)
    }


_NAME = "NAME"
"""Stands for the name of the design."""

CONTENTS: tuple[tuple[tuple[str, ...], str], ...] = (
    (
        ("datasheet.html", "datasheet.pdf"),
        "the datasheet; the page has a 3D view that can be rotated, reads on a phone and prints",
    ),
    (("NAME.3mf",), "both bodies as one assembly, with material names and colours"),
    (("stl/*.stl",), "one file a body, all in one frame, for tray software that reads STL"),
    (("NAME.step", "NAME.glb"), "the exact solids for CAD; the meshes for viewers"),
    (
        ("NAME-pressed.png", "NAME-pressed.glb"),
        "the pressed dome in three dimensions, with the contact pressure on it (models `solid` and `harmonic`)",
    ),
    (
        ("mould/*",),
        "of a cast design: its mould, each part as it is printed, all on build plates, closed for CAD, apart for "
        "viewers, in section",
    ),
    (("prediction.json",), "every figure and curve, with units in the names"),
    (("print-sheet.md",), "which body takes which resin, orientation, cleaning, fits"),
    (("manifest.json",), "inputs, versions, measured mesh deviation, SHA-256 of every file"),
)
"""Files of an output folder that belong together, by patterns of their names, with a description; as in
docs/reference/files.md."""


def described(names: Iterable[str], design: str) -> list[tuple[list[str], str]]:
    """The files of the output folder of ``design`` by group, with a description; groups without a file left out."""
    left = list(names)
    groups = []
    for patterns, words in CONTENTS:
        expected = [pattern.replace(_NAME, design) for pattern in patterns]
        there = [name for pattern in expected for name in left if fnmatchcase(name, pattern)]
        left = [name for name in left if name not in there]
        groups.append((there, words))
    return [(there, words) for there, words in [*groups, (left, "")] if there]


def calibrated_name(source: DesignSource, changes: Changes) -> str | None:
    """Name of the build of a calibrated sensor, so that it does not replace the design's; None without calibration."""
    calibration = changes.get(CALIBRATION, source.content.get(CALIBRATION, NO_CALIBRATION))
    if calibration == NO_CALIBRATION or not isinstance(calibration, str):
        return None
    return calibration if calibration.startswith(source.name) else f"{source.name}-{calibration}"
