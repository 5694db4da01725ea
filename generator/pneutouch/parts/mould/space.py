"""Check that a mould has space for its details: channels within the flange, fillets within its thickness."""

import math

from pneutouch.errors import InputError
from pneutouch.parts.mould.size import FILLET, MouldSize

_EDGE = 0.05
"""Flange in mm that must be left at both sides of a channel: less would cut ring or core."""

_LEAST_HOLE = 0.3
"""Least diameter in mm of a channel where it is narrowest: own choice."""

_LEAST_GAP = 0.5
"""Least silicone in mm between core and ring: own choice."""


def check_mould_space(where: str, size: MouldSize) -> None:
    """Raise InputError that names the key of the design file ``where`` which leaves a detail no space."""
    _check_insert(where, size)
    shape, faces = size.shape, size.faces
    width = faces.edge.start[0] - faces.rim.end[0] - 2 * _EDGE
    for key, diameter, narrowest in (
        ("sprue_diameter_mm", shape.sprue_diameter, 2 * size.neck),
        ("vent_diameter_mm", shape.vent_diameter, 2 * (0.5 * shape.vent_diameter - size.foot * _slope(size))),
    ):
        if diameter > width:
            raise InputError(
                f"wider than the flange; it must be at most {width:.2f} mm",
                file=where,
                key=f"mould.{key}",
                value=diameter,
                remedy="take a smaller one, or raise membrane.wall_thickness_mm, which the flange follows",
            )
        if narrowest < _LEAST_HOLE:
            raise InputError(
                f"its draft closes it: {max(narrowest, 0.0):.2f} mm is left in diameter",
                file=where,
                key=f"mould.{key}",
                value=diameter,
                remedy="take a larger one, or less mould.draft_deg or mould.wall_mm",
            )
    flange = -size.low
    if FILLET + shape.clearance > 0.9 * flange:
        raise InputError(
            f"the flange of {flange:.2f} mm has no space for the ring's rounding",
            file=where,
            key="mould.clearance_mm",
            value=shape.clearance,
            remedy=f"it must be at most {0.9 * flange - FILLET:.2f} mm",
        )


def _check_insert(where: str, size: MouldSize) -> None:
    """Silicone must pass between the core and the ring that it is cast around: the mould grows, the ring does not."""
    if size.insert is None:
        return
    gap = size.insert.web_inner - max(size.faces.rim.start[0], size.faces.rim.end[0])
    if gap < _LEAST_GAP:
        raise InputError(
            f"the core leaves {max(gap, 0.0):.2f} mm inside the ring that the flange is cast around; at least "
            f"{_LEAST_GAP:g} mm lets silicone through",
            file=where,
            key="mould.shrinkage_percent",
            value=round(100 * size.shape.shrinkage, 6),
            remedy="take a silicone that shrinks less, or less mould.draft_deg",
        )


def _slope(size: MouldSize) -> float:
    """Radius lost by a channel over height."""
    return math.tan(size.shape.draft)
