"""A small dome on its carrier, at 27 um: a stack of a second's work."""

from __future__ import annotations

from functools import cache

from pneutouch.body import Solid
from pneutouch.catalogue import Library, load_scene
from pneutouch.export.voxels.raster import ResinBlend, VoxelBody, VoxelJob, raster
from pneutouch.parts import Assembly, assemble
from pneutouch.shape.meridian import Arc, Line, Meridian
from pneutouch.spec.read import parse_changes
from tests.conftest import ROOT

SETS = (
    "membrane.inner_radius_mm=4",
    "membrane.wall_thickness_mm=1",
    "indentation.plate_diameter_mm=20",
    "connector.mount=plain",
    "pneumatics.driving_pressures_kPa=[0]",
)
RESINS = ("Agilus30", "TangoPlus", "VeroClear")


@cache
def small_assembly(*more: str) -> Assembly:
    return assemble(load_scene("graded-dome", parse_changes([*SETS, *more]), Library((ROOT,))))


def material(name: str):
    return Library((ROOT,)).load("materials", name)


def block(low: float, high: float, radius: float, name: str = "block", resin: str = "TangoPlus") -> Solid:
    """A disc about the z axis."""
    outline = Meridian(
        (
            Line((0.0, low), (radius, low), ""),
            Line((radius, low), (radius, high), ""),
            Line((radius, high), (0.0, high), ""),
        )
    )
    return Solid(name, "coupon", material(resin), outline)


def ball(radius: float) -> Meridian:
    return Meridian((Arc((0.0, 0.0), radius, -1.5707963267948966, 1.5707963267948966, ""),))


def job(*bodies: tuple[Solid, ResinBlend], layer_um: float = 27.0, dpi=(600, 300), upright=True, seed=1) -> VoxelJob:
    jetted = tuple(VoxelBody(solid, blend) for solid, blend in bodies)
    grid = raster([body.inside for body in jetted], dpi, layer_um, upright=upright)
    return VoxelJob(jetted, grid, RESINS, seed)
