"""The manifest of a stack, ``stack.json``: what every colour and number in it stands for."""

import hashlib
import math
from collections.abc import Mapping, Sequence
from typing import Any

from pneutouch.export.voxels.job import BACKGROUND, VoxelBody, VoxelJob
from pneutouch.export.voxels.raster import Raster
from pneutouch.export.voxels.skin import reach_for
from pneutouch.export.voxels.slices import CUBE, FULL, VoxelCounts, VoxelSlicer
from pneutouch.formats import KEY, format_of
from pneutouch.units import UM

MANIFEST = "stack.json"

METHOD = (
    "void and cluster: thresholds of blue noise in three dimensions, block by block rolled, soft skin made up for "
    "beneath"
)

SHORT = 1e-3
"""Difference of fractions over a body beyond which a warning says that the request is not met."""


def slice_name(prefix: str, number: int) -> str:
    """Name of a slice: no zeros in front, as the utility's own files."""
    return f"{prefix}{number}.png"


def whole_hash(hashes: Sequence[str]) -> str:
    """SHA-256 over the slices' own, one a line, in order."""
    return hashlib.sha256("".join(f"{one}\n" for one in hashes).encode()).hexdigest()


def manifest(
    job: VoxelJob, slicer: VoxelSlicer, hashes: Sequence[str], about: Mapping[str, Any], prefix: str
) -> dict[str, Any]:
    """The manifest of a stack that has been sliced; ``about`` goes in as it is: design, printer, mode, input hash."""
    voxel = job.raster.voxel
    return {
        **about,
        KEY: format_of("stack"),
        "prefix": prefix,
        **raster_entry(job.raster),
        "background_rgba": list(BACKGROUND),
        "resins": {
            resin: {"rgba": list(colour), "voxels": count, "volume_mm3": round(count * voxel, 6)}
            for resin, colour in job.colours.items()
            for count in [slicer.counts[resin]]
        },
        "bodies": {
            body.solid.name: _body(body, slicer.tallies[body.solid.name], job.raster.pitch) for body in job.bodies
        },
        "dither": {"method": METHOD, "seed": job.seed, "cube_mm": CUBE, "least_share_of_a_cube": FULL},
        "assumptions": _assumptions(job),
        "sha256": whole_hash(hashes),
        "slices": list(hashes),
    }


def raster_entry(raster: Raster) -> dict[str, Any]:
    """The raster's entries."""
    x, y, z = (step / UM for step in raster.pitch)
    return {
        "dpi": list(raster.dpi),
        "pixel_um": [round(x, 6), round(y, 6)],
        "layer_um": round(z, 6),
        "pixels": [len(raster.x), len(raster.y)],
        "layers": len(raster.z),
        "size_mm": [round(length, 6) for length in raster.size],
        "first_voxel_mm": [round(float(axis[0]), 6) for axis in (raster.x, raster.y, raster.z)],
    }


def shortfalls(job: VoxelJob, slicer: VoxelSlicer) -> list[str]:
    """A line for every body whose fraction could not be met."""
    lines = []
    for body in job.bodies:
        tally = slicer.tallies[body.solid.name]
        if tally.voxels and abs(tally.realised - tally.requested) > SHORT * tally.voxels:
            requested, got = tally.requested / tally.voxels, tally.realised / tally.voxels
            lines.append(
                f"{body.solid.name}: {got:.2%} {body.blend.resins[1]} of the {requested:.2%} requested: "
                f"{tally.skin / tally.voxels:.0%} of its voxels are skin, which stays {body.blend.resins[0]}"
            )
    return lines


def _body(body: VoxelBody, tally: VoxelCounts, pitch: tuple[float, float, float]) -> dict[str, Any]:
    exact = body.solid.volume
    entry: dict[str, Any] = {
        "material": body.solid.material.label,
        "resins": list(body.blend.resins),
        "voxels": tally.voxels,
        "volume_mm3": round(tally.voxels * math.prod(pitch), 6),
        "exact_volume_mm3": round(exact, 6),
    }
    if body.blend.share is None or not tally.voxels:
        return entry
    return {
        **entry,
        "made_up_within_mm": round(reach_for(body.blend.most, pitch), 6),
        "stiff_resin": body.blend.resins[1],
        "skin_voxels": tally.skin,
        "fraction_requested": round(tally.requested / tally.voxels, 9),
        "fraction_given": round(tally.given / tally.voxels, 9),
        "fraction_realised": round(tally.realised / tally.voxels, 9),
        "worst_cube": round(tally.worst, 9),
        "cubes": tally.cubes,
    }


def _assumptions(job: VoxelJob) -> list[str]:
    lines = [f"{body.solid.name}: {body.blend.assumed}" for body in job.bodies if body.blend.assumed]
    return [
        *lines,
        "row 0 of a slice is at the greatest y, seen from above; slice 0 lies on the tray: our choice, the vendor "
        "states neither",
        "colours stand for resins by this file alone; the operator maps them in the utility",
        "a voxel is of the body that its centre lies in",
        "a voxel of a mixed body with a neighbour outside it stays the soft resin",
    ]
