"""The studio in use for a long time: ``python -m tests.studio.soak [--minutes 60]``.

Random acts of a user, with a second between them: sliders, other designs, a value that is refused, undo, redo, reset, pins, areas, the
page left and opened again. Each must be answered, and nothing may fail in the page or the process. Stores ten times what the page
and the studio's processes keep, in docs/background/soak.json.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Page

from tests.browser import Pages, launched
from tests.studio.kept import Kept
from tests.studio.served import Studio, move, served

STORED = Path(__file__).resolve().parents[2] / "docs" / "background" / "soak.json"

ANSWERED = (
    "(() => { const status = document.getElementById('status');"
    "return document.body.dataset.painted && !status.classList.contains('busy')"
    " && !/^(Opening|Answered by the atlas)/.test(status.textContent); })()"
)
"""The solid's answer or its refusal is shown, or the errors of a value."""

DESIGNS = ("paper-dome", "fingertip-dome", "soft-pad", "stiff-dome", "cast-dome")
WEIGHTS = {
    **{"wall": 12, "radius": 12, "design": 2, "refused": 1, "undo": 3},
    **{"redo": 2, "reset": 1, "pin": 1, "areas": 1, "reload": 0.3},
}

LONGEST = 3600
"""Seconds of the clock that an answer is waited for: the machine may be busy with something else."""


def memory_mb(process: subprocess.Popen[str]) -> float:
    """Resident memory of a process and its children, MB."""
    words = ["ps", "-o", "pid=,rss=", "--ppid", str(process.pid), "--pid", str(process.pid)]
    listed = subprocess.run(words, capture_output=True, text=True, check=True)
    return sum(int(line.split()[1]) for line in listed.stdout.splitlines()) * 1024 / 1e6


def press(page: Page, name: str) -> None:
    """Press a button of the design's bar, where it can be pressed."""
    button = page.locator(f"#{name}")
    if button.is_enabled():
        button.click()


def acts(page: Page, chance: random.Random) -> dict[str, Callable[[], object]]:
    """What a user does, by name."""
    wall = f"location.hash = '#paper-dome&membrane.wall_thickness_mm={chance.choice(('-1', '1e99', 'x'))}'"
    return {
        "wall": lambda: move(page, "Wall thickness, mm", chance.randint(200, 350)),
        "radius": lambda: move(page, "Inner radius, mm", chance.randint(100, 300)),
        "design": lambda: page.evaluate(f"location.hash = '#{chance.choice(DESIGNS)}'"),
        # A wall that no design has; the next act is on a page that shows its error.
        "refused": lambda: page.evaluate(wall),
        "undo": lambda: press(page, "undo"),
        "redo": lambda: press(page, "redo"),
        "reset": lambda: press(page, "reset"),
        "pin": lambda: press(page, "pin"),
        "areas": lambda: areas(page),
        "reload": page.reload,
    }


def areas(page: Page) -> None:
    tabs = page.locator("#areas [role=tab]")
    for tab in [*tabs.all(), tabs.first]:
        tab.click()


def act(page: Page, chance: random.Random) -> str:
    """One act, and wait for its answer; its name."""
    todo = acts(page, chance)
    name = chance.choices(list(todo), weights=[WEIGHTS[each] for each in todo])[0]
    if name in ("wall", "radius") and page.get_by_role("slider", name="Wall thickness, mm", exact=True).count() == 0:
        name = "design"
    todo[name]()
    end = time.monotonic() + LONGEST
    while not page.evaluate(f"!!({ANSWERED})"):
        assert time.monotonic() < end, f"no answer after {name}: {page.locator('#status').text_content()}"
        page.wait_for_timeout(100)
    return name


def main(minutes: float) -> None:
    chance, done, rows = random.Random(2026), Counter[str](), []
    with served() as (address, process), launched() as browser:
        pages = Pages(browser)
        page = Studio(address, process).open(pages)
        page.set_default_timeout(1000 * LONGEST)
        start = time.monotonic()
        for point in range(11):
            while time.monotonic() - start < 60.0 * minutes * point / 10:
                done[act(page, chance)] += 1
                page.wait_for_timeout(1000)
                assert not pages.errors, pages.errors
                assert process.poll() is None, process.communicate()
            kept = Kept.of(page)
            row = {"minutes": round((time.monotonic() - start) / 60, 1), "acts": done.total()} | kept._asdict()
            rows.append(row | {"scripts_mb": round(kept.scripts_mb, 2), "processes_mb": round(memory_mb(process))})
            print(json.dumps(rows[-1]), flush=True)
            STORED.write_text(json.dumps({"acts": dict(done), "points": rows}, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--minutes", type=float, default=60.0)
    main(options.parse_args().minutes)
