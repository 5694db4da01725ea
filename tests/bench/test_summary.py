"""Runs to groups: what belongs together, and what does not."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.figures import FRESH, summarize
from pneutouch.bench.record import MeasuredCurve
from pneutouch.spec.campaign import CampaignRun
from pneutouch.units import KPA

DEPTHS = np.linspace(0.0, 7.0, 15)


def run(sensor, slope=2.0, pressure=0.0, number=1, age=0.0, resin="TangoPlus"):
    force = 1.5 * DEPTHS**1.5
    named = CampaignRun(
        file=f"{sensor}{pressure}{number}{age}",
        sensor=sensor,
        resin=resin,
        driving_pressure_kPa=pressure,
        run=number,
        age_days=age,
    )
    return MeasuredCurve(named, DEPTHS, force, slope * KPA * force, pressure * KPA)


def ages(*days):
    return [group.key.age for group in summarize([run("a", age=day) for day in days])]


def test_a_print_of_a_week_is_fresh_and_one_of_two_weeks_is_not():
    assert ages(0, 2, FRESH) == ["fresh"]
    assert ages(0, 14) == ["fresh", "14 days"]
    assert ages(40, 42, 365, 370) == ["41 days", "12 months"]
    assert ages(8) == ["8 days"]
    # Apart by 3 days or 5 %, whichever is more.
    assert [len(ages(40, other)) for other in (43, 44)] == [1, 2]
    assert [len(ages(400, other)) for other in (420, 421)] == [1, 2]


def test_groups_are_of_one_resin_age_and_pressure():
    curves = [run(f"{resin}-{k}", resin=resin, pressure=p) for resin in ("B", "A") for k in (1, 2) for p in (22.0, 0.0)]
    result = summarize(curves)
    assert [(g.key.resin, g.key.driving_pressure_kPa) for g in result] == [
        ("A", 0.0),
        ("A", 22.0),
        ("B", 0.0),
        ("B", 22.0),
    ]
    assert all(len(group.curves) == 2 and len(group.sensors) == 2 for group in result)


def test_means_are_over_specimens_and_spreads_are_separate():
    slopes = {"a": (1.9, 2.1), "b": (2.9, 3.1), "c": (2.4, 2.6)}
    (group,) = summarize(
        [run(name, slope, number=k + 1) for name, pair in slopes.items() for k, slope in enumerate(pair)]
    )
    figures = group.figures
    assert figures["sensitivity_kPa_per_N"].value == pytest.approx(2.5)
    assert figures["repeatability_kPa_per_N"].value == pytest.approx(0.1 * np.sqrt(2))
    assert figures["part_to_part_kPa_per_N"].value == pytest.approx(0.5)
    assert (figures["sensitivity_kPa_per_N"].specimens, figures["sensitivity_kPa_per_N"].runs) == (3, 6)


def test_the_order_of_runs_and_the_names_of_specimens_do_not_matter():
    one = [run(name, slope) for name, slope in (("a", 2.0), ("b", 2.2), ("c", 2.1), ("d", 2.4), ("e", 1.9))]
    other = [run(name, slope) for name, slope in (("z", 2.2), ("y", 2.0), ("x", 2.4), ("w", 1.9), ("v", 2.1))]
    first, second = (summarize(curves)[0].figures["sensitivity_kPa_per_N"] for curves in (one, other))
    assert (first.value, first.low, first.high) == pytest.approx((second.value, second.low, second.high))
