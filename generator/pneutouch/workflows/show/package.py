"""Content of a 3MF, as data."""

from pathlib import Path
from typing import Any

from pneutouch.export.threemf_read import RECIPE, Package, StoredBody, read_threemf
from pneutouch.export.threemf_tray import TRAY_RECIPE
from pneutouch.output.recipe_read import other_versions, read_recipe, stored_versions

_SHOWN_APART = (RECIPE, TRAY_RECIPE, "versions")
"""Entries that are shown apart, or are too long to be read."""

_DIGITS = 6
"""Decimals of lengths in mm and volumes in mm3: those that the 3MF is written with."""


def show(path: Path) -> dict[str, Any]:
    """The content of a 3MF: bodies, metadata and the recipe, None if the file is not one of ours.

    Raises InputError for a file that is unsafe, not valid, or whose recipe is damaged.
    """
    package = read_threemf(path)
    return {
        "file": str(path),
        "bodies": [_body(body) for body in package.bodies],
        "thumbnail": package.thumbnail,
        "warnings": list(package.warnings),
        "metadata": {key: value for key, value in package.metadata.items() if key not in _SHOWN_APART},
        "recipe": None if package.recipe is None else _recipe(package),
    }


def _body(body: StoredBody) -> dict[str, Any]:
    return {
        "name": body.name,
        "material": body.material,
        "colour": body.colour,
        "mix": body.mix,
        "size_mm": [round(float(length), _DIGITS) for length in body.size],
        "volume_mm3": round(body.volume, _DIGITS),
        "vertices": len(body.vertices),
        "triangles": len(body.triangles),
    }


def _recipe(package: Package) -> dict[str, Any]:
    """The recipe with the versions and the input hash that are stored with it; nothing is computed from it."""
    recipe = read_recipe(package)
    return {
        **recipe.document(),
        "input_hash": package.metadata["input-hash"],
        "versions": stored_versions(package),
        "other_versions": other_versions(package, recipe),
    }
