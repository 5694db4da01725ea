"""The key contact.base of a design: what the wall lies down on."""

import numpy as np

from pneutouch.evaluation.evaluate import evaluate, sensor_of
from pneutouch.mechanics.models.choice import outside
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.parts.connector import LIP
from tests.refusals import refused

OFF = {"contact.base": False}


def test_the_base_is_the_connector_s(library):
    plain = evaluate("agilus-dome", {"pneumatics.driving_pressures_kPa": [0.0], **OFF}, model="membrane")
    assert plain.sensor.dome.base is None
    found = evaluate("agilus-dome", {"pneumatics.driving_pressures_kPa": [0.0]})
    assert found.sensor.dome.base == RigidBase(found.assembly.layout.channel_radius)
    assert any("lies down" in line for line in found.prediction.assumptions)


def test_a_clamping_ring_is_part_of_the_base():
    changes = {"connector.seat": "clamped-flange-M2", "pneumatics.driving_pressures_kPa": [0.0]}
    assembly = evaluate("paper-dome", {**changes, **OFF}, model="membrane").assembly
    scene = evaluate("paper-dome", changes, model="auto").assembly
    base, layout = sensor_of(scene).dome.base, scene.layout
    assert sensor_of(assembly).dome.base is None
    assert base.ring == layout.ring_inner and base.ring_height == scene.scene.seat.ring_thickness
    # the ring's cone, drawn by the parts, lies on the base's above the lip and ends where that does
    cone = next(piece for piece in scene.solid("ring").meridian.pieces if piece.tag == "ring cone")
    ends = sorted([cone.start, cone.end])
    assert np.allclose(ends, [(base.ring + LIP, LIP), (base.ring + base.ring_height, base.ring_height)])


def test_the_atlas_does_not_answer_without_it(library):
    without, with_it = (evaluate("paper-dome", changes, model="membrane").sensor for changes in (OFF, {}))
    assert outside("atlas", without) is not None and outside("atlas", with_it) is None
    with refused("model", "atlas", remedy="solid"):
        evaluate("paper-dome", OFF, model="atlas")
