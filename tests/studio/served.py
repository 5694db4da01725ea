"""The studio as a user starts it: a process of its own, and the address that it prints."""

from __future__ import annotations

import http.client
import json
import os
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing, contextmanager
from typing import Any
from urllib.parse import urlsplit

from playwright.sync_api import Page

from pneutouch.spec.fields import Declaration
from pneutouch.studio.guard import KEY, OPENING
from tests.browser import Pages, until

SOLVED = "document.getElementById('status').textContent.startsWith('Answered by the model')"
PAINTED = "document.body.dataset.painted"


def hears_interrupts() -> None:
    """For a process that is to hear Ctrl-C: the background jobs of a shell ignore it, and so would all that they start."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@contextmanager
def served(*words: str, files: int | None = None) -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """The address that ``pneutouch studio`` prints, and its process, which is stopped by Ctrl-C where it still runs.

    It may have so many ``files`` and connections open at once; None: as many as the tests may.
    """

    def prepared() -> None:
        hears_interrupts()
        if files is not None:
            resource.setrlimit(resource.RLIMIT_NOFILE, (files, files))

    command = [sys.executable, "-m", "pneutouch", "studio", "--no-browser", *words]
    pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    running = subprocess.Popen(command, env={**os.environ, "PYTHONUNBUFFERED": "1"}, preexec_fn=prepared, **pipes)
    try:
        address = running.stdout.readline().strip()
        assert address.startswith("http://127.0.0.1:"), running.stderr.read()
        yield address, running
    finally:
        if running.poll() is None:
            running.send_signal(signal.SIGINT)
        running.communicate(timeout=60)


class Studio:
    """A studio whose address was opened: any number of pages may use the key that it gave."""

    def __init__(self, address: str, process: subprocess.Popen[str]) -> None:
        parts = urlsplit(address)
        self.address, self.process, self.netloc, self.port = address, process, parts.netloc, parts.port
        self.home = f"http://{parts.netloc}/"
        self.token = parts.query.removeprefix("token=")
        with closing(http.client.HTTPConnection(parts.netloc)) as connection:
            connection.request("POST", OPENING, headers={"Origin": self.home[:-1], KEY: self.token})
            self.key = json.load(connection.getresponse())["key"]

    def profile(self) -> dict[str, Any]:
        """The state of a browser's profile that holds the key."""
        kept = [{"name": KEY, "value": self.key}]
        return {"cookies": [], "origins": [{"origin": self.home[:-1], "localStorage": kept}]}

    def open(self, pages: Pages, design: str = "", **options: Any) -> Page:
        """A page on ``design``, written as in the address (``#paper-dome&membrane.wall_thickness_mm=1.4``), painted."""
        page = pages.open(f"{self.home}{design}", storage_state=self.profile(), **options)
        until(page, PAINTED)
        return page


def solved(page: Page, design: str) -> None:
    """Wait until the page shows the answer of the model behind the atlas to ``design``, written as in the address."""
    until(page, f"location.hash === {design!r} && document.body.dataset.solved === {design!r} && {SOLVED}")


def move(page: Page, label: str, place: float) -> None:
    """Move the slider of a name to a place and let it go; on a narrow screen the form is opened."""
    page.evaluate("document.getElementById('change').open = true")
    page.get_by_role("slider", name=label, exact=True).evaluate(
        "(slider, place) => { slider.value = place; slider.dispatchEvent(new Event('input'));"
        "slider.dispatchEvent(new Event('change')); }",
        place,
    )


def is_declared(field: dict[str, Any], declared: Declaration) -> bool:
    """Whether a field of a form has what is declared."""
    return all(field[key] == getattr(declared, key) for key in ("unit", "low", "high", "help"))
