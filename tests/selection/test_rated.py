"""The rated pressure of candidates: that of the evaluated design, and what it does to an answer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.evaluation.evaluate import evaluate
from pneutouch.mechanics import predict
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.selection.candidates import evaluated, margins, rated
from pneutouch.selection.problem import least_limit
from pneutouch.units import KPA
from pneutouch.workflows.select.checks import source_of
from pneutouch.workflows.select.document import would_need
from tests.mechanics.uncertainty.designs import materials
from tests.selection.targets import FINGERTIP, answer, document


@pytest.mark.parametrize("resin", ["TangoPlus", "FLX9970", "FLX9985", "FLX9995"])
@pytest.mark.parametrize("wall", [0.8, 1.5, 2.7])
def test_the_least_limit_is_that_of_the_prediction(library, resin, wall):
    """Limit point of the soft ones, break strain of the stiff ones."""
    sensor = material_sensor(materials(library)[resin]).replace(wall_thickness=wall)
    limits = predict("", sensor, [0.0], model="atlas").limits
    expected = min(value for value in (limits.limit_point, limits.break_strain) if value is not None)
    stretch = np.array([sensor.wall.break_stretch])
    found = sensor.wall.shear_modulus * least_limit(np.array([wall / 9.25]), stretch)[0]
    assert found == pytest.approx(expected, rel=2e-3)


def test_a_design_is_rated_as_its_file_is():
    selection = answer(FINGERTIP)
    for choice in selection.answer.designs[:2]:
        found = evaluate(source_of(selection.base, selection.assignments(choice)), model="atlas").rating
        assert choice.rated == pytest.approx(found.pressure, rel=3e-3)


@pytest.mark.slow
def test_no_design_is_driven_above_its_rated_pressure():
    """A free driving pressure is searched up to the rated one, a given one is a limit."""
    given = {"inner_radius_mm": 9.25, "wall_thickness_mm": 1.5, "materials": ["TangoPlus"]}
    free = answer({"sensitivity_kPa_per_N": 2.0}, given=given, setting={"base": "paper-dome"})
    for selection in (answer(FINGERTIP), free):
        assert selection.answer.designs
        for choice in selection.answer.designs:
            assert float(choice.pool.pressure[0]) <= choice.rated
    assert all(design["above_rated_pressure"] is False for design in document(free)["designs"])


def test_a_target_above_every_rated_pressure_says_so_and_what_it_would_take():
    """The paper's dome reads 1.95 kPa/N at 22 kPa and is rated 19.7 kPa."""
    given = {"inner_radius_mm": 9.25, "wall_thickness_mm": 1.5, "materials": ["TangoPlus"]}
    wanted = {"sensitivity_kPa_per_N": 1.95, "driving_pressure_kPa": 22.0}
    selection = answer(wanted, given=given, setting={"base": "paper-dome"})
    found = selection.answer
    assert found.designs == [] and found.nearest is not None
    assert found.nearest.margins["rated pressure"] == pytest.approx(19.73 / 22 - 1, abs=2e-3)
    assert [dropped.requirement for dropped in found.dropped] == ["rated pressure"]
    assert would_need(selection, found.dropped[0]) == "rated 19.7 kPa, driven at 22 kPa"
    assert document(selection)["dropped_requirements"][0]["design"]["above_rated_pressure"] is True


def test_a_narrower_modulus_widens_what_may_be_driven():
    """Candidates of one problem, once with limits as designed and once with a spread of a tenth: exp(-0.2) apart."""
    problem = replace(answer(FINGERTIP).problem, gauge_limit=10.0)
    number, radius, wall = np.zeros(3), np.array([8.0, 9.0, 10.0]), np.array([1.0, 1.2, 1.4])
    tenth = replace(problem, limit_spread=lambda resin, batch: np.full(len(batch), 0.1))
    bare = replace(problem, limit_spread=None)
    assert rated(tenth, number, radius, wall) == pytest.approx(np.exp(-0.2) * rated(bare, number, radius, wall))
    pool = evaluated(bare, number, radius, wall, np.full(3, 12 * KPA))
    assert "rated pressure" not in margins(bare, pool)
    assert margins(tenth, pool)["rated pressure"] == pytest.approx(rated(tenth, number, radius, wall) / (12 * KPA) - 1)
