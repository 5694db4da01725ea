"""The manifest of a stack, ``stack.json``, and the check of a stack that is read back by it."""

import hashlib
import json
import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from pneutouch.arrays import Labels, Pixels
from pneutouch.errors import InputError
from pneutouch.export.voxels.png import decode, table
from pneutouch.export.voxels.raster import BACKGROUND, VoxelBody, VoxelJob, reach_for
from pneutouch.export.voxels.slices import CUBE, FULL, VoxelCounts, VoxelSlicer
from pneutouch.formats import check_format
from pneutouch.results.stack import BodyVoxels, DitherRecord, ResinVoxels, StackRecord
from pneutouch.spec.files import read_bytes
from pneutouch.units import UM
from pneutouch.wording import data_of

MANIFEST = "stack.json"

_WORDS = data_of(__file__)

METHOD = str(_WORDS["method"])

SHORT = 1e-3
"""Difference of fractions over a body above which a warning says that the request is not met."""


def slice_name(prefix: str, number: int) -> str:
    """Name of a slice: the number without leading zeros, as in the files of the vendor's utility."""
    return f"{prefix}{number}.png"


def whole_hash(hashes: Sequence[str]) -> str:
    """SHA-256 of a text that holds the slices' hashes in order, one on each line."""
    return hashlib.sha256("".join(f"{one}\n" for one in hashes).encode()).hexdigest()


def stack_record(
    job: VoxelJob, slicer: VoxelSlicer, hashes: Sequence[str], about: Mapping[str, Any], prefix: str
) -> StackRecord:
    """The manifest of a stack that has been sliced; ``about`` are the fields on its source: design, printer, mode."""
    raster, voxel = job.raster, job.raster.voxel
    x, y, z = (round(step / UM, 6) for step in raster.pitch)
    return StackRecord(
        **about,
        prefix=prefix,
        dpi=raster.dpi,
        pixel_um=(x, y),
        layer_um=z,
        pixels=(len(raster.x), len(raster.y)),
        layers=len(raster.z),
        size_mm=tuple(round(length, 6) for length in raster.size),
        first_voxel_mm=tuple(round(float(axis[0]), 6) for axis in (raster.x, raster.y, raster.z)),
        background_rgba=tuple(BACKGROUND),
        resins={
            resin: ResinVoxels(tuple(colour), slicer.counts[resin], round(slicer.counts[resin] * voxel, 6))
            for resin, colour in job.colours.items()
        },
        bodies={body.solid.name: _body(body, slicer.tallies[body.solid.name], raster.pitch) for body in job.bodies},
        dither=DitherRecord(METHOD, job.seed, CUBE, FULL),
        assumptions=_assumptions(job),
        sha256=whole_hash(hashes),
        slices=tuple(hashes),
    )


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


def _body(body: VoxelBody, tally: VoxelCounts, pitch: tuple[float, float, float]) -> BodyVoxels:
    entry = BodyVoxels(
        material=body.solid.material.label,
        resins=tuple(body.blend.resins),
        voxels=tally.voxels,
        volume_mm3=round(tally.voxels * math.prod(pitch), 6),
        exact_volume_mm3=round(body.solid.volume, 6),
    )
    if body.blend.share is None or not tally.voxels:
        return entry
    return replace(
        entry,
        made_up_within_mm=round(reach_for(body.blend.most, pitch), 6),
        stiff_resin=body.blend.resins[1],
        skin_voxels=tally.skin,
        fraction_requested=round(tally.requested / tally.voxels, 9),
        fraction_given=round(tally.given / tally.voxels, 9),
        fraction_realised=round(tally.realised / tally.voxels, 9),
        worst_cube=round(tally.worst, 9),
        cubes=tally.cubes,
    )


def _assumptions(job: VoxelJob) -> tuple[str, ...]:
    lines = [f"{body.solid.name}: {body.blend.assumed}" for body in job.bodies if body.blend.assumed]
    return (*lines, *_WORDS["assumptions"])


_MOST_BYTES = 100_000_000
"""Largest size of a slice, and of the manifest."""

LEAST_SLICES = 30
MOST_COLOURS = 6
"""Largest number of colours of the utility (GrabCAD Voxel Print guide), whatever a manifest gives."""

_NEEDED: dict[str, type | tuple[type, ...]] = {
    "layers": int,
    **dict.fromkeys(("prefix", "sha256"), str),
    **dict.fromkeys(("dpi", "pixels", "pixel_um", "background_rgba", "slices"), list),
    **dict.fromkeys(("resins", "bodies"), dict),
    "layer_um": (int, float),
}


@dataclass(frozen=True)
class VoxelStack:
    """A stack as read and checked. ``counts`` are its voxels by resin, counted in the slices."""

    folder: Path
    manifest: dict[str, Any]
    counts: dict[str, int]
    section: Labels
    """The plane through the middle, (layers, columns), layer 0 first: labels as in `labels`."""

    @property
    def colours(self) -> Pixels:
        """Pixel values by label: the background, then the resins as the manifest lists them."""
        return _colours(self.manifest)

    @property
    def voxel(self) -> float:
        """Volume of a voxel, mm3."""
        x, y = self.manifest["pixel_um"]
        return float(x * y * self.manifest["layer_um"]) * 1e-9

    def labels(self, number: int) -> Labels:
        """A slice, (rows, columns): 0 the background, k the k-th resin of the manifest."""
        path = self.folder / slice_name(self.manifest["prefix"], number)
        return _labels(_read(path), self.manifest, str(path))


def read_stack(folder: Path) -> VoxelStack:
    """Read a folder of slices. Raises InputError that names the file and what breaks which rule."""
    manifest = _manifest(folder)
    _check_names(folder, manifest)
    resins = list(manifest["resins"])
    totals = np.zeros(len(resins) + 1, np.int64)
    middle = []
    for number, stated in enumerate(manifest["slices"]):
        path = folder / slice_name(manifest["prefix"], number)
        content = _read(path)
        labels = _labels(content, manifest, str(path))
        totals += np.bincount(labels.ravel(), minlength=len(totals))
        middle.append(labels[len(labels) // 2].copy())
        if hashlib.sha256(content).hexdigest() != stated:
            raise InputError(f"was changed after it was written: its SHA-256 is not that of {MANIFEST}", file=path)
    counts = {resin: int(totals[k + 1]) for k, resin in enumerate(resins)}
    for resin, count in counts.items():
        stated = manifest["resins"][resin].get("voxels")
        if stated != count:
            raise InputError(f"{resin} has {count} voxels in the slices; {stated} are stated", file=folder / MANIFEST)
    return VoxelStack(folder, manifest, counts, np.array(middle))


def stated_slices(folder: Path) -> dict[str, str]:
    """SHA-256 of every slice of a stack by its name, as its manifest states them. Raises InputError."""
    stated = _manifest(folder)
    return {slice_name(stated["prefix"], number): str(each) for number, each in enumerate(stated["slices"])}


def _manifest(folder: Path) -> dict[str, Any]:
    path = folder / MANIFEST
    try:
        if not os.path.lexists(path):
            built = sorted(folder.glob("*.3mf"))
            remedy = f"of a build, give {built[0]}" if built else "give the folder of a stack, or a 3MF"
            raise InputError(f"holds no {MANIFEST}: not a voxel stack that pneutouch wrote", file=folder, remedy=remedy)
        document: Any = json.loads(read_bytes(path, _MOST_BYTES, "manifest"))
    except (ValueError, RecursionError):
        raise InputError("not JSON", file=path, remedy="write the stack again") from None
    content: dict[str, Any] = document if isinstance(document, dict) else {}
    check_format("stack", content, path)
    for key, kind in _NEEDED.items():
        if not isinstance(content.get(key), kind):
            raise InputError(f"{key} is missing or of another type", file=path, remedy="write the stack again")
    for key in ("dpi", "pixels", "pixel_um"):
        if len(content[key]) != 2 or not all(type(each) in (int, float) for each in content[key]):
            raise InputError(f"{key} is not two numbers", file=path, remedy="write the stack again")
    try:
        colours = _colours(content)
    except (ValueError, TypeError, KeyError, OverflowError):
        raise InputError(
            "the colours are not four numbers from 0 to 255 each", file=path, remedy="write the stack again"
        ) from None
    if len(set(colours.tolist())) != len(colours):
        raise InputError("two of the colours are the same", file=path, remedy="write the stack again")
    if len(content["resins"]) > MOST_COLOURS:
        raise InputError(f"{len(content['resins'])} colours; the utility takes {MOST_COLOURS}", file=path)
    if whole_hash([str(one) for one in content["slices"]]) != content["sha256"]:
        raise InputError("was changed after it was written: sha256 is not that of its slices", file=path)
    return content


def _colours(manifest: dict[str, Any]) -> Pixels:
    listed = [manifest["background_rgba"], *(entry["rgba"] for entry in manifest["resins"].values())]
    if any(len(colour) != 4 for colour in listed):
        raise ValueError
    return table([tuple(colour) for colour in listed])


def _check_names(folder: Path, manifest: dict[str, Any]) -> None:
    """Raise InputError unless slices count from 0 without gaps, as many as stated, and no other PNG is there."""
    prefix, layers = manifest["prefix"], manifest["layers"]
    pattern = re.compile(re.escape(prefix) + r"(0|[1-9][0-9]*)\.png")
    numbers = set()
    for path in folder.glob("*.png"):
        match = pattern.fullmatch(path.name)
        if match is None:
            raise InputError(
                f"is no slice; they are called {slice_name(prefix, 0)}, {slice_name(prefix, 1)} ...", file=path
            )
        numbers.add(int(match[1]))
    for number in range(max(layers, max(numbers, default=-1) + 1)):
        if number not in numbers:
            raise InputError(
                f"{slice_name(prefix, number)} is missing; slices must be numbered without gaps", file=folder
            )
    if len(numbers) != layers or len(manifest["slices"]) != layers:
        raise InputError(f"{len(numbers)} slices; {MANIFEST} states {layers}", file=folder)
    if layers < LEAST_SLICES:
        raise InputError(f"{layers} slices; the utility takes no fewer than {LEAST_SLICES}", file=folder)


def _labels(content: bytes, manifest: dict[str, Any], where: str) -> Labels:
    """The content of a slice as labels. Raises InputError for another size, pitch or colour than the manifest's."""
    read = decode(content, where)
    rows, columns = read.pixels.shape
    if [columns, rows] != manifest["pixels"]:
        wide, tall = manifest["pixels"]
        raise InputError(f"{columns} x {rows} pixels; all slices must be {wide} x {tall}", file=where)
    if read.dpi is None or list(read.dpi) != manifest["dpi"]:
        stated = "no pitch" if read.dpi is None else f"{read.dpi[0]} x {read.dpi[1]} dpi"
        raise InputError(f"states {stated}; must be {manifest['dpi'][0]} x {manifest['dpi'][1]} dpi", file=where)
    labels, known = np.zeros(read.pixels.shape, np.uint8), np.zeros(read.pixels.shape, bool)
    for k, colour in enumerate(_colours(manifest)):
        same = read.pixels == colour
        known |= same
        if k:
            labels[same] = k
    if not known.all():
        row, column = (int(index) for index in np.argwhere(~known)[0])
        colour = ", ".join(str(part) for part in read.pixels[row : row + 1, column].view(np.uint8))
        raise InputError(
            f"the pixel in column {column}, row {row} is ({colour}), which stands for no resin", file=where
        )
    return labels


def _read(path: Path) -> bytes:
    return read_bytes(path, _MOST_BYTES, "PNG file")
