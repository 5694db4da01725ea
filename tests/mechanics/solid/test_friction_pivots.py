"""The points of a linear model of contact and friction settled one after another: its answer solves the model."""

from unittest import mock

import numpy as np
import pytest

from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.sensor import RigidBase
from pneutouch.mechanics.solid.friction_linear import LinearContact, PiecewiseLine, PointStatus, PointTractions
from pneutouch.mechanics.solid.friction_newton import StepSettling
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere

N, SIZE, RADIUS = 8, 12, 9.25


def _tractions(status, at, grip, held):
    normal = np.where(status.touching, at.normal, 0.0)
    slides = status.sign * (grip if held else grip * normal)
    return np.concatenate([normal, np.where(status.bearing & (status.sign == 0.0), at.trial, slides)])


def _status(at, grip, held):
    touching = at.normal > 0.0
    cap = grip if held else grip * np.maximum(at.normal, 0.0)
    bearing = np.full(N, True) if held else touching
    return PointStatus(touching, bearing, np.where(bearing & (np.abs(at.trial) > cap), np.sign(at.trial), 0.0))


class _Model:
    """A wall of random stiffness with points that touch or not, loaded at random; held: their largest tractions are."""

    def __init__(self, seed, held):
        random = np.random.default_rng(seed)
        root, self.rows = random.normal(size=(SIZE, SIZE)), random.normal(size=(2 * N, SIZE))
        self.wall, self.load = root @ root.T + np.eye(SIZE), 5.0 * random.normal(size=SIZE)
        self.areas, self.held = random.uniform(1.0, 3.0, (2, N)), held
        self.grip = random.uniform(0.5, 2.0, N) if held else random.uniform(0.05, 0.3, N)
        self.start = random.normal(size=2 * N)

    def at(self, move):
        return PointTractions(*(self.start + self.rows @ move).reshape(2, N))

    def status(self, move):
        return _status(self.at(move), self.grip, self.held)

    def residual(self, move, status):
        borne = _tractions(status, self.at(move), self.grip, self.held)
        return self.wall @ move + self.load + self.rows.T @ (self.areas.ravel() * borne)

    def solved(self, status):
        """The move that a status leads to, and the matrix of its system."""
        still = self.residual(np.zeros(SIZE), status)
        matrix = np.stack([self.residual(one, status) - still for one in np.eye(SIZE)], axis=1)
        return -np.linalg.solve(matrix, still), matrix


@pytest.mark.parametrize("held", [False, True])
def test_the_answer_solves_the_model(held):
    """The residual with the tractions that the points bear vanishes, and the first status seldom is the last."""
    changed = 0
    for seed in range(40):
        model, still = _Model(seed, held), np.zeros(SIZE)
        first = model.status(still)
        move, matrix = model.solved(first)
        response = model.rows @ np.linalg.solve(matrix, model.rows.T)
        line = PiecewiseLine(first, model.at(still), model.at(move), response, model.areas, model.grip, held)
        found = line.status()
        assert found is not None
        changed += found != first
        answer, _ = model.solved(found)
        assert np.abs(model.residual(answer, model.status(answer))).max() < 1e-9
    assert changed > 20


def test_a_thin_wall_is_settled_in_fewer_rounds_to_the_same_forces():
    """A wall of 0.07 R0 with a coefficient of 0.72, whose points bear next to nothing inside the contact."""
    solid = SolidModel(dome(Hemisphere(RADIUS, 0.07 * RADIUS)), neo_hookean(1.08), base=RigidBase())
    free, press = state_at(solid, 0.0), PressSettings(0.3 * RADIUS, 7, friction=0.72, gauge_range=np.inf)
    rounds, forces = [], []
    for in_pieces in (True, False):
        with (
            mock.patch.object(LinearContact, "IN_PIECES", in_pieces),
            mock.patch.object(StepSettling, "_solve", autospec=True, side_effect=StepSettling._solve) as solved,
        ):
            forces.append(indent(solid, free, press).column("force"))
        rounds.append(solved.call_count)
    assert rounds[0] <= 0.75 * rounds[1]
    assert forces[0] == pytest.approx(forces[1], rel=1e-7, abs=1e-9)
