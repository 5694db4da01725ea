"""The page in a browser; left out, and said so, where there is none."""

from __future__ import annotations

import json
from urllib.parse import urlsplit

import pytest

from tests.report.browser import FOUND, WHY_NOT, WITH_WEBGL, WITHOUT_WEBGL, browser
from tests.studio.served import served, until

pytestmark = [pytest.mark.slow, pytest.mark.skipif(FOUND is None, reason=WHY_NOT)]

_SOLVED = "document.getElementById('status')?.textContent === 'Answered by the model solid.'"
_MOVE = """(slider => {{ slider.value = {place}; slider.dispatchEvent(new Event('input')); slider.dispatchEvent(new Event('change')); }})
(document.querySelector('[aria-label="Wall thickness, mm"]'))"""
_TOO_WIDE = """[...document.querySelectorAll('body *')].filter(e => !e.closest('.scroll') && !e.closest('svg') &&
!e.matches('.skip') && e.getBoundingClientRect().right > innerWidth + 0.5).map(e => e.tagName + e.className)"""
_UNNAMED = """[...document.querySelectorAll('input, select, button, canvas')].filter(e => !(e.labels && e.labels.length) &&
!e.getAttribute('aria-label') && !e.textContent.trim()).map(e => e.outerHTML)"""


@pytest.fixture(scope="module")
def studio():
    with served() as (address, _):
        yield address


@pytest.fixture(scope="module")
def screen(studio, tmp_path_factory):
    with browser(tmp_path_factory.mktemp("browser"), *WITH_WEBGL) as opened:
        opened.visit(studio, 1400)
        until(opened, _SOLVED)
        yield opened


def test_a_slider_moves_the_figures_of_the_commands(screen, command):
    screen.evaluate(_MOVE.format(place=280))
    until(screen, f"document.body.dataset.solved?.includes('wall_thickness_mm') && {_SOLVED}")
    wall = screen.evaluate("document.getElementById('field-membrane-wall_thickness_mm').value")
    assert screen.evaluate("location.hash") == f"#paper-dome&membrane.wall_thickness_mm={wall}"
    said = json.loads(command("predict", "paper-dome", "--set", f"membrane.wall_thickness_mm={wall}", "--json").stdout)
    shown = screen.evaluate(
        "[...document.querySelectorAll('#figures tbody tr')].map(e => e.children[1].textContent.split(' ')[0])"
    )
    expected = [state["sensitivity_kPa_per_N"] for state in said["states"]]
    assert [float(text) for text in shown] == [float(f"{value:.4g}") for value in expected]
    assert (
        screen.evaluate(
            "document.querySelectorAll('#sensitivity canvas, #force canvas, #rise canvas, #inflation canvas').length"
        )
        == 4
    )
    screen.evaluate("document.getElementById('undo').click()")
    until(screen, f"document.body.dataset.solved === '#paper-dome' && {_SOLVED}")
    assert screen.evaluate("document.getElementById('field-membrane-wall_thickness_mm').value") == "1.5"


def test_a_resin_takes_a_printer_that_runs_it(screen):
    screen.evaluate(
        "(e => { e.value = 'Agilus30'; e.dispatchEvent(new Event('change')); })"
        "(document.getElementById('field-membrane-material'))"
    )
    assert screen.evaluate("location.hash") == "#paper-dome&membrane.material=Agilus30&print.profile=j735"
    screen.evaluate("document.getElementById('undo').click()")
    until(screen, f"location.hash === '#paper-dome' && document.querySelectorAll('.faulty').length === 0 && {_SOLVED}")


def test_an_error_stands_at_its_field_and_goes_again(screen):
    screen.evaluate("location.hash = '#paper-dome&membrane.wall_thickness_mm=14'")
    until(screen, "document.querySelectorAll('.faulty').length === 2")
    assert (
        screen.evaluate("document.getElementById('field-membrane-wall_thickness_mm-wrong').textContent")
        == "wall_thickness_mm = 14 must be less than inner_radius_mm = 9.25"
    )
    screen.evaluate("document.getElementById('reset').click()")
    until(screen, f"document.querySelectorAll('.faulty').length === 0 && {_SOLVED}")


@pytest.mark.parametrize("width", [360, 800, 1400, 2560])
def test_no_scrolling_sideways_and_every_control_has_a_name(width, screen):
    screen.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 600)
    until(screen, f"innerWidth === {width}")
    screen.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert screen.evaluate("document.documentElement.scrollWidth") <= width
    assert screen.evaluate(_TOO_WIDE) == []
    assert screen.evaluate(_UNNAMED) == []


def test_no_request_leaves_the_studio_and_nothing_fails(screen, studio):
    home = urlsplit(studio).netloc
    assert len(screen.requested) > 10
    assert {urlsplit(each).netloc for each in screen.requested if not each.startswith("data:")} == {home}
    assert screen.errors == []


def test_without_webgl_the_section_stands_alone(tmp_path):
    with served() as (address, running), browser(tmp_path, *WITHOUT_WEBGL) as plain:
        plain.visit(address, 800)
        until(plain, _SOLVED)
        assert plain.evaluate("document.querySelectorAll('#section svg').length") == 1
        assert "no WebGL" in plain.evaluate("document.getElementById('view').textContent")
        assert plain.errors == []
        running.terminate()
        running.wait(60)
        plain.evaluate(_MOVE.format(place=290))
        until(plain, "document.getElementById('status').textContent.includes('was stopped')")
