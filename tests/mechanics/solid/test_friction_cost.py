"""What a press with friction costs over the same press without, in Newton steps and states; neither has a clock."""

from unittest import mock

import numpy as np
import pytest

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid import friction_newton, newton
from pneutouch.mechanics.solid.continuation import descend
from pneutouch.mechanics.solid.indent import PressSettings, follower_of
from pneutouch.mechanics.solid.inflate import FreeState, first_touch, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere

RADIUS, STEPS = 9.25, 14


def cost(solid: SolidModel, free: FreeState, friction: float) -> tuple[int, int]:
    """Tangents that a press to 0.6 R0 assembled in Newton steps, and its states."""
    press = PressSettings(0.6 * RADIUS, STEPS, friction=friction, gauge_range=np.inf)
    solver = friction_newton if friction else newton
    with mock.patch.object(solver, "tangent", wraps=newton.tangent) as tangents:
        follower = follower_of(solid, free, press, first_touch(solid, free, None, 30.0))
        top = follower.here.height
        for k in range(1, STEPS + 1):
            assert descend(follower, top - 0.6 * k / STEPS) is None
    return tangents.call_count, len(follower.path)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("friction", "mu", "wall"), [(np.inf, 0.72, 0.101), (np.inf, 3.06, 0.119), (0.88, 2.24, 0.211), (1.05, 1.52, 0.228)]
)
def test_friction_takes_hardly_more_newton_steps(friction, mu, wall):
    """Presses that took up to twice as many where steps next to a solution were cut by the energy of held tractions, and
    twice the states where a suspect step was approached by bisection alone."""
    solid = SolidModel(dome(Hemisphere(RADIUS, RADIUS * wall)), neo_hookean(mu), base=RigidBase())
    free = state_at(solid, 0.0)
    without, states = cost(solid, free, 0.0)
    rough, rough_states = cost(solid, free, friction)
    assert rough <= 1.25 * without
    assert rough_states <= 1.3 * states
