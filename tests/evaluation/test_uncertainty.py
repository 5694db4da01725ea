"""Intervals of a prediction: the budget's, about the figures of the model that was requested, or a word why there are none."""

from __future__ import annotations

import json

import numpy as np
import pytest

from pneutouch.evaluation import evaluate
from pneutouch.evaluation.result import by_model, predicted
from pneutouch.evaluation.uncertainty import uncertainties
from pneutouch.mechanics.atlas.figures import FIGURES
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.models.accuracy import NUMERICAL
from pneutouch.mechanics.uncertainty.document import budget, gas_text
from pneutouch.mechanics.uncertainty.sources.model_error import model_errors
from pneutouch.output.files import json_bytes
from pneutouch.results.record import plain as data
from pneutouch.spec.material import Material

SENSITIVITY = "sensitivity_kPa_per_N"


def own_budget(evaluation, library, near):
    scene = evaluation.scene
    batch = batch_of(evaluation.sensor, [state.driving_pressure for state in evaluation.prediction.states])
    errors = model_errors(scene.membrane_material, library.all("materials", Material).values())
    numerical = {SENSITIVITY: NUMERICAL[evaluation.prediction.model], "limit_pressure_kPa": 0.002}
    return batch, budget(
        batch, scene.membrane_material, scene.printer, near_paper=near, errors=errors, numerical=numerical
    )


@pytest.mark.parametrize(
    ("name", "near"), [("paper-dome", True), pytest.param("long-tube", False, marks=pytest.mark.slow)]
)
def test_widths_are_the_budgets_and_values_the_models(evaluated, library, name, near):
    evaluation = evaluated(name)
    batch, found = own_budget(evaluation, library, near)
    for row, (state, said) in enumerate(zip(evaluation.prediction.states, evaluation.uncertainty, strict=True)):
        values = dict(
            zip(
                FIGURES,
                (
                    state.figures.sensitivity,
                    1e3 * evaluation.prediction.limits.limit_point,
                    state.figures.stiffness,
                    state.figures.force_range[1],
                    state.range_end,
                    state.apex_outer,
                ),
                strict=True,
            )
        )
        said = data(said)
        assert said["figures"].keys() == values.keys()
        for i, (figure, value) in enumerate(values.items()):
            width = float(found.expanded[i, row])
            own = said["figures"][figure]
            assert own["value"] == pytest.approx(value, rel=1e-5)
            assert own["low"] == pytest.approx(value * np.exp(-width), rel=1e-5)
            assert own["high"] == pytest.approx(value * np.exp(width), rel=1e-5)
        assert sum(said["figures"][SENSITIVITY]["shares"].values()) == pytest.approx(1.0, abs=1e-4)
        assert set(gas_text(batch)[row]) <= set(said["notes"])


def test_the_model_that_solves_more_exactly_has_the_smaller_share(evaluated):
    solid, atlas = (
        data(evaluated("paper-dome", model=model).uncertainty[0])["figures"][SENSITIVITY]["shares"]["numerical"]
        for model in ("solid", "atlas")
    )
    assert solid / atlas == pytest.approx((NUMERICAL["solid"] / NUMERICAL["atlas"]) ** 2, rel=0.02)


def test_a_range_that_ends_at_the_depth_has_no_uncertainty_and_no_rounding_noise(evaluated):
    figure = data(evaluated("paper-dome", model="atlas").uncertainty[-1])["figures"]["range_end_mm"]
    assert figure["expanded_uncertainty"] == 0.0
    assert figure["low"] == figure["high"] == figure["value"]


def test_document_keeps_its_keys_and_gains_one_a_state(evaluated):
    evaluation = evaluated("paper-dome", model="atlas")
    before, after = data(by_model(evaluation.prediction)), data(predicted(evaluation))
    kept = {**after, "states": [{k: v for k, v in s.items() if k != "uncertainty"} for s in after["states"]]}
    more = {"rating", "dead_volume_note", "dead_volume_as_drawn_mL", "as_drawn", "as_drawn_model"}
    assert {key: value for key, value in kept.items() if key not in more} == before
    assert after["rating"]["rated_pressure_kPa"] < after["rating"]["limit_kPa"]
    assert all(state["uncertainty"]["coverage_factor"] == 2 for state in after["states"])
    again = evaluate("paper-dome", model="atlas")
    assert json_bytes(data(predicted(again))) == json_bytes(after)


def test_outside_the_atlas_every_state_says_why(evaluated):
    pressed = {"indentation.depth_mm": 3, "indentation.steps": 4, "pneumatics.driving_pressures_kPa": [0, 5]}
    flange = evaluate("paper-dome", pressed, clamp="flange")
    assert [list(said) for said in map(data, flange.uncertainty)] == [["unknown"], ["unknown"]]
    assert "flange" in data(flange.uncertainty[0])["unknown"]
    membrane = evaluated("paper-dome", model="membrane").uncertainty
    assert len(membrane) == 4
    assert "model atlas" in membrane[0].unknown


def test_samples_of_the_same_sources_give_nearly_the_same_interval(evaluated):
    one = evaluated("paper-dome", model="atlas")
    for said in map(data, uncertainties(one.prediction, one.sensor, one.scene, lambda: one.resins, 3000)[::3]):
        own, drawn = said["figures"][SENSITIVITY], said["monte_carlo"]["figures"][SENSITIVITY]
        width = np.log(own["high"] / own["low"])
        assert np.log(drawn["high"] / drawn["low"]) == pytest.approx(width, rel=0.12)
        assert drawn["low"] < own["value"] < drawn["high"]
        assert said["monte_carlo"]["samples"] == 3000


def test_predict_shows_the_interval_and_what_to_measure_first(command, root):
    text = command("predict", "paper-dome", "--model", "atlas", "--monte-carlo", "400", cwd=root).stdout
    said = json.loads(command("predict", "paper-dome", "--model", "atlas", "--json", cwd=root).stdout)
    for state in said["states"]:
        figure = state["uncertainty"]["figures"][SENSITIVITY]
        assert f"{figure['low']:.2f} to {figure['high']:.2f}" in text
    assert "sampled" in text
    assert "measure first: ageing" in text
    membrane = command("predict", "paper-dome", "--model", "membrane", cwd=root).stdout
    assert "uncertainty not known: the membrane" in membrane
