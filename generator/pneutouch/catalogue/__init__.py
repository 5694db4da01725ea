"""Finds designs, printers, materials and parts by name: the one registry."""

from pneutouch.catalogue.library import KINDS, Library
from pneutouch.catalogue.scene import ResolvedDesign, check_scene, default_scene, load_scene

__all__ = ["KINDS", "Library", "ResolvedDesign", "check_scene", "default_scene", "load_scene"]
