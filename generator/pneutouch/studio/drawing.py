"""Drawing of a design on the page: the section through its bodies, its dimensions, and meshes for the view."""

from __future__ import annotations

import base64
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body, Solid
from pneutouch.body.mesh import corner_normals
from pneutouch.body.section import section_outline
from pneutouch.mechanics import SensorState
from pneutouch.parts import Assembly
from pneutouch.shape.meridian import Meridian
from pneutouch.units import KPA

_TOLERANCE = 0.02
"""Greatest distance of the drawn section, and of a mesh that is looked at, from the exact surface, mm."""

_DRAWN_DIGITS = 3


@dataclass(frozen=True, slots=True)
class DrawnBody:
    """Loops x, z, x, z and so on, mm, where the plane y = 0 cuts a body."""

    name: str
    role: str
    material: str
    loops: list[list[float]]


@dataclass(frozen=True, slots=True)
class DrawnDesign:
    """The section through the bodies of a design, and the lengths that its dimensions state, mm."""

    bodies: list[DrawnBody]
    inner_radius_mm: float
    wall_thickness_mm: float
    flange_diameter_mm: float
    size_mm: list[float]
    low_mm: float
    high_mm: float


@dataclass(frozen=True, slots=True)
class ViewedBody:
    """A body as triangle corners (float32, mm) with normals (int8, in 1/127), both little-endian in base 64."""

    name: str
    colour: str
    corners: str
    normals: str


@dataclass(frozen=True, slots=True)
class ViewedDesign:
    """The bodies of a design as meshes to look at."""

    bodies: list[ViewedBody]


@dataclass(frozen=True, slots=True)
class PressedWall:
    """The faces of the pressed wall and the objects at every solved indentation, r, z, r, z and so on, mm."""

    driving_pressure_kPa: float
    indentation_mm: list[float]
    walls: list[list[float]]
    objects: list[list[float]]


def drawn_design(assembly: Assembly) -> DrawnDesign:
    """The section of an assembly with its dimensions."""
    bodies = [
        DrawnBody(
            solid.name,
            solid.role,
            solid.material.label,
            [_flat(loop, _DRAWN_DIGITS) for loop in section_outline(solid, _TOLERANCE)],
        )
        for solid in assembly.solids
    ]
    layout = assembly.layout
    bounds = [_bounds(solid) for solid in assembly.solids]
    low, high = np.min([each[0] for each in bounds], axis=0), np.max([each[1] for each in bounds], axis=0)
    return DrawnDesign(
        bodies=bodies,
        inner_radius_mm=layout.inner_radius,
        wall_thickness_mm=layout.wall,
        flange_diameter_mm=2 * layout.flange_radius,
        size_mm=[round(float(value), _DRAWN_DIGITS) for value in high - low],
        low_mm=round(float(low[2]), _DRAWN_DIGITS),
        high_mm=round(float(high[2]), _DRAWN_DIGITS),
    )


def _bounds(solid: Solid) -> Array:
    """Smallest and largest corner, shape (2, 3), mm; those of the exact surface where nothing sits on a turned body."""
    if not isinstance(solid.base, Meridian) or solid.adds or solid.cuts:
        return solid.mesh(_TOLERANCE).bounds
    radius, low, high = solid.base.bounds()
    return np.array([(-radius, -radius, low), (radius, radius, high)])


def viewed_design(assembly: Assembly) -> ViewedDesign:
    """The bodies of an assembly as meshes."""
    return ViewedDesign([_mesh(solid.mesh(_TOLERANCE)) for solid in assembly.solids])


def _mesh(body: Body) -> ViewedBody:
    normals = np.rint(127 * corner_normals(body)).astype("<i1")
    corners = base64.b64encode(body.corners.astype("<f4").tobytes()).decode()
    return ViewedBody(body.name, body.material.colour, corners, base64.b64encode(normals.tobytes()).decode())


def pressed_wall(state: SensorState) -> PressedWall | None:
    """The pressed wall of a state; None by a model without walls."""
    walls = state.walls
    if walls is None:
        return None
    loops = np.concatenate([walls.inner, walls.outer[:, ::-1]], axis=1)
    return PressedWall(
        state.driving_pressure / KPA,
        [round(float(depth), _DRAWN_DIGITS) for depth in walls.indentation],
        [_flat(loop, _DRAWN_DIGITS) for loop in loops],
        [_flat(section, _DRAWN_DIGITS) for section in walls.objects],
    )


def _flat(points: Array, digits: int) -> list[float]:
    return [float(value) + 0.0 for value in np.round(points, digits).reshape(-1)]
