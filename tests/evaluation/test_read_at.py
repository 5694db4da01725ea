"""A prediction read at the depths of runs: a sensor that obeys it has the predicted figures, however deep each run went."""

from __future__ import annotations

import numpy as np
import pytest

from pneutouch.bench.figures import line_figures
from pneutouch.evaluation.comparison import figures_at
from pneutouch.mechanics.response import figures

TRAVEL = np.linspace(0.0, 7.0, 29)
RANGE_END = 7.0


def curve(travel):
    """Force (N) and rise (kPa) of a dome that stiffens: neither goes straight with travel."""
    return 0.4 * travel**1.8, 0.9 * travel**1.7


def measured(specimens):
    """Figures as a campaign has them: of each run, averaged over runs and then over specimens."""
    each = [[line_figures(figures(at, *curve(at))) for at in runs] for runs in specimens]
    keys = set.intersection(*(set(one) for runs in each for one in runs))
    return {key: np.mean([np.mean([one[key] for one in runs]) for runs in each]) for key in keys}


@pytest.mark.parametrize("ends", [[[6.9]], [[5.9], [6.9]], [[5.5, 6.9, 6.8], [6.9]]])
def test_a_sensor_that_obeys_the_prediction_is_not_off(ends):
    specimens = [[np.linspace(0.0, end, 12) for end in runs] for runs in ends]
    read = figures_at(TRAVEL, *curve(TRAVEL), RANGE_END, specimens)
    for key, value in measured(specimens).items():
        assert read[key] == pytest.approx(value, rel=2e-3, abs=2e-3), key


def test_a_depth_just_beyond_the_range_is_read_at_its_end():
    """First contact is found to some 0.01 mm: the last step of a run must not be lost to that, nor its force."""
    depths = np.linspace(0.0, 1.0014 * RANGE_END, 15)
    read = figures_at(TRAVEL, *curve(TRAVEL), RANGE_END, [[depths]])
    whole = line_figures(figures(depths, *curve(depths)))
    for key in ("force_range_N", "stiffness_N_per_mm", "sensitivity_kPa_per_N"):
        assert read[key] == pytest.approx(whole[key], rel=0.01), key


def test_what_is_beyond_the_predicted_range_is_left_out():
    read = figures_at(TRAVEL, *curve(TRAVEL), 5.0, [[np.linspace(0.0, 6.0, 13)]])
    assert read["force_range_N"] == pytest.approx(curve(np.array(5.0))[0], rel=1e-3)
    assert figures_at(TRAVEL, *curve(TRAVEL), 0.0, [[np.linspace(0.0, 6.0, 13)]]) == {}
