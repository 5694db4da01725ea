"""Random objects, friction, walls and gas: every press ends at its depth or by a typed event."""

import numpy as np
import pytest

from pneutouch.mechanics.events import BREAKS_CURVE, DETAIL, OBJECT_EDGE
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.indenter import ProfileVertex, ball, cone, profile, ring
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import CELLS_PER_RADIUS, arc_cells, dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere

ENDS = {*BREAKS_CURVE, "floor"} - {"separation"}
FRICTION = (0.0, 0.0, 0.3, 0.6, 1.5, np.inf)


def draw(random):
    """An object for a dome of inner radius 1, whose least radius needs at most 96 cells."""
    kind, size = random.integers(5), float(np.exp(random.uniform(np.log(0.15), np.log(5.0))))
    if kind == 0:
        return ball(size)
    if kind == 1:
        return cone(float(random.uniform(np.pi / 6, 1.4)), max(0.1, 0.3 * size))
    if kind == 2:
        return ring(float(random.uniform(0.3, 0.8)), float(random.uniform(0.1, 0.25)))
    if kind == 3:
        return profile([ProfileVertex(0, 0), ProfileVertex(0.5, 0, 0.2), ProfileVertex(1.0, 0.4, 0.2)])
    return None


def scene(seed):
    random = np.random.default_rng(seed)
    body, wall = draw(random), float(random.uniform(0.05, 0.4))
    least = np.inf if body is None else body.smallest
    cells = max(
        int(arc_cells(0.5 * np.pi, np.array(wall))), int(np.ceil(CELLS_PER_RADIUS * 0.5 * np.pi * (1 + wall) / least))
    )
    solid = SolidModel(dome(Hemisphere(1.0, wall), arc=cells), neo_hookean(1.0))
    limit = inflate(solid, past_limit=1.0)
    assert limit.limit is not None
    free = state_at(solid, float(random.uniform(0.0, 0.8)) * limit.limit.pressure, limit)
    gas = {
        "ambient": float(np.exp(random.uniform(np.log(0.02), 0.0))),
        "dead_volume": float(random.choice([0.0, 2, 1e4])),
    }
    friction = float(random.choice(FRICTION))
    press = PressSettings(0.7, 10, plate_diameter=None, gauge_range=np.inf, body=body, friction=friction, **gas)
    return press, indent(solid, free, press)


def check(seed):
    press, run = scene(seed)
    kinds = [event.kind for event in run.events]
    assert run.complete or set(kinds) & ENDS, kinds
    assert all(event.detail for event in run.events) and set(kinds) <= {*DETAIL, *ENDS, OBJECT_EDGE, "sway", "lobes"}
    force, travel = run.column("force"), run.column("indentation")
    assert np.isfinite(force).all() and (force >= 0).all()
    assert (np.diff(travel) > 0).all() and travel[-1] <= press.depth * (1 + 1e-9)
    held = (run.column("pressure") + press.ambient) * (run.column("volume") + press.dead_volume)
    assert held == pytest.approx(held[0], rel=1e-9)
    return kinds


def test_a_random_object_is_pressed_to_its_depth_or_to_an_event():
    check(1)


@pytest.mark.slow
def test_forty_random_objects_are_pressed_to_their_depths_or_to_events():
    for seed in range(40):
        check(seed)
