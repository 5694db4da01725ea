"""Presses in the atlas: exact scalings, Boyle's law, the energy balance, and what physics forbids."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from pneutouch.mechanics.atlas.press import AtlasPress, SensorBatch
from pneutouch.mechanics.atlas.respond import BREAK, BUCKLING, DEPTH, EDGE, GAUGE, OUTSIDE, respond
from pneutouch.mechanics.atlas.table import shipped
from pneutouch.units import KPA
from tests.mechanics.atlas.sampled import batch, energy, random_batch

seeds = st.integers(0, 2**31)
factors = st.floats(0.2, 5.0)


def pressed(batch: SensorBatch) -> AtlasPress:
    """A batch with its slices, one a sensor."""
    walls, k = np.unique(batch.wall_ratio, return_inverse=True)
    return AtlasPress(batch, shipped().slices(walls), k)


@given(seeds, factors)
def test_modulus_and_all_pressures_scale_together(seed, factor):
    one = random_batch(12, seed)
    names = ("shear_modulus", "ambient_pressure", "driving_pressure", "gauge_limit")
    a, b = respond(one), respond(replace(one, **{name: factor * getattr(one, name) for name in names}))
    assert b.lines.sensitivity == pytest.approx(a.lines.sensitivity, rel=1e-8, nan_ok=True)
    gap, full = np.abs(b.force - factor * a.force), factor * a.force.max(axis=1, keepdims=True)
    assert np.nanmax(gap / full) < 1e-8
    assert (a.ends == b.ends).all() and b.range_end == pytest.approx(a.range_end, rel=1e-6, nan_ok=True)


@given(seeds, factors)
def test_sensitivity_goes_with_the_inverse_square_of_the_size(seed, factor):
    one = random_batch(12, seed)
    lengths = {name: factor * getattr(one, name) for name in ("inner_radius", "wall_thickness", "depth")}
    a, b = respond(one), respond(replace(one, **lengths, dead_volume=factor**3 * one.dead_volume))
    assert factor**2 * b.lines.sensitivity == pytest.approx(a.lines.sensitivity, rel=1e-8, nan_ok=True)
    assert b.lines.stiffness == pytest.approx(factor * a.lines.stiffness, rel=1e-8, nan_ok=True)
    assert b.limit_pressure == pytest.approx(a.limit_pressure, rel=1e-10)


@pytest.mark.parametrize(("wall", "share"), [(0.07, 0.6), (0.16, 0.0), (0.16, 0.9), (0.3, 0.4)])
def test_behind_an_endless_dead_volume_the_press_is_that_of_constant_pressure(wall, share):
    slices = shipped().slices(np.array([wall]))
    pressure = share * float(slices.limit_pressure[0])
    huge = [1e4, 1e5, 1e6]
    found = respond(batch(wall_thickness=wall, driving_pressure=pressure, dead_volume=huge, depth=0.35))
    # The rise dies with the inverse of the volume: only the rise times the volume has a limit.
    product = found.rise[:, -1] * huge
    assert product == pytest.approx(product[-1], rel=2e-3)
    assert 0.0 < found.rise[2, -1] < 1e-5
    zero = np.zeros(1, dtype=np.intp)

    def lack(nu: float, height: float) -> float:
        return float(slices.point(zero, np.array([nu]), np.array([height])).pressure[0]) - pressure

    start = float(brentq(lambda nu: lack(nu, float(slices.free_apex(zero, np.array([nu]))[0, 0])), -1e-3, 0.995))
    height, nu = float(slices.free_apex(zero, np.array([start]))[0, 0]), start
    for column in range(1, 15):
        lower = height - 0.35 * column / 14
        # The table goes on behind the edge at zero pressure, where nothing was asked: stay near.
        width = next(w for w in (0.001, 0.003, 0.01, 0.03) if lack(nu - w, lower) * lack(nu + 0.01, lower) < 0)
        nu = brentq(lambda x, h=lower: lack(x, h), nu - width, nu + 0.01)
        force = float(slices.point(zero, np.array([nu]), np.array([lower])).force[0])
        assert found.force[2, column] == pytest.approx(force, rel=2e-4, abs=1e-6)


@given(seeds)
def test_trapped_gas_obeys_boyle_along_the_curve(seed):
    sensors = random_batch(12, seed)
    press = pressed(sensors)
    track = press.march(np.linspace(0.0, 1.0, 15) * (sensors.depth / sensors.inner_radius)[:, None])
    volume = 2.0 / 3.0 * np.pi + track.nu * press.slices.reach(press.k)[:, None]
    content = (track.point.pressure + press.ambient[:, None]) * (volume + press.dead[:, None])
    error = np.where(track.ok, content / content[:, :1] - 1.0, 0.0)
    assert np.abs(error).max() < 1e-6
    # The curve that is given away is that of these states.
    found = respond(sensors)
    whole = (found.ends == DEPTH) & np.isfinite(found.force[:, -1])
    rise = (track.point.pressure - press.pressure[:, None]) * sensors.shear_modulus[:, None]
    assert found.rise[whole] == pytest.approx(rise[whole], rel=1e-6, abs=1e-12)


@given(seeds)
def test_the_plates_work_goes_into_wall_and_gas(seed):
    """Simpson's rule along the press; the gas takes p_a dV - C ln V, the wall the difference of its energy."""
    sensors = random_batch(6, seed)
    press = pressed(sensors)
    travel = np.linspace(0.0, 1.0, 201) * (sensors.depth / sensors.inner_radius)[:, None]
    track = press.march(travel)
    weight = np.ones(201)
    weight[1:-1:2], weight[2:-1:2] = 4.0, 2.0
    for i in np.flatnonzero(track.ok.all(axis=1)):
        work = float(weight @ track.point.force[i]) * travel[i, 1] / 3.0
        ends = [0, -1]
        stored = np.diff(energy(press.slices, track.nu[i, ends], track.height[i, ends], press.k[i]))[0]
        first, last = press.volume(track.nu.T)[ends, i] + press.dead[i]
        gas = press.content[i] * np.log(first / last) - press.ambient[i] * (first - last)
        assert work == pytest.approx(stored + gas, rel=1e-4)


@given(seeds)
def test_more_travel_takes_more_force_and_squeezes_the_gas(seed):
    found = respond(random_batch(25, seed))
    good = np.isfinite(found.lines.sensitivity)
    assert good.mean() > 0.8
    force, rise = found.force[good], found.rise[good]
    scale = force.max(axis=1, keepdims=True)
    assert (np.diff(force, axis=1) > -1e-3 * scale).all()
    assert (np.diff(rise, axis=1) > 0.0).all()
    assert (found.lines.sensitivity[good] > 0.0).all() and (found.max_stretch[good] >= 1.0).all()


@pytest.mark.parametrize(("wall", "share"), [(0.065, 0.3), (0.16, 0.0), (0.16, 0.8), (0.33, 0.5)])
def test_dead_volume_softens_and_gas_stiffens(wall, share):
    limit = float(shipped().slices(np.array([wall])).limit_pressure[0])
    scene = {"wall_thickness": wall, "driving_pressure": share * limit, "depth": 0.4}
    by_dead = respond(batch(**scene, dead_volume=[0.0, 0.1, 0.5, 2.0, 10.0]))
    assert (np.diff(by_dead.lines.sensitivity) < 0).all() and (np.diff(by_dead.force[:, -1]) < 0).all()
    by_gas = respond(batch(**scene, ambient_pressure=[0.02, 0.1, 0.3, 0.6, 1.0]))
    assert (np.diff(by_gas.force[:, -1]) > 0).all() and (np.diff(by_gas.lines.sensitivity) > 0).all()


def test_a_thicker_wall_takes_more_pressure_and_more_force():
    found = respond(batch(wall_thickness=[0.06, 0.1, 0.2, 0.35], depth=0.4))
    assert (np.diff(found.force[:, -1]) > 0).all() and (np.diff(found.limit_pressure) > 0).all()


@given(st.floats(0.06, 0.35))
def test_more_pressure_blows_the_dome_up_further(wall):
    limit = float(shipped().slices(np.array([wall])).limit_pressure[0])
    pressures = (np.linspace(0.0, 0.999, 25) * limit).tolist()
    found = respond(batch(wall_thickness=wall, driving_pressure=pressures, depth=1e-3))
    assert (np.diff(found.apex_outer) > 0).all() and (np.diff(found.cavity_volume) > 0).all()


@settings(max_examples=10)
@given(seeds, st.integers(2, 30))
def test_one_by_one_in_a_batch_and_in_any_order_the_answers_are_the_same(seed, steps):
    sensors = random_batch(6, seed, deepest=0.75)
    order = np.random.default_rng(seed).permutation(6)
    whole, mixed = respond(sensors, steps), respond(sensors.take(order), steps)
    singles = [respond(sensors.take(slice(i, i + 1)), steps) for i in range(6)]
    for row, i in enumerate(order):
        for one, at in ((mixed, row), (singles[i], 0)):
            assert one.ends[at] == whole.ends[i]
            assert one.range_end[at] == pytest.approx(whole.range_end[i], rel=2e-4, nan_ok=True)
            assert one.lines.sensitivity[at] == pytest.approx(whole.lines.sensitivity[i], rel=1e-4, nan_ok=True)


def test_more_than_a_chunk_is_joined_in_order_and_repeats_to_the_last_bit(monkeypatch):
    monkeypatch.setattr("pneutouch.mechanics.atlas.respond._CHUNK", 100)
    sensors = random_batch(230, 5)
    found, again = respond(sensors), respond(sensors)
    for one, other in zip((*found.lines, *found[1:]), (*again.lines, *again[1:]), strict=True):
        assert np.array_equal(one, other, equal_nan=True)
    last = respond(sensors.take(slice(220, 230)))
    assert found.lines.sensitivity[220:] == pytest.approx(last.lines.sensitivity, rel=1e-4, nan_ok=True)
    assert found.force.shape == (230, 15) and found.ends.shape == (230,)


def test_each_end_of_a_range_lies_where_its_own_quantity_meets_its_level():
    limit = float(shipped().slices(np.array([0.16])).limit_pressure[0])
    scene = {"driving_pressure": 0.3 * limit, "depth": 0.6}
    free = respond(batch(**scene))
    assert free.ends[0] == DEPTH and free.range_end[0] == pytest.approx(0.6)
    gauge = 0.3 * limit + 0.5 * free.rise[0, -1]
    by_gauge = respond(batch(**scene, gauge_limit=gauge))
    assert by_gauge.ends[0] == GAUGE and 0.2 < by_gauge.range_end[0] < 0.5
    assert 0.3 * limit + by_gauge.rise[0, -1] == pytest.approx(gauge, abs=2e-4 * gauge)
    by_edge = respond(batch(**scene, plate_radius=0.5))
    assert by_edge.ends[0] == EDGE and 0.0 < by_edge.range_end[0] < 0.6
    bare = respond(batch(driving_pressure=0.3 * limit, depth=0.01)).max_stretch[0]
    by_tear = respond(batch(**scene, break_stretch=0.5 * (bare + free.max_stretch[0])))
    assert by_tear.ends[0] == BREAK and 0.0 < by_tear.range_end[0] < 0.6
    assert by_tear.max_stretch[0] == pytest.approx(0.5 * (bare + free.max_stretch[0]), abs=2e-3)
    # A range that ends earlier is the beginning of the longer curve.
    for cut in (by_gauge, by_edge, by_tear):
        force = np.interp(cut.indentation[0], free.indentation[0], free.force[0])
        assert np.abs(cut.force[0] - force).max() < 5e-3 * free.force.max()


@pytest.mark.parametrize("steps", [14, 150, 1000])
def test_where_no_level_is_set_only_buckling_ends_a_range(steps):
    """At fine steps a state may just hold from one guess of the volume and not from another: that is no level met."""
    ends = respond(random_batch(600 if steps < 1000 else 150, 5, deepest=0.75), steps=steps).ends
    assert set(ends.tolist()) <= {DEPTH, BUCKLING, OUTSIDE} and BUCKLING in ends


def test_the_end_of_a_range_has_one_reason_at_any_number_of_steps():
    nearly = {"wall_thickness": 1.5, "inner_radius": 9.25, "shear_modulus": 0.17, "ambient_pressure": 0.101325}
    nearly |= {"dead_volume": 4935.04935971, "driving_pressure": 0.005, "depth": 6.9375, "plate_radius": 15.0}
    ends = []
    for steps in (14, 200, 1000):
        found = respond(batch(**nearly, gauge_limit=0.1, break_stretch=2.7), steps=steps)
        ends.append(found.range_end[0])
        assert found.ends[0] == BUCKLING
    assert np.ptp(ends) < 2e-3 and ends[0] == pytest.approx(6.833, abs=0.02), "the solid's end is 6.833"


def test_a_range_that_ends_within_the_first_step_ends_where_its_pressure_is_reached():
    limit = float(shipped().slices(np.array([0.16])).limit_pressure[0])
    scene = {"driving_pressure": 0.3 * limit, "depth": 0.6}
    free = respond(batch(**scene))
    gauge = 0.3 * limit + 0.5 * free.rise[0, 1]
    early = respond(batch(**scene, gauge_limit=gauge))
    assert early.ends[0] == GAUGE and 0.0 < early.range_end[0] < free.indentation[0, 1]
    assert 0.3 * limit + early.rise[0, -1] == pytest.approx(gauge, abs=2e-4 * gauge)


def test_a_rise_is_in_megapascal_and_a_sensitivity_in_kilopascal_per_newton():
    found = respond(batch(dead_volume=0.3))
    slope = np.polyfit(found.force[0], found.rise[0] / KPA, 1)[0]
    assert found.lines.sensitivity[0] == pytest.approx(slope, rel=1e-9)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        *[
            (name, value)
            for name in ("inner_radius", "shear_modulus", "depth", "plate_radius")
            for value in (0.0, -1.0)
        ],
        ("ambient_pressure", -0.1),
        ("driving_pressure", -0.1),
        ("wall_thickness", 0.9 * shipped().recipe.thinnest),
        ("wall_thickness", 1.1 * shipped().recipe.thickest),
        ("depth", 1.1 * shipped().recipe.deepest),
        ("gauge_limit", np.nan),
        ("break_stretch", np.nan),
    ],
)
def test_what_is_no_sensor_or_outside_the_box_has_no_answer_and_its_neighbour_has(field, value):
    plain = {
        "depth": 0.5,
        "wall_thickness": 0.16,
        "driving_pressure": 0.0,
        "gauge_limit": np.inf,
        "break_stretch": np.inf,
    }
    usual = plain.get(field, 1.0)
    found = respond(batch(**{field: [usual, value]}))
    assert np.isfinite(found.lines.sensitivity[0])
    assert np.isnan(found.lines.sensitivity[1]) and np.isnan(found.range_end[1])


def test_inflation_ends_on_the_root_wherever_its_bracket_lies():
    """A root on an end of its bracket is kept; half of the bracket away it would be off by some 1e-10."""
    from pneutouch.mechanics.atlas.press import _inflated
    from pneutouch.mechanics.atlas.table import shipped

    draw = np.random.default_rng(3)
    ratio = np.sort(draw.uniform(0.1, 0.2, 200))
    slices, k = shipped().slices(ratio), np.repeat(np.arange(200), 20)
    pressure = draw.uniform(0.05, 0.9, k.size) * slices.limit_pressure[k]
    nu = _inflated(slices, k, pressure)
    reached = slices.point(k, nu, slices.free_apex(k, nu)[:, 0]).pressure
    assert np.abs(reached / pressure - 1.0).max() < 1e-12


def test_a_range_that_the_gauge_ends_does_so_at_its_limit_to_five_digits():
    """What is left of the end's place is noise in every derivative, and so in every interval."""
    draw = np.random.default_rng(11)
    size = 400
    radius, modulus = draw.uniform(5.0, 15.0, size), draw.uniform(0.15, 1.0, size)
    batch = SensorBatch(
        inner_radius=radius,
        wall_thickness=draw.uniform(0.1, 0.3, size) * radius,
        shear_modulus=modulus,
        ambient_pressure=np.full(size, 0.101325),
        dead_volume=draw.uniform(0.0, 1500.0, size),
        driving_pressure=np.zeros(size),
        depth=0.6 * radius,
        plate_radius=np.full(size, np.inf),
        gauge_limit=draw.uniform(0.002, 0.05, size),
        break_stretch=np.full(size, np.inf),
    )
    found = respond(batch)
    ended = found.ends == GAUGE
    assert ended.sum() > 100
    np.testing.assert_allclose(found.rise[ended, -1], batch.gauge_limit[ended], rtol=1e-5)
