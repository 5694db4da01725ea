"""The set of touching points is settled inside one quadratic model: its least is met, also on thin walls."""

import numpy as np
import pytest

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.continuation import LONGEST, descend
from pneutouch.mechanics.solid.indent import PressSettings, follower_of
from pneutouch.mechanics.solid.inflate import first_touch, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import direction, evaluate, full_tangent
from pneutouch.shape.hemisphere import Hemisphere

RATIO = 0.09  # wall over radius: where sets of touching points took turns for ever, and line searches failed


@pytest.fixture(scope="module")
def pressed():
    return thin_wall()


def thin_wall():
    """A thin wall pressed from 12 kPa to three quarters of its radius, at full steps."""
    solid = SolidModel(dome(Hemisphere(9.5, 9.5 * RATIO)), neo_hookean(0.55))
    press = PressSettings(0.75 * 9.5)
    touch = first_touch(solid, state_at(solid, 0.012), None, 30.0)
    follower = follower_of(solid, state_at(solid, 0.012), press, touch)
    bottom = touch.body.height - press.depth / solid.length
    assert descend(follower, bottom) is None
    return follower


def test_full_steps_of_the_plate_are_solved_without_a_cutback(pressed):
    travel = -np.diff([state.height for state in pressed.path])
    assert np.allclose(travel[:-1], LONGEST)
    assert max(state.iterations for state in pressed.path) <= 10


def test_newton_steps_with_the_averaged_pressure_unknown_are_fewer_to_the_same_states(pressed, monkeypatch):
    monkeypatch.setattr(SolidModel, "mixed", lambda solid, before, here, move: here)
    plain = thin_wall()
    fewer, more = (sum(state.iterations for state in run.path) for run in (pressed, plain))
    assert fewer < 0.9 * more
    assert [state.force for state in pressed.path] == pytest.approx([state.force for state in plain.path], rel=1e-8)


@pytest.mark.parametrize("number", [2, 3, 4])
def test_the_step_is_the_least_of_the_model_with_contact(pressed, number):
    here = pressed.path[number]  # where the tangent is definite without being lifted
    solid = here.scene.solid
    contact, lower = solid.contact, here.scene.plate.at(here.height - LONGEST)
    scene = type(here.scene)(solid, here.scene.supply, lower)
    state = evaluate(scene, here.state.x - LONGEST * here.by_height)
    newton = direction(scene, state)
    # The slope of the model at the step: wall and filling by the tangent without contact, contact where it then is.
    bare = full_tangent(scene, evaluate(type(scene)(solid, scene.supply, None), state.x))
    pulled = state.inner + banded_product(bare, newton.step)
    pulled += state.filling.rate * state.by_volume * (state.by_volume @ newton.step)
    traction = contact.linear(state.touch, solid.expand(newton.step))
    pushed = solid.faces.push(contact.force(np.maximum(traction, 0.0), state.touch.slope))
    changed = ((traction > 0.0) != (state.touch.traction > 0.0)).sum()
    assert changed > 3
    assert np.linalg.norm(pulled + pushed) < 1e-9 * np.linalg.norm(pushed)


def banded_product(band, x):
    """K x of a symmetric matrix by its lower band."""
    out = band[0] * x
    for k in range(1, len(band)):
        out[k:] += band[k, :-k] * x[:-k]
        out[:-k] += band[k, :-k] * x[k:]
    return out


@pytest.mark.parametrize("seed", range(5))
def test_the_least_along_a_move_is_that_of_a_fine_search(seed):
    generator = np.random.default_rng(seed)
    contact = SolidModel(dome(Hemisphere(9.25, 1.5), 24, 1), neo_hookean(1.0)).contact
    here, there = generator.normal(size=(2, *contact.weight.shape)) * 0.01 * contact.stiffness
    share = np.linspace(0.0, 1.0, 20001)
    pushed = np.maximum(here[..., None] * (1.0 - share) + there[..., None] * share, 0.0)
    energy = np.einsum("ij,ijk->k", contact.weight, pushed**2) / (2.0 * contact.stiffness)
    scale = float(np.abs(np.gradient(energy, share)).max())
    start, end = -2.0 * scale, -0.3 * scale * seed
    energy += start * share + 0.5 * (end - start) * share**2
    assert contact.least_share(here, there, start, end) == pytest.approx(share[energy.argmin()], abs=1e-4)


def test_a_plate_far_above_leaves_the_whole_move():
    contact = SolidModel(dome(Hemisphere(9.25, 1.5), 24, 1), neo_hookean(1.0)).contact
    free = -np.ones_like(contact.weight) * contact.stiffness
    assert contact.least_share(free, 0.5 * free, -1.0, 0.0) == 1.0
