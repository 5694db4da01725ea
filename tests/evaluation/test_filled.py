"""Intervals by the solid's derivatives: of states by injected gas or by a height, of a vacuum, of uncovered sensors."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.evaluation import evaluate
from pneutouch.evaluation.filled import driven_uncertainties
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from tests.evaluation.calibrated import AT, predicted

PRESSURE, APEX = "driving_pressure_kPa", "apex_height_outer_mm"
INJECTED, HEIGHTS = "pneumatics.injected_volumes_mL", "pneumatics.apex_heights_mm"


def known(evaluation):
    return [record.known for record in evaluation.filled_uncertainty]


@pytest.fixture(scope="module")
def dome():
    """The vented dome, and one filled beyond its limit point; the dome at a height."""
    return evaluate("paper-dome", {INJECTED: [0.0, 6.0], HEIGHTS: [13.0], "indentation.depth_mm": 5.5})


def test_the_vented_dome_has_the_interval_that_the_atlas_gives_at_no_pressure(dome):
    """Two ways to the same derivatives: the solid's here, the atlas's for driving pressures."""
    filled, usual = known(dome)[0], dome.uncertainty[0].known
    for figure, close in ((SENSITIVITY_KEY, 2e-3), (STIFFNESS_KEY, 0.02), (APEX, 1e-3)):
        ends = np.log([filled[figure].low / usual[figure].low, filled[figure].high / usual[figure].high])
        assert np.abs(ends).max() < close
    assert PRESSURE not in filled


def test_what_is_given_is_exact_and_what_follows_has_an_interval(dome):
    beyond, at_height = known(dome)[1:]
    assert at_height[APEX].high == pytest.approx(at_height[APEX].low, rel=1e-6)
    for figures in (beyond, at_height):
        assert figures[PRESSURE].low < 0.8 * figures[PRESSURE].value < figures[PRESSURE].value
    assert beyond[APEX].high > 1.05 * beyond[APEX].low


def test_the_pressure_at_a_height_follows_the_modulus(dome):
    """Without gas behind it a membrane's pressure at a height is proportional to the modulus."""
    slope = dome.filled_uncertainty[2].elasticities[PRESSURE]["shear_modulus"]
    assert slope == pytest.approx(1.0, abs=0.01)


def test_a_vacuum_and_another_contact_have_no_interval_of_the_pressure():
    vacuum = evaluate("paper-dome", {INJECTED: [-0.3]})
    assert PRESSURE not in known(vacuum)[0]
    assert APEX in known(vacuum)[0]
    gripping = evaluate("paper-dome", {INJECTED: [1.0], "contact.friction": 0.5, "indentation.depth_mm": 3.0})
    assert gripping.filled_uncertainty[0].unknown == gripping.sensor.protocol.other_contact


@pytest.mark.parametrize("name", ["paper-dome", "fingertip-dome"])
def test_two_models_give_the_same_intervals_at_a_driving_pressure(name):
    """The atlas's derivatives and the solid's, which share no code but the sources: half widths in logarithms."""
    evaluation = evaluate(name, {"pneumatics.driving_pressures_kPa": [10.0]})
    (usual,) = evaluation.uncertainty
    resins = list(evaluation.resins.values())
    (other,) = driven_uncertainties(evaluation.prediction, evaluation.sensor, evaluation.scene, resins)
    for figure, close in ((SENSITIVITY_KEY, 0.01), ("limit_pressure_kPa", 1e-3), (STIFFNESS_KEY, 0.05), (APEX, 0.03)):
        one, two = (np.log(said.known[figure].high / said.known[figure].value) for said in (usual, other))
        assert two == pytest.approx(one, rel=close)


def test_a_vacuum_and_a_wall_outside_the_tables_have_intervals():
    vacuum = evaluate("paper-dome", {"pneumatics.driving_pressures_kPa": [-4.0, 0.0]}).uncertainty
    thick = evaluate("paper-dome", {"membrane.wall_thickness_mm": 5.5, "pneumatics.driving_pressures_kPa": [5.0]})
    for record in (*vacuum, *thick.uncertainty):
        figure = record.known[SENSITIVITY_KEY]
        assert figure.low < figure.value < figure.high
    assert vacuum[0].known["limit_pressure_kPa"] == vacuum[1].known["limit_pressure_kPa"]


def test_a_calibrated_sensor_and_an_unknown_contact_keep_their_sources(place):
    """The vented dome of a calibrated sensor: the interval of 0 kPa, a quarter as wide; contact anywhere: wider."""
    calibrated = predicted(place, {**AT, INJECTED: [0.0]})
    drawn = evaluate("paper-dome", {INJECTED: [0.0]})
    anywhere = evaluate("paper-dome", {INJECTED: [0.0], "contact.anywhere": True})
    for evaluation in (calibrated, drawn, anywhere):
        (filled,), usual = known(evaluation), evaluation.uncertainty[0].known
        assert filled[SENSITIVITY_KEY].high == pytest.approx(usual[SENSITIVITY_KEY].high, rel=5e-3)

    def width(evaluation):
        figure = known(evaluation)[0][SENSITIVITY_KEY]
        return np.log(figure.high / figure.low)

    assert width(calibrated) < width(drawn) < 0.9 * width(anywhere)
