"""Ends of presses with friction: a point that is let go is no jump, a path that turns back is one."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch.mechanics.solid.continuation import _turns_back
from pneutouch.mechanics.solid.indent import follower_of, indent
from pneutouch.mechanics.solid.inflate import first_touch, inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere
from tests.stability.random_scenes import RADIUS, random_dome, sensors

#: Kinds of an end by a jump.
JUMPS = {"snap", "clamp_fold"}
#: Presses that grip or rub and end by a jump: dome and its press.
ENDED = [(13, 3), (17, 0), (27, 2)]


@pytest.fixture(scope="module")
def gripped():
    """A round object grips a thin wall; one of three points that hold it is let go within the first 1.8 mm."""
    scene = random_dome(17)
    solid = SolidModel(
        dome(Hemisphere(RADIUS, scene.wall * RADIUS), arc=24, through=1), sensors()[scene.resin].wall.hyperelastic
    )
    (share, press), inflated = scene.presses[0], inflate(solid, past_limit=1.0)
    return solid, state_at(solid, share * inflated.limit.pressure, inflated), press


def test_a_point_that_slips_and_leaves_keeps_the_balance_of_energy(gripped):
    """Its largest traction falls a hundredfold while it sticks and slips: 0.4 % of the work so far in one step."""
    solid, free, press = gripped
    follower = follower_of(solid, free, press, first_touch(solid, free, press.body, None, None))
    for _ in range(50):
        follower.step(follower.here.height - 0.004)
    height, force = (np.array([getattr(s, n) for s in follower.path[1:]]) for n in ("height", "force"))
    work = -0.5 * float(np.diff(height) @ (force[1:] + force[:-1]))
    spent = [s.friction.dissipated for s in follower.path[2:]]
    stored = follower.path[-1].state.energy - follower.path[1].state.energy
    assert max(spent) > 0.003 * work
    assert stored + sum(spent) == pytest.approx(work, rel=1e-3)


def test_a_point_that_is_let_go_is_no_jump(gripped):
    """Two of six steps of the press: the wall moves by 0.004 R0 at once, and a full step's work is 50 times what the
    point held."""
    solid, free, press = gripped
    assert indent(solid, free, replace(press, depth=press.depth / 3.0, steps=2)).complete


def _path(*speeds_at):
    move = np.array([[0.0, 0.0], [0.0, 1.0]])
    return [SimpleNamespace(height=height, by_height=speed * move) for height, speed in speeds_at]


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_path_turns_back_where_the_inverse_square_of_its_speed_falls_to_nothing(sense):
    """With x = x0 - sqrt(h - h0) the speed is that of its derivative; a step from one speed to another is no end."""
    limit = [(0.5 + sense * left, 0.5 / np.sqrt(left)) for left in (9.0e-4, 3.0e-4, 1.0e-4)]
    assert _turns_back(_path(*limit))
    assert not _turns_back(_path(*limit[:2]))
    assert not _turns_back(_path(*[(height, 1.2) for height, _ in limit]))
    stepped = [(height, speed) for (height, _), speed in zip(limit, (1.0, 1.0, 30.0), strict=True)]
    assert not _turns_back(_path(*stepped))
    far = [(0.5 + sense * left, 0.5 / np.sqrt(left)) for left in (9.0e-2, 3.0e-2, 1.0e-2)]
    assert not _turns_back(_path(*far))


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "one"), ENDED)
def test_a_jump_with_friction_is_one_on_a_finer_mesh_too(seed, one):
    """A tenth of the inner radius: the fold at the clamp itself depends on a mesh as coarse as the first."""
    scene = random_dome(seed)
    scene = replace(scene, presses=scene.presses[one : one + 1])
    ends = [next(scene.runs(finer)) for finer in (1, 2)]
    assert all(end.kind in JUMPS for end in ends), [end.kind for end in ends]
    coarse, fine = (end.run.events[-1].indentation for end in ends)
    assert fine == pytest.approx(coarse, abs=0.1 * RADIUS)
