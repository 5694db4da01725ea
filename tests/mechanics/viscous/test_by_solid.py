"""Runs by the solid: against those on the atlas without friction, and against presses of the solid with it."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch.mechanics.models.solid import press_settings, solid_probe, solid_states
from pneutouch.mechanics.solid.indenter import ball
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.viscous.describe import _Run, loop_by_solid, relaxation_by_solid
from pneutouch.mechanics.viscous.prony import Prony
from pneutouch.mechanics.viscous.runs import loop, relaxation
from tests.mechanics.solid.friction_loops import friction_loop
from tests.mechanics.viscous.test_follow import SENSOR, A, B

DEPTH, AT_ONCE, FOR_EVER = 4.625, 1e9, 1e-7
BALL = SENSOR.replace(body=ball(10.0))
ROUGH = SENSOR.replace(friction=0.6)
ELASTIC, SOFTENS = Prony((1e-9,), (1.0,)), Prony((0.81,), (1.0,))


def pressed(sensor, modulus: float = 1.0) -> tuple[float, float]:
    """Force (N) and pressure rise (MPa) at the depth of an elastic press at 0 kPa."""
    sized = sensor.replace(shear_modulus=modulus * sensor.wall.shear_modulus, depth=DEPTH, steps=15)
    (state,) = solid_states(sized, np.array([0.0]))
    return float(state.force[-1]), float(state.pressure_rise[-1])


@pytest.mark.parametrize("prony", [A, B], ids="AB")
def test_without_friction_the_solid_relaxes_as_the_atlas(prony):
    for pressure in (0.0, 0.022):
        (exact,), (found,) = (
            run(SENSOR, [prony], [pressure], DEPTH, 5.0)[0] for run in (relaxation, relaxation_by_solid)
        )
        for name in ("force", "rise"):
            lost, stated = (np.array(one.drop(getattr(one, name))) for one in (found, exact))
            assert lost == pytest.approx(stated, abs=0.003)
            np.testing.assert_allclose(getattr(found, name), getattr(exact, name), rtol=0.005)


@pytest.mark.slow
@pytest.mark.parametrize("prony", [A, B], ids="AB")
def test_without_friction_the_loop_is_that_on_the_atlas(prony):
    for speed in (0.5, 5.0):
        (exact,), (found,) = (run(SENSOR, [prony], [0.0], DEPTH, speed)[0] for run in (loop, loop_by_solid))
        assert found.hysteresis() == pytest.approx(exact.hysteresis(), abs=0.003)
        assert found.contact_lost == pytest.approx(exact.contact_lost, abs=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("sensor", [ROUGH, BALL], ids=["friction", "ball"])
def test_pressed_at_once_it_is_the_press_at_the_instantaneous_modulus(sensor):
    (run,) = loop_by_solid(sensor, [B], [0.0], DEPTH, AT_ONCE)[0]
    assert (run.force_in[-1], run.rise_in[-1]) == pytest.approx(pressed(sensor, 1 / B.relaxed_share), rel=2e-3)


@pytest.mark.parametrize("sensor", [ROUGH, pytest.param(BALL, marks=pytest.mark.slow)], ids=["friction", "ball"])
def test_pressed_slowly_it_is_the_press_at_the_relaxed_modulus(sensor):
    (run,) = loop_by_solid(sensor, [B], [0.0], DEPTH, FOR_EVER)[0]
    assert (run.force_in[-1], run.rise_in[-1]) == pytest.approx(pressed(sensor), rel=2e-3)
    relaxed, stiff = (p / f for f, p in (pressed(sensor), pressed(sensor, 1 / B.relaxed_share)))
    assert relaxed > 1.5 * stiff


def test_without_friction_a_hold_ends_as_the_press_at_the_relaxed_modulus_and_with_it_friction_keeps_a_part():
    """Where the wall sticks, the volume of the press is kept, and with it a part of the pressure rise."""
    runs = (relaxation_by_solid(one, [SOFTENS], [0.0], DEPTH, AT_ONCE)[0][0] for one in (BALL, ROUGH))
    (round_, rough) = (np.array([run.force[-1], run.rise[-1]]) for run in runs)
    assert round_ == pytest.approx(pressed(BALL), rel=0.005)
    force, rise = rough / pressed(ROUGH)
    assert 1.03 < rise < 1.1 and force == pytest.approx(1.0, abs=0.02)


@pytest.mark.slow
def test_a_resin_that_hardly_relaxes_has_the_loop_of_friction_alone():
    rough = SENSOR.replace(friction=0.3, depth=DEPTH, steps=16)
    (run,) = loop_by_solid(rough, [ELASTIC], [0.0], DEPTH, 1.0)[0]
    solid = solid_probe(rough).solid
    alone = friction_loop(solid, state_at(solid, 0.0), press_settings(rough)).hysteresis()
    assert alone[0] > 0.005
    assert run.hysteresis() == pytest.approx(alone, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.3, np.inf])
def test_figures_under_friction_hold_on_finer_steps(friction, monkeypatch):
    rough = SENSOR.replace(friction=friction)

    def figures() -> np.ndarray:
        (held,) = relaxation_by_solid(rough, [B], [0.0], DEPTH, 5.0)[0]
        (turn,) = loop_by_solid(rough, [B], [0.0], DEPTH, 5.0)[0]
        return np.array([held.drop(held.force)[0], held.drop(held.rise)[0], *turn.hysteresis()])

    coarse = figures()
    module = "pneutouch.mechanics.viscous.describe"
    for name, steps in (("_RAMP_STEPS", 60), ("_LOOP_STEPS", 72)):
        monkeypatch.setattr(f"{module}.{name}", steps)
    assert coarse == pytest.approx(figures(), abs=0.003)


@pytest.mark.parametrize("stop", [None, "first", "second"])
def test_a_step_that_is_not_solved_is_taken_in_two_halves_and_the_first_that_fails_is_the_reason(stop):
    reached = []

    def reach(time, travel, cuts):
        reached.append((time, travel, cuts))
        return ({"first": 1, "second": 2}.get(stop) == len(reached) and "no equilibrium found") or None

    run = SimpleNamespace(_now=SimpleNamespace(time=1.0, travel=2.0), _reach=reach)
    assert _Run._halved(run, 3.0, 6.0, 0) == (None if stop is None else "no equilibrium found")
    assert reached == [(2.0, 4.0, 1), (3.0, 6.0, 1)][: 1 if stop == "first" else 2]
