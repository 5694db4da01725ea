"""A ranking that counts an unknown place of contact: it changes, and it finds what depends least on the place."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from pneutouch.cli.app import app
from pneutouch.errors import InputError
from pneutouch.mechanics.uncertainty.sources.model_error import measured_errors
from pneutouch.selection.candidates import margins
from pneutouch.selection.choose import choose, places, searched
from pneutouch.spec.material import Material
from pneutouch.spec.target import Given, Setting, Target, TargetFigures, Weights
from pneutouch.workflows.select.base import base_scene
from pneutouch.workflows.select.checks import base_sensor, sensitivity_uncertainties
from pneutouch.workflows.select.select import problem_of, resins_of, select

FIGURES = TargetFigures(sensitivity_kPa_per_N=1.9, driving_pressure_kPa=12, force_range_N=15, max_diameter_mm=25)
"""The target of docs/background/off-axis.md."""


@pytest.fixture(scope="module")
def problem(library):
    target = Target(target=FIGURES)
    scene = base_scene(target, "target", library)
    sensor = base_sensor(scene)
    resins, _ = resins_of(target, "target", scene, sensor, library)
    errors = measured_errors(library.all("materials", Material))
    return problem_of(target, scene, sensor, resins), partial(sensitivity_uncertainties, scene, sensor, errors)


@pytest.fixture(scope="module")
def answers(problem):
    """The search without and with the place of contact."""
    plain, uncertainty = problem
    counted = replace(plain, anywhere=True), partial(uncertainty, anywhere=True)
    return choose(plain, (1.0, 0.0), uncertainty), choose(counted[0], (1.0, 0.0), counted[1])


def place_of(problem, choice):
    return float(places(problem, choice.pool)[0])


def test_the_ranking_changes_and_its_first_design_is_moved_less(problem, answers):
    plain, counted = (answer.designs for answer in answers)
    assert [one.place for one in plain] == [None] * len(plain)
    order = [[one.resin.name for one in designs[:5]] for designs in (plain, counted)]
    assert order[0] != order[1]
    assert counted[0].place < 0.9 * place_of(problem[0], plain[0])


def test_no_candidate_of_a_resin_that_fits_is_moved_much_less_than_its_best(problem, answers):
    """Against all candidates of the search, not those of the short list alone."""
    plain, _ = problem
    pool = searched(plain)
    fits = np.all([margin >= 0.0 for margin in margins(plain, pool).values()], axis=0)
    fitting = pool.take(fits)
    moved = places(plain, fitting)
    for number, resin in enumerate(plain.resins):
        rows = np.asarray(fitting.resin == number) & np.isfinite(moved)
        best = [one.place for one in answers[1].designs if one.resin.name == resin.name]
        if rows.any():
            assert min(best) <= 1.02 * float(moved[rows].min()) + 0.005


def test_the_place_is_counted_in_the_uncertainty_that_ranks(answers):
    for choice in answers[1].designs:
        assert choice.expanded > 2.0 * choice.place
    costs = [choice.cost for choice in answers[1].designs]
    best = len({choice.resin.name for choice in answers[1].designs})
    assert costs[:best] == sorted(costs[:best]) and costs[best:] == sorted(costs[best:])


def test_a_base_with_friction_cannot_be_ranked_by_it(library):
    target = Target(
        target=FIGURES,
        given=Given(materials=["TangoPlus"]),
        setting=Setting(assignments=["contact.friction=0.5"]),
        weights=Weights(contact_anywhere=True),
    )
    with pytest.raises(InputError, match="central plate calibrates") as caught:
        select(target, "target", library)
    assert caught.value.key == "weights.contact_anywhere"


def test_the_search_for_a_grade_refuses_it():
    with pytest.raises(ValueError, match="contact_anywhere ranks resins"):
        Target(
            target=TargetFigures(sensitivity_kPa_per_N=2, widest_range=True),
            given=Given(graded=True),
            weights=Weights(contact_anywhere=True),
        )


@pytest.mark.slow
def test_the_command_states_the_place_of_each_design(capsys):
    from typer.testing import CliRunner

    words = ["select", "--sensitivity", "1.9", "--at", "12", "--max-diameter", "25", "--material", "TangoPlus"]
    plain, counted = (
        json.loads(CliRunner().invoke(app, [*words, *more, "--json"]).stdout) for more in ([], ["--contact-anywhere"])
    )
    assert all("place_uncertainty_relative" not in design for design in plain["designs"])
    assert all(design["place_uncertainty_relative"] > 0.0 for design in counted["designs"])
