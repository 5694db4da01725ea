"""What is said of a jump of the wall, on states that are known."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch.mechanics.solid import continuation
from pneutouch.mechanics.solid.continuation import _describe

NODES = np.array([[0.0, 9.0], [9.0, 0.5], [6.0, 6.0]])


def state(force, height_of_the_last, *, stable=True):
    """The wall's points at rest, the last of them moved."""
    x = NODES / 9.0
    x[2, 1] = height_of_the_last
    scene = SimpleNamespace(solid=SimpleNamespace(mesh=SimpleNamespace(nodes=NODES)))
    return SimpleNamespace(force=force, stable=stable, scene=scene, state=SimpleNamespace(x=x))


@pytest.mark.parametrize(("force", "percent"), [(1.5, "-25.0"), (2.0, "0.0"), (2.2, "10.0")])
def test_the_change_of_the_force_is_that_from_the_last_state(force, percent, monkeypatch):
    monkeypatch.setattr(continuation, "lost_work", lambda path, after: 0.12)
    said = _describe([state(2.0, 0.6)], state(force, 0.2))
    assert f"the force changes by {percent} % at once and 12 % of a step's work is lost" in said
    assert "at rest at r 6.00, z 6.00 mm moves most" in said


def test_an_unstable_state_has_a_negative_mode():
    assert _describe([state(2.0, 0.6)], state(2.0, 0.2, stable=False)).startswith("the tangent has a negative mode")
