"""A target against what was measured: met, missed, not decided, not answered."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.figures import summarize
from pneutouch.bench.record import MeasuredCurve
from pneutouch.spec.campaign import CampaignRun
from pneutouch.spec.read import validate
from pneutouch.spec.target import Target
from pneutouch.units import KPA
from pneutouch.workflows.characterize.predicted import ageing, verdicts

DEPTHS = np.linspace(0.0, 7.0, 15)


def curves(slopes, pressure=12.0, age=0.0):
    force = 1.5 * DEPTHS**1.5
    return [
        MeasuredCurve(
            CampaignRun(
                file=f"{k}{age}", sensor=f"s{k}", resin="TangoPlus", driving_pressure_kPa=pressure, age_days=age
            ),
            DEPTHS,
            force,
            slope * KPA * force,
            pressure * KPA,
        )
        for k, slope in enumerate(slopes)
    ]


def judged(wanted, slopes, pressure=12.0):
    target = validate(Target, {"target": wanted}, "target.toml")
    return [(v.passed, v.measured) for v in verdicts(target, summarize(curves(slopes, pressure)))]


WISH = {"sensitivity_kPa_per_N": 1.9, "tolerance_percent": 5.0, "driving_pressure_kPa": 12.0}


def test_an_interval_inside_is_met_outside_missed_and_across_not_decided():
    assert judged(WISH, (1.89, 1.90, 1.91))[0][0] is True
    assert judged(WISH, (2.19, 2.20, 2.21))[0][0] is False
    assert judged(WISH, (1.80, 1.90, 2.00))[0][0] is None


def test_a_wish_that_nothing_answers_is_not_met():
    assert judged(WISH, (1.89, 1.90, 1.91), pressure=22.0) == [(None, "not measured")]
    assert judged({"force_range_N": 15.0, "driving_pressure_kPa": 22.0}, (1.9, 1.9, 1.9)) == [(None, "not measured")]


def test_a_pressure_is_the_same_within_rounding():
    assert judged({**WISH, "driving_pressure_kPa": 12.0 + 1e-9}, (1.89, 1.90, 1.91))[0][0] is True


def test_one_run_decides_nothing():
    passed, said = judged(WISH, (1.9,))[0]
    assert passed is None and "no interval" in said


@pytest.mark.parametrize(("age", "published"), [(365.0, 14.76), (40.0, None)])
def test_ageing_is_over_the_aged_as_in_the_paper_and_beside_it_after_a_year_alone(library, age, published):
    groups = summarize([*curves((2.0, 2.02, 1.98)), *curves((1.6, 1.62, 1.58), age=age)])
    (row,) = ageing(groups, library)
    change, paper = row.sensitivity_change_percent, row.published_change_one_year_percent
    assert (row.resin, row.driving_pressure_kPa) == ("TangoPlus", 12.0)
    assert change == pytest.approx(-25.0, abs=0.2) and row.low < change < row.high and paper == published
