"""The files of a mould: STL of each part as it is printed, plates as 3MF, and the closed mould as STEP, GLB and SVG."""

from dataclasses import replace

import numpy as np

from pneutouch import __version__
from pneutouch.arrays import Array
from pneutouch.body import Body
from pneutouch.export.scene import glb, stl
from pneutouch.export.step import step_files
from pneutouch.export.threemf import TrayItem, threemf_tray
from pneutouch.packing import PackingArea, in_rows
from pneutouch.parts.cast_ring import RING
from pneutouch.parts.mould import MouldAssembly, silicone_batch
from pneutouch.parts.mould.filling import release_of
from pneutouch.report.mould import mould_section
from pneutouch.results.folder import BodyMesh, MouldRecord, SiliconeRecord

FOLDER = "mould"
"""Folder of the mould's files within a design's."""

_GAP, _BORDER = 5.0, 5.0
"""Space in mm between parts on a plate and at its border: own choice."""

_APART = 1.2
"""Distance of the parts in the exploded view, over the height of each."""


def mould_files(mould: MouldAssembly) -> tuple[dict[str, bytes], dict[str, str]]:
    """The files by name, and those left out with the reason. Raises ComputationError if the CAD kernel fails."""
    name = f"{mould.scene.name}-mould"
    files = {f"{FOLDER}/{body.name}.stl": stl(body) for body in mould.printed}
    plates = _plates(mould)
    for k, items in enumerate(plates):
        numbered = name if len(plates) == 1 else f"{name}-{k + 1}"
        files[f"{FOLDER}/{numbered}.3mf"] = threemf_tray(numbered, items, _metadata(mould, k + 1, len(plates)))
    files[f"{FOLDER}/{name}.glb"] = glb(exploded(mould))
    files[f"{FOLDER}/{name}.svg"] = mould_section(mould).encode()
    exact, left_out = step_files(name, mould.solids, mould.print_offset)
    files |= {f"{FOLDER}/{file}": content for file, content in exact.items()}
    return files, {f"{FOLDER}/{file}": why for file, why in left_out.items()}


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
    """The parts of the mould apart along the axis, in the order in which they close, all coordinates positive."""
    size = mould.size
    lifts = {
        "mould-cap": _APART * (size.faces.high - size.low + size.foot),
        "mould-ring": _APART * size.faces.high,
        RING: 0.6 * _APART * size.faces.high,
        "mould-core": 0.0,
        "mould-base": -_APART * (size.foot + size.shape.wall),
    }
    apart = [body.moved(np.array([0.0, 0.0, lifts[_part(body.name)]])) for body in mould.closed]
    low = np.min([body.bounds[0] for body in apart], axis=0)
    return tuple(body.moved(-low) for body in apart)


def _part(name: str) -> str:
    """The part that a numbered body is one of: ``mould-core-2`` is a mould-core."""
    return name.rstrip("0123456789").rstrip("-")


def _plates(mould: MouldAssembly) -> list[list[TrayItem]]:
    """Every part as often as it is made, on build plates one after another, each as full as `in_rows` packs it."""
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
    transform: Array = np.vstack([np.eye(3), [x, y, 0.0]])
    return TrayItem(label, body.name, (replace(body, name=body.name),), transform)


def _metadata(mould: MouldAssembly, plate: int, plates: int) -> dict[str, str]:
    cavities = mould.size.shape.cavities
    which = f", plate {plate} of {plates}" if plates > 1 else ""
    return {
        "Title": f"Mould of {mould.scene.design.document.title}",
        "Application": f"pneutouch {__version__}",
        "Description": f"Mould of {mould.scene.name}, {cavities} cavities{which}",
        "mesh-tolerance-mm": f"{mould.tolerance:g}",
    }
