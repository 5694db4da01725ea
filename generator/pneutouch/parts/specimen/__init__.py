"""Texture specimens: a block of one resin with patterns of another, as two closed bodies that share their faces."""

from pneutouch.parts.specimen import bars, struts, surfaces, waves
from pneutouch.parts.specimen.faces import complement
from pneutouch.parts.specimen.family import Box, Mesh, PatternContext, PatternFamily, PatternGeometry
from pneutouch.parts.specimen.struts import STRUTS
from pneutouch.parts.specimen.surfaces import SURFACES

FAMILIES: dict[str, PatternFamily] = {
    "bars": bars.FAMILY,
    "sinusoid": waves.FAMILY,
    "random-phase": waves.FAMILY,
    **dict.fromkeys(STRUTS, struts.FAMILY),
    **dict.fromkeys(SURFACES, surfaces.FAMILY),
}
"""Pattern family of every kind of a [[layer]]."""

__all__ = ["FAMILIES", "Box", "Mesh", "PatternContext", "PatternFamily", "PatternGeometry", "complement"]
