"""The area Live in a browser: a simulated device opened, tared, recorded and closed; errors at their fields."""

from __future__ import annotations

import pytest

pytest.importorskip("serial")

from tests.browser import until
from tests.studio.access import violations
from tests.studio.served import Studio, served

pytestmark = pytest.mark.slow

_LINK = "document.querySelector('#area-live').dataset.link"
_TILE = "document.querySelector('#area-live .tile.{} b').textContent"
_EVENTS = "document.querySelector('#area-live .said').textContent"
_STEP = "document.querySelector('#area-live .step').textContent"
_NO_WIDER = "document.documentElement.scrollWidth <= innerWidth"


@pytest.fixture(scope="module")
def studio(tmp_path_factory):
    """A studio that was started in an empty folder."""
    home = tmp_path_factory.mktemp("home")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(home)
        patch.setenv("PNEUTOUCH_HOME", str(home))
        with served() as (address, process):
            yield Studio(address, process)


@pytest.fixture
def at_live(pages, studio):
    def opened(port="simulated:5", **options):
        page = pages.open(f"{studio.home}live", storage_state=studio.profile(), **options)
        until(page, "document.querySelector('#area-live button.first')")
        page.locator("[name='live.port']").fill(port)
        page.get_by_role("button", name="Open", exact=True).click()
        return page

    return opened


def test_a_device_is_read_tared_recorded_and_closed(at_live, tmp_path_factory):
    page = at_live()
    until(page, f"{_LINK} === 'reading' && {_EVENTS}.includes('OK')")
    until(page, f"parseFloat({_TILE.format('force')}) > 0.5")
    low, high = map(float, page.evaluate(_TILE.format("interval")).split(" to "))
    assert 0.0 <= low < high
    assert float(page.evaluate("document.body.dataset.delay")) >= 0.0
    assert page.evaluate("document.querySelectorAll('#area-live .chart canvas').length") == 2
    page.get_by_role("button", name="Record", exact=True).click()
    until(page, f"{_STEP}.includes('live-1.csv')")
    # A page that is loaded anew shows what is recorded, with the seconds before.
    page.reload()
    until(page, f"{_LINK} === 'reading' && {_STEP}.includes('live-1.csv')")
    assert violations(page) == []
    page.get_by_role("button", name="Stop recording").click()
    until(page, f"{_EVENTS}.includes('live-1.csv')")
    page.get_by_role("button", name="Tare").click()
    until(page, f"{_EVENTS}.split('tare').length > 2")
    page.get_by_role("button", name="Close").click()
    until(page, f"{_LINK} === 'closed'")


def test_a_port_that_is_not_there_is_told_at_its_field(at_live):
    page = at_live("/dev/no-such-port")
    until(page, "document.querySelector('#area-live .faulty [name=\"live.port\"]')")
    until(page, f"{_LINK} === 'closed'")


@pytest.mark.parametrize("width", [360, 1400])
def test_the_page_fits_and_keeps_the_rules_in_the_dark(at_live, width):
    page = at_live(width=width, dark=True)
    until(page, f"{_LINK} === 'reading' && {_EVENTS}.includes('OK')")
    assert page.evaluate(_NO_WIDER) and violations(page) == []
    page.get_by_role("button", name="Close").click()
    until(page, f"{_LINK} === 'closed'")
