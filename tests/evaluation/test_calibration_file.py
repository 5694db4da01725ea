"""A calibration by its file: what it belongs to, where it is named and carried, and what is refused."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

from pneutouch.catalogue import load_scene
from pneutouch.catalogue.library import elastomers
from pneutouch.catalogue.listing import listing
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.result import by_model
from pneutouch.output.recipe import BuildRecipe, evaluate_recipe, read_recipe
from pneutouch.results.record import plain as data
from pneutouch.spec.design import CALIBRATION
from tests.evaluation.calibrated import AT, CONTENT, DEAD, changed, held, library_of, predicted
from tests.refusals import refused


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"membrane.material": "FLX9950"}, "made with a membrane of TangoPlus, this one is of FLX9950"),
        ({"membrane.wall_thickness_mm": 1.6}, "made with a membrane of wall 1.5 mm, this one has 1.6 mm"),
        ({"membrane.inner_radius_mm": 9.3}, "made with a membrane of inner radius 9.25 mm, this one has 9.3 mm"),
    ],
)
def test_another_membrane_is_refused(place, changes, why):
    with pytest.raises(InputError, match=f'calibration = "mine": the calibration was {why}'):
        load_scene("paper-dome@mine", changes, place)


def test_a_model_or_clamp_that_was_not_fitted_is_refused(place):
    with refused("calibration", "mine", remedy="another model"):
        evaluate("paper-dome@mine", DEAD, model="membrane", library=place)
    with refused("calibration", "mine", remedy="clamp base"):
        evaluate("paper-dome@mine", DEAD, clamp="flange", library=place)


def test_it_is_named_in_three_forms_and_left_out_by_one(place):
    named = {**DEAD, CALIBRATION: "mine"}
    assert predicted(place, DEAD).sensor == predicted(place, named, "paper-dome").sensor
    (place.folders[0] / "designs").mkdir()
    file = place.folders[0] / "designs" / "in-hand.toml"
    file.write_text('calibration = "mine"\n[pneumatics]\ndead_volume_mL = 0.3\n')
    assert predicted(place, {}, "in-hand").sensor == predicted(place, DEAD).sensor
    for without in ({CALIBRATION: "none"}, {CALIBRATION: None}):
        scene = load_scene("in-hand", without, place)
        assert scene.calibration is None
    with pytest.raises(InputError, match="other: no such name among the calibrations"):
        load_scene("paper-dome@other", None, place)


def test_it_is_no_resin(place):
    assert [entry["name"] for entry in listing("calibrations", place)["calibrations"]] == ["mine"]
    groups = listing(None, place)
    assert not any(entry["name"] == "mine" for kind in groups.keys() - {"calibrations"} for entry in groups[kind])
    assert "mine" not in elastomers(place)


@pytest.mark.parametrize(
    ("content", "why"),
    [
        ({**CONTENT, "format": "pneutouch/calibration/2"}, "of a later version"),
        ({**CONTENT, "format": "pneutouch/plan/1"}, "not the format of this file"),
        ({**CONTENT, "covariance": [[1.0]]}, "must be 3 rows of 3 numbers"),
        (
            {**CONTENT, "covariance": [[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]]},
            "without negative eigenvalues",
        ),
        ({key: value for key, value in CONTENT.items() if key != "response"}, "response: must be there where curves"),
        (changed(source={"driving_pressures_kPa": [12.0, 0.0]}), "ascending"),
        (changed(response={"force_factors": [1.0]}), "must have a number for each driving pressure"),
        (changed(source={"digest": "x"}), "source.digest"),
        (changed(source={"driving_pressures_kPa": [-1.0, 12.0]}), "driving_pressures_kPa"),
        (changed(response=held(-1.0)), "held_out_sensitivity_errors"),
        (changed(response=held(-2.0)), "held_out_sensitivity_errors"),
        (changed(response=held(11.0)), "held_out_sensitivity_errors"),
        (changed(response={**held(0.1), "held_out_pressures_kPa": [-12.0]}), "held_out_pressures_kPa"),
        (changed(response={"held_out_sensitivity_errors": [0.1]}), "a number for each of held_out_pressures_kPa"),
        ({**CONTENT, "covariance": np.diag([4.1, 1.0, 1.0]).tolist()}, "shear_modulus_MPa must be at most 4"),
        ({**CONTENT, "covariance": np.diag([1.0, 1e9, 1.0]).tolist()}, "wall_thickness_mm must be at most 4"),
        ({**CONTENT, "covariance": np.diag([1.0, 1.0, 1e9]).tolist()}, "dead_volume_mL must be at most 100"),
    ],
)
def test_a_damaged_file_is_refused(content, why, library, tmp_path):
    with pytest.raises(InputError, match=why):
        library_of(tmp_path, library, content).load("calibrations", "mine")


def test_a_recipe_carries_it_and_is_the_same_again(place, tmp_path):
    from pneutouch.export.threemf_read import Package
    from pneutouch.output.files import input_hash

    recipe = BuildRecipe.of(predicted(place))
    assert recipe.inputs()["calibration"]["source"]["digest"] == "ab" * 32
    fields = {field.name: None for field in dataclasses.fields(Package)}
    metadata = {"input-hash": input_hash(recipe.inputs())}
    package = Package(**{**fields, "path": tmp_path / "a.3mf", "recipe": recipe.text(), "metadata": metadata})
    again = evaluate_recipe(read_recipe(package))
    assert BuildRecipe.of(again).text() == recipe.text()
    assert json.dumps(data(by_model(again.prediction))) == json.dumps(data(by_model(predicted(place).prediction)))
    plain = BuildRecipe.of(evaluate("paper-dome", AT, model="atlas", library=place))
    assert "calibration" not in plain.inputs() and "calibration" not in plain.inputs()["design"]


@pytest.mark.slow
def test_a_built_3mf_is_built_again_without_the_calibration_file(place, tmp_path):
    from pneutouch.export.threemf_read import read_threemf
    from pneutouch.workflows.build import build

    folder = build(predicted(place), tmp_path / "first")
    assert (
        "Calibration `mine`: the figures of the datasheet are those of sensor A"
        in (folder / "print-sheet.md").read_text()
    )
    assert json.loads((folder / "manifest.json").read_text())["inputs"]["calibration"]["source"]["sensor"] == "A"
    (place.folders[0] / "calibrations" / "mine.toml").unlink()
    again = build(evaluate_recipe(read_recipe(read_threemf(folder / "paper-dome.3mf"))), tmp_path / "second")
    for path in folder.rglob("*"):
        assert path.is_dir() or path.read_bytes() == (again / path.relative_to(folder)).read_bytes(), path


def test_a_campaign_names_it_and_a_build_of_it_has_a_name_of_its_own(place, tmp_path, monkeypatch):
    from pneutouch.cli.build import _calibrated_name
    from pneutouch.workflows.simulate import named_design

    (tmp_path / "dome.toml").write_text("[membrane]\n")
    assert named_design("paper-dome@mine", place) == ("paper-dome@mine", {})
    name, copied = named_design(f"{tmp_path / 'dome.toml'}@mine", place)
    assert name == "dome.toml@mine" and list(copied) == ["dome.toml"]
    monkeypatch.setattr("pneutouch.catalogue.library.Library.default", lambda: place)
    assert _calibrated_name("paper-dome@mine", {}) == "paper-dome-mine"
    assert _calibrated_name("paper-dome", {"calibration": "mine"}) == "paper-dome-mine"
    assert _calibrated_name("paper-dome", {}) is _calibrated_name("paper-dome@mine", {"calibration": "none"}) is None


def test_the_recipe_of_a_calibrated_build_is_shown(place):
    from pneutouch.cli.show import _recipe
    from pneutouch.results.stored import ShownRecipe

    inputs = {"design": {"calibration": "mine", "membrane": {"material": "TangoPlus", "wall_thickness_mm": None}}}
    inputs |= {"model": None, "closure": None, "clamp": None, "tolerance": None, "compared_resins": []}
    text = "\n".join(_recipe(ShownRecipe("pneutouch/recipe/1", "x", "1", inputs, "a", {}, ())))
    assert "calibration" in text and "mine" in text and "membrane.material" in text and "wall_thickness" not in text


@pytest.mark.parametrize("simulated", [False, True])
def test_text_and_sheet_state_the_specimen_and_that_data_are_simulated(simulated, library, tmp_path):
    from pneutouch.cli.prediction_text import prediction_text
    from pneutouch.evaluation.result import predicted_in_full
    from pneutouch.report.prose import status

    content = changed(source={"simulated": simulated})
    evaluation = predicted(library_of(tmp_path, library, content))
    sensor = content["source"]["sensor"]
    for text in (prediction_text(predicted_in_full(evaluation)), status(evaluation.scene)):
        assert f"sensor {sensor}" in text and ("SIMULATED DATA" in text) is simulated


def test_a_calibrated_prediction_is_of_its_schema(place):
    from pneutouch.evaluation.result import predicted_in_full
    from pneutouch.output.files import json_bytes
    from pneutouch.results.record import plain
    from tests.schemas.held import hold

    document = json.loads(json_bytes(plain(predicted_in_full(predicted(place)))))
    assert document["calibration"]["sensor"]
    hold("prediction", document)
