"""The area Map in a browser: a map, the present design moved on it, reasons, errors and a target."""

from __future__ import annotations

import re

import pytest

from tests.browser import until
from tests.studio.access import violations
from tests.studio.served import move, solved

pytestmark = pytest.mark.slow

_READY = "document.querySelector('#area-map form')"
_IDLE = "!document.querySelector('#area-map .first').disabled"
_DRAWN = f"{_IDLE} && document.querySelector('#area-map .plot .design')"
_OLD = "!document.querySelector('#area-map .old').hidden"
_NO_WIDER = "document.documentElement.scrollWidth <= innerWidth"
_TAKE = """() => { const json = Response.prototype.json; Response.prototype.json = async function () {
const content = await json.call(this); if (content.kind === 'map' && content.state === 'done') window.taken = content.content; return content; }; }"""
"""Keep the answer of the job beside what the page draws of it."""


def at_map(page):
    page.get_by_role("tab", name="Map").click()
    until(page, _READY)
    return page.get_by_role("form", name="Map")


def compute(page):
    at_map(page).get_by_role("button", name="Compute map").click()
    until(page, _DRAWN)


def design(page) -> dict[str, float]:
    """Values of the address by the key of the field."""
    pairs = re.findall(r"\.(\w+)=([^&]+)", page.evaluate("decodeURIComponent(location.hash)"))
    return {key: float(value) for key, value in pairs}


def place(page) -> tuple[float, float]:
    """Middle of the point, pixels."""
    box = page.locator("#area-map .design .spot").bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def figures(page) -> list[str]:
    return page.locator("#area-map .tile b").all_text_contents()


def test_a_map_appears_and_its_point_sets_both_fields(screen):
    screen.evaluate(_TAKE)
    compute(screen)
    taken = screen.evaluate("window.taken")
    missing = sum(value is None for column in taken["figures"]["sensitivity"] for value in column)
    counts = screen.locator("#area-map .reasons li").evaluate_all("all => all.map(one => Number(one.dataset.count))")
    assert sum(counts) == missing > 0
    assert len(counts) == len({word for column in taken["reasons"] for word in column if word})
    levels = {float(each) for each in screen.locator("#area-map .level").all_text_contents()}
    known = [value for column in taken["figures"]["sensitivity"] for value in column if value is not None]
    assert len(levels) >= 3 and min(known) < min(levels) < max(levels) < max(known)
    painted = "document.querySelector('#area-map canvas').getContext('2d').getImageData(0, 0, 400, 400).data"
    assert screen.evaluate(f"new Set({painted}).size") > 20
    # Dragged: to the left and downwards, where both are less.
    x, y = place(screen)
    screen.mouse.move(x, y)
    screen.mouse.down()
    screen.mouse.move(x - 60, y + 50, steps=4)
    assert screen.evaluate("location.hash") == "#paper-dome"
    screen.mouse.up()
    until(screen, "location.hash.includes('inner_radius_mm')")
    dropped = design(screen)
    assert dropped["inner_radius_mm"] < 9.25 and dropped["wall_thickness_mm"] < 1.5
    assert place(screen) == pytest.approx((x - 60, y + 50), abs=5)
    shown = float(figures(screen)[0])
    for key, value in dropped.items():
        assert float(screen.locator(f"#field-membrane-{key}").input_value()) == value
    hash_of_it = screen.evaluate("location.hash")
    screen.get_by_role("tab", name="Design").click()
    solved(screen, hash_of_it)
    row = screen.evaluate("document.querySelectorAll('#figures tbody tr')[1].children[1].textContent")
    assert float(row.split()[0]) == pytest.approx(shown, rel=0.03)
    screen.get_by_role("button", name="Undo").click()
    solved(screen, "#paper-dome")
    at_map(screen)
    assert place(screen) == pytest.approx((x, y), abs=1)
    # By the arrow keys, one step of each field; the figure is read out.
    point = screen.get_by_role("slider", name="Present design on the map, moved by the arrow keys")
    point.focus()
    for key in ("ArrowRight", "Shift+ArrowDown"):
        screen.keyboard.press(key)
    until(screen, "location.hash.includes('inner_radius_mm')")
    assert design(screen) == {"inner_radius_mm": 9.3, "wall_thickness_mm": 1.4}
    assert figures(screen)[0] in point.get_attribute("aria-valuetext")
    # Both are fields of the map: it is of this design still; another field makes it an older one's.
    assert not screen.evaluate(_OLD)
    screen.get_by_role("tab", name="Design").click()
    move(screen, "Dead volume, mL", 300)
    at_map(screen)
    until(screen, _OLD)
    screen.get_by_role("button", name="Compute again").click()
    until(screen, f"{_DRAWN} && !({_OLD})")


def test_a_click_and_another_figure_need_no_new_map(screen):
    compute(screen)
    screen.evaluate("performance.clearResourceTimings()")
    before = screen.locator("#area-map .plot svg").get_attribute("aria-label")
    screen.get_by_role("button", name="rated pressure").click()
    assert screen.locator("#area-map .plot svg").get_attribute("aria-label") != before
    assert screen.get_by_role("button", name="rated pressure").get_attribute("aria-pressed") == "true"
    box = screen.locator("#area-map canvas").bounding_box()
    screen.mouse.click(box["x"] + box["width"] - 20, box["y"] + 40)
    until(screen, "location.hash.includes('inner_radius_mm')")
    assert figures(screen) == ["–"] * 4
    asked = screen.evaluate("performance.getEntriesByType('resource').map(each => each.name)")
    assert not [each for each in asked if "/api/jobs" in each]


def test_a_wrong_range_stands_at_its_field_and_a_map_is_cancelled(screen):
    form = at_map(screen)
    form.get_by_label("to", exact=True).first.fill("5")
    form.get_by_role("button", name="Compute map").click()
    until(screen, "document.querySelector('#area-map .faulty')")
    assert screen.evaluate("document.activeElement.id") == "field-x-high"
    until(screen, _IDLE)
    form.get_by_label("Up", exact=True).last.select_option("membrane.inner_radius_mm")
    form.get_by_label("to", exact=True).first.fill("12")
    form.get_by_role("button", name="Compute map").click()
    until(screen, "document.querySelector('#area-map .faulty #field-y-field')")
    until(screen, _IDLE)
    form.get_by_label("Up", exact=True).last.select_option("pneumatics.driving_pressures_kPa")
    assert form.get_by_label("Driving pressure kPa").is_hidden()
    form.get_by_role("button", name="Compute map").click()
    screen.get_by_role("button", name="Cancel").click()
    until(screen, f"{_IDLE} && document.querySelector('#area-map .under').hidden")
    assert screen.locator("#area-map .faulty, #area-map .plot:visible").count() == 0


def test_the_target_is_drawn_and_a_driving_pressure_is_moved(screen):
    screen.get_by_role("tab", name="Target").click()
    screen.get_by_role("button", name="Example").click()
    form = at_map(screen)
    form.get_by_label("Up", exact=True).last.select_option("pneumatics.driving_pressures_kPa")
    compute(screen)
    assert screen.locator("#area-map .plot .target.ends").count() >= 2
    screen.get_by_role("slider", name="Present design on the map, moved by the arrow keys").focus()
    screen.keyboard.press("Shift+ArrowUp")
    until(screen, "location.hash.includes('driving_pressures')")
    said = screen.locator("#field-pneumatics-driving_pressures_kPa").input_value()
    pressures = [float(each) for each in said.split(",")]
    assert len(pressures) == 4 and pressures[0] == 0 and pressures[2:] == [12, 22] and 5 < pressures[1] < 12


@pytest.mark.parametrize(("width", "dark"), [(400, True), (1400, False)])
def test_no_rule_of_accessibility_is_broken_and_nothing_is_too_wide(width, dark, open_studio):
    page = open_studio(width=width, dark=dark, is_mobile=width < 600)
    at_map(page)
    assert violations(page) == []
    compute(page)
    assert violations(page) == []
    assert page.evaluate(_NO_WIDER)
