"""Sets of touching points: solving by the points that changed is solving with the tangent of the new set."""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.mechanics.harmonic.model import HarmonicModel, PointSets
from pneutouch.mechanics.harmonic.surface import PlacedObject
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.indent import PressSettings, shut_in
from pneutouch.mechanics.solid.indenter import ball
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import SolidScene, SolverState, evaluate, tangent
from pneutouch.mechanics.solid.object_contact import ContactEvaluation
from pneutouch.shape.hemisphere import Hemisphere

RADIUS = 9.25


@dataclass(frozen=True)
class Pressed:
    """A state under a ball, its tangent, and two sets of touching points that differ in a few."""

    scene: SolidScene
    state: SolverState
    held: ContactEvaluation
    start: Array
    band: Array
    first: Flags
    other: Flags

    def sets(self, band: Array | None = None) -> PointSets:
        return PointSets(self.scene, self.state, self.held, self.start, self.band if band is None else band)


@cache
def _pressed() -> Pressed:
    solid = SolidModel(dome(Hemisphere(RADIUS, 1.5), arc=8, through=1), neo_hookean(0.27))
    free = state_at(solid, 0.005)
    model = HarmonicModel(solid, 2)
    gas = shut_in(solid, free, PressSettings(depth=1.0, steps=1))
    body = PlacedObject(ball(8.0).scaled(1.0 / RADIUS), 0.2).at(float(free.outer_apex / RADIUS) - 0.05)
    scene = SolidScene(model, gas, body)
    state = evaluate(scene, model.harmonics.lifted(free.unit.x))
    assert state is not None and state.touch is not None
    start = model.contact.linear(state.touch, np.zeros_like(state.x))
    first = start > 0.0
    assert 4 < first.sum() < first.size - 8
    other = first.copy()
    other.ravel()[np.flatnonzero(first)[:2]] = False
    other.ravel()[np.flatnonzero(~first)[-4:]] = True
    held = replace(state.touch, traction=np.zeros_like(start))
    return Pressed(scene, state, held, start, tangent(scene, state), first, other)


def test_changed_points_give_the_step_of_the_new_set() -> None:
    pressed = _pressed()
    one, fresh = pressed.sets(), pressed.sets()
    before = one.at(pressed.first)
    changed, direct = one.at(pressed.other), fresh.at(pressed.other)
    scale = float(np.abs(direct.step).max())
    assert np.abs(before.step - direct.step).max() > 1e-3 * scale
    assert changed.wall_stable and direct.wall_stable
    np.testing.assert_allclose(changed.step, direct.step, atol=1e-8 * scale)
    np.testing.assert_allclose(changed.soft, direct.soft, atol=1e-8 * float(np.abs(direct.soft).max()))


def test_what_made_a_tangent_definite_is_kept_on_its_diagonal_for_the_other_sets() -> None:
    """A tangent with a negative diagonal is lifted for the first set; the next is solved by the lifted one as it is."""
    pressed = _pressed()
    bent = pressed.band.copy(order="F")
    bent[0] -= 0.05 * bent[0].max()
    sets = pressed.sets(bent)
    lift = sets.at(pressed.first).lift
    assert lift > 0.0
    lifted = bent.copy(order="F")
    lifted[0] += lift
    ours, direct = sets.at(pressed.other), pressed.sets(lifted).at(pressed.other)
    assert direct.lift == 0.0
    np.testing.assert_allclose(ours.step, direct.step, atol=1e-8 * float(np.abs(direct.step).max()))
