"""Fronts under a contact that the atlas does not cover: against the solid at their own places."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.evaluation import evaluate
from pneutouch.evaluation.charts import resized, tradeoff_problem
from pneutouch.mechanics.models.atlas import MODEL
from pneutouch.selection.contact_search import SolvedStates, tried
from pneutouch.selection.front import contact_front, front, place


def problem_of(evaluation, pressure: float, *resins: str):
    problem = tradeoff_problem(evaluation, pressure)
    return replace(problem, resins=tuple(resin for resin in problem.resins if resin.name in resins))


@pytest.mark.slow
def test_a_contact_that_changes_nothing_leaves_the_fronts_as_they_are(evaluated):
    """The places on the fronts are answered by the atlas itself."""
    sensor = evaluated("paper-dome", model="atlas").sensor
    problem, asked = problem_of(evaluated("paper-dome", model="atlas"), 0.022, "FLX9950"), []

    def solve(resin, pool, pressures):
        radius, wall = float(pool.radius[0]), float(pool.wall[0])
        asked.append((radius, wall))
        sized = sensor.replace(inner_radius=radius, wall_thickness=wall, depth=problem.depth_share * radius)
        sized = sized.replace(shear_modulus=resin.shear_modulus, break_stretch=resin.break_stretch)
        return SolvedStates(MODEL.answer_one(sized, np.array(pressures)).result.states)

    (plain,), drawn = front(problem), contact_front(problem, solve)
    (found,) = drawn.fronts
    assert len(set(asked)) == 5
    assert drawn.median_error <= drawn.greatest_error < 2e-3
    assert found.force == pytest.approx(plain.force, rel=2e-3)
    assert found.sensitivity == pytest.approx(plain.sensitivity, rel=2e-3)


@pytest.mark.slow
def test_a_solver_without_answers_corrects_nothing(evaluated):
    problem = problem_of(evaluated("paper-dome", model="atlas"), 0.022, "FLX9950")
    (plain,), drawn = front(problem), contact_front(problem, lambda *_: SolvedStates((), "none"))
    (found,) = drawn.fronts
    assert np.isnan(drawn.greatest_error)
    np.testing.assert_array_equal(found.force, plain.force)


@pytest.mark.slow
@pytest.mark.parametrize(
    "contact", [{"contact.friction": 0.6}, {"contact.object": "ball", "contact.ball_radius_mm": 10.0}], ids=str
)
def test_places_of_a_front_solved_again_are_within_the_stated_error(contact):
    """Those between the solved ones too, eight of ten; the plate without friction is off by
    more than a tenth, and twice as far in the middle."""
    changes = {"pneumatics.driving_pressures_kPa": [10.0], "indentation.checked_waves": 0, **contact}
    evaluation = evaluate("paper-dome", changes)
    problem = problem_of(evaluation, 0.010, "TangoPlus", "FLX9985")
    solve, draw, off, plate = resized(evaluation.sensor, problem), np.random.default_rng(3), [], []
    drawn = contact_front(problem, solve)
    for number, one in enumerate(drawn.fronts):
        for row in draw.integers(0, one.force.size, 5).tolist():
            trial = tried(problem, place(problem, number, one, row), solve)
            assert not trial.why
            exact_kPa_per_N, force = trial.pool.response.lines.sensitivity[0], trial.pool.force[0]
            off.append((one.sensitivity[row] / exact_kPa_per_N - 1.0, one.force[row] / force - 1.0))
            plate.append(abs(trial.atlas.lines.sensitivity[0] / exact_kPa_per_N - 1.0))
    differences = np.abs(off).max(axis=1)
    assert np.mean(differences <= drawn.greatest_error) >= 0.8
    assert np.median(differences) < 0.5 * np.median(plate)
    assert max(plate) > 0.1
