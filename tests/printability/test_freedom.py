"""The dome as predicted against the bodies around it."""

from __future__ import annotations

import pytest

from pneutouch.evaluation.subject import subject_of
from pneutouch.printability import SensorContext, check


def meetings(evaluation):
    return [finding for finding in evaluation.findings if finding.rule == "freedom"]


THROUGH = "contact.base=false"
"""The wall passes through its base and ring."""


@pytest.mark.slow
def test_a_wide_soft_dome_meets_its_clamping_ring_and_no_glued_groove(evaluated):
    found = meetings(evaluated("soft-pad", "connector.seat=clamped-flange-M2", THROUGH))
    assert [finding.severity for finding in found] == ["warning"]
    assert "meets the ring at 0 kPa, pressed by 11.25 mm" in found[0].message
    assert 0.3 < found[0].excess.measured < 1.5
    assert meetings(evaluated("soft-pad", THROUGH)) == []


@pytest.mark.slow
def test_a_wall_that_lies_down_on_the_ring_does_not_enter_it(evaluated):
    assert meetings(evaluated("soft-pad", "connector.seat=clamped-flange-M2")) == []


@pytest.mark.slow
def test_less_indentation_leaves_it_free(evaluated):
    short = evaluated("soft-pad", "connector.seat=clamped-flange-M2", "indentation.depth_mm=5", THROUGH)
    assert meetings(short) == []
    assert meetings(evaluated("paper-dome", "connector.seat=clamped-flange-M2", THROUGH)) == []


def test_without_predicted_shapes_nothing_is_said(evaluated):
    evaluation = evaluated("soft-pad", "connector.seat=clamped-flange-M2", model="membrane")
    context = SensorContext(evaluation.prediction, evaluation.sensor, evaluation.rating)
    assert [f for f in check(subject_of(evaluation.assembly), context) if f.rule == "freedom"] == []
