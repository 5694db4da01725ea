"""Texture specimens: a block of one resin with patterns of another in it, two closed bodies that share their faces."""

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
"""Every kind of a [[layer]] with how it is drawn."""

__all__ = ["FAMILIES", "Box", "Mesh", "PatternContext", "PatternFamily", "PatternGeometry", "complement"]
