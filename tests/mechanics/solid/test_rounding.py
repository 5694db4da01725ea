"""Newton's method on walls so thin that rounding the positions leaves more residual than the tolerance."""

import numpy as np
import pytest

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.elements import Regulator
from pneutouch.mechanics.solid.inflate import inflate
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene, direction, evaluate, rounding
from pneutouch.shape import shape_of


@pytest.mark.parametrize(("wall", "nu"), [(0.1, 0.499), (0.05, 0.499), (0.02, 0.49)])
def test_a_thin_flat_wall_is_inflated_past_its_limit_point(wall, nu):
    """Far from rest the positions and the stiffness are greater, and their rounding leaves more than at rest."""
    solid = SolidModel(dome(shape_of("disc", 10.0, wall, {})), neo_hookean(0.17, nu))
    run = inflate(solid, past_limit=1.2)
    assert run.limit is not None and run.limit.volume < run.states[-1].volume
    # the thin membrane's limit does not depend on the wall but by its product with the modulus
    assert run.limit.pressure * 10.0 / (0.17 * wall) == pytest.approx(1.885 if nu == 0.499 else 1.836, rel=5e-3)


@pytest.mark.parametrize("key", ["disc", "cap", "ellipsoid", "thimble", "hemisphere"])
@pytest.mark.parametrize(("wall", "nu"), [(1.5, 0.3), (0.5, 0.4999), (0.1, 0.49), (0.02, 0.49)])
def test_newton_stalls_at_the_residual_that_rounding_leaves(key, wall, nu):
    solid = SolidModel(dome(shape_of(key, 10.0, wall, {})), neo_hookean(1.0, nu))
    # a deflection far below the wall, so that no step needs a line search
    scene = SolidScene(solid, Regulator(1e-3 * (wall / 10.0) ** 3), None)
    state, stalled = evaluate(scene, solid.rest), []
    for _ in range(12):
        state = evaluate(scene, state.x + solid.expand(direction(scene, state).step))
        stalled.append(float(np.linalg.norm(state.residual)))
    assert 0.15 < np.median(stalled[6:]) / rounding(scene, state) < 0.5
    assert max(stalled[6:]) < rounding(scene, state)
