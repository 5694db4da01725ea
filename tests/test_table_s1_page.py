"""The stored cells of Table S1 are what the solid gives today, and their reduction is that of the cells."""

import json

import numpy as np
import pytest
from benchmarks.paper import resins
from benchmarks.store import stored
from benchmarks.table_s1 import ALL, Assumptions, ranked, read, reduced, resin_rows, spread

from pneutouch.catalogue import Library
from tests.conftest import ROOT

KNOWN = stored("table-s1")
ROWS = read(KNOWN["cells"])


def test_the_summary_is_that_of_the_stored_cells():
    assert json.loads(json.dumps(reduced(ROWS))) == KNOWN["summary"]


@pytest.mark.parametrize(
    "assumed",
    [
        Assumptions(),
        pytest.param(Assumptions(friction=0.3, dead_volume_mL=0.2), marks=pytest.mark.slow),
        pytest.param(Assumptions(friction=np.inf, range="depth"), marks=pytest.mark.slow),
        pytest.param(Assumptions(friction=0.6, rim="as printed"), marks=pytest.mark.slow),
    ],
)
def test_cells_are_what_the_solid_gives_today(assumed):
    soft = resins(Library((ROOT,)))[0]
    for row, known in zip(resin_rows(soft, (assumed,)), ROWS, strict=False):
        assert (row.material, row.pressure_kPa) == (known.material, known.pressure_kPa)
        assert row.sensitivity[assumed] == pytest.approx(known.sensitivity[assumed], rel=1e-4)
        assert row.ends[assumed][0] == pytest.approx(known.ends[assumed][0], abs=0.01)


def test_air_softens_the_reading_of_every_cell():
    for row in ROWS:
        for assumed in ALL:
            if assumed.dead_volume_mL == 0:
                more = row.sensitivity[assumed._replace(dead_volume_mL=0.2)]
                assert more < row.sensitivity[assumed] * 1.001


def test_the_best_combination_ranks_first_and_the_default_lies_in_the_span():
    order = ranked(ROWS[:12])
    assert len(order) == len(ALL) == len(set(order))
    for row in ROWS:
        low, high = spread(row)
        assert low <= row.sensitivity[Assumptions()] <= high
