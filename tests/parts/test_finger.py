"""The sleeve's bore goes with the finger that the design gives; without one it is the mount's own."""

from __future__ import annotations

import pytest

from pneutouch.catalogue import Library, load_scene
from pneutouch.parts import assemble
from tests.conftest import ROOT

LIBRARY = Library((ROOT,))
SLEEVE = {"connector.mount": "finger-16"}


def drawn(finger_mm: float | None):
    given = {} if finger_mm is None else {"connector.finger_diameter_mm": finger_mm}
    return assemble(load_scene("stiff-dome", SLEEVE | given, LIBRARY))


def bore(assembly) -> float:
    """Diameter of the sleeve's inner wall, mm."""
    (wall,) = assembly.solid("connector").meridian.tagged("finger")
    assert wall.start[0] == wall.end[0]
    return 2 * wall.start[0]


@pytest.mark.parametrize("finger_mm", [12.0, 20.0, 31.5])
def test_the_bore_is_wider_by_as_much_as_the_finger(finger_mm):
    usual, other = drawn(None), drawn(finger_mm)
    assert bore(other) - bore(usual) == pytest.approx(finger_mm - 16.0, abs=1e-12)
    assert other.scene.mount.title == usual.scene.mount.title.replace("16 mm", f"{finger_mm:g} mm")
    assert other.scene.mount.code == f"F{finger_mm:g}"


def test_the_sleeve_s_own_finger_gives_the_same_bodies():
    usual, named = drawn(None), drawn(16.0)
    assert named.layout == usual.layout
    assert named.scene.mount == usual.scene.mount
    assert [solid.volume for solid in named.solids] == [solid.volume for solid in usual.solids]
