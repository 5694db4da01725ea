"""Content of a 3MF file as data, and of a voxel stack as data and as a picture."""

from pathlib import Path

import numpy as np

from pneutouch.arrays import Labels
from pneutouch.errors import InputError
from pneutouch.export.threemf import TRAY_RECIPE
from pneutouch.export.threemf_read import RECIPE, Package, StoredBody, read_threemf
from pneutouch.export.voxels.png import encode
from pneutouch.export.voxels.stack import VoxelStack, read_stack
from pneutouch.formats import format_of
from pneutouch.output.files import replace_file
from pneutouch.output.recipe import other_versions, read_recipe, stored_versions
from pneutouch.results.stored import PrintedResin, ShownBody, ShownPackage, ShownRecipe, ShownStack

_SHOWN_APART = (RECIPE, TRAY_RECIPE, "versions")
"""Entries of the metadata that are shown elsewhere or are too long."""

_RASTER = ("pixels", "layers", "dpi", "pixel_um", "layer_um", "size_mm")
_HELD = ("name", "printer", "mode", "prefix", *_RASTER, "bodies", "dither", "assumptions", "input_hash", "sha256")
"""Keys of a stack's manifest that are shown unchanged."""

_DIGITS = 6
"""Decimals of lengths in mm and volumes in mm3, as many as the 3MF is written with."""


def show(path: Path) -> ShownPackage:
    """Content of a 3MF file: bodies, metadata and recipe; the recipe is None if the file holds none.

    Raises InputError for a file that is unsafe, not valid, or whose recipe is damaged."""
    package = read_threemf(path)
    return ShownPackage(
        file=str(path),
        bodies=tuple(map(_body, package.bodies)),
        thumbnail=package.thumbnail,
        warnings=package.warnings,
        metadata={key: value for key, value in package.metadata.items() if key not in _SHOWN_APART},
        recipe=None if package.recipe is None else _recipe(package),
    )


def _body(body: StoredBody) -> ShownBody:
    return ShownBody(
        name=body.name,
        material=body.material,
        colour=body.colour,
        mix=body.mix,
        size_mm=tuple(round(float(length), _DIGITS) for length in body.size),
        volume_mm3=round(body.volume, _DIGITS),
        vertices=len(body.vertices),
        triangles=len(body.triangles),
    )


def _recipe(package: Package) -> ShownRecipe:
    """Recipe with the versions and the input hash stored beside it; nothing is computed from it."""
    recipe = read_recipe(package)
    return ShownRecipe(
        format=format_of("recipe"),
        name=recipe.scene.name,
        version=recipe.version,
        inputs=recipe.inputs(),
        input_hash=package.metadata["input-hash"],
        versions=stored_versions(package),
        other_versions=tuple(other_versions(package, recipe)),
    )


_BACKGROUND = np.uint32(0xFFFFFFFF)
"""White, for the picture's background; the stack has black."""


def show_stack(folder: Path, picture: Path | None = None) -> ShownStack:
    """Content of a stack, checked, with voxels counted in the slices; ``picture``: path for a PNG of two sections, or
    None.

    Raises InputError for a stack that breaks a rule and for a picture that cannot be written.
    """
    stack = read_stack(folder)
    if picture is not None:
        draw(stack, picture)
    filled = max(1, sum(stack.counts.values()))
    resins = {
        resin: PrintedResin(
            rgba=tuple(stack.manifest["resins"][resin]["rgba"]),
            voxels=count,
            volume_mm3=round(count * stack.voxel, 6),
            share_of_the_print=round(count / filled, 9),
        )
        for resin, count in stack.counts.items()
    }
    held = {key: stack.manifest[key] for key in _HELD if key in stack.manifest}
    return ShownStack(str(stack.folder), resins, held)


def draw(stack: VoxelStack, path: Path) -> None:
    """Write a PNG of the middle section (x across, z up) above the middle slice (x across, y up), to one scale."""
    x, y = stack.manifest["pixel_um"]
    upper = _stretched(stack.section[::-1], stack.manifest["layer_um"] / x)
    lower = _stretched(stack.labels(stack.manifest["layers"] // 2), y / x)
    gap = np.zeros((max(8, upper.shape[1] // 40), upper.shape[1]), np.uint8)
    colours = stack.colours.copy()
    colours[0] = _BACKGROUND
    across = stack.manifest["dpi"][0]
    drawn = encode(np.concatenate([upper, gap, lower]), colours, (across, across))
    if path.is_file() and path.read_bytes() != drawn:
        raise InputError("there is another file of this name", file=path, remedy="give another name, or delete it")
    replace_file(path, drawn)


def _stretched(labels: Labels, ratio: float) -> Labels:
    """Rows repeated or left out so that a row is as high as a column is wide: no colours are blended."""
    rows = max(1, round(len(labels) * ratio))
    return labels[np.minimum(((np.arange(rows) + 0.5) / ratio).astype(np.int64), len(labels) - 1)]
