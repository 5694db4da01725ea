"""The dome as predicted against the bodies around it."""

from __future__ import annotations

from pneutouch.evaluation.subject import subject_of
from pneutouch.printability import SensorContext, check


def meetings(evaluation):
    return [finding for finding in evaluation.findings if finding.rule == "freedom"]


def test_a_wide_soft_dome_meets_its_clamping_ring_and_no_glued_groove(evaluated):
    found = meetings(evaluated("soft-pad", "connector.seat=clamped-flange-M2"))
    assert [finding.severity for finding in found] == ["warning"]
    assert "meets the ring at 0 kPa, pressed by 11.25 mm" in found[0].message
    assert 0.3 < found[0].excess.measured < 1.5
    assert meetings(evaluated("soft-pad")) == []


def test_less_indentation_leaves_it_free(evaluated):
    assert meetings(evaluated("soft-pad", "connector.seat=clamped-flange-M2", "indentation.depth_mm=5")) == []
    assert meetings(evaluated("paper-dome", "connector.seat=clamped-flange-M2")) == []


def test_without_predicted_shapes_nothing_is_said(evaluated):
    evaluation = evaluated("soft-pad", "connector.seat=clamped-flange-M2", model="membrane")
    context = SensorContext(evaluation.prediction, evaluation.sensor, evaluation.rating)
    assert [f for f in check(subject_of(evaluation.assembly), context) if f.rule == "freedom"] == []
