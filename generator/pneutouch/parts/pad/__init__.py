"""Pads: several domes on one membrane, over a manifold that gives each a port of its own."""

from pneutouch.parts.pad.layout import PadLayout, lay_out_pad
from pneutouch.parts.pad.solids import pad_solids

__all__ = ["PadLayout", "lay_out_pad", "pad_solids"]
