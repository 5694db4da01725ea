"""Campaigns of a sensor that was pressed with friction: by the solid, fitted by the corrected atlas."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.calibrate.fit import fit, identify
from pneutouch.bench.calibrate.fitted_atlas import FittedContact
from pneutouch.bench.calibrate.goodness import misses
from pneutouch.bench.calibrate.observations import Observations
from pneutouch.bench.calibrate.parameters import FRICTION, MODULUS, NAMES, USUAL, parse_names
from pneutouch.catalogue import load_scene
from pneutouch.errors import InputError
from pneutouch.mechanics.corrected.figures import GRIPS
from pneutouch.mechanics.models.solid import solid_states
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.units import KPA
from pneutouch.workflows.calibrate.calibration_files import CampaignSource, savable
from pneutouch.workflows.calibrate.fit import calibrate
from tests.bench.calibrate.sensors import chosen, disturbed

TRUTH = {"shear_modulus": 0.8, "dead_volume": 400.0, "friction": 0.5}
SOURCE = CampaignSource("ab" * 32)


def sensor_of(library):
    return material_sensor(library.load("materials", "FLX9960")).replace(waves=0, dead_volume=300.0)


def campaign(library, pressures_kPa, runs, depth=5.5, steps=11, **truth) -> Observations:
    """Runs of the solid's sensor with gains, zeros and noise."""
    true = sensor_of(library).replace(break_stretch=None, gauge_limit=np.inf, depth=depth, steps=steps, **truth)
    rng = np.random.default_rng(3)
    states = solid_states(true, np.array(pressures_kPa) * KPA)
    pairs = [(p, state, n) for p, state in zip(pressures_kPa, states, strict=True) for n in range(runs)]
    return Observations(
        tuple(disturbed(s.indentation, s.force, s.pressure_rise, p, n + 1, rng, 0.004) for p, s, n in pairs)
    )


def test_friction_is_not_fitted_unless_it_is_named(library):
    assert parse_names(USUAL) == (0, 1, 2, 3)
    usual = chosen(library, *USUAL)
    assert usual.frictions == () and usual.prior_spread[FRICTION] == 0.0 and FRICTION not in usual.others
    named = chosen(library, *NAMES)
    assert named.frictions[0] == 0.0 and named.frictions[-1] == GRIPS and FRICTION in named.fitted
    rough = chosen(library, *USUAL, sensor=sensor_of(library).replace(friction=np.inf))
    assert rough.start[FRICTION] == GRIPS and FRICTION in rough.others


def test_sensors_differ_by_the_greatest_change_of_modulus_wall_or_gas_volume(library):
    sensor = sensor_of(library)
    cavity = 2 * np.pi / 3 * sensor.dome.inner_radius**3
    here = FittedContact(sensor, (0.0, GRIPS), ())

    def other(**changes):
        return FittedContact(sensor.replace(**changes), (0.0, GRIPS), ())

    assert here.distance(here) == 0.0
    assert here.distance(other(shear_modulus=1.3 * sensor.wall.shear_modulus)) == pytest.approx(np.log(1.3))
    assert here.distance(other(wall_thickness=0.9 * sensor.dome.wall_thickness)) == pytest.approx(-np.log(0.9))
    more = np.log((cavity + 800.0) / (cavity + 300.0))
    assert here.distance(other(dead_volume=800.0)) == pytest.approx(more, rel=1e-6)


@pytest.mark.slow
def test_a_design_with_friction_is_fitted_with_it(library):
    """The friction held at the true one: the modulus comes out, although the design's was 14 % off."""
    seen = campaign(library, (0.0,), 3, **TRUTH)
    design = sensor_of(library).replace(friction=0.5, dead_volume=400.0)
    found = fit(seen, design, chosen(library, "modulus", "offset", sensor=design))
    assert found.contact is not None
    assert found.full[MODULUS] == pytest.approx(np.log(0.8), abs=found.half_width[0])
    assert found.full[MODULUS] == pytest.approx(np.log(0.8), abs=0.02)
    # the ratio was taken where the fit ended
    assert found.contact.centre.wall.shear_modulus == pytest.approx(float(np.exp(found.full[MODULUS])), rel=0.05)


@pytest.fixture(scope="module")
def whole(library):
    """All that a campaign of three pressures has."""
    scene = load_scene("paper-dome", {"membrane.material": "FLX9960", "pneumatics.dead_volume_mL": 0.3}, library)
    return scene, campaign(library, (0.0, 12.0, 22.0), 3, **TRUTH)


@pytest.mark.slow
def test_the_interval_of_a_fitted_friction_holds_the_truth_and_is_saved(whole):
    scene, seen = whole
    made = calibrate(seen, scene, NAMES, sensor="A1")
    (friction,) = [one for one in made.record.estimates if one.key == "friction"]
    low, high = friction.interval_95
    assert low < 0.5 < high and low >= 0.0 and high <= GRIPS
    assert high - low < 1.0
    content = savable(made, SOURCE)
    (kept,) = [one for one in content["parameters"] if one["key"] == "friction"]
    assert kept["fitted"] and kept["covered"] and kept["value"] == pytest.approx(friction.value, rel=1e-6)


@pytest.mark.slow
def test_without_friction_the_fit_of_the_same_runs_says_that_the_model_deviates(whole):
    scene, seen = whole
    made = calibrate(seen, scene, USUAL, sensor="A1")
    assert misses(made.fit)
    assert any(note.startswith("the model deviates in all runs alike") for note in made.notes_for_reader)
    assert all(one["key"] != "friction" for one in savable(made, SOURCE)["parameters"])


@pytest.mark.slow
def test_a_shallow_press_does_not_determine_the_friction_and_saves_no_calibration(library, whole):
    scene, _ = whole
    seen = campaign(library, (0.0,), 2, depth=1.0, steps=5, **TRUTH)
    made = calibrate(seen, scene, NAMES, sensor="A1")
    left = identify(made.fit)
    groups = {k for group in left.ambiguities for k in group.members}
    assert FRICTION in left.unseen or FRICTION in groups or made.fit.solution.bound[-1]
    with pytest.raises(InputError, match="friction"):
        savable(made, SOURCE)
