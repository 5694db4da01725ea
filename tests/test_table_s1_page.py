"""The stored cells of Table S1 are what the solid gives today, and their reduction is that of the cells."""

import json

import pytest
from benchmarks.paper import resins
from benchmarks.store import stored
from benchmarks.table_s1 import FACTORS, Assumptions, read, reduced, resin_rows

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
        *(pytest.param(FACTORS[name], marks=pytest.mark.slow) for name in ("grip", "rim as printed", "range to depth")),
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
        assert row.sensitivity[FACTORS["dead volume 0.2 mL"]] < row.sensitivity[Assumptions()]
