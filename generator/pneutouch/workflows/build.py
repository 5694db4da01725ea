"""Build of a design: print files of sensor and mould, prediction, datasheet, print sheet, manifest, in one folder."""

from collections import defaultdict
from collections.abc import Callable, Iterable
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Protocol

import numpy as np

from pneutouch import __version__
from pneutouch.body import Body, Solid
from pneutouch.catalogue import DesignSource
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.evaluation.result import predicted_in_full
from pneutouch.evaluation.sheet import sheet_data
from pneutouch.export.scene import glb, stl
from pneutouch.export.step import step_files
from pneutouch.export.threemf import TrayItem, threemf, threemf_tray
from pneutouch.export.threemf_read import RECIPE
from pneutouch.formats import versioned
from pneutouch.output.files import check_writable, json_bytes, versions, with_manifest, write_folder
from pneutouch.output.files import input_hash as hash_of
from pneutouch.output.recipe import BuildRecipe
from pneutouch.packing import PackingArea, in_rows
from pneutouch.parts.cast_ring import RING
from pneutouch.parts.connector import gasket_radii
from pneutouch.parts.glue import glue_volume
from pneutouch.parts.mould import MouldAssembly, silicone_batch
from pneutouch.parts.mould.filling import release_of
from pneutouch.printability import refuse
from pneutouch.printability.rulebook import MOULD_INFILL
from pneutouch.report.datasheet import datasheet
from pneutouch.report.mould import mould_section
from pneutouch.report.pages import filled
from pneutouch.report.pictures import picture, pressed_files, shown
from pneutouch.report.print_sheet import print_sheet, steps
from pneutouch.report.section import assembly_pictures
from pneutouch.results.folder import BodyMesh, MouldRecord, SiliconeRecord
from pneutouch.results.record import plain
from pneutouch.spec.design import CALIBRATION, NO_CALIBRATION
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Mode, Printer
from pneutouch.spec.read import Changes
from pneutouch.units import ML, UM
from pneutouch.wording import data_of, enumerated

StepReport = Callable[[str], None]

STEPS = ("rules", "meshes", "3MF", "STL", "GLB", "STEP", "datasheet", "files")
"""Steps that a build reports, in order."""

_THUMBNAIL_PIXELS = 256
"""Width and height of the picture in the 3MF file."""


def build(evaluation: Evaluation, out: Path, progress: StepReport = lambda step: None) -> Path:
    """Write all files of a design into ``out/<name>/`` and return that folder.

    Raises RuleBrokenError, with nothing written, where a rule is broken, and InputError for an aged prediction or a
    folder that cannot be written. The same input gives the same bytes."""
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
    thumbnail = picture(shown(assembly, _THUMBNAIL_PIXELS), _THUMBNAIL_PIXELS, _THUMBNAIL_PIXELS)
    files[f"{scene.name}.3mf"] = threemf(scene.name, bodies, _metadata(evaluation, bodies), thumbnail)
    shared = _metadata(evaluation, assembly.bodies)
    del shared[RECIPE]
    jobs = job_files(scene.name, assembly, shared)
    files |= jobs
    progress("STL")
    files |= {f"stl/{body.name}.stl": stl(body) for body in bodies}
    progress("GLB")
    files[f"{scene.name}.glb"] = glb(bodies)
    progress("STEP")
    exact, left_out = step_files(scene.name, assembly.solids, assembly.print_offset)
    files |= exact
    if assembly.layout.gasket:
        cut = filled("gasket.dxf.j2", radii=gasket_radii(assembly.layout))
        files[f"{scene.name}-gasket.dxf"] = cut.encode()
    if assembly.mould is not None:
        made, absent = mould_files(assembly.mould)
        files, left_out = files | made, left_out | absent
    progress("datasheet")
    sheet = sheet_data(evaluation, input_hash(evaluation))
    files |= datasheet(sheet)
    files["assembly.svg"] = assembly_pictures(assembly, steps(sheet)).encode()
    if sheet.pressed is not None:
        files |= pressed_files(sheet.pressed, scene.name)
    files["print-sheet.md"] = print_sheet(
        sheet, [name for name in sorted(jobs) if name.endswith(".3mf")], left_out
    ).encode()
    progress("files")
    made = with_manifest(
        files,
        scene.name,
        BuildRecipe.of(evaluation).inputs(),
        print_frame_offset_mm=tuple(assembly.print_offset.tolist()),
        mesh=_meshes(evaluation, bodies),
        findings=tuple(finding.stated for finding in evaluation.findings),
        estimates=evaluation.estimates,
        glue_mL=glue_volume(scene, assembly.layout) / ML,
        left_out=left_out or None,
        mould=None if assembly.mould is None else mould_record(assembly.mould),
    )
    return write_folder(folder, made)


def input_hash(evaluation: Evaluation) -> str:
    """First twelve digits of the SHA-256 of the build's inputs and the program's version."""
    return hash_of(BuildRecipe.of(evaluation).inputs())


class PrintedBodies(Protocol):
    """Bodies as they are printed: meshes, and of each by name its solid, machine, job and side on the bed."""

    @property
    def bodies(self) -> tuple[Body, ...]:
        """Print meshes in the design frame."""

    def solid(self, name: str) -> Solid:
        """Solid of a body."""

    def machine(self, name: str) -> tuple[Printer, Mode]:
        """Printer of a body, and its mode."""

    def job(self, name: str) -> str:
        """Name of the print job of a body; bodies of one job are printed together."""

    def stands_up(self, name: str) -> bool:
        """True if a body is printed as it stands in the design frame, False if turned over."""


def job_files(called: str, made: PrintedBodies, shared: dict[str, str]) -> dict[str, bytes]:
    """One 3MF for each print job of what is ``called`` so, by path: its bodies as they lie on the bed, in the corner of
    it; ``shared`` is their metadata. A cast membrane has none: its mould is printed."""
    jobs, files = defaultdict[str, list[Body]](list), {}
    for body in made.bodies:
        if not made.machine(body.name)[0].is_casting:
            jobs[made.job(body.name)].append(body)
    for job, bodies in jobs.items():
        name, names = f"{called}-{job.replace(' ', '-')}", enumerated([body.name for body in bodies])
        turn = np.diag([1.0, 1.0, 1.0] if made.stands_up(bodies[0].name) else [1.0, -1.0, -1.0])
        low = np.min([(body.vertices @ turn).min(axis=0) for body in bodies], axis=0)
        item = TrayItem(job, name, tuple(bodies), np.vstack([turn, np.array([_BORDER, _BORDER, 0.0]) - low]))
        machine = made.machine(bodies[0].name)[0].title
        about = {"Description": f"Print job of {called}: {names}, as it lies on the bed of the {machine}"}
        files[f"{_JOB_FOLDER}/{name}.3mf"] = threemf_tray(name, [item], {**shared, **about})
        material = made.solid(bodies[0].name).material
        files |= _slicer(f"{_JOB_FOLDER}/{name}", *made.machine(bodies[0].name), material)
    return files


def _slicer(path: str, printer: Printer, mode: Mode, material: Material, infill: str | None = None) -> dict[str, bytes]:
    """Settings of PrusaSlicer as a file ``path``.ini, the material's over the printer's; none if they state none."""
    stated = [one.making for one in (printer, material) if one.making is not None]
    settings = {key: value for one in stated for key, value in one.slicer.items()}
    more = {"layer_height": UM * mode.layer_um} | ({} if infill is None else {"fill_density": infill})
    texts = {key: value if isinstance(value, str) else f"{value:g}" for key, value in (settings | more).items()}
    lines = sorted(f"{key} = {text}\n" for key, text in texts.items())
    return {f"{path}.ini": "".join(lines).encode()} if settings else {}


def _metadata(evaluation: Evaluation, bodies: tuple[Body, ...]) -> dict[str, str]:
    scene = evaluation.scene
    return {
        "Title": scene.design.document.title,
        "Application": f"pneutouch {__version__}",
        "Description": f"Pneumatic touch sensor {scene.name}: assembly of {enumerated([body.name for body in bodies])}",
        RECIPE: BuildRecipe.of(evaluation).text(),
        "versions": json_bytes(versions()).decode(),
        "input-hash": input_hash(evaluation),
        "mesh-tolerance-mm": f"{scene.mesh_tolerance:g}",
    }


def _meshes(evaluation: Evaluation, bodies: tuple[Body, ...]) -> dict[str, BodyMesh]:
    assembly = evaluation.assembly
    return {
        body.name: BodyMesh(
            triangles=len(body.triangles),
            volume_mm3=round(body.volume, 3),
            exact_volume_mm3=round(solid.volume, 3),
            tolerance_mm=evaluation.scene.mesh_tolerance,
            measured_deviation_mm=round(solid.deviation(original), 6),
        )
        for body, original, solid in zip(bodies, assembly.bodies, assembly.solids, strict=True)
    }


_NAME = "NAME"
"""Placeholder for the design's name in patterns."""

CONTENTS = tuple((tuple(group["names"]), group["words"]) for group in data_of(__file__)["files"])
"""Files of a build's folder by patterns of names, with a description, as in docs/reference/files.md."""


def described(names: Iterable[str], design: str) -> list[tuple[list[str], str]]:
    """Files in the output folder of ``design`` by group, with a description; groups without a file are left out."""
    left = list(names)
    groups = []
    for patterns, words in CONTENTS:
        expected = [pattern.replace(_NAME, design) for pattern in patterns]
        there = [name for pattern in expected for name in left if fnmatchcase(name, pattern)]
        left = [name for name in left if name not in there]
        groups.append((there, words))
    return [(there, words) for there, words in [*groups, (left, "")] if there]


def calibrated_name(source: DesignSource, changes: Changes) -> str | None:
    """Name of the build of a calibrated sensor, which must not replace the design's; None without a calibration."""
    calibration = changes.get(CALIBRATION, source.content.get(CALIBRATION, NO_CALIBRATION))
    if calibration == NO_CALIBRATION or not isinstance(calibration, str):
        return None
    return calibration if calibration.startswith(source.name) else f"{source.name}-{calibration}"


_JOB_FOLDER = "jobs"
"""Folder of the print jobs' files within the folder of a build."""

_MOULD_FOLDER = "mould"
"""Folder of the mould's files within the folder of a build."""

_GAP, _BORDER = 5.0, 5.0
"""Space in mm between parts on a plate and at its border: own choice."""

_APART = 1.2
"""Distance of the parts in the exploded view, as a multiple of a part's height."""


def mould_files(mould: MouldAssembly) -> tuple[dict[str, bytes], dict[str, str]]:
    """Files of a mould by path, and reasons for those left out. Raises ComputationError if the CAD kernel fails."""
    name = f"{mould.scene.name}-mould"
    files = {f"{_MOULD_FOLDER}/{body.name}.stl": stl(body) for body in mould.printed}
    plates = _plates(mould)
    for k, items in enumerate(plates):
        numbered = name if len(plates) == 1 else f"{name}-{k + 1}"
        files[f"{_MOULD_FOLDER}/{numbered}.3mf"] = threemf_tray(
            numbered, items, _mould_metadata(mould, k + 1, len(plates))
        )
    files |= _slicer(f"{_MOULD_FOLDER}/{name}", mould.printer, mould.mode, mould.material, f"{MOULD_INFILL:.0%}")
    files[f"{_MOULD_FOLDER}/{name}.glb"] = glb(exploded(mould))
    files[f"{_MOULD_FOLDER}/{name}.svg"] = mould_section(mould).encode()
    exact, left_out = step_files(name, mould.solids, mould.print_offset)
    files |= {f"{_MOULD_FOLDER}/{file}": content for file, content in exact.items()}
    return files, {f"{_MOULD_FOLDER}/{file}": why for file, why in left_out.items()}


def mould_record(mould: MouldAssembly) -> MouldRecord:
    """The mould as the manifest states it."""
    size, release, batch = mould.size, release_of(mould.membrane, mould.size), silicone_batch(mould)
    return MouldRecord(
        cavities=size.shape.cavities,
        parts=mould.counts,
        scale=round(size.shape.factor, 9),
        mesh_tolerance_mm=mould.tolerance,
        wall_error_mm=round(size.wall_error, 6),
        release_strain_percent=round(100 * release.strain, 3),
        silicone=SiliconeRecord(
            cavities=batch.cavities,
            cavity_mL=round(batch.cavity_mL, 4),
            channels_mL=round(batch.channels_mL, 4),
            overflow_mL=round(batch.overflow_mL, 4),
            loss_mL=round(batch.loss_mL, 4),
            volume_mL=round(batch.volume_mL, 4),
            mass_g=round(batch.mass_g, 3),
            parts_g=tuple(round(part, 3) for part in batch.parts_g),
        ),
        mesh={
            body.name: BodyMesh(len(body.triangles), round(body.volume, 3), round(solid.volume, 3))
            for body, solid in zip(mould.bodies, mould.solids, strict=True)
        },
    )


def exploded(mould: MouldAssembly) -> tuple[Body, ...]:
    """Parts of the mould, apart along the axis in the order in which they close; no coordinate is negative."""
    size = mould.size
    lifts = {
        "mould-cap": _APART * (size.faces.high - size.low + size.foot),
        "mould-ring": _APART * size.faces.high,
        RING: 0.6 * _APART * size.faces.high,
        "mould-core": 0.0,
        "mould-base": -_APART * (size.foot + size.shape.wall),
    }
    # A numbered copy, such as mould-core-2, is lifted as its part.
    apart = [body.moved(np.array([0.0, 0.0, lifts[body.name.rstrip("-0123456789")]])) for body in mould.closed]
    low = np.min([body.bounds[0] for body in apart], axis=0)
    return tuple(body.moved(-low) for body in apart)


def _plates(mould: MouldAssembly) -> list[list[TrayItem]]:
    """Parts, each as often as it is made, on as many build plates as needed, each as full as `in_rows` packs it."""
    envelope = mould.printer.envelope
    area = PackingArea(envelope.x, envelope.y, _BORDER, _GAP)
    left = [
        (f"{body.name}-{k + 1}" if mould.counts[body.name] > 1 else body.name, body)
        for body in mould.printed
        for k in range(mould.counts[body.name])
    ]
    plates: list[list[TrayItem]] = []
    while left:
        sizes = [(float(body.bounds[1][0]), float(body.bounds[1][1])) for _, body in left]
        places = in_rows(sizes, area)
        # What the rules let pass fits alone, if need be turned: it then begins a plate of its own.
        if places[0] is None:
            plates.append([_item(*left[0], 0.0, 0.0)])
            left = left[1:]
            continue
        taken = [k for k, place in enumerate(places) if place is not None]
        plates.append([_item(*left[k], place.x, place.y) for k in taken if (place := places[k]) is not None])
        left = [each for k, each in enumerate(left) if k not in set(taken)]
    return plates


def _item(label: str, body: Body, x: float, y: float) -> TrayItem:
    return TrayItem(label, body.name, (body,), np.vstack([np.eye(3), [x, y, 0.0]]))


def _mould_metadata(mould: MouldAssembly, plate: int, plates: int) -> dict[str, str]:
    cavities = mould.size.shape.cavities
    which = f", plate {plate} of {plates}" if plates > 1 else ""
    return {
        "Title": f"Mould of {mould.scene.design.document.title}",
        "Application": f"pneutouch {__version__}",
        "Description": f"Mould of {mould.scene.name}, {cavities} cavities{which}",
        "mesh-tolerance-mm": f"{mould.tolerance:g}",
    }
