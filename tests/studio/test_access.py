"""The page breaks no rule of axe-core, whatever it shows."""

from __future__ import annotations

import pytest

from tests.browser import until
from tests.studio.access import violations
from tests.studio.served import SOLVED, move, solved

_EVERY_DAY = [(1400, False)]
_ALL = [
    pytest.param(width, dark, marks=() if (width, dark) in _EVERY_DAY else pytest.mark.slow)
    for width in (360, 1400)
    for dark in (False, True)
]


@pytest.mark.parametrize(("width", "dark"), _ALL)
def test_results_a_pinned_design_and_an_error_break_no_rule(width, dark, open_studio):
    page = open_studio(width=width, dark=dark, is_mobile=width < 600)
    solved(page, "#paper-dome")
    # With every field of the form open there is most to look at.
    page.evaluate("document.querySelectorAll('details').forEach((each) => (each.open = true))")
    assert violations(page) == []
    page.get_by_role("button", name="Pin").click()
    move(page, "Wall thickness, mm", 290)
    until(page, f"document.querySelectorAll('#comparison tbody tr').length > 5 && {SOLVED}")
    assert violations(page) == []
    page.evaluate("location.hash = '#paper-dome&membrane.wall_thickness_mm=14'")
    until(page, "document.querySelectorAll('.faulty').length === 2")
    assert violations(page) == []


def test_a_page_with_faults_is_found_out(pages):
    page = pages.open("data:text/html,<html><body><img src='data:,'><p style='color:%23aaa'>grey</p></body></html>")
    broken = {each.partition(":")[0] for each in violations(page)}
    assert {"document-title", "html-has-lang", "image-alt", "color-contrast"} <= broken
