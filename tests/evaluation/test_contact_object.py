"""Objects in a design file: what the predictions of all commands make of them."""

import json
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.catalogue import DesignSource
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.result import predicted
from pneutouch.report.curves import shapes
from pneutouch.results.record import plain as data
from pneutouch.spec.design import DesignFile
from pneutouch.spec.read import validate

BALL = {"contact.object": "ball", "contact.ball_radius_mm": 10.0, "pneumatics.driving_pressures_kPa": [22.0]}


@pytest.fixture(scope="module")
def ball():
    return evaluate("paper-dome", BALL, model="auto")


def test_the_plate_of_one_table_stands_in_both():
    design = validate(DesignFile, {"contact": {"plate_diameter_mm": 20}}, "here")
    assert design.indentation.plate_diameter_mm == 20
    again = validate(DesignFile, json.loads(json.dumps(design.model_dump(mode="json"))), "here")
    assert again == design
    same = {"contact": {"plate_diameter_mm": 20}, "indentation": {"plate_diameter_mm": 20.0}}
    assert validate(DesignFile, same, "here").indentation.plate_diameter_mm == 20


def test_a_plate_by_its_new_key_answers_as_by_its_old_one():
    driven = {"pneumatics.driving_pressures_kPa": [12.0]}
    default = DesignSource("default", {}, "the default design")
    old = evaluate(default, {**driven, "indentation.plate_diameter_mm": 25.0}, model="atlas")
    new = evaluate(default, {**driven, "contact.plate_diameter_mm": 25.0}, model="atlas")
    assert data(predicted(old)) == data(predicted(new))


def test_a_ball_is_answered_by_the_solid_alone_and_stated(ball):
    document = data(predicted(ball))
    assert document["model"] == "solid"
    stated = {"object": "ball", "label": "ball of 10 mm radius", "ball_radius_mm": 10.0, "friction": 0.0}
    assert document["contact"] == stated
    assert any("rigid ball of 10 mm radius, frictionless" in text for text in document["assumptions"])
    assert not any("plate" in text for text in document["assumptions"])
    said = document["states"][0]["uncertainty"]
    assert any("not a plate" in note for note in said["notes"])
    own = said["figures"]["sensitivity_kPa_per_N"]
    assert own["low"] < document["states"][0]["sensitivity_kPa_per_N"] < own["high"]
    assert document["error_estimate"]["sensitivity_relative"] is None
    # a ball meets less of the dome than the plate: less force, more pressure for each newton of it
    plate = evaluate("paper-dome", {"pneumatics.driving_pressures_kPa": [22.0]}).prediction.states[0]
    state = ball.prediction.states[0]
    assert (state.force[1:] < plate.force[1:]).all()
    assert state.figures.sensitivity > plate.figures.sensitivity
    # where it is drawn it touches the wall and does not cut it
    pressed = state.shapes[-1]
    reach = np.interp(pressed.cells[..., 0], *pressed.body[pressed.body[:, 1] < 14].T)
    under = pressed.cells[..., 0] < 4.0
    assert (pressed.cells[..., 1][under] < reach[under] + 0.02).all()
    assert (reach - pressed.cells[..., 1])[under].min() == pytest.approx(0.0, abs=0.02)


def test_the_object_is_drawn_in_the_pressed_section(ball):
    """With the ball there is a curve of many lines in place of the straight one of a plate."""
    prediction = ball.prediction
    state = prediction.states[0]
    bare = replace(state, shapes=tuple(replace(shape, body=None) for shape in state.shapes))
    without = shapes(replace(prediction, states=(bare,)))
    assert shapes(replace(prediction, states=(state,))).count("L ") > without.count("L ") + 10


@pytest.mark.parametrize("model", ["atlas", "membrane"])
def test_models_of_a_plate_refuse_another_object_and_name_the_one_that_answers(model):
    with pytest.raises(InputError, match="ball of 10 mm radius, not a plate") as refused:
        evaluate("paper-dome", BALL, model=model)
    assert refused.value.key == "model" and "solid" in refused.value.remedy


@pytest.mark.slow
@pytest.mark.parametrize(("friction", "stated"), [(0.6, 0.6), ("inf", "inf")])
def test_friction_reaches_the_solid_and_the_document(friction, stated):
    given = {"contact.friction": friction, "pneumatics.driving_pressures_kPa": [0.0], "indentation.depth_mm": 4.0}
    rough = evaluate("paper-dome", given, model="auto")
    document = data(predicted(rough))
    assert (document["model"], document["contact"]["friction"]) == ("solid", stated)
    json.dumps(document, allow_nan=False)
    assert rough.sensor.protocol.friction == float(friction)
    smooth = evaluate("paper-dome", {**given, "contact.friction": 0.0}).prediction.states[0]
    assert rough.prediction.states[0].force[-1] > 1.005 * smooth.force[-1]
    with pytest.raises(InputError, match="friction"):
        evaluate("paper-dome", given, model="atlas")
    table = json.loads(json.dumps(rough.scene.design.contact.model_dump(mode="json"), allow_nan=False))
    assert validate(DesignFile, {"contact": table}, "here").contact == rough.scene.design.contact
