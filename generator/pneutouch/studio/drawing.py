"""Drawing of a design on the page: the section through its bodies, its dimensions, and meshes for the view."""

import base64
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body, Solid
from pneutouch.body.normals import corner_normals
from pneutouch.body.outline import section_outline
from pneutouch.mechanics import SensorState
from pneutouch.meridian import Meridian
from pneutouch.parts import Assembly
from pneutouch.units import KPA

_TOLERANCE = 0.02
"""Greatest distance of the drawn section, and of a mesh that is looked at, from the exact surface, mm."""

_DIGITS = 3


def drawing_document(assembly: Assembly) -> dict[str, Any]:
    """Loops (x, z) in mm where the plane y = 0 cuts each body, and the lengths that the dimensions state, mm."""
    bodies = [
        {
            "name": solid.name,
            "role": solid.role,
            "material": solid.material.label,
            "loops": [_flat(loop, _DIGITS) for loop in section_outline(solid, _TOLERANCE)],
        }
        for solid in assembly.solids
    ]
    layout = assembly.layout
    bounds = [_bounds(solid) for solid in assembly.solids]
    low, high = np.min([each[0] for each in bounds], axis=0), np.max([each[1] for each in bounds], axis=0)
    return {
        "bodies": bodies,
        "inner_radius_mm": layout.inner_radius,
        "wall_thickness_mm": layout.wall,
        "flange_diameter_mm": 2 * layout.flange_radius,
        "size_mm": [round(float(value), _DIGITS) for value in high - low],
        "low_mm": round(float(low[2]), _DIGITS),
        "high_mm": round(float(high[2]), _DIGITS),
    }


def _bounds(solid: Solid) -> Array:
    """Smallest and largest corner, shape (2, 3), mm; those of the exact surface where nothing sits on a turned body."""
    if not isinstance(solid.base, Meridian) or solid.adds or solid.cuts:
        return solid.mesh(_TOLERANCE).bounds
    radius, low, high = solid.base.bounds()
    return np.array([(-radius, -radius, low), (radius, radius, high)])


def view_document(assembly: Assembly) -> dict[str, Any]:
    """Each body as triangle corners (float32, mm) with normals (int8, in 1/127), both little-endian in base 64."""
    bodies = [_mesh(solid.mesh(_TOLERANCE)) for solid in assembly.solids]
    return {"bodies": bodies}


def _mesh(body: Body) -> dict[str, Any]:
    normals = np.rint(127 * corner_normals(body)).astype("<i1")
    return {
        "name": body.name,
        "colour": body.material.colour,
        "corners": base64.b64encode(body.corners.astype("<f4").tobytes()).decode(),
        "normals": base64.b64encode(normals.tobytes()).decode(),
    }


def walls_document(state: SensorState) -> dict[str, Any] | None:
    """The faces of the pressed wall at every solved indentation, (r, z) in mm; None by a model without them."""
    walls = state.walls
    if walls is None:
        return None
    loops = np.concatenate([walls.inner, walls.outer[:, ::-1]], axis=1)
    return {
        "driving_pressure_kPa": state.driving_pressure / KPA,
        "indentation_mm": [round(float(depth), _DIGITS) for depth in walls.indentation],
        "walls": [_flat(loop, _DIGITS) for loop in loops],
        "objects": [_flat(section, _DIGITS) for section in walls.objects],
    }


def _flat(points: Array, digits: int) -> list[float]:
    return [float(value) + 0.0 for value in np.round(points, digits).reshape(-1)]
