"""The area Pads in a browser: a ball dragged over a pad, a plate, errors at their fields."""

from __future__ import annotations

import pytest

from tests.browser import until
from tests.studio.access import violations
from tests.studio.pads import NAME, kept_pad
from tests.studio.served import Studio, served

pytestmark = pytest.mark.slow

_READ = "document.querySelector('#area-pads .place')?.dataset.kind"
_BARS = "document.querySelector('#area-pads .bars svg')?.getAttribute('aria-label')"
_TABLE = "document.querySelector('#area-pads table').textContent"
_NO_WIDER = "document.documentElement.scrollWidth <= innerWidth"


@pytest.fixture(scope="module")
def studio(tmp_path_factory):
    """A studio whose user has a pad, with a table at one driving pressure."""
    home = tmp_path_factory.mktemp("home")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PNEUTOUCH_HOME", str(home))
        patch.setenv("XDG_CACHE_HOME", str(home))
        kept_pad(home)
        with served() as (address, process):
            yield Studio(address, process)


@pytest.fixture
def at_pad(pages, studio):
    """Opens the pad at its table's driving pressure, with its first answer."""

    def opened(**options):
        page = pages.open(f"{studio.home}pad?name={NAME}", storage_state=studio.profile(), **options)
        until(page, _READ)
        return page

    return opened


def test_a_ball_is_dragged_and_bars_and_estimate_follow(at_pad):
    page = at_pad()
    before = page.evaluate(f"[{_BARS}, {_TABLE}]")
    box = page.locator("#area-pads .design .spot").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x - 90, y + 20, steps=5)
    until(page, f"{_BARS} !== {before[0]!r} && {_TABLE} !== {before[1]!r}")
    page.mouse.up()
    moved = page.evaluate(_BARS)
    assert float(page.locator("#field-touch-x_mm").input_value()) < 0.0
    # By an arrow key, ten steps to the right.
    page.get_by_role("slider", name="Object on the pad").focus()
    page.keyboard.press("Shift+ArrowRight")
    until(page, f"{_BARS} !== {moved!r}")
    page.locator("#field-touch-object").select_option("cylinder")
    until(page, "!document.getElementById('field-touch-turn_deg').closest('.field').hidden")
    page.locator("#field-touch-object").select_option("plate")
    until(page, "!document.getElementById('field-touch-slope_x').closest('.field').hidden")
    assert page.locator("#field-touch-radius_mm").is_hidden()
    page.locator("#field-touch-depth_mm").fill("nan")
    until(page, "document.querySelector('#area-pads .faulty #field-touch-depth_mm')")


@pytest.mark.parametrize(("width", "dark"), [(400, True), (1400, False)])
def test_no_rule_of_accessibility_is_broken_and_nothing_is_too_wide(width, dark, at_pad):
    page = at_pad(width=width, dark=dark, is_mobile=width < 600)
    assert violations(page) == []
    assert page.evaluate(_NO_WIDER)


def test_a_pad_that_is_not_known_is_an_error_in_words(pages, studio):
    page = pages.open(f"{studio.home}pad?name=no-such-pad", storage_state=studio.profile())
    until(page, f"document.querySelector('#area-pads .problems')?.textContent.includes({NAME!r})")
    assert NAME in page.locator("#area-pads select option").all_text_contents()
