"""Solids and their meshes: a closed mesh with a material and a role."""

from pneutouch.body.mesh import Body
from pneutouch.body.solid import Bore, Solid

__all__ = ["Body", "Bore", "Solid"]
