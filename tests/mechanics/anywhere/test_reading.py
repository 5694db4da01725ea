"""The error of a force that is read by the central calibration, and what an unknown place of contact amounts to."""

from __future__ import annotations

import numpy as np
import pytest
from release.tables.contact.press import DomeState, at_equal_reading, pressed

from pneutouch.mechanics.anywhere.reading import (
    ball_places,
    batch_conditions,
    covered,
    edge_places,
    force_logs,
    outside,
    place_uncertainty,
    plate_places,
    state_conditions,
)
from pneutouch.mechanics.anywhere.table import RECIPE, DomeConditions
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import respond

PAPER = DomeConditions(np.array([0.162, 0.162]), np.array([0.0, 0.55]), np.array([0.18, 0.18]))


def test_a_large_ball_is_a_plate_and_its_offset_a_tilt():
    """A ball of endless radius touches where its normal leans as much as a tilted plate's."""
    radius, tilt = 1e6, np.radians([5.0, 20.0])
    offset = np.sin(tilt) * (1.162 + radius)
    levels = np.full((2, 1), 0.25)
    balls = force_logs(PAPER, ball_places(PAPER.wall_ratio, np.full(2, radius), offset), levels)
    plates = force_logs(PAPER, plate_places(PAPER.wall_ratio, tilt), levels)
    np.testing.assert_allclose(balls, plates, atol=1e-5)


def test_what_an_object_does_not_reach_has_no_force():
    logs = force_logs(PAPER, ball_places(PAPER.wall_ratio, np.array([0.3]), np.zeros(1)), np.array([[0.1, 0.7]] * 2))
    assert np.isfinite(logs[:, 0, 0]).all() and np.isnan(logs[:, 0, 1]).all()


def test_the_uncertainty_is_that_of_samples_of_what_it_assumes():
    draw = np.random.default_rng(3)
    n, ends = 4000, np.array([0.75, 0.75])
    curvature, offset = draw.uniform(0, 1 / 0.3, n), 0.6 * np.sqrt(draw.uniform(0, 1, n))
    levels = np.tile(np.linspace(0.05, 0.75, 8), (2, 1))
    squares = [
        np.nanmean(force_logs(PAPER, places, levels) ** 2, axis=(1, 2))
        for places in (
            ball_places(PAPER.wall_ratio, 1 / curvature, offset),
            plate_places(PAPER.wall_ratio, np.radians(draw.uniform(0, 20, n))),
        )
    ]
    np.testing.assert_allclose(place_uncertainty(PAPER, ends), np.sqrt(sum(squares)), rtol=0.05)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.9])
@pytest.mark.parametrize("wall", [0.06, 0.15, 0.35])
def test_edges_are_off_by_less_than_the_balls_that_are_assumed(wall, share):
    """So the uncertainty of an unknown ball covers an unknown edge of the same radii and places."""
    domes = DomeConditions(np.array([wall]), np.array([share]), np.array([0.1]))
    draw = np.random.default_rng(5)
    radius, offset = 1.0 / draw.uniform(0, 1 / 0.3, 300), 0.6 * np.sqrt(draw.uniform(0, 1, 300))
    levels = np.linspace(0.05, 0.75, 8)[None]
    edges, balls = (
        float(np.nanmean(force_logs(domes, places(domes.wall_ratio, radius, offset), levels) ** 2))
        for places in (edge_places, ball_places)
    )
    assert edges < balls


def test_outside_the_table_it_is_not_known():
    off = DomeConditions(np.array([0.05, 0.162, 0.162, 0.162]), np.array([0.0, 0.95, 0.0, 0.0]), np.array([0.2] * 4))
    assert covered(off).tolist() == [False, False, True, True]
    known = np.isfinite(place_uncertainty(off, np.array([0.75, 0.75, 0.75, 0.03])))
    assert known.tolist() == [False, False, True, False]


def test_the_reason_states_value_and_bounds(paper_sensor):
    batch = batch_of(paper_sensor.replace(ambient_pressure=1.0), [0.0])
    response = respond(batch)
    domes = batch_conditions(batch, response.limit_pressure, np.array([1700.0]))
    why = outside(paper_sensor, domes)
    assert why is not None and "gas stiffness" in why and "0.01 to 0.6" in why
    assert "flange" in str(outside(paper_sensor.replace(flange=(3.0, 2.0)), PAPER))
    assert outside(paper_sensor, PAPER) is None


class State:
    """A predicted state, as far as the variables need one."""

    def __init__(self, driving_pressure, cavity_volume):
        self.driving_pressure, self.cavity_volume = driving_pressure, cavity_volume


def test_the_variables_are_wall_share_of_the_limit_and_bulk_modulus_of_the_gas_over_its_volume(paper_sensor):
    radius, modulus = paper_sensor.dome.inner_radius, paper_sensor.wall.shear_modulus
    sensor, cavity = paper_sensor.replace(dead_volume=500.0), 2 * np.pi / 3 * radius**3
    domes = state_conditions(sensor, [State(0.0, cavity), State(0.012, 1.3 * cavity)], 0.04)
    volume = (np.array([1.0, 1.3]) * cavity + 500.0) / radius**3
    np.testing.assert_allclose(domes.wall_ratio, paper_sensor.dome.wall_thickness / radius)
    np.testing.assert_allclose(domes.share, [0.0, 0.3])
    np.testing.assert_allclose(domes.gas, (np.array([0.0, 0.012]) + 0.101325) / modulus / volume)


@pytest.mark.parametrize(("radius", "offset"), [(0.3, 0.5), (1.0, 0.6), (4.0, 0.6)])
def test_a_ball_next_to_the_axis_first_touches_where_the_wall_leans_as_stated(radius, offset):
    """The least vertical gap between the ball's underside and the outer hemisphere, point by point."""
    outer = 1.0 + PAPER.wall_ratio[0]
    x = np.linspace(max(0.0, offset - radius), min(outer, offset + radius), 2_000_001)[1:-1]
    gap = -np.sqrt(radius**2 - (x - offset) ** 2) - np.sqrt(outer**2 - x**2)
    places = ball_places(PAPER.wall_ratio, np.array([radius]), np.array([offset]))
    assert places.lean[0, 0] == pytest.approx(x[gap.argmin()] / outer, abs=1e-5)
    assert places.curvature[0, 0] == pytest.approx(1.0 / radius)


def test_with_balls_as_flat_as_plates_the_uncertainty_is_that_of_the_tilt(monkeypatch):
    monkeypatch.setattr("pneutouch.mechanics.anywhere.reading.SMALLEST_BALL", 1e9)
    tilts, levels = np.radians((np.arange(200) + 0.5) / 10.0), np.tile(np.linspace(0.05, 0.75, 8), (2, 1))
    of_tilts = np.sqrt(np.nanmean(force_logs(PAPER, plate_places(PAPER.wall_ratio, tilts), levels) ** 2, axis=(1, 2)))
    assert (of_tilts > 0.005).all()
    np.testing.assert_allclose(place_uncertainty(PAPER, np.array([0.75, 0.75])), of_tilts, rtol=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("wall", [0.07, 0.2])
def test_ambient_pressure_and_dead_volume_enter_by_the_gas_stiffness_alone(wall, monkeypatch):
    """The same stiffness from little air at a low pressure and from much at a high one: one force at equal reading."""
    logs = []
    for ambient in (0.05, 0.8):
        monkeypatch.setattr("release.tables.contact.press._AMBIENT", ambient)
        state = DomeState(wall, 0.1, 0.1)
        plate, ball = (pressed(RECIPE, state, curvature, 0.0) for curvature in (0.0, 2.0))
        logs.append(at_equal_reading(RECIPE, plate, ball)[0])
    known = np.array(RECIPE.levels) <= 0.4
    assert np.abs(logs[0]).max() > 0.2
    np.testing.assert_allclose(logs[0][known], logs[1][known], atol=0.02)
