"""The error of a run's first contact, from the scatter of those of its indentations."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from pneutouch.bench.calibrate.observations import _travel_errors
from pneutouch.bench.indents import EARLY


def run(*onsets, lost=()):
    fitted = [SimpleNamespace(onset=onset, fitted=True) for onset in onsets]
    return SimpleNamespace(indents=[*(SimpleNamespace(onset=onset, fitted=False) for onset in lost), *fitted])


def test_the_spread_is_that_of_all_runs_and_falls_with_the_number_of_contacts():
    pairs, single = [(0.10, 0.14), (0.50, 0.44, 0.52)], 0.3
    pooled = np.sqrt(sum(np.var(each, ddof=1) * (len(each) - 1) for each in pairs) / 3)
    found = _travel_errors([run(*pairs[0]), run(*pairs[1], lost=(9.0,)), run(single)])
    assert found == pytest.approx(pooled * np.sqrt(0.5 * np.pi / np.array([2, 3, 1])))


def test_only_the_first_contacts_of_a_run_count():
    early = (0.1, 0.2, 0.15)[:EARLY]
    assert _travel_errors([run(*early, 5.0)]) == pytest.approx(_travel_errors([run(*early)]))


def test_without_two_contacts_of_one_run_there_is_no_spread():
    assert _travel_errors([run(0.1), run(0.2)]).tolist() == [0.0, 0.0]
