"""Intervals under friction and other objects: against differences of the solid with the contact itself."""

from __future__ import annotations

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch.evaluation import evaluate
from pneutouch.evaluation.charts import curve, under_contact
from pneutouch.evaluation.result import by_model
from pneutouch.evaluation.uncertainty import spread, uncertainties
from pneutouch.mechanics.atlas.coverage import under_plate
from pneutouch.mechanics.atlas.figures import CONTACT_FIGURES, DEAD, FIGURES, INPUTS, SENSITIVITY, log_figures
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.corrected import figures as corrected
from pneutouch.mechanics.corrected.figures import CorrectedAtlas, state_logs
from pneutouch.mechanics.models.solid import solid_states
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.solid.indenter import ball, cone
from pneutouch.mechanics.uncertainty.contact_model import SPREAD, ContactModel
from pneutouch.results.record import plain as data
from pneutouch.spec.material import Material
from pneutouch.units import KPA

STATED = "sensitivity_kPa_per_N"


def logs(sensor: Sensor, pressure: float) -> np.ndarray:
    """Logarithms of the figures that depend on the contact."""
    (state,) = solid_states(sensor, np.array([pressure]))
    found = state.figures
    return np.log([found.sensitivity, found.stiffness, found.force_range[1], state.range_end])


@pytest.fixture(scope="module")
def rough():
    changes = {
        "contact.friction": 0.5,
        "membrane.material": "FLX9970",
        "pneumatics.driving_pressures_kPa": [0.0, 22.0],
        "indentation.depth_mm": 4.0,
    }
    return evaluate("paper-dome", changes)


@pytest.mark.slow
def test_an_unknown_coefficient_has_the_share_that_the_solid_gives_it(rough):
    said = data(rough.uncertainty[0])
    (source,) = [one for one in said["sources"] if one["name"] == "friction" and STATED in one["figures"]]
    half, double = (logs(rough.sensor.replace(friction=f), 0.0)[0] for f in (0.5 / SPREAD, 0.5 * SPREAD))
    assert half - double > 0.05
    # even in the logarithm between both ends, to which ln S bends little
    assert source["standard_uncertainty"] == pytest.approx((half - double) / math.sqrt(12), rel=0.1)
    assert not source["known"]
    slope = (double - half) / (2 * math.log(SPREAD))
    assert said["elasticities"][STATED]["friction"] == pytest.approx(slope, rel=0.1)
    assert said["figures"][STATED]["shares"]["friction"] > 0.01
    figure = said["figures"][STATED]
    assert figure["value"] == pytest.approx(rough.prediction.states[0].figures.sensitivity, rel=1e-5)
    assert figure["low"] < figure["value"] < figure["high"]
    assert "friction" not in next(note for note in said["notes"] if note.startswith("not in the budget"))


@pytest.mark.slow
def test_the_derivative_by_the_modulus_is_the_solids_with_friction(rough):
    pressure = 22 * KPA
    more, less = (
        logs(rough.sensor.replace(shear_modulus=f * rough.sensor.wall.shear_modulus), pressure)[0]
        for f in (math.exp(0.1), math.exp(-0.1))
    )
    found = data(rough.uncertainty[1])["elasticities"][STATED]["shear_modulus"]
    assert found == pytest.approx((more - less) / 0.2, abs=0.02)
    assert any(note.startswith("the contact has friction (0.5)") for note in data(rough.uncertainty[1])["notes"])


def test_the_figures_are_in_the_units_of_a_prediction(evaluated):
    answer = evaluated("paper-dome", model="atlas")
    found = np.exp(log_figures(batch_of(under_plate(answer.sensor), (22 * KPA,)))[:, 0])
    (state,) = [one for one in data(by_model(answer.prediction))["states"] if one["driving_pressure_kPa"] == 22.0]
    limit_kPa = data(by_model(answer.prediction))["limit_point"]["driving_pressure_kPa"]
    assert found[:2] == pytest.approx([state["sensitivity_kPa_per_N"], limit_kPa], rel=1e-6)


def test_the_shift_of_a_contact_is_taken_at_a_softer_and_a_stiffer_wall(evaluated):
    """The softer wall first: the change by the modulus enters with its own sign at either end."""
    sensor = evaluated("paper-dome", model="atlas").sensor
    modulus, shape = sensor.wall.shear_modulus, (len(FIGURES), 2)
    plate = log_figures(batch_of(under_plate(sensor), (0.0, 22 * KPA)))
    stub = SimpleNamespace(
        sensor=sensor,
        pressures=(0.0, 22 * KPA),
        logs=plate + 0.5,
        plate=lambda pressures: plate,
        _change=lambda moved: np.full(shape, moved.wall.shear_modulus / modulus),
    )
    nodes = ContactModel.shift(stub, 0.3).nodes[:, list(CONTACT_FIGURES)]
    expected = 0.5 + np.array([math.exp(-0.3), 0.0, math.exp(0.3)])
    np.testing.assert_allclose(nodes, np.broadcast_to(expected[:, None, None], nodes.shape))


@pytest.mark.slow
def test_the_ratio_makes_the_plates_figures_those_of_the_contact(evaluated):
    """At the pressures that are solved, and in its logarithm straight between them."""
    sensor, pressures = (
        evaluated("paper-dome", model="atlas").sensor.replace(friction=0.6, steps=6),
        (0.0, 0.011, 0.022),
    )
    found = CorrectedAtlas(sensor, pressures, least=2)
    solved = state_logs(solid_states(sensor, np.array([pressures[0], pressures[2]])))
    contact = found.ratio + found.plate(pressures)
    rows = list(CONTACT_FIGURES)
    assert contact[rows][:, [0, 2]] == pytest.approx(solved[rows], abs=1e-9)
    assert found.ratio[rows, 1] == pytest.approx(0.5 * (found.ratio[rows, 0] + found.ratio[rows, 2]), abs=1e-9)


@pytest.mark.parametrize(
    ("top_kPa", "tried"), [(99.0, [(0, 30)]), (25.0, [(0, 30), (0, 20)]), (5.0, [(0, 30), (0, 20), (0, 10), (0,)])]
)
def test_the_ends_are_solved_and_the_highest_left_out_where_it_is_not_reached(monkeypatch, evaluated, top_kPa, tried):
    asked = []

    def logs_of(sensor, pressures):
        asked.append(tuple(round(p / KPA) for p in pressures))
        return np.full((len(FIGURES), len(pressures)), 0.0 if max(pressures) <= top_kPa * KPA else np.nan)

    monkeypatch.setattr(corrected, "pressed_logs", logs_of)
    sensor = evaluated("paper-dome", model="atlas").sensor
    corrected.solved_at(sensor, [p * KPA for p in (0, 10, 20, 30)], [], least=2)
    assert asked == tried


@pytest.mark.slow
@pytest.mark.parametrize(("modulus", "friction"), [(0.17, 0.6), (0.27, 0.3)])
def test_between_the_pressures_that_are_solved_the_derivatives_are_the_solids(evaluated, modulus, friction):
    """In the middle of the driving pressures, of which the ends alone are solved where ranges end at the depth. The
    greatest differences found are 0.006 for the sensitivity and 0.009 for stiffness and force, where d ln S / d ln
    modulus is 0.1 and the modulus is known to 40 %."""
    base = evaluated("paper-dome", model="atlas").sensor
    sensor = base.replace(friction=friction, shear_modulus=modulus, waves=0)
    middle, half = 11 * KPA, 0.35
    nodes = ContactModel(sensor, (0.0, middle, 22 * KPA)).shift(half).nodes
    found = (nodes[2] - nodes[0])[list(CONTACT_FIGURES), 1] / (2 * half)
    up, down = (sensor.replace(shear_modulus=modulus * math.exp(x)) for x in (half, -half))
    plates = [log_figures(batch_of(under_plate(one), (middle,)))[list(CONTACT_FIGURES), 0] for one in (up, down)]
    direct = (logs(up, middle) - logs(down, middle) - (plates[0] - plates[1])) / (2 * half)
    assert np.abs(direct[:3]).max() > 0.02
    np.testing.assert_allclose(found[0], direct[0], atol=0.01)
    np.testing.assert_allclose(found[1:3], direct[1:3], atol=0.015)


@pytest.mark.slow
def test_the_limit_pressure_and_the_height_know_of_no_friction(rough):
    smooth = evaluate("paper-dome", {"membrane.material": "FLX9970", "pneumatics.driving_pressures_kPa": [22.0]})
    for name in ("limit_pressure_kPa", "apex_height_outer_mm"):
        own, other = (data(one.uncertainty[-1])["figures"][name] for one in (rough, smooth))
        assert own["low"] == pytest.approx(other["low"], rel=1e-5)
        assert own["high"] == pytest.approx(other["high"], rel=1e-5)
    assert not any(source["name"] == "friction" for source in data(smooth.uncertainty[0])["sources"])
    assert any("misalignment, friction" in note for note in data(smooth.uncertainty[0])["notes"])


@pytest.mark.slow
def test_the_tuning_curve_passes_through_the_solids_states(rough):
    drawn = curve(under_plate(rough.sensor), 30 * KPA, "here")
    bent = under_contact(rough.sensor, drawn, rough.prediction.states)
    for pressure in (5 * KPA, 20 * KPA):
        found = np.interp(pressure / KPA, bent.driving_pressure_kPa, bent.sensitivity)
        plate = np.interp(pressure / KPA, drawn.driving_pressure_kPa, drawn.sensitivity)
        exact = math.exp(logs(rough.sensor, pressure)[0])
        assert found == pytest.approx(exact, rel=0.01)
        assert plate / exact - 1 > 0.04


@pytest.mark.slow
def test_samples_of_the_same_sources_give_nearly_the_same_interval_with_friction(rough):
    for said in map(data, uncertainties(rough.prediction, rough.sensor, rough.scene, lambda: rough.resins, 3000)):
        own, drawn = said["figures"][STATED], said["monte_carlo"]["figures"][STATED]
        assert np.log(drawn["high"] / drawn["low"]) == pytest.approx(np.log(own["high"] / own["low"]), rel=0.12)


def solid_slopes(sensor: Sensor, pressure: float, slopes: np.ndarray) -> np.ndarray:
    """Slopes (inputs, figures, 1), each by differences of the solid with the contact where it is not 0."""
    rows, slopes = list(CONTACT_FIGURES), slopes.copy()
    here = logs(sensor, pressure)
    steps = {"shear_modulus": 0.35, "wall_thickness": 0.066, "inner_radius": 0.02, "ambient_pressure": 0.02}
    parts = {"shear_modulus": "wall", "ambient_pressure": "gas"}
    for name, step in steps.items():
        value = getattr(getattr(sensor, parts.get(name, "dome")), name)
        up, down = (logs(sensor.replace(**{name: value * math.exp(x)}), pressure) for x in (step, -step))
        slopes[INPUTS.index(name), rows, 0] = (up - down) / (2 * step)
    slopes[DEAD, rows, 0] = (logs(sensor.replace(dead_volume=sensor.gas.dead_volume + 100.0), pressure) - here) / 100
    up, down = (logs(sensor, pressure * f) for f in (1.02, 0.98))
    slopes[INPUTS.index("driving_pressure"), rows, 0] = (up - down) / (2 * math.log(1.02))
    return slopes


CONTACTS = {
    "friction 0.3": {"friction": 0.3},
    "friction 1": {"friction": 1.0},
    "grip": {"friction": np.inf},
    "ball": {"body": ball(9.25)},
    "small ball": {"body": ball(4.6)},
    "cone": {"body": cone(math.radians(70), 2.0)},
}


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("contact", CONTACTS)
def test_the_interval_is_that_of_all_derivatives_by_the_solid(evaluated, library, contact, seed):
    draw = np.random.default_rng([seed, list(CONTACTS).index(contact)])
    base = evaluated("paper-dome", model="atlas")
    wall, modulus = float(draw.uniform(0.09, 0.24)), float(np.exp(draw.uniform(np.log(0.15), np.log(3.0))))
    sensor = base.sensor.replace(
        wall_thickness=wall * 9.25,
        shear_modulus=modulus,
        dead_volume=float(draw.uniform(0, 1500)),
        depth=float(draw.uniform(0.4, 0.7)) * 9.25,
        waves=0,
        **CONTACTS[contact],
    )
    pressure = float(draw.uniform(0.05, 0.3)) * wall * modulus
    materials = list(library.all("materials", Material).values())
    scene = base.scene
    budget = spread(sensor, [pressure], scene.membrane_material, materials, scene.printer, "solid").combined().budget
    slopes = solid_slopes(sensor, pressure, budget.derivatives.slopes)
    exact = np.sqrt(sum(source.variance(slopes) for source in budget.sources))
    assert budget.standard[SENSITIVITY, 0] == pytest.approx(exact[SENSITIVITY, 0], rel=0.03)
    for name in ("stiffness_N_per_mm", "force_at_range_end_N"):
        figure = FIGURES.index(name)
        assert budget.standard[figure, 0] == pytest.approx(exact[figure, 0], rel=0.08)


@pytest.mark.slow
def test_a_prediction_already_solved_is_not_solved_again(rough, monkeypatch):
    """The contact is solved at two moduli and two coefficients alone."""
    solved = []
    import pneutouch.mechanics.models.solid as module

    original = module.solid_states
    monkeypatch.setattr(module, "solid_states", lambda *given: solved.append(given[0]) or original(*given))
    short = dataclasses.replace(rough.prediction, states=rough.prediction.states[:1])
    uncertainties(short, rough.sensor, rough.scene, lambda: rough.resins)
    kinds = [
        (one.protocol.friction == 0.5, one.wall.shear_modulus == rough.sensor.wall.shear_modulus) for one in solved
    ]
    assert sorted(kinds) == [(False, True), (False, True), (True, False), (True, False)]
