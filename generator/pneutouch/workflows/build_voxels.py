"""Voxel stack of a design: the bodies printed with the membrane, one PNG for each layer, in its own folder."""

import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch import __version__
from pneutouch.catalogue import Library
from pneutouch.errors import InputError, nearest
from pneutouch.export.voxels.png import encode, table
from pneutouch.export.voxels.raster import BACKGROUND, VoxelBody, VoxelJob, blend, raster
from pneutouch.export.voxels.slices import VoxelSlicer
from pneutouch.export.voxels.stack import MANIFEST, shortfalls, slice_name, stack_record, stated_slices
from pneutouch.formats import versioned
from pneutouch.output.files import alone_in, check_writable, digest, exchange, file_digest, json_bytes
from pneutouch.parts import Assembly
from pneutouch.printability import Finding, refuse
from pneutouch.printability.rules.resins import check_stack
from pneutouch.results.record import plain
from pneutouch.spec.printer import Mode
from pneutouch.stopping import parent_folders, temporary_folder, uninterrupted

Progress = Callable[[int, int], None]
"""Called with the number of slices written and the number of all slices."""

SEED = 1


_INCH_UM = 25400.0


@dataclass(frozen=True)
class VoxelPlan:
    """Plan of a stack before it is made: the job, its print mode, and the findings on it."""

    assembly: Assembly
    job: VoxelJob
    mode: Mode
    findings: tuple[Finding, ...]

    def refuse(self) -> None:
        """Raise RuleBrokenError, which names the design file and the key, where a rule is broken."""
        scene = self.assembly.scene
        refuse(self.findings, scene.where, "print.profile", scene.design.print.profile)


def plan_voxels(
    assembly: Assembly, *, mode: str | None = None, library: Library | None = None, coarser: float = 1.0
) -> VoxelPlan:
    """Plan the stack of the membrane's print job; ``mode`` names a print mode (None: the design's); ``coarser`` as in
    `raster`.

    Raises InputError for an unknown mode and for a mix of unknown fraction."""
    scene = assembly.scene
    printer, _ = assembly.machine("membrane")
    chosen = _mode(assembly, mode)
    library = library or Library.default()
    solids = [solid for solid in assembly.solids if assembly.job(solid.name) == assembly.job("membrane")]
    names = {"membrane": scene.design.membrane.material, "connector": scene.design.connector.material}
    bodies = []
    for solid in solids:
        table_name = "membrane" if solid.name == "membrane" else "connector"
        where = f"{scene.where}: {table_name}.material"
        mixed = blend(solid.material, str(names[table_name]), library, where, assembly.layout.shape)
        bodies.append(VoxelBody(solid, mixed))
    grid = raster(
        [body.inside for body in bodies],
        (round(_INCH_UM / printer.pixel.x_um), round(_INCH_UM / printer.pixel.y_um)),
        chosen.layer_um,
        upright=assembly.stands_up("membrane"),
        coarser=coarser,
    )
    job = VoxelJob(tuple(bodies), grid, tuple(printer.resins), SEED)
    findings = check_stack(printer, chosen, job.used, len(grid.z), grid.size, "membrane")
    return VoxelPlan(assembly, job, chosen, tuple(findings))


def stack_folder(out: Path, name: str) -> Path:
    """Folder of a design's stack, next to the design's output folder."""
    return out / f"{name}-voxels"


def write_voxels(
    plan: VoxelPlan, out: Path, input_hash: str, progress: Progress = lambda done, all_: None
) -> tuple[Path, list[str]]:
    """Write the stack into ``out/<name>-voxels/``; return the folder, and a line for each volume fraction that is not
    met.

    The folder appears whole or not at all. Raises RuleBrokenError, with nothing written, where a rule is broken, and
    InputError where the folder cannot be written."""
    plan.refuse()
    scene = plan.assembly.scene
    printer, _ = plan.assembly.machine("membrane")
    about = {
        "name": scene.name,
        "input_hash": input_hash,
        "printer": printer.title,
        "mode": plan.mode.name,
        "orientation": scene.design.print.orientation,
        "versions": {"pneutouch": __version__, "zlib": zlib.ZLIB_RUNTIME_VERSION},
        "print_frame_offset_mm": plan.assembly.print_offset.tolist(),
    }
    folder = stack_folder(out, scene.name)
    slicer = write_stack(plan.job, folder, f"{scene.name}_", about, progress)
    return folder, shortfalls(plan.job, slicer)


def write_stack(
    job: VoxelJob, folder: Path, prefix: str, about: Mapping[str, Any], progress: Progress = lambda done, all_: None
) -> VoxelSlicer:
    """Slice a job into a hidden folder and rename that to ``folder``. One slice at a time is in memory.

    Raises InputError that names the folder where it cannot be written, the disk is full, or other files lie in it; then
    nothing is left behind, and an earlier stack stays.
    """
    check_stack_folder(folder)
    try:
        with parent_folders(folder), temporary_folder(prefix=f".{folder.name}.", within=folder.parent) as fresh:
            slicer = VoxelSlicer(job)
            hashes = []
            colours = table([BACKGROUND, *job.colours.values()])
            for number, labels in enumerate(slicer):
                content = encode(labels, colours, job.raster.dpi)
                (fresh / slice_name(prefix, number)).write_bytes(content)
                hashes.append(digest(content))
                progress(number + 1, len(job.raster.z))
            record = plain(stack_record(job, slicer, hashes, about, prefix))
            (fresh / MANIFEST).write_bytes(json_bytes(versioned("stack", record)))
            with uninterrupted(), alone_in(folder.parent):
                fresh.chmod(0o755)
                if folder.exists():
                    check_stack_folder(folder)
                    exchange(folder, fresh)
                else:
                    fresh.rename(folder)
            return slicer
    except OSError as error:
        raise InputError(
            f"{folder}: {error.strerror or error}",
            key="out",
            remedy="no stack was written, and an earlier one is unchanged",
        ) from None


def check_stack_folder(folder: Path) -> None:
    """Raise InputError where a stack cannot be written into ``folder``, or a file in it is not as a stack wrote it."""
    if not folder.is_dir() or folder.is_symlink() or not any(folder.iterdir()):
        check_writable(folder)
        return
    if not (folder / MANIFEST).is_file():
        raise InputError(
            f"{folder} holds files but no {MANIFEST}: not written by pneutouch", key="out", remedy="give another folder"
        )
    stated = stated_slices(folder)
    for path in sorted(folder.iterdir()):
        ours = not path.is_symlink() and file_digest(path) == stated.get(path.name, "none")
        if path.name != MANIFEST and not ours:
            raise InputError("is not of the stack that is to be replaced", file=path, remedy="move it elsewhere")


def _mode(assembly: Assembly, name: str | None) -> Mode:
    printer, default = assembly.machine("membrane")
    if name is None:
        return default
    match = next((mode for mode in printer.mode if mode.name.lower() == name.lower()), None)
    if match is None:
        raise InputError(f"unknown.{nearest(name, [mode.name for mode in printer.mode])}", key="voxel_mode", value=name)
    return match
