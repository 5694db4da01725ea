"""Everything registered is built with everything else and compared with stored figures."""

from __future__ import annotations

import json

import pytest

from pneutouch.catalogue import Library
from tests.catalogue.store import ROOT, SMALL, STORED, assembled, combinations, design_figures, shape_figures

LIBRARY = Library((ROOT,))
EXPECTED = json.loads(STORED.read_text(encoding="utf-8"))
PARTS = combinations(LIBRARY)
DEAR = {"agilus-dome", "cast-dome", "graded-dome", "long-tube", "soft-pad", "stiff-dome"}
SHAPES = ("volume_mm3", "mesh_volume_mm3")


def compare_shapes(found, expected):
    assert found["triangles"] == expected["triangles"]
    assert found["internal_volume_mm3"] == pytest.approx(expected["internal_volume_mm3"], rel=1e-6)
    for key in SHAPES:
        assert found[key] == pytest.approx(expected[key], rel=1e-6)


def test_stored_figures_cover_exactly_what_is_registered():
    assert set(EXPECTED["designs"]) == set(LIBRARY.paths("designs"))
    assert set(EXPECTED["parts"]) == {" ".join(parts) for parts in PARTS}


@pytest.mark.parametrize(
    "design",
    [pytest.param(name, marks=pytest.mark.slow) if name in DEAR else name for name in LIBRARY.paths("designs")],
)
def test_figures_of_designs_are_the_stored_ones(design):
    found, expected = design_figures(LIBRARY, design), EXPECTED["designs"][design]
    assert found["findings"] == expected["findings"]
    compare_shapes(found, expected)
    # A law that stiffens has no limit point.
    assert (found["limit_point_kPa"] is None) == (expected["limit_point_kPa"] is None)
    for key in ("dead_volume_mm3", "limit_point_kPa", "sensitivity_kPa_per_N", "force_range_N"):
        assert expected[key] is None or found[key] == pytest.approx(expected[key], rel=2e-4)


@pytest.mark.slow
@pytest.mark.parametrize("parts", PARTS, ids=" ".join)
def test_figures_of_parts_are_the_stored_ones(parts):
    compare_shapes(shape_figures(assembled(LIBRARY, parts, *SMALL)), EXPECTED["parts"][" ".join(parts)])
