"""Everything registered is built with everything else and compared with stored figures."""

from __future__ import annotations

import json

import pytest

from pneutouch.catalogue import Library
from tests.catalogue.store import ROOT, STORED, cases, figures, label

LIBRARY = Library((ROOT,))
EXPECTED = json.loads(STORED.read_text(encoding="utf-8"))
CASES = cases(LIBRARY)


def test_stored_figures_cover_exactly_what_is_registered():
    assert set(EXPECTED) == {label(*case) for case in CASES}


@pytest.mark.parametrize(("design", "parts"), CASES, ids=[label(*case) for case in CASES])
def test_figures_are_the_stored_ones(design, parts):
    found, expected = figures(LIBRARY, design, parts), EXPECTED[label(design, parts)]
    assert found["findings"] == expected["findings"]
    assert found["triangles"] == expected["triangles"]
    for key in ("volume_mm3", "mesh_volume_mm3"):
        assert found[key] == pytest.approx(expected[key], rel=1e-6)
    for key in ("dead_volume_mm3", "limit_point_kPa", "sensitivity_kPa_per_N", "force_range_N"):
        assert found[key] == pytest.approx(expected[key], rel=2e-4)
