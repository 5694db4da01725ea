"""The solid under a ball against closed forms: Hertz on a thick block, a point load on a pressurised thin sphere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.store import timed
from pneutouch.arrays import Array
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.indent import IndentationPath, PressSettings, indent
from pneutouch.mechanics.solid.indenter import ball
from pneutouch.mechanics.solid.inflate import rest_state, state_at
from pneutouch.mechanics.solid.mesh import SolidMesh, boundary, dome, graded, grid_cells, with_middles
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere

POISSON = 0.499

BLOCK, BALL = 1.0, 0.2
"""Radius and height of the block, and radius of the ball, mm."""

FINE, COARSE = 8, 12
"""Cells to twice the contact's radius and beyond, each way."""

TAU = (0.0, 0.3, 1.0, 2.0, 5.0, 10.0)
"""Pressures of the sphere, p R^2/(4 sqrt(E h B))."""

WALLS = (0.02, 0.01, 0.005, 0.0025)
"""Walls over radii of the spheres."""


@dataclass(frozen=True)
class Comparison:
    """A value of the solid and that of a closed form."""

    value: float
    exact: float

    @property
    def error(self) -> float:
        """Relative deviation of the solid."""
        return self.value / self.exact - 1.0


def block(contact: float, fine: int, coarse: int) -> SolidMesh:
    """A cylinder of radius and height `BLOCK`, held around and supported below; ``fine`` cells to twice the contact's radius and
    ``coarse`` growing ones beyond, the same downwards."""
    near = 2.0 * contact
    far = near + (BLOCK - near) * graded(coarse, near / fine / (BLOCK - near) * 2.0)
    places = with_middles(np.concatenate([np.linspace(0.0, near, fine + 1), far[1:]]))
    n = fine + coarse
    grid = np.stack(np.meshgrid(places[::-1], -places[::-1], indexing="ij"), axis=-1)
    height = 2 * n + 1
    nodes = grid.reshape(-1, 2)
    numbers = np.arange(nodes.shape[0])
    around, below = nodes[:, 0] == nodes[:, 0].max(), nodes[:, 1] == nodes[:, 1].min()
    return SolidMesh(
        # Above the base plane, where a membrane's inside is.
        nodes + np.array([0.0, 2.0 * BLOCK]),
        grid_cells(n, n, 9),
        inner=boundary(n, height, 0),
        outer=boundary(n, height, height - 1),
        clamped=numbers[around].astype(np.intp),
        axis=numbers[nodes[:, 0] == 0.0].astype(np.intp),
        sliding=numbers[below & ~around].astype(np.intp),
        length=BLOCK,
        # The scale of the contact's stiffness: the penetration is a share of it.
        wall=contact,
    )


def hertz(contact: float, fine: int = FINE, coarse: int = COARSE) -> Comparison:
    """Force on a ball that is pressed in until Hertz's contact radius is ``contact`` mm, with modulus 1 MPa."""
    solid = SolidModel(block(contact, fine, coarse), neo_hookean(1.0, POISSON))
    depth = contact**2 / BALL
    run = indent(solid, rest_state(solid), PressSettings(depth, steps=1, ambient=0.0, dead_volume=1e3, body=ball(BALL)))
    young = 2.0 * (1.0 + POISSON)
    exact = 4.0 / 3.0 * young / (1.0 - POISSON**2) * np.sqrt(BALL) * depth**1.5
    return Comparison(run.states[-1].force, float(exact))


def point_stiffness(tau: float) -> float:
    """First stiffness of a thin sphere under a point load over 8 sqrt(E h B)/R (Vella et al. 2012, DOI
    10.1103/PhysRevLett.109.144302, its closed form); ``tau`` is p R^2/(4 sqrt(E h B))."""
    if tau == 1.0:
        return float(0.5 * np.pi)
    if tau < 1.0:
        return float(0.5 * np.pi * np.sqrt(1.0 - tau**2) / np.arccos(tau))
    return float(0.5 * np.pi * np.sqrt(tau**2 - 1.0) / np.arccosh(tau))


def sheared_stiffness(wall: float, radius: float, tau: float, contact: float) -> float:
    """The same stiffness, N/mm with modulus 1 MPa, of a wall that also shears: linear shallow-shell theory with the
    transverse shear of Reissner's plate (5/6), the load spread as by Hertz over ``contact`` mm and as it arrives in the
    middle of the wall (half-space, (1 + k d) exp(-k d) at depth d)."""
    young = 2.0 * (1.0 + POISSON)
    bending = young * wall**3 / (12.0 * (1.0 - POISSON**2))
    shear, tension = bending / (5.0 / 6.0 * wall), 2.0 * tau * np.sqrt(young * wall * bending) / radius
    q = np.geomspace(1e-3 / radius, 1e3 / wall, 20001)
    spread = q * contact
    small = spread < 1e-2
    safe = np.where(small, 1.0, spread)
    load = np.where(small, 1.0 - spread**2 / 10.0, 3.0 * (np.sin(safe) - safe * np.cos(safe)) / safe**3)
    load *= (1.0 + 0.5 * q * wall) * np.exp(-0.5 * q * wall)
    soft = bending * q**4 / (1.0 + shear * q**2) + tension * q**2 + young * wall / radius**2
    return float(2.0 * np.pi / np.trapezoid(q**2 * load / soft, np.log(q)))


@dataclass(frozen=True)
class SpherePress:
    """First stiffness of the solid, of a thin shell in closed form, and of one with transverse shear, N/mm."""

    value: float
    thin: float
    sheared: float


def sphere(ratio: float, tau: float, arc: int = 144, through: int = 2) -> SpherePress:
    """A sphere of mid-surface radius 1 mm, wall ``ratio`` mm and modulus 1 MPa under a small ball."""
    mesh = dome(Hemisphere(1.0 - 0.5 * ratio, ratio), arc=arc, through=through, base_ratio=40.0, slides=True)
    return pressed_shell(SolidModel(mesh, neo_hookean(1.0, POISSON)), ratio, tau)


def pressed_shell(solid: SolidModel, ratio: float, tau: float) -> SpherePress:
    """A sphere of mid-surface radius 1 mm, or a cap of it at no pressure, under a small ball.

    The travel is that of the inner surface: the ball's local indentation of the wall is no part of the shell's. The
    pressure is held; radius and wall of the shell theories are those of the inflated sphere.
    """
    young = 2.0 * (1.0 + POISSON)
    bending = np.sqrt(12.0 * (1.0 - POISSON**2))
    free = state_at(solid, 4.0 * tau * young * ratio**2 / bending)
    run = indent(solid, free, PressSettings(0.04 * ratio, steps=8, dead_volume=1e9, body=ball(20.0 * ratio)))
    wall, radius = free.outer_apex - free.inner_apex, 0.5 * (free.outer_apex + free.inner_apex) if tau else 1.0
    # sqrt(E h B) is E h^2 over the same number as of the pressure.
    pressed = float(free.pressure * radius**2 * bending / (4.0 * young * wall**2))
    thin = 8.0 * young * wall**2 / (bending * radius) * point_stiffness(pressed)
    contact = float(np.median(run.column("contact_radius")[1:]))
    return SpherePress(_first_stiffness(run), float(thin), sheared_stiffness(wall, radius, pressed, contact))


def _first_stiffness(run: IndentationPath) -> float:
    """Force over travel of the inner surface at no travel: the line through the later half of the states."""
    sunk: Array = run.column("inner_apex")[0] - run.column("inner_apex")
    half = len(run.states) // 2
    ratio = run.column("force")[half:] / sunk[half:]
    return float(np.polyfit(sunk[half:], ratio, 1)[1])


def balls() -> dict[str, Any]:
    """Errors of the solid under a ball, and the processor times of both comparisons: Hertz by contact radius (mm); the shell by
    wall over radius, over `TAU`, against the closed form, against theory with shear, and of that theory against the closed form."""
    blocks, hertz_s = timed(lambda: [[contact, hertz(contact).error] for contact in (0.02, 0.01, 0.005)])
    spheres, shell_s = timed(lambda: [(ratio, [sphere(ratio, tau) for tau in TAU]) for ratio in WALLS])
    return {
        "hertz": blocks,
        "hertz_s": hertz_s,
        "shell": [
            {
                "wall_ratio": ratio,
                "thin": [one.value / one.thin - 1 for one in found],
                "sheared": [one.value / one.sheared - 1 for one in found],
                "share": [one.sheared / one.thin - 1 for one in found],
            }
            for ratio, found in spheres
        ],
        "shell_s": shell_s,
    }
