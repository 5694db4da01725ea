"""Finds designs, printers, materials and parts by name: the one registry."""

from pneutouch.catalogue.library import KINDS, Library
from pneutouch.catalogue.places import user_folder
from pneutouch.catalogue.scene import DEFAULT, DesignSource, ResolvedDesign, check_scene, load_scene, split_calibration

__all__ = [
    "DEFAULT",
    "KINDS",
    "DesignSource",
    "Library",
    "ResolvedDesign",
    "check_scene",
    "load_scene",
    "split_calibration",
    "user_folder",
]
