"""A pressure left out is predicted by the others; the truth is the solid's, which is not the model that is fitted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.bench.calibrate.fit import fit
from pneutouch.bench.calibrate.notes import predict_held_out
from pneutouch.bench.calibrate.observations import Observations
from pneutouch.bench.calibrate.parameters import DEAD, MODULUS
from pneutouch.mechanics.models.solid import solid_result
from tests.bench.calibrate.sensors import DESIGNED, chosen, curves, disturbed, other
from tests.refusals import refused


@pytest.fixture(scope="module")
def solid_curves():
    truth = other(shear_modulus=0.2, dead_volume=1300.0)
    rng = np.random.default_rng(12)
    states = solid_result(truth, np.array([0.0, 0.012, 0.022])).states
    at = np.linspace(0.0, 6.5, 14)
    return tuple(
        disturbed(
            at, np.interp(at, s.indentation, s.force), np.interp(at, s.indentation, s.pressure_rise), p, n, rng, 0.002
        )
        for s, p in zip(states, (0.0, 12.0, 22.0), strict=True)
        for n in (1, 2)
    )


def test_the_solids_parameters_come_back(library, solid_curves):
    result = fit(Observations(solid_curves), DESIGNED, chosen(library, "modulus", "dead-volume"))
    assert np.exp(result.full[MODULUS]) == pytest.approx(0.2, rel=0.01)
    assert result.full[DEAD] == pytest.approx(1300.0, abs=40.0)


@pytest.mark.parametrize("pressure", [0.0, 12.0, 22.0])
def test_a_pressure_left_out_is_predicted(library, solid_curves, pressure):
    result = predict_held_out(Observations(solid_curves), DESIGNED, chosen(library, "modulus", "dead-volume"), pressure)
    assert abs(result.sensitivity_error) < 0.015
    assert result.force_rms_share < 0.015
    assert result.pressure_rms_share < 0.015
    assert result.force_greatest_share >= result.force_rms_share
    assert (result.points, result.points_left_out) == (26, 0)


def test_the_greatest_errors_of_force_and_rise_are_those_of_the_points_that_are_off(library, solid_curves):
    """One force of one run is 10 % of full scale too high, one pressure of another 20 % too low."""
    spoilt = list(solid_curves)
    first, second = (k for k, one in enumerate(solid_curves) if one.driving == 0.0)
    force, rise = solid_curves[first].force.copy(), solid_curves[second].rise.copy()
    force[9] += 0.1 * force.max()
    rise[9] -= 0.2 * rise.max()
    spoilt[first], spoilt[second] = replace(spoilt[first], force=force), replace(spoilt[second], rise=rise)
    names = chosen(library, "modulus", "dead-volume")
    result = predict_held_out(Observations(tuple(spoilt)), DESIGNED, names, 0.0)
    assert (result.force_greatest_share, result.pressure_greatest_share) == (
        pytest.approx(0.1, abs=0.02),
        pytest.approx(0.2, abs=0.02),
    )


def test_the_prediction_is_better_than_the_designs(library, solid_curves):
    """The design has the wrong modulus and dead volume; the fit to the other pressures mends it."""
    held = predict_held_out(Observations(solid_curves), DESIGNED, chosen(library, "modulus", "dead-volume"), 22.0)
    stiff = chosen(library, "offset")
    assert abs(held.sensitivity_error) < 0.3 * abs(
        predict_held_out(Observations(solid_curves), DESIGNED, stiff, 22.0).sensitivity_error
    )


def test_what_cannot_be_held_out_is_refused(library):
    parameters = chosen(library, "modulus")
    seen = curves(DESIGNED, (22.0,), 3, np.random.default_rng(1))
    with refused("hold_out_kPa", 12.0):
        predict_held_out(Observations(seen), DESIGNED, parameters, 12.0)
    with refused("hold_out_kPa", 22.0):
        predict_held_out(Observations(seen), DESIGNED, parameters, 22.0)
