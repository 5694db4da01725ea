"""A pool that is stopped while one of its processes is sending what it computed."""

from __future__ import annotations

import os
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.workflows.sweep.conftest import PATIENCE

SCRIPT = """
import signal
from pathlib import Path
from pneutouch.workflows.sweep import workers
from tests.workflows.sweep.test_stop_while_sending import half_sent

if __name__ == "__main__":
    # A shell's background jobs ignore Ctrl-C, and so would all that they start.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    workers.compute = half_sent
    try:
        next(workers.in_pool([0, 1], Path(), 2))
    except BaseException as error:
        print(type(error).__name__)
"""


def half_sent(number: int, folder: Path) -> list[dict[str, int]]:
    """The first computes; the second begins a message of 10,000 bytes and does not go on; its parent is stopped."""
    if number:
        queue = sys._getframe(1).f_locals["result_queue"]
        os.write(queue._writer.fileno(), struct.pack("!i", 10_000) + b"a part")
        os.kill(os.getppid(), signal.SIGINT)
    time.sleep(PATIENCE)
    return []


@pytest.mark.slow
def test_a_stop_ends_the_pool_and_the_process(tmp_path):
    script = tmp_path / "stopped.py"
    script.write_text(SCRIPT)
    paths = os.pathsep.join(filter(None, [str(ROOT), str(ROOT / "generator"), os.environ.get("PYTHONPATH")]))
    done = subprocess.run(
        [sys.executable, script],
        env=os.environ | {"PYTHONPATH": paths},
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "KeyboardInterrupt\n"), done.stderr
