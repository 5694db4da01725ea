"""Two ways to ask a studio.

Without a server, as the browser that was given its address: ``client``. And in a browser:

    def test_a_slider_moves_the_figures(screen):              # the design that the studio begins with, painted by the atlas
        move(screen, "Wall thickness, mm", 280)               # tests/studio/served.py
        until(screen, "document.querySelector('...')")        # tests/browser.py: any condition in JavaScript
        screen.get_by_role("button", name="Undo").click()     # Playwright's Page

    def test_another_design_in_the_dark(open_studio):
        page = open_studio("#agilus-dome", width=360, dark=True)

    def test_no_rule_of_accessibility_is_broken(screen):
        assert violations(screen) == []                       # tests/studio/access.py

One browser serves the tests of a file, one studio every test of a worker; each page has a profile of its own. After each test the fixtures require that
no script failed, that the Content-Security-Policy was kept and that no request left the studio.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from urllib.parse import urlsplit

import pytest

pytest.importorskip("starlette")
pytest.importorskip("httpx2")

from playwright.sync_api import Page
from starlette.testclient import TestClient

from pneutouch.studio.guard import KEY, OPENING
from pneutouch.studio.server import application, bases_of
from tests.browser import Pages
from tests.studio.served import Studio, served

PORT = 8123
HOME = f"http://127.0.0.1:{PORT}"
TOKEN = "the-token-of-the-tests"


@pytest.fixture
def stranger():
    """A client that was given nothing; the studio runs while it is used."""
    bases, first = bases_of(None)
    with TestClient(application(bases, first, PORT, TOKEN), base_url=HOME, follow_redirects=False) as client:
        yield client


@pytest.fixture
def client(stranger):
    """A client that opened the address."""
    return admitted(stranger)


def admitted(stranger: TestClient) -> TestClient:
    """The client, from here on with the key that it was given for the token."""
    answer = stranger.post(OPENING, headers={"Origin": HOME, KEY: TOKEN})
    stranger.headers[KEY] = answer.json()["key"]
    return stranger


@pytest.fixture(scope="session")
def studio() -> Iterator[Studio]:
    """A studio that runs as a user starts it, for tests that leave it as they found it."""
    with served() as (address, process):
        yield Studio(address, process)


@pytest.fixture
def open_studio(pages: Pages, studio: Studio) -> Iterator[Callable[..., Page]]:
    """Opens a page on a design: ``open_studio("#agilus-dome", width=360, height=800, dark=True)``."""

    def opened(design: str = "", **options: object) -> Page:
        return studio.open(pages, design, **options)

    yield opened
    home = {urlsplit(each).netloc for each in pages.requested if not each.startswith(("data:", "blob:"))}
    assert home <= {studio.netloc}


@pytest.fixture
def screen(open_studio: Callable[..., Page]) -> Page:
    """A page of 1400 by 900 pixels on the design that the studio begins with, painted by the atlas."""
    return open_studio()
