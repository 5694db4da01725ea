"""The second opinion, against meshes with known faults."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.body import Body
from pneutouch.catalogue import load_scene
from pneutouch.errors import InputError
from pneutouch.parts import assemble
from pneutouch.printability.inspection import inspect, least_angles
from tests.printability.gallery import body_of, box, rod
from tests.printability.test_rules import LIBRARY


def test_without_pymeshlab_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "pymeshlab", None)
    with pytest.raises(InputError, match=r"pneutouch\[inspect\]"):
        inspect(body_of(box(1, 1, 1)))


@pytest.fixture(autouse=True)
def lab(request):
    if "extra" not in request.node.name:
        pytest.importorskip("pymeshlab", reason="the inspect extra is not installed")


def test_a_sensor_s_meshes_pass():
    assembly = assemble(load_scene("paper-dome", None, LIBRARY))
    for body, solid in zip(assembly.bodies, assembly.solids, strict=True):
        found = inspect(body, solid, assembly.scene.mesh_tolerance)
        assert [finding for finding in found if finding.severity != "note"] == []


def test_a_coarse_mesh_is_measured_both_ways():
    assembly = assemble(load_scene("paper-dome", None, LIBRARY))
    solid = assembly.solids[0]
    (finding,) = [found for found in inspect(solid.mesh(0.1), solid, 0.016) if found.severity == "warning"]
    assert 0.02 < finding.excess.measured <= 0.1 * 1.02


def test_crossing_shells_are_found():
    one, other = body_of(box(10, 10, 10)), body_of(box(10, 10, 10, (5, 4, 3)))
    both = Body(
        "both",
        "coupon",
        one.material,
        np.vstack([one.vertices, other.vertices]),
        np.vstack([one.triangles, other.triangles + len(one.vertices)]),
    )
    assert any("cross" in finding.message for finding in inspect(both))
    assert inspect(one) == []


def test_an_open_mesh_is_found():
    whole = body_of(box(10, 10, 10))
    assert any("open edges" in finding.message for finding in inspect(replace(whole, triangles=whole.triangles[1:])))


def test_slivers_are_counted():
    assert least_angles(body_of(box(3, 3, 3))).min() == pytest.approx(45.0)
    needle = body_of(rod(0.05, 100, sides=64))
    assert any(finding.severity == "note" and "angle" in finding.message for finding in inspect(needle))
