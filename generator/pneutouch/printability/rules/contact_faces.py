"""Bodies must not overlap, and must meet where they are bonded. Measured on the meshes."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold, Mesh64

from pneutouch.body import Body
from pneutouch.mechanics import Prediction
from pneutouch.parts import Assembly
from pneutouch.parts.connector import SEAT
from pneutouch.printability.finding import Finding

_SOURCE = "vendor: one closed shell per material region, shells must not occupy the same space (multi-colour guideline)"
_NOTHING = 1e-6
"""Volume in mm3 below which an overlap is rounding: a cube of 10 um."""


def check(assembly: Assembly, prediction: Prediction) -> list[Finding]:
    """Measure the overlap of the two bodies and the area of the face they share."""
    membrane, connector = assembly.bodies
    where = (assembly.layout.flange_radius, 0.0, assembly.layout.plate_high)
    overlap = overlap_volume(membrane, connector)
    if overlap > _NOTHING:
        text = f"the bodies overlap by {overlap:.3g} mm3"
        return [
            Finding("contact faces", "error", "membrane", text, "report the design: this is a fault", _SOURCE, where)
        ]
    wanted = sum(piece.area() for piece in assembly.solids[1].meridian.tagged(SEAT))
    shared = shared_area(membrane, connector)
    if shared < 0.999 * wanted:
        text = f"the bodies share {shared:.1f} mm2 of the seat's {wanted:.1f} mm2"
        return [
            Finding("contact faces", "error", "membrane", text, "report the design: this is a fault", _SOURCE, where)
        ]
    return []


def overlap_volume(one: Body, other: Body) -> float:
    """Volume in mm3 that both bodies occupy."""
    solids = [Manifold(Mesh64(body.vertices, body.triangles.astype(np.uint64))) for body in (one, other)]
    return float((solids[0] ^ solids[1]).volume())


def shared_area(one: Body, other: Body) -> float:
    """Area in mm2 of the triangles that both bodies have, facing opposite ways."""
    mine = {tuple(sorted(map(tuple, np.round(corners, 6)))) for corners in one.corners}
    area = 0.0
    for corners in other.corners:
        if tuple(sorted(map(tuple, np.round(corners, 6)))) in mine:
            area += 0.5 * float(np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0])))
    return area
