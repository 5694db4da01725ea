"""The studio as a user starts it: a process of its own, and the address that it prints."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager

_LONGEST = 300


@contextmanager
def served(*words: str):
    """The address that ``pneutouch studio`` prints, and its process, which is stopped by Ctrl-C where it still runs."""
    command = [sys.executable, "-m", "pneutouch", "studio", "--no-browser", *words]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    running = subprocess.Popen(command, env={**os.environ, "PYTHONUNBUFFERED": "1"}, **pipes)
    try:
        address = running.stdout.readline().strip()
        assert address.startswith("http://127.0.0.1:"), running.stderr.read()
        yield address, running
    finally:
        if running.poll() is None:
            running.send_signal(signal.SIGINT)
        running.communicate(timeout=60)


def until(screen, condition: str) -> None:
    """Wait until a condition holds in the page."""
    end = time.monotonic() + _LONGEST
    while not screen.evaluate(f"!!({condition})"):
        assert time.monotonic() < end, condition
        time.sleep(0.1)
