"""The page in a browser; left out, and said so, where there is none."""

from __future__ import annotations

import json
import os
import re

import pytest

from pneutouch.cli.studio import forwarding
from tests.browser import FOUND, WITHOUT_WEBGL, Pages, launched, leave_out_or_fail, until
from tests.studio.served import PAINTED, SOLVED, Studio, move, served, solved

_TOO_WIDE = """[...document.querySelectorAll('body *')].filter(e => !e.closest('.scroll') && !e.closest('svg') &&
!e.matches('.skip') && e.getBoundingClientRect().right > innerWidth + 0.5).map(e => e.tagName + e.className)"""
_UNNAMED = """[...document.querySelectorAll('input, select, button, canvas')].filter(e => !(e.labels && e.labels.length) &&
!e.getAttribute('aria-label') && !e.textContent.trim()).map(e => e.outerHTML)"""
_REFUSED = "document.getElementById('status').textContent.includes('pneutouch studio printed')"
_WALL = "document.getElementById('field-membrane-wall_thickness_mm')"


@pytest.mark.slow
def test_the_address_opens_in_one_browser_once_and_stays_open_there(pages, tmp_path):
    leave_out_or_fail(FOUND, os.environ)
    with served() as (address, _):
        begin = "#paper-dome&membrane.wall_thickness_mm=1.4"
        page, home = pages.open("about:blank"), address.partition("?")[0]
        page.goto(forwarding(f"{address}{begin}", tmp_path).as_uri(), wait_until="commit")
        page.wait_for_url(lambda url: url.startswith(home))
        until(page, PAINTED)
        assert page.url == f"{home}{begin}"
        page.reload()
        until(page, PAINTED)
        second = page.context.new_page()
        second.goto(home)
        until(second, PAINTED)
        # The address again, as from the list of those that were opened: the browser has the key.
        second.goto(address)
        until(second, PAINTED)
        for closed in (home, address):
            until(pages.open(closed), _REFUSED)


@pytest.mark.slow
def test_a_slider_moves_the_figures_of_the_commands(screen, command):
    solved(screen, "#paper-dome")
    move(screen, "Wall thickness, mm", 280)
    wall = screen.evaluate(f"{_WALL}.value")
    assert float(wall) != 1.5
    solved(screen, f"#paper-dome&membrane.wall_thickness_mm={wall}")
    said = json.loads(command("predict", "paper-dome", "--set", f"membrane.wall_thickness_mm={wall}", "--json").stdout)
    assert screen.locator("#status").text_content() == f"Answered by the model {said['model']}."
    shown = screen.evaluate(
        "[...document.querySelectorAll('#figures table:first-of-type tbody tr')].map(e => e.children[1].textContent.split(' ')[0])"
    )
    expected = [state["sensitivity_kPa_per_N"] for state in said["states"]]
    assert [float(text) for text in shown] == [float(f"{value:.4g}") for value in expected]
    assert screen.locator("#sensitivity canvas, #force canvas, #rise canvas, #inflation canvas").count() == 4
    screen.get_by_role("button", name="Undo").click()
    solved(screen, "#paper-dome")
    assert screen.evaluate(f"{_WALL}.value") == "1.5"


def test_a_shape_brings_its_sizes_and_a_dragged_rise_moves_the_figures(screen, command):
    solved(screen, "#paper-dome")
    rise = "document.getElementById('field-membrane-rise_mm')"
    assert screen.evaluate(f"{rise}.closest('.field').hidden")
    screen.locator("#field-membrane-shape").select_option("disc")
    until(screen, "document.getElementById('field-membrane-boss_height_mm').value === '2.77'")
    screen.locator("#field-membrane-shape").select_option("cap")
    until(screen, f"{rise}.value === '4.63' && !{rise}.closest('.field').hidden")
    assert screen.evaluate("document.getElementById('field-membrane-boss_height_mm').closest('.field').hidden")
    until(screen, SOLVED)
    move(screen, "Rise, mm", 300)
    until(screen, SOLVED)
    dragged = screen.evaluate(f"{rise}.value")
    assert float(dragged) != 4.63
    changes = ["--set", "membrane.shape=cap", "--set", f"membrane.rise_mm={dragged}"]
    expected = json.loads(command("predict", "paper-dome", *changes, "--json").stdout)["states"]
    shown = "[...document.querySelectorAll('#figures table:first-of-type tbody tr')].map(e => e.children[1].textContent.split(' ')[0])"
    values = json.dumps([f"{state['sensitivity_kPa_per_N']:.4g}" for state in expected])
    until(screen, f"JSON.stringify({shown}.map(Number)) === JSON.stringify({values}.map(Number))")


def test_states_by_injected_gas_stand_in_a_table_and_on_both_branches_of_the_chart(screen, command):
    gas = "#paper-dome&pneumatics.injected_volumes_mL=%5B1%2C%204%2C%207%5D"
    screen.evaluate(f"location.hash = {gas!r}")
    solved(screen, gas)
    said = json.loads(
        command("predict", "paper-dome", "--set", "pneumatics.injected_volumes_mL=[1, 4, 7]", "--json").stdout
    )
    rows = screen.evaluate(
        "[...document.querySelectorAll('#figures table:last-of-type tbody tr')].map(e => [...e.children].map(c => c.textContent))"
    )
    assert [row[2] for row in rows] == [
        "regulator or syringe",
        "regulator or syringe",
        "syringe, beyond the limit point",
    ]
    assert [float(row[3].split()[0]) for row in rows] == [
        float(f"{s['sensitivity_kPa_per_N']:.4g}") for s in said["filled"]
    ]
    legend = screen.locator("#sensitivity .u-legend").text_content()
    assert "by injected gas" in legend and "beyond the limit" in legend


@pytest.mark.slow
def test_a_resin_takes_a_printer_that_runs_it(screen, pages):
    # That no request goes elsewhere is required by the fixtures; here, that requests are seen at all.
    seen = {each.rpartition("/")[2] for each in pages.requested}
    assert {"studio.js", "three.module.min.js", "uPlot.esm.js", "form", "quick"} <= seen
    screen.get_by_label("Material").first.select_option("Agilus30")
    assert screen.evaluate("location.hash") == "#paper-dome&membrane.material=Agilus30&print.profile=j735"
    screen.get_by_role("button", name="Undo").click()
    until(screen, "location.hash === '#paper-dome' && document.querySelectorAll('.faulty').length === 0")


@pytest.mark.slow
def test_the_mould_is_shown_for_a_cast_membrane_alone(screen):
    mould = screen.locator("#form details", has_text="Mould: more")
    assert mould.is_hidden()
    screen.evaluate("location.hash = '#cast-dome'")
    until(screen, "document.getElementById('field-print-profile').value === 'silicone-casting'")
    mould.locator("summary").wait_for()
    # The design leaves the table out: the fields show what it then is.
    until(screen, "document.getElementById('field-mould-profile').value === 'abs-filament'")
    assert screen.locator("#field-mould-cavities").input_value() == "1"
    screen.evaluate("location.hash = '#paper-dome&mould.cavities=17'")
    until(screen, "document.getElementById('field-print-profile').value === 'objet260-connex'")
    # What is changed there all the same stays in sight, with what is wrong.
    until(screen, "document.getElementById('field-mould-cavities-wrong').textContent")
    assert mould.is_visible() and mould.get_by_label("Cavities", exact=True).input_value() == "17"
    screen.get_by_role("button", name="Reset").click()
    solved(screen, "#paper-dome")
    assert mould.is_hidden()


@pytest.mark.slow
def test_an_error_stands_at_its_field_and_goes_again(screen):
    screen.evaluate("location.hash = '#paper-dome&membrane.wall_thickness_mm=14'")
    until(screen, "document.querySelectorAll('.faulty').length === 2")
    wrong = "wall_thickness_mm = 14 must be less than inner_radius_mm = 9.25"
    assert screen.locator("#field-membrane-wall_thickness_mm-wrong").text_content() == wrong
    screen.get_by_role("button", name="Reset").click()
    until(screen, "document.querySelectorAll('.faulty').length === 0")
    solved(screen, "#paper-dome")


@pytest.mark.parametrize("width", [360, *(pytest.param(each, marks=pytest.mark.slow) for each in (800, 1400, 2560))])
def test_no_scrolling_sideways_and_every_control_has_a_name(width, open_studio):
    page = open_studio(width=width, is_mobile=width < 600)
    until(page, SOLVED)
    assert page.evaluate("innerWidth") == width
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.evaluate(_TOO_WIDE) == []
    assert page.evaluate(_UNNAMED) == []


@pytest.mark.slow
def test_without_webgl_the_section_stands_alone():
    leave_out_or_fail(FOUND, os.environ)
    with served() as (address, process), launched(*WITHOUT_WEBGL) as browser:
        pages = Pages(browser)
        plain = Studio(address, process).open(pages, width=800)
        until(plain, SOLVED)
        assert plain.locator("#section svg").count() == 1
        assert "no WebGL" in plain.locator("#view").text_content()
        assert [each for each in pages.errors if "WebGL" not in each] == []
        process.terminate()
        process.wait(60)
        move(plain, "Wall thickness, mm", 290)
        until(plain, "document.getElementById('status').textContent.includes('was stopped')")


def test_on_a_narrow_screen_the_figures_come_before_the_form(open_studio):
    narrow = open_studio(width=400)
    top = "document.getElementById({!r}).getBoundingClientRect().top"
    assert not narrow.evaluate("document.getElementById('change').open")
    assert narrow.evaluate(
        f"{top.format('tiles')} < {top.format('change')} && {top.format('change')} < {top.format('section')}"
    )
    narrow.get_by_text("Change the design").click()
    assert narrow.get_by_role("slider", name="Wall thickness, mm").is_visible()


def test_a_changed_design_says_so_in_the_list_and_a_port_at_the_side_in_its_size(open_studio):
    page = open_studio("#paper-dome&connector.mount=finger-16&membrane.inner_radius_mm=6&membrane.wall_thickness_mm=1")
    assert page.evaluate("document.getElementById('base').selectedOptions[0].textContent") == "paper-dome, changed"
    size = page.locator(".tile", has_text="Size").inner_text()
    assert re.search(r"22\.6\s+mm across", size) and re.search(r"with its port", size)


def test_a_chart_lists_an_interval_once_and_not_its_axis(screen):
    shown = (
        "[...document.querySelectorAll('#sensitivity .u-series')].filter(e => e.offsetParent).map(e => e.textContent)"
    )
    entries = screen.evaluate(shown)
    assert sum("interval" in entry for entry in entries) == 1
    assert not [entry for entry in entries if entry.startswith("driving")]


@pytest.mark.slow
def test_the_figures_with_the_gas_as_drawn_stand_below_those_of_the_command(screen, command):
    solved(screen, "#paper-dome")
    said = json.loads(command("predict", "paper-dome", "--json").stdout)
    drawn = [float(f"{state['sensitivity_kPa_per_N']:.4g}") for state in said["as_drawn"]]
    shown = "[...document.querySelectorAll('#figures table:last-of-type tbody tr')].map(e => Number(e.children[1].textContent))"
    assert screen.evaluate(shown) == drawn


def test_on_a_narrow_screen_no_table_is_cut_off_and_no_curve_differs_by_colour_alone(open_studio):
    page = open_studio(width=400)
    until(page, SOLVED)
    cut = "[...document.querySelectorAll('.scroll')].filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.id)"
    assert page.evaluate(cut) == []
    for chart in ("force", "rise", "inflation"):
        entries = f"[...document.querySelectorAll('#{chart} .u-series:not(:first-child) .u-marker')]"
        dashes = page.evaluate(f"{entries}.map(e => e.style.background.replace(/(rgb|#)[^ ]+ ?[^ ]* ?[^ ]*\\)?/g, ''))")
        assert len(dashes) == len(set(dashes)) > 1, dashes
