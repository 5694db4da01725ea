"""States looked up in the atlas: pressure and force are the slopes of one energy, and every derivative is one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.mechanics.atlas.table import REST_VOLUME, AtlasSlices, shipped
from tests.mechanics.atlas.sampled import energy

walls = st.floats(0.06, 0.35)
seeds = st.integers(0, 2**31)
COUNT = 40
NONE = np.zeros(COUNT, dtype=np.intp)


def states(wall: float, seed: int) -> tuple[AtlasSlices, np.ndarray, np.ndarray]:
    """One slice with volumes nu and plate heights inside the box, the plate below the free apex."""
    slices, rng = shipped().slices(np.array([wall])), np.random.default_rng(seed)
    nu = rng.uniform(-0.25, 1.0, COUNT)
    w = rng.uniform(0.02, 0.72, COUNT)
    return slices, nu, slices.free_apex(NONE, nu)[:, 0] - w


@given(walls, seeds)
def test_pressure_and_force_are_slopes_of_one_energy(wall, seed):
    slices, nu, height = states(wall, seed)
    point, reach, step = slices.point(NONE, nu, height), slices.reach(NONE), 1e-5
    by_volume = (energy(slices, nu + step / reach, height) - energy(slices, nu - step / reach, height)) / (2 * step)
    by_height = (energy(slices, nu, height + step) - energy(slices, nu, height - step)) / (2 * step)
    unit = slices.limit_pressure[0]
    assert np.abs(by_volume - point.pressure).max() < 1e-4 * unit
    assert np.abs(by_height + point.force).max() < 1e-4 * unit


@given(walls, seeds)
def test_every_derivative_is_a_difference_quotient_and_the_mixed_ones_are_equal(wall, seed):
    slices, nu, height = states(wall, seed)
    point, step = slices.point(NONE, nu, height), 1e-6
    swell = step / slices.reach(NONE)
    fuller, emptier = slices.point(NONE, nu + swell, height), slices.point(NONE, nu - swell, height)
    higher, lower = slices.point(NONE, nu, height + step), slices.point(NONE, nu, height - step)

    def same(quotient: np.ndarray, exact: np.ndarray) -> None:
        assert np.abs(quotient - exact).max() < 1e-3 * np.abs(exact).max()

    same((fuller.pressure - emptier.pressure) / (2 * step), point.by_volume)
    same((higher.pressure - lower.pressure) / (2 * step), point.by_height)
    same((higher.force - lower.force) / (2 * step), point.force_by_height)
    same((fuller.force - emptier.force) / (2 * step), -point.by_height)


@given(walls, st.floats(0.05, 0.8), st.floats(0.05, 0.5))
def test_no_work_is_won_on_a_round_trip(wall, nu, w):
    """The integral of p dV - F dh around a closed loop of volumes and heights, by the trapezoid rule on a circle."""
    slices = shipped().slices(np.array([wall]))
    turn = np.linspace(0.0, 2 * np.pi, 241)[:-1]
    k = np.zeros(turn.size, dtype=np.intp)
    reach = float(slices.reach(k[:1])[0])
    apex = float(slices.free_apex(k[:1], np.array([nu]))[0, 0])
    here, height = nu + 0.04 * np.cos(turn), apex - w + 0.03 * np.sin(turn)
    point = slices.point(k, here, height)
    swell, lift = -0.04 * reach * np.sin(turn), 0.03 * np.cos(turn)
    won = (point.pressure * swell - point.force * lift).mean()
    paid = (np.abs(point.pressure * swell) + np.abs(point.force * lift)).mean()
    assert abs(won) < 1e-4 * paid


@given(walls)
def test_a_plate_at_the_free_apex_bears_nothing_and_the_pressure_rises_to_its_limit_there(wall):
    slices = shipped().slices(np.array([wall]))
    nu = np.linspace(0.0, 1.0, 61)
    k = np.zeros(nu.size, dtype=np.intp)
    apex = slices.free_apex(k, nu)[:, 0]
    point = slices.point(k, nu, apex)
    limit = slices.limit_pressure[0]
    assert np.abs(point.force).max() < 4e-3 * limit
    assert point.pressure[0] == pytest.approx(0.0, abs=2e-3 * limit)
    assert point.pressure[-1] == pytest.approx(limit, rel=1e-3)
    assert (np.diff(point.pressure[:55]) > 0).all() and (np.diff(apex) > 0).all()
    assert apex[0] == pytest.approx(1.0 + wall, abs=2e-4)


@given(walls)
def test_work_to_inflate_is_the_energy_stored(wall):
    """The integral of p dV along the free curve (Simpson) is the energy at its end."""
    slices = shipped().slices(np.array([wall]))
    nu = np.linspace(0.0, 0.9, 181)
    k = np.zeros(nu.size, dtype=np.intp)
    apex = slices.free_apex(k, nu)[:, 0]
    pressure = slices.point(k, nu, apex).pressure
    weight = np.ones(nu.size)
    weight[1:-1:2], weight[2:-1:2] = 4.0, 2.0
    work = float(weight @ pressure) * (nu[1] - nu[0]) / 3.0 * float(slices.reach(k[:1])[0])
    stored = energy(slices, nu[[0, -1]], apex[[0, -1]])
    assert stored[1] - stored[0] == pytest.approx(work, rel=2e-3)


def test_unloaded_cavity_is_a_hemisphere():
    assert pytest.approx(2.0 * np.pi / 3.0) == REST_VOLUME
    # The atlas's volumes begin where the discrete wall's own do.
    assert (shipped().slices(np.array([0.06, 0.35])).limit_volume > 2.0 * REST_VOLUME).all()
