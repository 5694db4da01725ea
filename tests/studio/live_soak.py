"""How long a live view holds: ``python -m tests.studio.live_soak [SECONDS]``.

A simulated device sends 200 lines a second to ``pneutouch live``, which records them: samples, losses, and memory after
a minute and at the end. Then the studio's page shows one at its own speed: the time from sample to painted number.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from tests.browser import Pages, launched, until
from tests.studio.served import Studio, served

LOOKS = 200
"""Number of times that the page is looked at."""


def memory_MB(process: subprocess.Popen[str]) -> float:
    text = Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8")
    return int(text.split("VmRSS:")[1].split()[0]) / 1024.0


def recorded(folder: Path, seconds: float) -> dict[str, object]:
    """What a command says that reads and records for so long, with its memory."""
    words = [
        "live",
        "paper-dome",
        "--port",
        "simulated:2",
        "--seconds",
        f"{2 * seconds:g}",
        "--record",
        "rec",
        "--json",
    ]
    command = [sys.executable, "-m", "pneutouch", *words]
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    time.sleep(min(60.0, 0.5 * seconds))
    first = last = memory_MB(process)
    while process.poll() is None:
        last = memory_MB(process)
        time.sleep(1.0)
    state = json.loads(process.communicate()[0])["state"]
    known = {key: state[key] for key in ("samples", "lost", "damaged")}
    return {**known, "memory_MB": [round(first, 1), round(last, 1)]}


def delays(folder: Path) -> dict[str, float]:
    """Median and 95th percentile of the time from sample to painted number, ms."""
    os.environ["PNEUTOUCH_HOME"] = str(folder)
    with served() as (address, process), launched() as browser:
        studio = Studio(address, process)
        page = Pages(browser).open(f"{studio.home}live", storage_state=studio.profile())
        until(page, "document.querySelector('#area-live button.first')")
        page.get_by_role("button", name="Open", exact=True).click()
        until(page, "document.querySelector('#area-live').dataset.link === 'reading'")
        page.wait_for_timeout(3000)
        found = []
        for _ in range(LOOKS):
            found.append(float(page.evaluate("document.body.dataset.delay")))
            page.wait_for_timeout(37)
    return {"median_ms": statistics.median(found), "p95_ms": statistics.quantiles(found, n=20)[-1]}


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 60.0
    with tempfile.TemporaryDirectory() as folder:
        sys.stdout.write(f"{json.dumps({**recorded(Path(folder), seconds), **delays(Path(folder))})}\n")


if __name__ == "__main__":
    main()
