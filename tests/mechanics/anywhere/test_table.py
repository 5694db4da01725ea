"""The shipped table of contact anywhere: whole, of today's model and recipe, and physical."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from release.tables.contact.build import central, edges
from release.tables.contact.fingerprint import model_answers
from release.tables.contact.held_out import compared, drawn
from release.tables.contact.press import DomeState, at_equal_reading, pressed
from scipy.interpolate import CubicHermiteSpline

from pneutouch.mechanics.anywhere.reading import TABLE_ERROR
from pneutouch.mechanics.anywhere.table import (
    RECIPE,
    SHIPPED,
    ContactPlaces,
    DomeConditions,
    NodeAxis,
    PlaceTableRecipe,
    digest,
    shipped,
)

EDGES = [*((seed, False) for seed in range(3)), *((seed, True) for seed in range(2))]
"""Seeds of presses by edges that the table was not made from, and whether they stand next to the pole."""


def domes(wall=0.162, share=0.0, gas=0.18):
    return DomeConditions(*(np.atleast_1d(np.array(value, dtype=float)) for value in (wall, share, gas)))


def place(curvature, lean=0.0, lying=False):
    return ContactPlaces(np.atleast_2d(float(curvature)), np.atleast_2d(float(lean)), lying)


def edge(curvature, lean=0.0):
    return place(curvature, lean, lying=True)


def test_the_shipped_file_is_whole_small_and_of_todays_recipe():
    with np.load(SHIPPED, allow_pickle=False) as file:
        tables = {name: file[name] for name in file.files if name not in ("recipe", "model", "digest")}
        assert str(file["digest"]) == digest(tables)
        assert str(file["recipe"]) == RECIPE.text()
    assert PlaceTableRecipe.from_text(RECIPE.text()) == RECIPE == shipped().recipe
    assert all(np.isfinite(table).all() for table in tables.values())
    assert tables["central"].shape == tuple(
        len(axis) for axis in (RECIPE.walls, RECIPE.shares, RECIPE.gases, RECIPE.curvatures, RECIPE.levels)
    )
    assert tables["edge"].shape == (
        *(len(axis) for axis in (RECIPE.leaning_walls, RECIPE.leaning_shares, RECIPE.edge_curvatures, RECIPE.levels)),
    )
    assert SHIPPED.stat().st_size < 100_000


def test_a_changed_number_changes_the_digest():
    tables = {"central": np.arange(6, dtype=np.float32), "leaning": np.ones(3, dtype=np.float32)}
    other = {**tables, "leaning": np.array([1, 1, np.nextafter(np.float32(1), np.float32(2))], dtype=np.float32)}
    assert digest(tables) == digest(dict(reversed(tables.items()))) != digest(other)


@pytest.mark.slow
def test_the_shipped_file_was_made_from_todays_model():
    with np.load(SHIPPED) as file:
        np.testing.assert_allclose(model_answers(RECIPE), file["model"], rtol=2e-4)


@pytest.mark.slow
def test_a_node_recomputes():
    state = DomeState(RECIPE.walls[2], RECIPE.shares[2], RECIPE.gases[1])
    logs, reach = central(RECIPE, state)
    with np.load(SHIPPED) as file:
        np.testing.assert_allclose(logs, file["central"][2, 2, 1], atol=2e-3)
        np.testing.assert_allclose(reach, file["central_reach"][2, 2, 1], atol=2e-3)


@pytest.mark.slow
def test_an_edge_across_the_pole_recomputes():
    wall, share = RECIPE.leaning_walls[1], RECIPE.leaning_shares[2]
    logs, reach = edges(RECIPE, DomeState(wall, share, RECIPE.leaning_gas), (0.0,))
    known = np.array(RECIPE.levels) < 0.5
    for row, highest, bend in zip(logs[:, 0], reach[:, 0], RECIPE.edge_curvatures, strict=True):
        at = domes(wall, share, RECIPE.leaning_gas)
        np.testing.assert_allclose(shipped().logs(at, edge(bend))[0, 0][known], row[known], atol=2e-3)
        assert shipped().reach(at, edge(bend))[0, 0] == pytest.approx(highest, abs=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "leaning"), EDGES)
def test_presses_by_edges_that_the_table_was_not_made_from(seed, leaning):
    press = compared(shipped(), *drawn(RECIPE, seed, leaning=leaning, lying=True), lying=True)
    known = np.isfinite(press.model)
    assert known.sum() >= 4 and press.reach[0] == pytest.approx(press.reach[1], abs=0.05)
    assert np.abs(press.table - press.model)[known].max() < TABLE_ERROR


@pytest.mark.slow
def test_the_press_in_which_the_table_of_edges_is_off_most():
    """Narrow and far from the pole, between all walls and driving pressures of the presses by edges next to it."""
    press = compared(shipped(), DomeState(0.15, 0.25, 0.1), RECIPE.edge_curvatures[-1], RECIPE.leans[-1], lying=True)
    known = np.isfinite(press.model)
    assert known.sum() == 4
    assert 0.02 < np.abs(press.table - press.model)[known].max() < TABLE_ERROR


@pytest.mark.slow
def test_a_slightly_curved_edge_presses_as_the_ball_of_its_mean_curvature():
    """The model has it by itself; the table is built on it."""
    state = DomeState(0.15, 0.0, 0.1)
    plate = pressed(RECIPE, state, 0.0, 0.0, cells=RECIPE.cells)
    ball, bar = (
        at_equal_reading(RECIPE, plate, pressed(RECIPE, state, bend, 0.0, lying=lying, cells=RECIPE.cells))[0]
        for bend, lying in ((0.05, False), (0.1, True))
    )
    level = RECIPE.levels.index(0.3)
    assert ball[level] < -0.02
    assert bar[level] / ball[level] == pytest.approx(1.0, abs=0.1)


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "leaning"), [*((seed, False) for seed in range(12)), *((s, True) for s in range(6))])
def test_presses_that_the_table_was_not_made_from(seed, leaning):
    press = compared(shipped(), *drawn(RECIPE, seed, leaning=leaning))
    known = np.isfinite(press.model)
    assert known.any()
    assert np.abs(press.table - press.model)[known].max() < TABLE_ERROR


def test_at_its_nodes_it_gives_the_tabulated_numbers():
    with np.load(SHIPPED) as file:
        for w, s, g, c in ((0, 0, 0, 0), (2, 3, 1, 2), (3, 4, 2, 3)):
            at = domes(RECIPE.walls[w], RECIPE.shares[s], RECIPE.gases[g])
            logs = shipped().logs(at, place(RECIPE.curvatures[c]))[0, 0]
            np.testing.assert_allclose(logs, file["central"][w, s, g, c], atol=1e-6)


def test_a_level_central_plate_takes_the_force_of_the_plate_at_every_reading():
    assert np.abs(shipped().logs(domes(), place(0.0))).max() < 1e-12
    assert shipped().reach(domes(), place(0.0)) == RECIPE.depth


def test_the_mirrored_scene_has_the_same_force():
    there, mirrored = (shipped().logs(domes(), place(1.0, lean)) for lean in (0.3, -0.3))
    assert np.abs(there).max() > 0.05
    np.testing.assert_array_equal(there, mirrored)


def test_a_smaller_ball_takes_less_force_for_a_reading():
    level = RECIPE.levels.index(0.3)
    logs = [shipped().logs(domes(), place(curvature))[0, 0, level] for curvature in (0.0, 0.5, 1.0, 2.0, 10 / 3)]
    assert np.all(np.diff(logs) < -0.01)


@pytest.mark.parametrize("lean", [0.0, 0.3])
def test_an_edge_without_curvature_is_the_plate_that_leans_as_much(lean):
    np.testing.assert_allclose(shipped().logs(domes(), edge(0.0, lean)), shipped().logs(domes(), place(0.0, lean)))


def test_a_slight_curvature_of_an_edge_acts_by_its_mean():
    ball, bar = shipped().logs(domes(), place(5e-4))[0, 0], shipped().logs(domes(), edge(1e-3))[0, 0]
    np.testing.assert_allclose(bar, ball, rtol=2e-3)


@given(
    wall=st.floats(RECIPE.walls[0], RECIPE.walls[-1]),
    share=st.floats(RECIPE.shares[0], RECIPE.shares[-1]),
    gas=st.floats(RECIPE.gases[0], RECIPE.gases[-1]),
    curvature=st.floats(0.1, RECIPE.curvatures[-1]),
)
def test_an_edge_across_the_pole_is_between_the_plate_and_the_ball_of_its_radius(wall, share, gas, curvature):
    at = domes(wall, share, gas)
    reach = shipped().reach(at, place(curvature))[0, 0]
    known = np.array(RECIPE.levels) <= reach
    ball, bar = (shipped().logs(at, kind(curvature))[0, 0][known] for kind in (place, edge))
    assert ((ball - 0.005 <= bar) & (bar <= 0.005)).all()
    assert reach <= shipped().reach(at, edge(curvature))[0, 0]


def test_the_mirrored_edge_has_the_same_force():
    there, mirrored = (shipped().logs(domes(), edge(1.0, lean)) for lean in (0.3, -0.3))
    assert np.abs(there - shipped().logs(domes(), edge(1.0))).max() > 0.01
    np.testing.assert_array_equal(there, mirrored)


def test_driving_pressure_makes_the_reading_depend_less_on_the_object():
    level = RECIPE.levels.index(0.2)
    logs = shipped().logs(domes(wall=[0.162] * 4, share=[0.0, 0.2, 0.5, 0.9], gas=[0.18] * 4), ball_of_r0(4))
    sizes = np.abs(logs[:, 0, level])
    assert np.all(np.diff(sizes) < 0.0) and sizes[-1] < 0.2 * sizes[0]


def ball_of_r0(count):
    return ContactPlaces(np.ones((count, 1)), np.zeros((count, 1)))


@pytest.mark.parametrize("count", [2, 3, 6])
def test_weights_are_those_of_a_hermite_spline_with_the_slopes_of_parabolas(count):
    nodes = np.cumsum(np.linspace(0.2, 0.7, count) ** 2)
    slopes = np.gradient(np.eye(count), nodes, axis=0, edge_order=min(count - 1, 2))
    at = np.linspace(nodes[0], nodes[-1], 23)
    expected = CubicHermiteSpline(nodes, np.eye(count), slopes)(at)
    np.testing.assert_allclose(NodeAxis(nodes).weights(at), expected, atol=1e-12)


def test_weights_give_back_parabolas_and_sum_to_one():
    nodes = np.array([0.0, 0.3, 0.5, 1.1, 1.2])
    at = np.linspace(0.0, 1.2, 41)
    weights = NodeAxis(nodes).weights(at)
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-12)
    np.testing.assert_allclose(weights @ (2 - nodes + 3 * nodes**2), 2 - at + 3 * at**2, atol=1e-12)
    np.testing.assert_allclose(NodeAxis(nodes).weights(nodes), np.eye(5), atol=1e-12)
    np.testing.assert_allclose(NodeAxis(nodes).weights(np.array([2.0])), [[0, 0, 0, 0, 1]], atol=1e-12)
    np.testing.assert_array_equal(NodeAxis(np.array([0.1])).weights(at), np.ones((41, 1)))
    line = NodeAxis(np.array([0.0, 0.44**2]))
    np.testing.assert_allclose(line.weights(np.array([0.1])) @ np.array([1.0, 1.0 + 0.44**2]), [1.1], atol=1e-12)
