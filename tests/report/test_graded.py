"""A graded design's datasheet shows how it is graded and what that does; any other's does not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pneutouch.evaluation.charts import in_resin
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.sheet import constant_membranes, sheet_data
from pneutouch.report.datasheet import CHARTS
from pneutouch.spec.read import parse_changes

SHALLOW = ["indentation.depth_mm=3", "indentation.steps=6", "pneumatics.driving_pressures_kPa=[0, 12]"]


@pytest.fixture(scope="module")
def graded():
    return evaluate("graded-dome", parse_changes(SHALLOW))


def graded_plots(sheet):
    return [plot for name, draw in CHARTS if name == "graded" and (plot := draw(sheet)) is not None]


@pytest.mark.slow
def test_a_graded_membrane_has_its_figures_in_the_same_bytes(graded):
    once, again = (graded_plots(sheet_data(graded, "")) for _ in range(2))
    assert len(once) == 5 and all(plot.caption for plot in once)
    assert once == again
    # The wall's cells are there one by one, on both sides of the axis.
    assert once[0].svg.count("<path") > 2 * 90


@pytest.mark.slow
def test_a_constant_membrane_has_none():
    found = evaluate("paper-dome", parse_changes(SHALLOW))
    assert graded_plots(sheet_data(found, "")) == []


@pytest.mark.slow
def test_constants_beyond_their_own_limit_are_drawn_as_far_as_they_go(graded):
    """The softest bears 40 kPa, the grade more: its curve ends, the sheet does not."""
    states = tuple(replace(s, driving_pressure=p) for s, p in zip(graded.prediction.states, (0.0, 0.05), strict=True))
    constants = constant_membranes(graded.sensor, replace(graded.prediction, states=states))
    assert [len(membrane.states) for membrane in constants] == [1, 2, 2]
    sheet = replace(sheet_data(graded, ""), constants=constants)
    assert len(graded_plots(sheet)) == 5


def test_other_resins_in_the_same_geometry_are_not_graded(graded, library):
    other = in_resin(graded.sensor, library.load("materials", "FLX9950"))
    assert other.wall.grade is None
    assert graded.sensor.wall.grade is not None
    assert np.ptp(graded.sensor.wall.grade[1]) > 1
