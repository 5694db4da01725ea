"""Predictions: limits, events, and what ends a range."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.evaluation.result import by_model
from pneutouch.mechanics import predict as predict_with
from pneutouch.mechanics.membrane import limit_point, limits
from pneutouch.results.record import plain as data
from tests.mechanics.test_contact import PAPER
from tests.mechanics.test_inflation import MODULI

predict = partial(predict_with, model="membrane")


def test_limit_point_is_the_same_stretch_for_every_resin_and_linear_in_the_radius():
    stretches = {limit_point(PAPER.replace(shear_modulus=mu)).thickness_stretch for mu in MODULI.values()}
    assert len(stretches) == 1
    heights = [limit_point(PAPER.replace(inner_radius=r)).apex_inner / r for r in np.linspace(2, 50, 49)]
    assert np.ptp(heights) < 1e-9


@pytest.mark.parametrize(
    ("name", "p_max"), list(zip(MODULI, (41.9, 66.5, 135.6, 224.3, 404.2, 985.9, 1313.7), strict=True))
)
def test_limit_pressures_of_the_seven_resins(name, p_max):
    point = limit_point(PAPER.replace(shear_modulus=MODULI[name]))
    assert 1e3 * point.driving_pressure == pytest.approx(p_max, abs=0.06)


def test_the_limit_that_is_met_first_binds():
    assert limits(PAPER).binding == "limit point"
    stiff = PAPER.replace(shear_modulus=5.33, break_stretch=1.35)
    found = limits(stiff)
    assert found.binding == "gauge range"
    assert found.break_strain is not None
    assert found.gauge < found.break_strain < found.limit_point
    brittle = PAPER.replace(break_stretch=1.1)
    assert limits(brittle).binding == "break strain"
    assert limits(PAPER.replace(break_stretch=3.0)).break_strain is None


def test_break_strain_is_met_at_its_own_stretch():
    from pneutouch.mechanics.membrane import membrane_stretch, relative_height

    brittle = PAPER.replace(break_stretch=1.2)
    p = limits(brittle).break_strain
    assert float(membrane_stretch(relative_height(np.array(p), 9.25, 1.5, 0.17))) == pytest.approx(1.2, rel=1e-9)


def test_range_ends_at_the_gauge_and_figures_stop_there():
    sensor = PAPER.replace(gauge_limit=0.040)
    state = predict("x", sensor, [0.022]).states[0]
    event = next(event for event in state.events if event.kind == "gauge range")
    assert event.ends_range
    assert state.range_end == pytest.approx(event.indentation)
    at = np.interp(event.indentation, state.indentation, state.pressure_rise + 0.022)
    assert at == pytest.approx(0.040, rel=0.02)
    assert state.figures is not None
    assert state.figures.force_range[1] < state.force[-1]


def test_plate_edge_is_detected():
    state = predict("x", PAPER.replace(plate_radius=3.0), [0.022]).states[0]
    assert "plate edge" in [event.kind for event in state.events if event.ends_range]


def test_figures_do_not_jump_when_an_event_passes_a_step():
    pressures = np.linspace(0.0, 0.038, 60)
    found = [state.figures.sensitivity for state in predict("x", PAPER, pressures.tolist()).states]
    steps = np.abs(np.diff(found))
    assert steps.max() < 4 * np.median(steps) + 0.02


def test_more_steps_change_the_sensitivity_little():
    few, many = (predict("x", PAPER.replace(steps=n), [0.022]).states[0].figures.sensitivity for n in (14, 112))
    assert few == pytest.approx(many, rel=0.01)


@pytest.mark.parametrize("words", [{"model": "solidd"}, {"closure": "variation"}])
def test_unknown_model_or_closure_is_an_input_error(words):
    with pytest.raises(InputError, match="unknown"):
        predict_with("x", PAPER, [0.0], **words)


def test_document_is_rounded_and_names_units():
    document = data(by_model(predict("x", PAPER, [0.0, 0.012])))
    state = document["states"][1]
    assert state["driving_pressure_kPa"] == 12.0
    assert state["curve"]["contact_force_N"][0] == 0.0
    assert set(document) >= {"design", "model", "error_estimate", "limit_point", "states", "assumptions"}
    assert set(state) >= {
        "driving_pressure_kPa",
        "apex_height_inner_mm",
        "apex_height_outer_mm",
        "sensitivity_kPa_per_N",
        "r_squared",
        "stiffness_N_per_mm",
        "force_range_N",
        "curve",
        "events",
    }
    assert set(state["curve"]) >= {"indentation_mm", "contact_force_N", "pressure_rise_kPa"}
