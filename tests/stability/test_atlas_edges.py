"""Failure: a table asked beyond what it knows. It must say nothing there, and never disturb its neighbours.

A polynomial goes on beyond the data it was fitted to and answers with nonsense; a look-up that takes many sensors at once
may spread one's NaN over all of them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.mechanics.atlas.respond import BUCKLING, DEPTH, GAUGE, OUTSIDE, AtlasResponse, respond
from pneutouch.mechanics.atlas.table import shipped
from tests.mechanics.atlas.sampled import batch, random_batch

LIMIT = float(shipped().slices(np.array([0.16])).limit_pressure[0])


def silent(found: AtlasResponse, row: int) -> bool:
    """Whether a row says nothing at all of a press."""
    parts = (*found.lines, found.range_end, found.apex_outer, found.cavity_volume, found.max_stretch)
    curves = np.concatenate([found.indentation[row], found.force[row], found.rise[row]])
    return all(np.isnan(part[row]) for part in parts) and bool(np.isnan(curves).all())


OUT = {
    "wall too thin": {"wall_thickness": 0.059},
    "wall too thick": {"wall_thickness": 0.351},
    "paper-thin": {"wall_thickness": 1e-4},
    "solid ball": {"wall_thickness": 5.0},
    "too deep": {"depth": 0.76},
    "gas too stiff": {"ambient_pressure": 1.1},
}


@pytest.mark.parametrize("case", OUT)
def test_outside_the_box_nothing_is_said_and_the_neighbours_answer_as_before(case):
    names = {"wall_thickness": 0.16, "depth": 0.5, "ambient_pressure": 0.6} | OUT[case]
    mixed = {name: [plain, odd, plain] for (name, odd), plain in zip(names.items(), (0.16, 0.5, 0.6), strict=True)}
    found, alone = respond(batch(**mixed)), respond(batch())
    assert found.ends[1] == OUTSIDE and silent(found, 1) and np.isnan(found.limit_pressure[1])
    for row in (0, 2):
        assert found.ends[row] == DEPTH
        assert found.lines.sensitivity[row] == pytest.approx(alone.lines.sensitivity[0], rel=1e-6)
        assert found.force[row] == pytest.approx(alone.force[0], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("share", [1.0, 1.0001, 1.5, 100.0])
def test_beyond_the_limit_point_nothing_is_said_but_the_limit(share):
    found = respond(batch(driving_pressure=[0.5 * LIMIT, share * LIMIT]))
    assert silent(found, 1) and not silent(found, 0)
    assert found.limit_pressure == pytest.approx(LIMIT, rel=1e-12)


ODD = {"wall_thickness": -0.16, "ambient_pressure": -0.1, "driving_pressure": -0.01, "depth": -0.5, "dead_volume": -2.0}


@pytest.mark.parametrize("name", ODD)
@pytest.mark.parametrize("nan", [False, True])
def test_what_is_no_sensor_is_told_nothing_and_its_neighbours_answer_as_before(name, nan):
    """Suction, negative sizes and NaN: a table of the blown dome knows nothing of them."""
    alone = respond(batch())
    plain = getattr(batch(), name)[0]
    found = respond(batch(**{name: [plain, np.nan if nan else ODD[name], plain]}))
    assert found.ends[1] == OUTSIDE and silent(found, 1)
    assert found.lines.sensitivity[[0, 2]] == pytest.approx(alone.lines.sensitivity[0], rel=1e-6)


def test_just_below_the_limit_point_there_is_an_answer():
    found = respond(batch(driving_pressure=(np.array([0.97, 0.99, 0.999, 0.9999]) * LIMIT).tolist(), depth=0.3))
    assert np.isfinite(found.lines.sensitivity).all() and (found.ends == DEPTH).all()
    assert (np.diff(found.apex_outer) > 0).all()


def test_a_gauge_that_is_full_before_contact_leaves_no_range():
    found = respond(batch(driving_pressure=0.5 * LIMIT, gauge_limit=[0.4 * LIMIT, 10.0]))
    assert found.ends[0] == GAUGE and silent(found, 0) and not silent(found, 1)


@pytest.mark.parametrize("wall", [0.06, 0.35])
@pytest.mark.parametrize("ambient", [0.0, 1e-9, 1.0])
@pytest.mark.parametrize("dead", [0.0, 1e9])
@pytest.mark.parametrize("share", [0.0, 0.5, 0.97])
def test_the_corners_of_the_box_have_answers(wall, ambient, dead, share):
    limit = float(shipped().slices(np.array([wall])).limit_pressure[0])
    found = respond(
        batch(
            wall_thickness=wall,
            ambient_pressure=ambient,
            dead_volume=dead,
            driving_pressure=share * limit,
            depth=[0.05, 0.3, 0.75],
        )
    )
    assert (found.ends != OUTSIDE).all()
    assert np.isfinite(found.force).all() and np.isfinite(found.range_end).all()
    assert (np.diff(found.force, axis=1) > -2e-3 * found.force.max()).all()
    whole = found.ends == DEPTH
    assert found.range_end[whole] == pytest.approx(np.array([0.05, 0.3, 0.75])[whole])
    assert whole[:2].all()


@given(st.integers(0, 2**31))
def test_random_sensors_either_answer_in_full_or_not_at_all(seed):
    sensors = random_batch(30, seed, deepest=0.75)
    found = respond(sensors)
    finite = np.isfinite(found.force).all(axis=1)
    assert (finite == np.isfinite(found.lines.sensitivity)).all()
    assert (finite == np.isfinite(found.range_end)).all() and finite.mean() > 0.9
    assert ((found.range_end <= sensors.depth * (1 + 1e-9)) | ~finite).all()
    assert np.isin(found.ends, (DEPTH, BUCKLING)).mean() > 0.95


@given(st.integers(0, 2**31), st.floats(1e-4, 5e-3))
def test_answers_do_not_jump_between_neighbouring_walls(seed, move):
    """Where tables of two surveys meet, a sensor and one a little thicker must be told nearly the same."""
    sensors = random_batch(20, seed, deepest=0.55)
    thicker = np.minimum(sensors.wall_thickness * (1 + move), 0.35 * sensors.inner_radius)
    there = replace(sensors, wall_thickness=thicker)
    one, other = respond(sensors), respond(there)
    both = (one.ends == DEPTH) & (other.ends == DEPTH)
    assert both.mean() > 0.5
    change = np.abs(np.log(other.lines.sensitivity[both] / one.lines.sensitivity[both]))
    assert (change < 4.0 * move + 2e-3).all()
