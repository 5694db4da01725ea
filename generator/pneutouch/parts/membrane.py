"""The membrane: a dome with a clamped rim and a flange, open at its base so that it can be cleaned."""

from pneutouch.body import Solid
from pneutouch.parts.layout import Layout
from pneutouch.shape.meridian import Line, Meridian
from pneutouch.spec.material import Material

HELD = "held"
"""Faces of the flange that the connector holds: the mechanics clamps them."""


def membrane_meridian(layout: Layout) -> Meridian:
    """Meridian from the pole inside, round the flange, back to the pole outside.

    A cast flange opens downwards inside and out by its draft, so that it leaves core and ring; one that is cast around
    a ring keeps its collar, upright outside. The meridian is then the outline of the silicone with the web in it.
    """
    inner, outer, flange = layout.inner_radius, layout.outer_radius, layout.flange_radius
    low, draft = -layout.flange_thickness, layout.flange_draft
    edge = draft if layout.ring is None else 0.0
    return Meridian(
        (
            *(piece.reverse() for piece in reversed(layout.shape.inner)),
            Line((inner, 0.0), (inner + draft, low), HELD),
            Line((inner + draft, low), (flange, low), HELD),
            Line((flange, low), (flange - edge, 0.0), HELD),
            Line((flange - edge, 0.0), (outer, 0.0), "flange top"),
            *layout.shape.outer,
        )
    )


def membrane_solid(layout: Layout, material: Material) -> Solid:
    """The membrane, without the volume that a ring takes of its flange."""
    outline = membrane_meridian(layout)
    if layout.ring is not None:
        return layout.ring.enclosed("membrane", material, outline)
    return Solid("membrane", "membrane", material, outline)
