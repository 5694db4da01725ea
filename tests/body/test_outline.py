"""The section of a solid from its meridian and bores: the one that the plane cuts out of its mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.body import Bore
from pneutouch.body.section import mesh_outline, section_outline
from pneutouch.catalogue import load_scene
from pneutouch.parts import assemble
from pneutouch.spec.read import parse_changes
from tests.printability.gallery import ball, body_of

TOLERANCE = 0.02
CASES = [
    ("paper-dome", []),
    ("paper-dome", ["membrane.wall_thickness_mm=0.5"]),
    ("agilus-dome", []),
    ("fingertip-dome", []),
    ("long-tube", []),
    ("stiff-dome", ["connector.port=thread-M5", "connector.mount=robot-50-4-M6"]),
    ("soft-pad", ["connector.port=luer-female"]),
]


def solids(name, changes, library):
    return assemble(load_scene(name, parse_changes(changes), library)).solids


def difference(one, other):
    """Area that only one of two sections has, mm2, and the length of their outlines, mm."""
    from manifold3d import CrossSection

    a, b = (CrossSection([np.ascontiguousarray(loop) for loop in loops]) for loops in (one, other))
    around = sum(np.hypot(*(loop - np.roll(loop, 1, axis=0)).T).sum() for loop in other)
    return (a - b).area() + (b - a).area(), around


@pytest.mark.parametrize(("name", "changes"), CASES)
def test_the_section_is_that_of_the_mesh(name, changes, library):
    for solid in solids(name, changes, library):
        fast, cut = section_outline(solid, TOLERANCE), mesh_outline(solid.mesh(0.2 * TOLERANCE))
        assert len(fast) == len(cut)
        area, around = difference(fast, cut)
        assert area < 0.5 * TOLERANCE * around


def test_a_bore_that_the_plane_cuts_is_as_wide_as_its_chord(library):
    connector = next(solid for solid in solids("paper-dome", [], library) if solid.role == "connector")
    plain = replace(connector, bores=())
    low, high = connector.meridian.bounds()[1:]
    bore = Bore(12.0, 0.6, 1.0, low, high)
    drilled = replace(plain, bores=(bore,))
    removed = difference(section_outline(plain, TOLERANCE), section_outline(drilled, TOLERANCE))[0]
    by_mesh = difference(mesh_outline(plain.mesh(TOLERANCE)), mesh_outline(drilled.mesh(TOLERANCE)))[0]
    assert removed == pytest.approx(by_mesh, rel=0.02)
    assert len(section_outline(drilled, TOLERANCE)) == len(section_outline(plain, TOLERANCE)) + 1
    # A bore beside the plane leaves the section as it was.
    aside = replace(plain, bores=(replace(bore, y=1.5),))
    assert difference(section_outline(aside, TOLERANCE), section_outline(plain, TOLERANCE))[0] == 0.0


@pytest.mark.parametrize("height", [-5.0, 0.0, 3.0])
def test_a_plane_cuts_the_mesh_of_a_ball_in_a_circle(height):
    """Its radius is that of the ball less what the plane is off its middle, to the sagitta of a chord."""
    (loop,) = mesh_outline(body_of(ball(6.0, sides=128)), height)
    radius = np.linalg.norm(loop, axis=1)
    assert radius.max() <= np.sqrt(36.0 - height**2) + 1e-3
    assert radius.min() >= np.sqrt(36.0 - height**2) - 0.01
