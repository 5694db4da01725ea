"""A calibration in a design: whose parameters, curves and uncertainty the prediction then has."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

from pneutouch.catalogue import Library, load_scene
from pneutouch.catalogue.listing import listing
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import elastomers, evaluate
from pneutouch.evaluation.uncertainty import known
from pneutouch.mechanics.uncertainty import FIGURES, monte_carlo
from pneutouch.output.recipe import BuildRecipe, evaluate_recipe
from pneutouch.output.recipe_read import read_recipe
from pneutouch.report.certainty import SENSITIVITY
from pneutouch.spec.design import CALIBRATION
from pneutouch.spec.toml_text import toml_text
from pneutouch.units import KPA, ML

MODULUS, WALL, VOLUME = 0.2, 1.55, 0.31
LOW, HIGH = (1.05, 1.01), (0.97, 1.03)
"""Factors on force and pressure at 0 and 12 kPa."""

CONTENT = {
    "format": 1,
    "title": "sensor A, spring",
    "covariance": [[9e-4, -6e-4, 0.0], [-6e-4, 1.6e-3, 0.0], [0.0, 0.0, 4e-4]],
    "source": {
        "sensor": "A",
        "campaign": "spring",
        "lab": "",
        "digest": "ab" * 32,
        "simulated": False,
        "curves": 4,
        "injections": 1,
        "driving_pressures_kPa": [0.0, 12.0],
        "ambient_pressure_kPa": 101.325,
        "age_days": 73.0,
    },
    "design": {
        "name": "paper-dome",
        "material": "TangoPlus",
        "inner_radius_mm": 9.25,
        "wall_thickness_mm": 1.5,
        "dead_volume_mL": 0.3,
    },
    "parameters": [
        {"key": "shear_modulus_MPa", "value": MODULUS, "fitted": True, "covered": True},
        {"key": "wall_thickness_mm", "value": WALL, "fitted": True, "covered": True},
        {"key": "dead_volume_mL", "value": VOLUME, "fitted": True, "covered": True},
    ],
    "response": {
        "force_factors": [LOW[0], HIGH[0]],
        "pressure_factors": [LOW[1], HIGH[1]],
        "sensitivity_errors_relative": [0.01, 0.01],
        "force_errors_relative": [0.015, 0.015],
        "errors_freedom": 60.0,
        "held_out_pressures_kPa": [],
        "held_out_sensitivity_errors": [],
    },
}
DEAD = {"pneumatics.dead_volume_mL": 0.3}
AT = {**DEAD, "pneumatics.driving_pressures_kPa": [0.0, 6.0, 12.0, 22.0]}


def changed(**tables):
    """The content with keys of its tables changed."""
    return {**CONTENT, **{name: {**CONTENT[name], **keys} for name, keys in tables.items()}}


def held(error):
    """The keys of a response of one pressure held out, with its error."""
    return {"held_out_pressures_kPa": [12.0], "held_out_sensitivity_errors": [error]}


def library_of(folder, shipped, content=CONTENT):
    path = folder / "calibrations" / "mine.toml"
    path.parent.mkdir(exist_ok=True)
    path.write_text(toml_text(content))
    return Library((folder, *shipped.folders))


@pytest.fixture
def place(library, tmp_path):
    return library_of(tmp_path, library)


def predicted(place, changes=AT, design="paper-dome@mine", **options):
    return evaluate(design, changes, model="atlas", library=place, **options)


def test_the_parameters_are_the_fitted_ones_and_the_bodies_the_drawn_ones(place):
    evaluation = predicted(place)
    sensor = evaluation.sensor
    assert (sensor.wall.shear_modulus, sensor.dome.wall_thickness) == (MODULUS, WALL)
    assert sensor.gas.dead_volume == pytest.approx(VOLUME * ML)
    assert evaluation.assembly.layout.wall == 1.5
    longer = predicted(place, {**AT, **{"pneumatics.dead_volume_mL": 1.3}})
    assert longer.sensor.gas.dead_volume == pytest.approx((VOLUME + 1.0) * ML)
    assert any("calibration mine: sensor A" in line for line in evaluation.prediction.assumptions)


def test_curves_and_figures_are_corrected_between_the_pressures_that_were_measured(library, place, tmp_path):
    factors = [LOW, tuple(np.sqrt(np.multiply(LOW, HIGH))), HIGH, HIGH]
    states = predicted(place).prediction.states
    bare = changed(response={"force_factors": [1.0, 1.0], "pressure_factors": [1.0, 1.0]})
    plain = predicted(library_of(tmp_path, library, bare)).prediction.states
    for (force, rise), state, before in zip(factors, states, plain, strict=True):
        assert np.allclose(state.force, force * before.force, rtol=1e-12)
        assert np.allclose(state.pressure_rise, rise * before.pressure_rise, rtol=1e-12)
        assert state.figures.sensitivity_kPa_per_N == pytest.approx(
            before.figures.sensitivity_kPa_per_N * rise / force, rel=1e-12
        )
        assert state.figures.stiffness == pytest.approx(before.figures.stiffness * force, rel=1e-12)
        assert state.range_end == before.range_end


def test_the_uncertainty_is_the_calibrations(place):
    old = evaluate("paper-dome", AT, model="atlas", library=place).uncertainty
    new = predicted(place).uncertainty
    for k, (before, after) in enumerate(zip(old, new, strict=True)):
        names = {source["name"] for source in after["sources"]}
        assert not names & {"published modulus", "modulus between prints", "wall thickness", "tube bore"}
        assert {"calibrated parameters", "model as calibrated", "ageing", "driving pressure"} <= names
        figure, was = after["figures"][SENSITIVITY], before["figures"][SENSITIVITY]
        inner = figure["at_calibration"]
        assert figure["low"] < inner["low"] < figure["value"] < inner["high"] < figure["high"]
        assert np.log(figure["high"] / figure["low"]) < np.log(was["high"] / was["low"])
        # At 22 kPa, beyond what was measured, model, radius, correction and parameters count as well.
        for name in ("calibrated parameters", "model", "inner radius"):
            assert (name in figure["shares"]) == (k == 3), name
        assert "inner radius" in after["figures"]["limit_pressure_kPa"]["shares"]
    limits = [entry[0]["figures"]["limit_pressure_kPa"] for entry in (old, new)]
    assert np.log(limits[1]["high"] / limits[1]["low"]) < 0.3 * np.log(limits[0]["high"] / limits[0]["low"])


def test_far_from_what_was_measured_the_models_error_stays_even_where_the_correction_is_one(library, tmp_path):
    """Runs at 0 kPa that the fitted model meets say little of 18 kPa: of the model's error 0.71 stays there."""
    values = {"force_factors": 1.0, "pressure_factors": 1.0}
    values |= {"sensitivity_errors_relative": 0.01, "force_errors_relative": 0.01}
    response = {key: [value] for key, value in values.items()}
    content = changed(source={"driving_pressures_kPa": [0.0]}, response=response)
    at = {**DEAD, "pneumatics.driving_pressures_kPa": [0.0, 18.0]}
    there, far = predicted(library_of(tmp_path, library, content), at).uncertainty
    plain = evaluate("paper-dome", at, model="atlas", library=library).uncertainty[1]

    def standard(entry):
        return {source["name"]: source["standard_uncertainty"] for source in entry["sources"]}.get("model", 0.0)

    assert standard(there) == 0.0
    assert standard(far) == pytest.approx(np.sqrt(0.5) * standard(plain), rel=1e-5)
    inner, near = (entry["figures"][SENSITIVITY]["at_calibration"] for entry in (far, there))
    assert np.log(inner["high"] / inner["low"]) > 2 * np.log(near["high"] / near["low"])
    assert np.log(inner["high"] / inner["low"]) >= 4 * standard(far)


@pytest.mark.parametrize("freedom", [2.0, 0.0])
def test_few_degrees_of_freedom_of_the_runs_are_those_of_the_figure(freedom, library, tmp_path):
    """0 stands for an assumed scatter, which has none (JCGM 100, G.4.3) and is not known."""
    content = changed(response={"errors_freedom": freedom}, source={"age_days": 400.0})
    place = library_of(tmp_path, library, content)
    (entry,) = predicted(place, {**DEAD, "pneumatics.driving_pressures_kPa": [12.0]}).uncertainty
    figure = entry["figures"]["force_at_range_end_N"]
    (source,) = (
        s for s in entry["sources"] if s["name"] == "model as calibrated" and "force_at_range_end_N" in s["figures"]
    )
    assert source["known"] == bool(freedom) and ("assumed" in source["origin"]) == (not freedom)
    if freedom:
        share = figure["shares"]["model as calibrated"]
        assert figure["degrees_of_freedom"] == pytest.approx(freedom / share**2, rel=1e-3)
        assert any("few degrees of freedom: " in note and "force_at_range_end_N" in note for note in entry["notes"])
    else:
        assert figure["degrees_of_freedom"] is None


def test_what_is_left_of_the_year_ages(library, tmp_path):
    ages = {0.0: 1.0, 73.0: 0.8, 365.0: 0.0, 1000.0: 0.0}
    standards = {}
    for age in ages:
        place = library_of(tmp_path, library, changed(source={"age_days": age}))
        sources = predicted(place, DEAD).uncertainty[0]["sources"]
        standards[age] = {source["name"]: source["standard_uncertainty"] for source in sources}
    for age, share in ages.items():
        assert standards[age].get("ageing", 0.0) == pytest.approx(share * standards[0.0]["ageing"])


def test_correlated_parameters_spread_as_samples_of_them_do(place):
    """The limit pressure follows modulus and wall, whose errors cancel in part: 2000 samples agree within 5 %."""
    evaluation = predicted(place, {**DEAD, "pneumatics.driving_pressures_kPa": [5.0]})
    scene, sensor = evaluation.scene, evaluation.sensor
    estimate = known(
        sensor, [5.0 * KPA], scene.membrane_material, [], scene.printer, "atlas", calibration=scene.calibration
    )
    (joint,) = (source for source in estimate.budget.sources if source.name == "calibrated parameters")
    drawn = monte_carlo(estimate.batch, [joint], 0, 2_000)
    k = FIGURES.index("limit_pressure_kPa")
    place_of = estimate.budget.sources.index(joint)
    linear = float(np.sqrt(estimate.budget.variances[place_of, k, 0]))
    assert linear == pytest.approx(drawn.standard[k], rel=0.05)
    by_modulus, by_wall = (estimate.budget.derivatives.elasticities[i, k, 0] for i in (0, 1))
    whole = by_modulus**2 * 9e-4 + by_wall**2 * 1.6e-3 - 2 * by_modulus * by_wall * 6e-4
    assert linear**2 == pytest.approx(whole, rel=0.02)


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
    with pytest.raises(InputError, match="of the models atlas and solid"):
        evaluate("paper-dome@mine", DEAD, model="membrane", library=place)
    with pytest.raises(InputError, match="clamped at the base plane"):
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
        ({**CONTENT, "format": 2}, "this pneutouch reads form 1"),
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


@pytest.mark.parametrize("error", [-0.9, 10.0])
def test_the_widest_file_that_is_taken_gives_finite_figures(error, library, tmp_path):
    content = changed(response={**held(error), "sensitivity_errors_relative": [2.0, 2.0]})
    place = library_of(tmp_path, library, {**content, "covariance": np.diag([4.0, 4.0, 100.0]).tolist()})
    for entry in predicted(place).uncertainty:
        for figure in entry["figures"].values():
            assert figure is None or all(np.isfinite(figure[key]) for key in ("low", "high") if figure.get(key))
        json.dumps(entry, allow_nan=False)


def test_a_prediction_says_where_it_leaves_what_was_measured(library, tmp_path):
    def notes(source, **indentation):
        place = library_of(tmp_path, library, changed(source=source))
        changes = {**DEAD, **{f"indentation.{key}": value for key, value in indentation.items()}}
        lines = predicted(place, changes).prediction.assumptions
        return [line for line in lines if "measured to" in line or "measured with" in line]

    known = {"depth_mm": 3.0, "plate_diameter_mm": 30.0}
    assert notes(known, depth_mm=3.1) == notes({}, depth_mm=3.2, plate_diameter_mm=31.0) == []
    (deep,) = notes(known, depth_mm=3.2)
    assert "measured to a travel of 3 mm; this prediction goes to 3.2 mm" in deep
    (plate,) = notes(known, depth_mm=3.0, plate_diameter_mm=31.0)
    assert "measured with a plate of 30 mm; this prediction is of one of 31 mm" in plate


def test_a_recipe_carries_it_and_is_the_same_again(place, tmp_path):
    from pneutouch.export.threemf_read import Package
    from pneutouch.output.manifest import input_hash

    recipe = BuildRecipe.of(predicted(place))
    assert recipe.inputs()["calibration"]["source"]["digest"] == "ab" * 32
    fields = {field.name: None for field in dataclasses.fields(Package)}
    metadata = {"input-hash": input_hash(recipe.inputs())}
    package = Package(**{**fields, "path": tmp_path / "a.3mf", "recipe": recipe.text(), "metadata": metadata})
    again = evaluate_recipe(read_recipe(package))
    assert BuildRecipe.of(again).text() == recipe.text()
    assert json.dumps(again.prediction.document()) == json.dumps(predicted(place).prediction.document())
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
    from pneutouch.cli.show_text import _recipe

    inputs = {"design": {"calibration": "mine", "membrane": {"material": "TangoPlus", "wall_thickness_mm": None}}}
    inputs |= {"model": None, "closure": None, "clamp": None, "tolerance": None, "compared_resins": []}
    recipe = {"inputs": inputs, "name": "x", "version": "1", "versions": {}, "other_versions": [], "input_hash": "a"}
    text = "\n".join(_recipe(recipe))
    assert "calibration" in text and "mine" in text and "membrane.material" in text and "wall_thickness" not in text


@pytest.mark.parametrize("simulated", [False, True])
def test_text_and_sheet_state_the_specimen_and_that_data_are_simulated(simulated, library, tmp_path):
    from pneutouch.cli.text import prediction_text
    from pneutouch.evaluation.document import full_document
    from pneutouch.evaluation.sheet import sheet_data
    from pneutouch.report.sheet import content_of

    content = changed(source={"simulated": simulated})
    evaluation = predicted(library_of(tmp_path, library, content))
    sensor = content["source"]["sensor"]
    for text in (prediction_text(full_document(evaluation)), content_of(sheet_data(evaluation, ""))["status"]):
        assert f"sensor {sensor}" in text and ("SIMULATED DATA" in text) is simulated
