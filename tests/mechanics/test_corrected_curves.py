"""The atlas's correction for friction and objects: against presses of the solid that it was not made from."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.mechanics.corrected.curves import NODES, _log_ratio, contact_ratio
from pneutouch.mechanics.corrected.figures import GRIPS
from pneutouch.mechanics.models.solid import solid_states
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.solid.indenter import ball
from pneutouch.units import KPA

DEPTH = 5.5


@pytest.fixture(scope="module")
def sensor(library):
    return material_sensor(library.load("materials", "FLX9960")).replace(
        waves=0, break_stretch=None, gauge_limit=np.inf
    )


def pressed(sensor, pressure, steps=28):
    (state,) = solid_states(sensor.replace(depth=DEPTH, steps=steps), np.array([pressure]))
    return state


def test_the_ratio_makes_the_plates_curve_that_under_friction(sensor):
    """At a depth between its own, and at the driving pressure that it was made at."""
    ratio = contact_ratio(sensor, (0.5,), np.array([12 * KPA]), DEPTH)
    plate, rough = (pressed(one, 12 * KPA, steps=11) for one in (sensor, sensor.replace(friction=0.5)))
    factors = np.exp(ratio.at(np.array([0.5]), np.array([12 * KPA]), plate.indentation[None]))[:, 0]
    force, rise = factors[0] * plate.force, factors[1] * plate.pressure_rise
    assert np.abs(force - rough.force).max() < 0.003 * rough.force.max()
    assert np.abs(rise - rough.pressure_rise).max() < 0.003 * rough.pressure_rise.max()
    assert np.abs(plate.force - rough.force).max() > 0.03 * rough.force.max()


def test_beyond_the_end_of_either_press_the_ratio_is_that_of_the_end():
    travel = np.array([0.0, 1.0, 2.0, 3.0])
    plate = np.array([travel, [1.0, 1.0, 1.0, 1.0], [2.0, 2.0, 2.0, 2.0]])
    short = np.array([travel[:3], [1.0, 2.0, 4.0], [2.0, 6.0, 18.0]])
    found = _log_ratio(short, plate, np.array([1.0, 2.0, 2.5, 9.0]))
    assert found == pytest.approx(np.log([[2.0, 4.0, 4.0, 4.0], [3.0, 9.0, 9.0, 9.0]]))


def test_without_friction_a_plate_is_left_as_it_is(sensor):
    ratio = contact_ratio(sensor, (0.0,), np.array([0.0]), DEPTH)
    assert ratio.logs == pytest.approx(0.0, abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("resin", ["TangoPlus", "FLX9960", "FLX9985"])
def test_between_its_coefficients_the_ratio_is_the_solids(library, resin):
    """Beyond the first tenth of the travel, where forces are a few hundredths of the greatest."""
    one = material_sensor(library.load("materials", resin)).replace(waves=0)
    pressures = np.array([0.0, 12 * KPA])
    ratio = contact_ratio(one, NODES, pressures, DEPTH)
    for friction in (0.17, 0.35, 0.55, 0.85, 1.2, 1.7):
        exact = contact_ratio(one, (friction,), pressures, DEPTH).logs[:, 0]
        found = [ratio.at(np.array([friction]), np.array([p]), ratio.depths[None])[:, 0] for p in pressures]
        gap = np.abs(np.stack(found, axis=1) - exact)[..., 3:]
        assert gap.max() < 0.007


@pytest.mark.slow
@pytest.mark.parametrize("resin", ["TangoPlus", "FLX9960", "FLX9985"])
def test_a_large_coefficient_grips(library, resin):
    one = material_sensor(library.load("materials", resin)).replace(waves=0, gauge_limit=np.inf)
    found = [pressed(one.replace(friction=f), 0.0).figures.sensitivity for f in (GRIPS, np.inf)]
    assert found[0] == pytest.approx(found[1], rel=0.006)


@pytest.mark.slow
@pytest.mark.parametrize("resin", ["TangoPlus", "FLX9960", "FLX9985"])
@pytest.mark.parametrize(
    ("contact", "bound"), [({"friction": 0.5}, 0.04), ({"friction": np.inf}, 0.04), ({"body": ball(9.25)}, 0.2)]
)
def test_nearby_the_ratio_is_nearly_the_same(library, resin, contact, bound):
    """A modulus 1.3 times as large, a wall 7 % thicker, 0.3 mL more air: the sensors that a fit may pass through."""
    one = material_sensor(library.load("materials", resin)).replace(waves=0, **contact)
    friction = (min(one.protocol.friction, GRIPS),)
    here = contact_ratio(one, friction, np.array([0.0]), DEPTH).logs[..., 3:]
    mu, wall = one.wall.shear_modulus, one.dome.wall_thickness
    for moved in ({"shear_modulus": 1.3 * mu}, {"wall_thickness": 1.07 * wall}, {"dead_volume": 300.0}):
        there = contact_ratio(one.replace(**moved), friction, np.array([0.0]), DEPTH).logs[..., 3:]
        assert np.abs(there - here).max() < bound
