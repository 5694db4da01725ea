"""Texture specimens: a block of one resin with patterns of another in it, two closed bodies that share their faces."""

from pneutouch.parts.specimen import bars, strut_layer, surface_layer, waves
from pneutouch.parts.specimen.family import PatternContext, PatternFamily, PatternGeometry
from pneutouch.parts.specimen.mesh import Box, Mesh
from pneutouch.parts.specimen.partition import complement
from pneutouch.parts.specimen.struts import STRUTS
from pneutouch.parts.specimen.surfaces import SURFACES

FAMILIES: dict[str, PatternFamily] = {
    "bars": bars.FAMILY,
    "sinusoid": waves.FAMILY,
    "random-phase": waves.FAMILY,
    **dict.fromkeys(STRUTS, strut_layer.FAMILY),
    **dict.fromkeys(SURFACES, surface_layer.FAMILY),
}
"""Every kind of a [[layer]] with how it is drawn."""

__all__ = ["FAMILIES", "Box", "Mesh", "PatternContext", "PatternFamily", "PatternGeometry", "complement"]
