"""Solids and their meshes; a body is a closed mesh with a material and a role."""

from pneutouch.body.shapes import Bore, Feature, Frame, Prism, Turned
from pneutouch.body.solid import Body, Solid

__all__ = ["Body", "Bore", "Feature", "Frame", "Prism", "Solid", "Turned"]
