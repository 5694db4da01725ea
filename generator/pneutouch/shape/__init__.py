"""Form of a membrane: one meridian, from which solid, print mesh, mould and finite elements all grow.

Shapes of the dome: one file each, and one line here.
"""

from pneutouch.shape.dome import DomeShape
from pneutouch.shape.hemisphere import Hemisphere

SHAPES: dict[str, type[DomeShape]] = {shape.key: shape for shape in (Hemisphere,)}
"""Shapes by the name that a design file gives; called with inner radius and wall, mm."""
