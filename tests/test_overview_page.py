"""The page of speed against accuracy is what the stored measurements say, and each way that it shows was measured."""

from __future__ import annotations

import math

import pytest
from benchmarks import overview_page
from benchmarks.overview_page import DOCS, OURS, panels

PANELS = panels()


def test_the_page_is_written_from_the_stored_measurements():
    assert (DOCS / "speed-against-accuracy.md").read_text(encoding="utf-8") == overview_page.page(PANELS)


@pytest.mark.parametrize("panel", PANELS, ids=[panel.title for panel in PANELS])
def test_every_panel_has_ours_and_a_peer_each_with_time_and_error(panel):
    assert {point.ours for point in panel.points} == {True, False}
    for point in panel.points:
        assert math.isfinite(point.time_ratio) and point.time_ratio > 0, point
        assert math.isfinite(point.error) and point.error >= 0, point
    assert any(
        math.isclose(point.time_ratio, 1.0, rel_tol=0.02) for point in panel.points if point.way.startswith(OURS)
    )
