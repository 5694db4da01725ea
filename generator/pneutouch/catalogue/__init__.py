"""The registry, which finds designs, printers, materials and parts by name.

Its names are imported on first use: listing files does not load the code that resolves designs.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pneutouch.catalogue.library import KINDS, Library, user_folder
    from pneutouch.catalogue.scene import DesignSource, ResolvedDesign, check_scene, load_scene, split_calibration

_HOMES = {
    "library": ("KINDS", "Library", "user_folder"),
    "scene": ("DesignSource", "ResolvedDesign", "check_scene", "load_scene", "split_calibration"),
}

__all__ = [
    "KINDS",
    "DesignSource",
    "Library",
    "ResolvedDesign",
    "check_scene",
    "load_scene",
    "split_calibration",
    "user_folder",
]


def __getattr__(name: str) -> object:
    from importlib import import_module

    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f"pneutouch.catalogue.{home}"), name)
    raise AttributeError(f"module 'pneutouch.catalogue' has no attribute {name!r}")
