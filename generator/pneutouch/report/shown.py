"""The sensor as it is shown in pictures and in the 3D view: cut open, a graded membrane in the colours of its grade."""

import numpy as np

from pneutouch.arrays import Array
from pneutouch.export.scene import cut_open
from pneutouch.export.view import ShadedBody, shaded
from pneutouch.meridian.arc import arc_share
from pneutouch.parts import Assembly
from pneutouch.report.style import ACCENT
from pneutouch.spec.material import ArcGrading

GRADE_COLOURS = ("#F4EBD6", ACCENT)
"""Colours of no and of the greatest share of the stiff resin: light to dark, so that gray paper keeps the order."""


def shown(assembly: Assembly, pixels: int) -> tuple[ShadedBody, ...]:
    """The bodies of an assembly for a view ``pixels`` wide: meshes within an eighth of a pixel."""
    extent = max(float(np.ptp(body.vertices, axis=0).max()) for body in assembly.bodies)
    tolerance = max(assembly.scene.mesh_tolerance, extent / pixels / 8)
    grading = assembly.scene.membrane_material.along
    bodies = [cut_open(solid.mesh(tolerance)) for solid in assembly.solids]
    return tuple(
        shaded(body, grade_colours(grading, body.vertices) if grading and body.role == "membrane" else None)
        for body in bodies
    )


def greatest_share(grading: ArcGrading) -> float:
    """Share of the stiff resin at the dark end of the colours; at least one percent, so that none of it is light."""
    return max(*grading.stiff_fraction, 0.01)


def grade_colours(grading: ArcGrading, points: Array) -> Array:
    """Colours (n, 3) of points (n, 3) of the wall, mm in the design frame."""
    light, dark = (np.array(list(bytes.fromhex(colour[1:]))) / 255 for colour in GRADE_COLOURS)
    arc = arc_share(np.hypot(points[:, 0], points[:, 1]), points[:, 2])
    share = np.interp(arc, grading.arc, grading.stiff_fraction)[:, None] / greatest_share(grading)
    colours: Array = light + share * (dark - light)
    return colours
