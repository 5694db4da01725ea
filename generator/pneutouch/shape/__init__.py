"""Form of a membrane: one meridian, from which solid, print mesh, mould and finite elements are derived."""

from pneutouch.shape.dome import DomeShape
from pneutouch.shape.hemisphere import Hemisphere

SHAPES: dict[str, type[DomeShape]] = {shape.key: shape for shape in (Hemisphere,)}
"""Shapes by their name in a design file; called with inner radius and wall thickness, mm."""
