"""The page breaks no rule of axe-core, whatever it shows."""

from __future__ import annotations

import pytest

from tests.browser import until
from tests.studio.access import violations
from tests.studio.served import SOLVED, move, solved

_WRONG = "#paper-dome&membrane.wall_thickness_mm=14"


def _pinned_and_wrong(page) -> None:
    """Pin the design and go to one that cannot work: all that the page has is shown then."""
    page.get_by_role("button", name="Pin", exact=True).click()
    move(page, "Wall thickness, mm", 290)
    until(page, f"document.querySelectorAll('#comparison tbody tr').length > 5 && {SOLVED}")
    page.evaluate(f"location.hash = {_WRONG!r}")
    until(page, "document.querySelectorAll('.faulty').length === 2")


@pytest.mark.slow
def test_a_pinned_design_and_an_error_break_no_rule(screen):
    solved(screen, "#paper-dome")
    # With every field of the form open there is most to look at.
    screen.evaluate("document.querySelectorAll('details').forEach((each) => (each.open = true))")
    _pinned_and_wrong(screen)
    assert violations(screen) == []


@pytest.mark.slow
@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", [360, 1400])
def test_every_state_breaks_no_rule_at_every_width_in_light_and_dark(width, dark, open_studio):
    page = open_studio(width=width, dark=dark, is_mobile=width < 600)
    solved(page, "#paper-dome")
    page.evaluate("document.querySelectorAll('details').forEach((each) => (each.open = true))")
    assert violations(page) == []
    page.get_by_role("button", name="Pin", exact=True).click()
    until(page, "!document.getElementById('compared').hidden")
    assert violations(page) == []
    page.get_by_role("button", name="Unpin").click()
    _pinned_and_wrong(page)
    assert violations(page) == []


@pytest.mark.slow
def test_a_page_with_faults_is_found_out(pages):
    page = pages.open("data:text/html,<html><body><img src='data:,'><p style='color:%23aaa'>grey</p></body></html>")
    broken = {each.partition(":")[0] for each in violations(page)}
    assert {"document-title", "html-has-lang", "image-alt", "color-contrast"} <= broken
