"""The order of the harmonics: how fast an answer settles where nothing touches the wall."""

from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.harmonic.model import HarmonicModel
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.elements import TermState
from pneutouch.mechanics.solid.indent import PressSettings, shut_in
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.mechanics.solid.newton import NewtonFailure, SolidScene, minimise
from pneutouch.shape.hemisphere import Hemisphere

ANGLES = np.arange(256) * 2.0 * np.pi / 256


@dataclass
class _SidewaysLoad:
    """A dead load outwards on the outer wall, per area at rest in mu: smooth around the axis, with all harmonics."""

    model: HarmonicModel
    most: float
    noise: float = 0.0

    def at(self, x: Array) -> TermState:
        model, order = self.model, self.model.harmonics.order
        contact = SolidModel(model.mesh, model.material).contact
        shares = np.zeros(len(x))
        np.add.at(shares, contact.edges, contact.weight @ contact.shape)
        wave = np.exp(np.cos(ANGLES) - 1.0) * self.most
        push = np.zeros_like(x)
        push[:, 0] = shares * wave.mean()
        for m in range(1, order + 1):
            push[:, 3 * m - 1] = shares * (wave * np.cos(m * ANGLES)).mean()
        # Where a coefficient is free it is an unknown or its negative.
        free, sign = model.dofs >= 0, model.expand(np.ones(model.size))
        flat = np.bincount(model.dofs[free], (push * sign)[free], model.size)
        return TermState(-float(np.vdot(push, x)), -flat)


def test_a_smooth_load_settles_a_hundredfold_from_two_to_eight_harmonics() -> None:
    solid = SolidModel(dome(Hemisphere(9.25, 1.5), arc=6, through=1), neo_hookean(0.27))
    free = state_at(solid, 0.005)
    gas = shut_in(solid, free, PressSettings(depth=1.0, steps=1))
    figures = {}
    for order in (2, 4, 8, 16):
        model = HarmonicModel(solid, order)
        scene = SolidScene(model, gas, None, (_SidewaysLoad(model, 0.06),))
        solved = minimise(scene, model.harmonics.lifted(free.unit.x))
        assert not isinstance(solved, NewtonFailure)
        state = solved.state
        figures[order] = np.array([state.energy, state.filling.pressure, state.x[solid.mesh.axis[0], 2]])
    # Energy, pressure and sideways displacement of the pole: from 2 to 4, 4 to 8 and 8 to 16.
    first, second, third = (np.abs(figures[2 * m] / figures[m] - 1.0) for m in (2, 4, 8))
    assert (first > 1e-7).all()
    assert (second < 1e-2 * first).all()
    assert (third < 1e-2 * second).all()
