"""What a move costs the page: no shader anew, no chart that nobody sees, no address for each step of a slider."""

from __future__ import annotations

from collections import Counter

import pytest

from tests.browser import until
from tests.studio.served import SOLVED, move, solved

_COUNTED = """window.linked = 0;
const link = WebGL2RenderingContext.prototype.linkProgram;
WebGL2RenderingContext.prototype.linkProgram = function (program) { window.linked += 1; return link.call(this, program); };"""
_INFLATION = "document.querySelector('#inflation canvas').toDataURL()"


@pytest.mark.slow
def test_a_body_of_another_shape_is_drawn_by_the_shaders_that_there_are(pages, studio):
    page = pages.open("about:blank", storage_state=studio.profile())
    page.add_init_script(_COUNTED)
    page.goto(studio.home)
    until(page, f"{SOLVED} && window.linked > 0")
    first = page.evaluate("window.linked")
    for place in (290, 280):
        drawn = sum(each.endswith("/api/view") for each in pages.requested)
        move(page, "Wall thickness, mm", place)
        until(page, f"document.body.dataset.solved === location.hash && {SOLVED}")
        assert sum(each.endswith("/api/view") for each in pages.requested) > drawn
        page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert page.evaluate("window.linked") == first


@pytest.mark.slow
def test_a_chart_outside_the_window_is_drawn_when_the_moves_pause(open_studio):
    page = open_studio(height=500)
    solved(page, "#paper-dome")
    assert page.evaluate("document.getElementById('inflation').getBoundingClientRect().top > innerHeight")
    before = page.evaluate(_INFLATION)
    page.route("**/api/intervals", lambda route: None)
    page.route("**/api/solved", lambda route: None)
    painted = int(page.evaluate("document.body.dataset.painted"))
    move(page, "Wall thickness, mm", 250)
    until(page, f"Number(document.body.dataset.painted) > {painted}")
    assert page.evaluate(_INFLATION) == before
    page.locator("#inflation").scroll_into_view_if_needed()
    until(page, f"{_INFLATION} !== {before!r}")


@pytest.mark.slow
def test_the_address_follows_a_slider_that_is_held(screen):
    solved(screen, "#paper-dome")
    slider = screen.get_by_role("slider", name="Wall thickness, mm", exact=True)
    slider.evaluate("slider => { slider.value = 250; slider.dispatchEvent(new Event('input')); }")
    assert screen.evaluate("location.hash") == "#paper-dome"
    until(screen, "location.hash.includes('membrane.wall_thickness_mm=')")
    wall = screen.evaluate("document.getElementById('field-membrane-wall_thickness_mm').value")
    assert screen.evaluate("location.hash") == f"#paper-dome&membrane.wall_thickness_mm={wall}"


def test_a_page_that_is_left_in_the_middle_of_a_move_keeps_it_in_its_address(screen):
    slider = screen.get_by_role("slider", name="Wall thickness, mm", exact=True)
    slider.evaluate("""slider => { slider.value = 250; slider.dispatchEvent(new Event('input'));
    window.dispatchEvent(new Event('pagehide')); }""")
    assert "membrane.wall_thickness_mm=" in screen.evaluate("location.hash")


@pytest.mark.slow
def test_a_slider_that_is_let_go_asks_once(screen, pages):
    """It reports the place of its last move again, which is no other question."""
    solved(screen, "#paper-dome")
    sent = len(pages.requested)
    for place in (290, 280, 270):
        move(screen, "Wall thickness, mm", place)
        until(screen, f"document.body.dataset.solved === location.hash && {SOLVED}")
    asked = Counter(each.rpartition("/")[2] for each in pages.requested[sent:])
    assert asked["quick"] == asked["solved"] == 3
    assert max(asked.values()) == 3
