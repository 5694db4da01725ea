"""The browser that the tests of pages run in: the Chromium that is installed, driven by Playwright.

Tests take pages from the fixtures ``open_page`` (any address) and, for the studio, ``open_studio`` and ``screen`` (tests/studio/conftest.py).
"""

from __future__ import annotations

import asyncio
import shutil
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import pytest
from playwright.sync_api import Browser, ConsoleMessage, Page, sync_playwright

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FOUND = next((path for name in NAMES if (path := shutil.which(name))), None)
WHY_NOT = "no Chromium on this machine: the page was not looked at in a browser"
VARIABLE = "PNEUTOUCH_BROWSER"

WITH_WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
WITHOUT_WEBGL = ("--disable-gpu", "--disable-3d-apis")

_LONGEST = 300
"""Seconds that anything is waited for at most: a hung page fails its test, a slow machine does not."""


_SAID = "[...document.querySelectorAll('[role=status], [role=alert], [aria-live]')].map((each) => [each.id, each.textContent])"
"""What a page says of its state, for the report of a condition that never held."""


def leave_out_or_fail(found: str | None, environment: Mapping[str, str]) -> None:
    """Leave a test out where there is no browser; fail it where the environment says that there has to be one."""
    if found is None and environment.get(VARIABLE) == "required":
        pytest.fail(f"{VARIABLE}=required, but there is none of {', '.join(NAMES)} on the PATH", pytrace=False)
    if found is None:
        pytest.skip(WHY_NOT)


@contextmanager
def launched(*options: str) -> Iterator[Browser]:
    """A browser without a window; it ends with the block."""
    with sync_playwright() as playwright:
        # Shared memory is small in containers.
        words = ["--disable-dev-shm-usage", "--hide-scrollbars", *options]
        browser = playwright.chromium.launch(executable_path=FOUND, args=words)
        try:
            yield browser
        finally:
            browser.close()


class SharedBrowser:
    """A browser for the tests of a file, whose event loop counts as running only while a test uses it.

    Playwright leaves its loop marked as running in the thread, and ``asyncio.run`` of other tests would refuse to start.
    """

    def __init__(self, browser: Browser) -> None:
        self.browser = browser
        self._loop = asyncio.get_running_loop()
        self.rest()

    def rest(self) -> None:
        """No test uses it."""
        asyncio._set_running_loop(None)

    def resume(self) -> None:
        """A test uses it from here on."""
        asyncio._set_running_loop(self._loop)


class Pages:
    """Opens pages, and keeps what they asked for and what failed in them."""

    def __init__(self, browser: Browser) -> None:
        self._browser = browser
        self.requested: list[str] = []
        self.errors: list[str] = []

    def open(self, address: str, width: int = 1400, height: int = 900, dark: bool = False, **context: Any) -> Page:
        """A page at ``address`` in a new profile; ``context`` are options of Playwright's ``new_context``."""
        profile = self._browser.new_context(
            viewport={"width": width, "height": height}, color_scheme="dark" if dark else "light", **context
        )
        profile.set_default_timeout(1000 * _LONGEST)
        page = profile.new_page()
        page.on("request", lambda request: self.requested.append(request.url))
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", self._note)
        page.goto(address)
        page.evaluate("document.fonts.ready.then(() => 1)")
        return page

    def _note(self, message: ConsoleMessage) -> None:
        """An error in the console is one of the page, unless it reports an answer that the page takes care of."""
        if message.type == "error" and not message.text.startswith("Failed to load resource"):
            self.errors.append(message.text)

    def close(self) -> None:
        for profile in self._browser.contexts:
            profile.close()


def until(page: Page, condition: str) -> None:
    """Wait until a condition, an expression of JavaScript, holds in the page.

    Playwright's own ``wait_for_function`` is stopped by the studio's Content-Security-Policy.
    """
    end = time.monotonic() + _LONGEST
    while not page.evaluate(f"!!({condition})"):
        assert time.monotonic() < end, (condition, page.evaluate(_SAID))
        page.wait_for_timeout(30)
