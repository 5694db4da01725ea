"""The area Target in a browser: a target typed in, its candidates, one of them used."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import pytest

from tests.browser import until
from tests.studio.access import violations
from tests.studio.served import solved

pytestmark = pytest.mark.slow

_FIELDS = {
    "Sensitivity kPa/N": "1.9",
    "Driving pressure kPa": "12",
    "Force range N": "15",
    "Max dome diameter mm": "25",
}
_ASKED = ["select", "--sensitivity", "1.9", "--at", "12", "--force-range", "15", "--max-diameter", "25"]
_HERE = "document.body.dataset.area === 'target' && document.querySelector('#area-target[data-ready]')"
_IDLE = "!document.querySelector('#area-target .submit .first').disabled"
_NO_WIDER = "document.documentElement.scrollWidth <= innerWidth"


def at_target(page):
    page.get_by_role("tab", name="Target").click()
    until(page, _HERE)
    return page.get_by_role("form", name="Target")


def ask(page, fields):
    form = at_target(page)
    for label, text in fields.items():
        form.get_by_label(label, exact=True).fill(text)
    page.keyboard.press("Enter")


def shown(page):
    """The figures of the cards, by what they are."""
    return page.evaluate(
        "[...document.querySelectorAll('.candidate')].map(e => Object.fromEntries([...e.querySelectorAll('dl div')]"
        ".map(d => [d.children[0].textContent, d.children[1].firstChild.textContent])))"
    )


def test_a_target_is_typed_in_and_its_third_design_used(open_studio, command, tmp_path):
    page = open_studio()
    ask(page, _FIELDS)
    until(page, "document.querySelectorAll('.candidate').length")
    said = json.loads(command(*_ASKED, "--json").stdout)
    cards = shown(page)
    assert len(cards) == len(said["designs"])
    for card, design in zip(cards, said["designs"], strict=True):
        assert card["Sensitivity"] == f"{design['sensitivity_kPa_per_N']:.3f} kPa/N"
        assert card["Inner radius R0"] == f"{design['inner_radius_mm']:.2f} mm"
        assert card["Wall t0"] == f"{design['wall_thickness_mm']:.2f} mm"
        assert card["Force range"] == f"0 to {design['force_range_N'][1]:.2f} N"
    # The chart by keyboard: from the first design on the chart to the next below it.
    radios = page.get_by_role("radio")
    assert radios.count() == len(cards)
    chosen = page.get_by_role("radio", checked=True)
    assert chosen.get_attribute("aria-label").startswith("1: TangoPlus, 1.9 kPa/N")
    chosen.focus()
    page.keyboard.press("Home")
    forces = [design["force_range_N"][1] for design in said["designs"]]
    most = 1 + max(range(len(forces)), key=forces.__getitem__)
    assert page.get_by_role("radio", checked=True).get_attribute("aria-label").startswith(f"{most}: ")
    assert page.evaluate("document.activeElement.getAttribute('aria-checked')") == "true"
    page.locator("[role=radio][aria-label^='3: '] text").click()
    card = page.locator(".candidate.chosen")
    assert card.get_by_role("heading").text_content().startswith("3  FLX")
    typed = card.locator("code").text_content()
    assert page.evaluate("document.activeElement.closest('.candidate').classList.contains('chosen')")
    page.keyboard.press("Enter")
    until(page, "document.body.dataset.area === 'design'")
    design = said["designs"][2]
    address = page.evaluate("location.hash")
    assert f"membrane.material={design['material']}" in address
    assert f"membrane.inner_radius_mm={design['inner_radius_mm']:.2f}" in address
    solved(page, address)
    written = json.loads(command(*shlex.split(typed)[1:], "--json", "--out", str(tmp_path)).stdout)["written"]
    predicted = json.loads(command("predict", written, "--json").stdout)
    figures = page.evaluate(
        "[...document.querySelectorAll('#figures tbody tr')].map(e => parseFloat(e.children[1].textContent))"
    )
    assert figures == [float(f"{state['sensitivity_kPa_per_N']:.4g}") for state in predicted["states"]]
    # It is built by the name that the command gave it.
    page.get_by_role("tab", name="Files").click()
    until(page, "document.getElementById('build-name')")
    assert page.locator("#build-name").get_attribute("placeholder") == Path(written).stem
    assert page.locator("#build-command").text_content().endswith(f" --name {Path(written).stem}")
    page.get_by_role("tab", name="Design").click()
    page.get_by_role("button", name="Undo").click()
    solved(page, "#paper-dome")


def test_nothing_that_meets_it_an_error_and_a_cancelled_search(open_studio, command):
    page = open_studio()
    ask(page, {**_FIELDS, "Force range N": "150"})
    until(page, "document.querySelector('.candidate.nearest')")
    lines = command(*_ASKED[:-3], "150", "--max-diameter", "25").stdout.splitlines()
    notes = page.locator(".candidate .note").all_text_contents()
    assert len(notes) == 3
    assert set(notes) <= set(lines)
    until(page, _IDLE)
    ask(page, {"Force range N": "-15"})
    until(page, "document.querySelector('#area-target .faulty')")
    assert page.locator("#field-target-force_range_N-wrong").text_content() == "must be from 0.0001 to 100000 N"
    assert page.evaluate("document.activeElement.id") == "field-target-force_range_N"
    until(page, _IDLE)
    ask(page, {"Force range N": "15"})
    page.get_by_role("button", name="Cancel").click()
    until(
        page, f"{_IDLE} && document.querySelector('#area-target .status').textContent === 'The search was cancelled.'"
    )
    assert page.locator("#area-target .faulty").count() == 0


@pytest.mark.parametrize(("width", "dark"), [(360, True), (1400, False)])
def test_no_rule_of_accessibility_is_broken_and_nothing_is_too_wide(width, dark, open_studio):
    page = open_studio(width=width, dark=dark, is_mobile=width < 600)
    form = at_target(page)
    assert violations(page) == []
    form.get_by_role("button", name="Example").click()
    form.get_by_role("button", name="Find designs").click()
    until(page, "document.querySelectorAll('.candidate').length")
    page.evaluate("document.querySelectorAll('#area-target details').forEach((each) => (each.open = true))")
    assert violations(page) == []
    assert page.evaluate(_NO_WIDER)
    page.get_by_role("button", name="Whole fronts").click()
    assert violations(page) == []
    form.get_by_label("Sensitivity kPa/N", exact=True).fill("-1")
    until(page, _IDLE)
    page.keyboard.press("Enter")
    until(page, "document.querySelector('#area-target .faulty')")
    assert violations(page) == []
    assert page.evaluate(_NO_WIDER)
