"""The harmonic model: how far fewer harmonics change a press, and that without any it is the solid."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch.mechanics import predict
from pneutouch.mechanics.models import harmonic as harmonic_states
from pneutouch.mechanics.models.harmonic import _change_from, _Curve
from pneutouch.mechanics.sensor import Dome, GasCircuit, IndentationProtocol, Sensor, WallMaterial
from pneutouch.mechanics.solid.indenter import ball
from pneutouch.shape.hemisphere import Hemisphere


class Press:
    """A press whose forces with fewer harmonics are a factor of those with all, or that has no equilibrium with them."""

    def __init__(self, factor):
        self.factor = factor

    def coarser(self, coarse, states):
        if self.factor is None:
            return None
        return [(self.factor * state.force, self.factor * state.rise) for state in states]


@pytest.mark.parametrize(("factor", "change"), [(1.0, 0.0), (0.98, 0.02), (1.05, 0.05), (None, np.inf)])
def test_a_force_that_differs_by_a_share_changes_the_figures_by_that_share(factor, change, monkeypatch):
    at = np.linspace(0.0, 5.0, 11)
    path = [SimpleNamespace(indentation=x, force=2.0 * x, rise=1e-3 * x) for x in at[1:]]
    monkeypatch.setattr(harmonic_states, "_curve", lambda sensor, pressed: _Curve(at, 2.0 * at, 1e-3 * at))
    found = _change_from(Press(factor), 4, SimpleNamespace(path=path), None)
    assert found == pytest.approx(change, abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("scene", [{}, {"friction": 0.5}, {"body": ball(10.0), "plate_radius": 10.0}], ids=str)
def test_pressed_centrally_it_is_the_solid(scene):
    """Without harmonics both solve one problem, each in its own coordinates."""
    sensor = Sensor(
        Dome(Hemisphere(9.25, 1.5)),
        WallMaterial(0.17, 0.49),
        GasCircuit(0.101325, dead_volume=0.0, gauge_limit=0.1),
        IndentationProtocol(plate_radius=15.0, depth=3.0, steps=6),
    ).replace(**scene)
    ours, theirs = (predict("", sensor, [0.012], model=name).states[0] for name in ("harmonic", "solid"))
    assert ours.figures.sensitivity == pytest.approx(theirs.figures.sensitivity, rel=1e-9)
    assert ours.figures.stiffness == pytest.approx(theirs.figures.stiffness, rel=1e-9)
