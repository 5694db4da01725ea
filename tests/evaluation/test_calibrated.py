"""A calibration in a design: whose parameters, curves and uncertainty the prediction then has."""

from __future__ import annotations

import json

import numpy as np
import pytest

from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.uncertainty import spread
from pneutouch.mechanics.atlas.figures import FIGURES
from pneutouch.mechanics.uncertainty.document import monte_carlo
from pneutouch.results.record import SENSITIVITY_KEY as SENSITIVITY
from pneutouch.results.record import plain as data
from pneutouch.units import KPA, ML
from tests.evaluation.calibrated import (
    AT,
    CONTENT,
    DEAD,
    HIGH,
    LOW,
    MODULUS,
    VOLUME,
    WALL,
    changed,
    held,
    library_of,
    predicted,
)


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
        assert state.figures.sensitivity == pytest.approx(before.figures.sensitivity * rise / force, rel=1e-12)
        assert state.figures.stiffness == pytest.approx(before.figures.stiffness * force, rel=1e-12)
        assert state.range_end == before.range_end


def test_the_uncertainty_is_the_calibrations(place):
    old = data(evaluate("paper-dome", AT, model="atlas", library=place).uncertainty)
    new = data(predicted(place).uncertainty)
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
    there, far = map(data, predicted(library_of(tmp_path, library, content), at).uncertainty)
    plain = data(evaluate("paper-dome", at, model="atlas", library=library).uncertainty[1])

    def standard(entry):
        return {source["name"]: source["standard_uncertainty"] for source in entry["sources"]}.get("model", 0.0)

    assert standard(there) == 0.0
    assert standard(far) == pytest.approx(np.sqrt(2 * (1 - 0.745)) * standard(plain), rel=1e-5)
    inner, near = (entry["figures"][SENSITIVITY]["at_calibration"] for entry in (far, there))
    assert np.log(inner["high"] / inner["low"]) > 2 * np.log(near["high"] / near["low"])
    assert np.log(inner["high"] / inner["low"]) >= 4 * standard(far)


@pytest.mark.parametrize("error", [0.01, 0.03])
def test_the_scatter_of_the_runs_and_the_gauges_of_the_rig_are_in_the_interval(error, library, tmp_path):
    place = library_of(tmp_path, library, changed(response={"sensitivity_errors_relative": [error, error]}))
    (entry,) = map(data, predicted(place, {**DEAD, "pneumatics.driving_pressures_kPa": [12.0]}).uncertainty)
    sources = {s["name"]: s["standard_uncertainty"] for s in entry["sources"] if SENSITIVITY in s["figures"]}
    figure = entry["figures"][SENSITIVITY]
    stated = {"model as calibrated": error}
    # Assumed: 2 % of the pressure and 1 % of the force, as limits of a rectangular distribution.
    stated |= {"pressure gauge of the rig": 0.02 / np.sqrt(3), "force sensor of the rig": 0.01 / np.sqrt(3)}
    for name, standard in stated.items():
        assert sources[name] == pytest.approx(standard, rel=1e-4)
        counted = figure["standard_uncertainty_relative"] ** 2 * figure["shares"][name]
        assert counted == pytest.approx(standard**2, rel=0.01)


@pytest.mark.parametrize("freedom", [2.0, 0.0])
def test_few_degrees_of_freedom_of_the_runs_are_those_of_the_figure(freedom, library, tmp_path):
    """0 stands for an assumed scatter, which has none (JCGM 100, G.4.3) and is not known."""
    content = changed(response={"errors_freedom": freedom}, source={"age_days": 400.0})
    place = library_of(tmp_path, library, content)
    (entry,) = map(data, predicted(place, {**DEAD, "pneumatics.driving_pressures_kPa": [12.0]}).uncertainty)
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
        sources = data(predicted(place, DEAD).uncertainty[0])["sources"]
        standards[age] = {source["name"]: source["standard_uncertainty"] for source in sources}
    for age, share in ages.items():
        assert standards[age].get("ageing", 0.0) == pytest.approx(share * standards[0.0]["ageing"])


def test_correlated_parameters_spread_as_samples_of_them_do(place):
    """The limit pressure follows modulus and wall, whose errors cancel in part: 2000 samples agree within 5 %."""
    evaluation = predicted(place, {**DEAD, "pneumatics.driving_pressures_kPa": [5.0]})
    scene, sensor = evaluation.scene, evaluation.sensor
    estimate = spread(
        sensor, [5.0 * KPA], scene.membrane_material, [], scene.printer, "atlas", calibration=scene.calibration
    ).combined()
    (joint,) = (source for source in estimate.budget.sources if source.name == "calibrated parameters")
    root = np.array([joint.loads[name] for name in ("shear_modulus", "wall_thickness", "dead_volume")])
    # Logarithms of modulus and wall; the dead volume in mm3, which the file has in mL.
    np.testing.assert_allclose(root @ root.T, np.array(CONTENT["covariance"]) * np.outer(*[[1, 1, ML]] * 2), atol=1e-9)
    drawn = monte_carlo(estimate.batch, [joint], 0, 2_000)
    k = FIGURES.index("limit_pressure_kPa")
    place_of = estimate.budget.sources.index(joint)
    linear = float(np.sqrt(estimate.budget.variances[place_of, k, 0]))
    assert linear == pytest.approx(drawn.standard[k], rel=0.05)
    by_modulus, by_wall = (estimate.budget.derivatives.elasticities[i, k, 0] for i in (0, 1))
    whole = by_modulus**2 * 9e-4 + by_wall**2 * 1.6e-3 - 2 * by_modulus * by_wall * 6e-4
    assert linear**2 == pytest.approx(whole, rel=0.02)


@pytest.mark.parametrize("error", [-0.9, 10.0])
def test_the_widest_file_that_is_taken_gives_finite_figures(error, library, tmp_path):
    content = changed(response={**held(error), "sensitivity_errors_relative": [2.0, 2.0]})
    place = library_of(tmp_path, library, {**content, "covariance": np.diag([4.0, 4.0, 100.0]).tolist()})
    for entry in map(data, predicted(place).uncertainty):
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
