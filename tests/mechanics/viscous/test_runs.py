"""Held and let go: limits in time and speed, energy, the solid beside, and where a run ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.atlas.respond import respond
from pneutouch.mechanics.models.solid import solid_result
from pneutouch.mechanics.viscous.prony import Prony
from pneutouch.mechanics.viscous.runs import HOLD_TIMES, loop, relaxation
from tests.mechanics.viscous.closed import after_ramp, energy_loss
from tests.mechanics.viscous.test_follow import SENSOR, A, B

DEPTH, AT_ONCE = 4.625, 1e5
PRESSURES = [0.0, 0.022]


def effective(modulus: float, driving_pressure: float):
    """An elastic dome of ``modulus`` times the relaxed one in the same inflated state with the same gas.

    It needs ``modulus`` times the driving pressure to stand there; the surroundings are lowered by the difference, so that the
    gas has its absolute pressure.
    """
    return SENSOR.replace(
        shear_modulus=modulus * SENSOR.wall.shear_modulus,
        ambient_pressure=SENSOR.gas.ambient_pressure - (modulus - 1) * driving_pressure,
    ), modulus * driving_pressure


def atlas_press(modulus: float, driving_pressure: float) -> tuple[float, float]:
    sensor, pressure = effective(modulus, driving_pressure)
    found = respond(batch_of(sensor, [pressure]), 14)
    return float(found.force[0, -1]), float(found.rise[0, -1])


@pytest.mark.parametrize("prony", [A, B])
@pytest.mark.parametrize("pressure", PRESSURES)
def test_it_begins_as_the_instantaneous_dome_and_ends_as_the_relaxed_one(prony, pressure):
    run = relaxation(SENSOR, [prony], [pressure], DEPTH, 1e9, np.array([1e-9, 1e5, 1e6]))[0][0]
    for k, modulus in ((0, 1 / prony.relaxed_share), (2, 1.0)):
        force, rise = atlas_press(modulus, pressure)
        assert run.force[k] == pytest.approx(force, rel=2e-3)
        assert run.rise[k] == pytest.approx(rise, rel=2e-3)


STEP = {"A": (A, 0.003), "B": (B, 0.02)}


@pytest.mark.parametrize("case", STEP)
def test_between_the_two_it_is_near_the_solid_solved_again_at_the_modulus_of_the_moment(case):
    """The solid knows no memory: its volume would have had to be the same all along. The difference is that memory."""
    (prony, near), pressure, times = STEP[case], 0.022, np.array([0.01, 1.0, 10.0])
    run = relaxation(SENSOR, [prony], [pressure], DEPTH, AT_ONCE, times)[0][0]
    for k, modulus in enumerate(prony.modulus(times)):
        sensor, driving = effective(float(modulus), pressure)
        state = solid_result(sensor, np.array([driving])).states[0]
        assert state.indentation[-1] == pytest.approx(DEPTH)
        assert run.force[k] == pytest.approx(state.force[-1], rel=near)
        assert run.rise[k] == pytest.approx(state.pressure_rise[-1], rel=near)


def test_after_a_slow_press_the_secant_modulus_is_the_lesser_answer():
    """Force grows faster than travel, so that most of it is younger than half the ramp: it has relaxed less than strain."""
    times = np.array([0.01, 1.0, 600.0])
    for prony, most in ((A, 0.03), (B, 0.09)):
        run = relaxation(SENSOR, [prony], [0.0], DEPTH, 5.0, times)[0][0]
        secant = [atlas_press(float(e), 0.0)[0] for e in after_ramp(prony, DEPTH / 5.0, times)]
        ratio = run.force / np.array(secant)
        assert 1.01 < ratio[0] < 1 + most
        assert ratio[-1] == pytest.approx(1.0, abs=2e-3)
        assert (np.diff(ratio) < 0).all()


@given(st.sampled_from([A, B]), st.sampled_from(PRESSURES), st.floats(0.2, 0.5), st.floats(-2, 3))
@settings(max_examples=15)
def test_a_held_sensor_only_loses_and_a_loop_only_takes(prony, pressure, share, speed):
    held = relaxation(SENSOR, [prony], [pressure], share * 9.25, 10**speed)[0][0]
    assert held.ended is None
    assert (np.diff(held.force) < 1e-6 * held.force[0]).all()
    assert (np.diff(held.rise) < 1e-6 * held.rise[0]).all()
    assert 0 < held.drop(held.rise)[0] < held.drop(held.force)[0] < 1
    turn = loop(SENSOR, [prony], [pressure], share * 9.25, 10**speed)[0][0]
    assert turn.ended is None
    assert 0 < energy_loss(turn) < 1
    if turn.contact_lost is not None:
        assert turn.force_out[-1] == pytest.approx(0.0, abs=1e-12)
        assert turn.indentation_out[-1] == pytest.approx(turn.contact_lost)


@pytest.mark.parametrize("prony", [A, B])
def test_slow_and_fast_loops_close_and_the_widest_lies_between(prony):
    speeds = np.geomspace(1e-7, 1e7, 8)
    wide = np.array([[one[0].hysteresis()[0] for one in loop(SENSOR, [prony], PRESSURES, DEPTH, v)] for v in speeds])
    assert (wide[[0, -1]] < 1e-3).all()
    assert (wide.max(axis=0) > 0.02).all()
    energy = [energy_loss(loop(SENSOR, [prony], [0.0], DEPTH, v)[0][0]) for v in speeds]
    assert abs(energy[0]) < 1e-3 and abs(energy[-1]) < 1e-3 and max(energy) > 0.05


def test_figures_stand_when_the_steps_are_made_finer():
    coarse, fine = (relaxation(SENSOR, [A, B], PRESSURES, DEPTH, 5.0, steps=n) for n in (30, 240))
    dense = np.concatenate([np.geomspace(1e-2, 1.0, 61)[:-1], np.geomspace(1.0, 600.0, 136)])
    closer = relaxation(SENSOR, [A, B], PRESSURES, DEPTH, 5.0, dense)
    for i in range(2):
        for j in range(2):
            own = coarse[i][j]
            assert own.force == pytest.approx(fine[i][j].force, rel=2e-3)
            assert own.drop(own.rise)[0] == pytest.approx(closer[i][j].drop(closer[i][j].rise)[0], abs=1e-3)
            assert own.drop(own.force)[1] == pytest.approx(closer[i][j].drop(closer[i][j].force)[1], abs=1e-3)
    for speed in (0.5, 5.0):
        plain, many = (loop(SENSOR, [A, B], PRESSURES, DEPTH, speed, steps=n) for n in (48, 384))
        for i in range(2):
            for j in range(2):
                assert plain[i][j].hysteresis() == pytest.approx(many[i][j].hysteresis(), abs=2e-3)


def test_the_loss_of_a_known_curve():
    run = relaxation(SENSOR, [Prony((0.1,), (1.0,))], [0.0], DEPTH, 5.0)[0][0]
    assert run.times is HOLD_TIMES or np.array_equal(run.times, HOLD_TIMES)
    total, decade = run.drop(10.0 - np.log10(run.times))
    assert total == pytest.approx(np.log10(600) / 10)
    assert decade == pytest.approx(0.1)
    with pytest.raises(ValueError, match="longer than 1 s"):
        replace(run, times=run.times[:5], force=run.force[:5]).drop(run.force[:5])


def test_series_and_states_do_not_disturb_one_another():
    both = loop(SENSOR, [A, B], PRESSURES, DEPTH, 5.0)
    for i, pressure in enumerate(PRESSURES):
        for j, prony in enumerate((A, B)):
            alone = loop(SENSOR, [prony], [pressure], DEPTH, 5.0)[0][0]
            assert both[i][j].force_out == pytest.approx(alone.force_out, rel=1e-5, abs=2e-6)


@pytest.mark.parametrize(("prony", "limit", "why"), [(B, np.inf, "inward buckling"), (B, 0.02, "gauge range")])
def test_a_run_that_cannot_go_on_says_where_and_gives_no_figures(prony, limit, why):
    sensor = SENSOR.replace(gauge_limit=limit)
    held = relaxation(sensor, [prony], [0.0], 6.9, 50.0)[0][0]
    turn = loop(sensor, [prony], [0.0], 6.9, 50.0)[0][0]
    assert held.ended.startswith(why) and turn.ended.startswith(why)
    assert held.times.size == held.force.size == 0
    assert turn.hysteresis() is None and energy_loss(turn) is None
    assert 0 < turn.indentation_in[-1] < 6.9
    assert f"{turn.indentation_in[-1]:.0f}" in turn.ended or "mm" in turn.ended


def test_a_stiffer_wall_widens_the_loop_but_holds_the_pressure_better():
    """Where the wall carries the load the force relaxes under a volume that the plate sets; where the gas does, both yield."""
    wide, lost = [], []
    for wall in (0.75, 1.5, 3.0):
        sensor = SENSOR.replace(wall_thickness=wall)
        wide.append(loop(sensor, [A], [0.0], DEPTH, 5.0)[0][0].hysteresis()[0])
        run = relaxation(sensor, [A], [0.0], DEPTH, 5.0)[0][0]
        lost.append(run.drop(run.rise)[0])
    assert (np.diff(wide) > 0.005).all()
    assert (np.diff(lost) < -0.005).all()
