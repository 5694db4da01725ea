"""Shapes of the dome; solid, print mesh, mould and finite elements of a membrane are derived from its shape."""

from pneutouch.shape.dome import DomeShape
from pneutouch.shape.hemisphere import FilletedHemisphere, Hemisphere

SHAPES: dict[str, type[DomeShape]] = {shape.key: shape for shape in (Hemisphere,)}
"""Classes of shapes by their name in a design file; called with inner radius and wall thickness, mm."""

__all__ = ["SHAPES", "DomeShape", "FilletedHemisphere", "Hemisphere"]
