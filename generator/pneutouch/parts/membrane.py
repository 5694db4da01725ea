"""The membrane as a solid: the dome with its flange."""

from itertools import pairwise

from pneutouch.body import Feature, Solid
from pneutouch.parts.cast_ring import RingSize
from pneutouch.parts.layout import Layout
from pneutouch.shape.meridian import Line, Meridian, Segment
from pneutouch.spec.material import Material

HELD = "held"
"""Tag of the faces of the flange that the connector holds: the mechanics clamps them."""


def membrane_meridian(layout: Layout) -> Meridian:
    """Meridian from the inner pole, around the flange, to the outer pole.

    A cast flange widens downwards inside and outside by its draft, so that it comes off core and ring; one that is cast
    around a ring keeps its collar, upright outside. The meridian then is the outline of silicone and web together.
    """
    inner, outer, flange = layout.inner_radius, layout.outer_radius, layout.flange_radius
    rim = layout.shape.inner[0].start
    low, draft = -layout.flange_thickness, layout.flange_draft
    edge = draft if layout.ring is None else 0.0
    return Meridian(
        (
            *(piece.reverse() for piece in reversed(layout.shape.inner)),
            Line(rim, (inner + draft, low), HELD),
            Line((inner + draft, low), (flange, low), HELD),
            Line((flange, low), (flange - edge, 0.0), HELD),
            Line((flange - edge, 0.0), (outer, 0.0), "flange top"),
            *layout.shape.outer,
        )
    )


def membrane_solid(layout: Layout, material: Material) -> Solid:
    """The membrane, without the volume of its flange that a ring takes."""
    outline = membrane_meridian(layout)
    if layout.ring is not None:
        return around_ring(layout.ring, "membrane", material, outline)
    return Solid("membrane", "membrane", material, outline)


def around_ring(ring: RingSize, name: str, material: Material, outline: Meridian) -> Solid:
    """Silicone within an outline whose flange ends at a ring's collar: without the web, but with its holes filled.

    A hole is filled by the same shape that drills it: both bodies then have the same facets.
    """
    pieces: list[Segment] = []
    for piece in outline.pieces:
        upright = isinstance(piece, Line) and piece.start[0] == piece.end[0] == ring.flange_radius
        pieces += _slot(ring, piece) if upright else [piece]
    plugs = tuple(Feature(hole, hole.volume()) for hole in ring.holes())
    return Solid(name, "membrane", material, Meridian(tuple(pieces)), adds=plugs)


def _slot(ring: RingSize, side: Segment) -> tuple[Segment, ...]:
    """Edge of the flange from below upwards, around the web."""
    edge, web = ring.flange_radius, ring.web_inner
    inside = [(edge, ring.web_low), (web, ring.web_low), (web, ring.web_high), (edge, ring.web_high)]
    return tuple(Line(one, other, side.tag) for one, other in pairwise([side.start, *inside, side.end]))
