"""The command live as a user runs it: ended by Ctrl-C or killed, at no port, with options that contradict one another."""

from __future__ import annotations

import json
import signal
import subprocess
import sys

import pytest

pytest.importorskip("serial")

from tests.running import in_process
from tests.studio.served import hears_interrupts
from tests.workflows.live.devices import wait_for
from tests.workflows.live.test_session import read_rows


def started(folder, *words):
    command = [sys.executable, "-m", "pneutouch", "live", "paper-dome", "--port", "simulated:20", *words]
    pipes = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(command, cwd=folder, preexec_fn=hears_interrupts, **pipes)


def rows_of(path):
    return len(read_rows(path)) if path.exists() else 0


def test_what_was_recorded_until_ctrl_c_is_a_run_of_the_campaign(tmp_path):
    process = started(tmp_path, "--record", "mine")
    wait_for(lambda: rows_of(tmp_path / "mine/runs/live-1.recording.csv") > 1000)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130 and "live-1.csv" in said
    assert rows_of(tmp_path / "mine/runs/live-1.csv") > 1000 and (tmp_path / "mine/campaign.toml").is_file()
    assert [path.name for path in (tmp_path / "mine/runs").iterdir()] == ["live-1.csv"]


def test_what_was_recorded_until_the_program_is_killed_is_whole(tmp_path):
    process = started(tmp_path, "--record", "mine")
    path = tmp_path / "mine/runs/live-1.recording.csv"
    wait_for(lambda: rows_of(path) > 2000)
    process.kill()
    process.communicate(timeout=60)
    rows = read_rows(path)
    assert all(row["pressure_kPa"] is not None for row in rows[:-1])
    # The next recording takes another name.
    done = in_process(
        ["live", "paper-dome", "--port", "simulated:20", "--seconds", "5", "--record", "mine", "--json"], tmp_path
    )
    assert done.returncode == 0, done.stderr
    record = json.loads(done.stdout)
    assert record["file"] == "mine/runs/live-2.csv" and record["state"]["lost"] == 0


@pytest.mark.parametrize(
    "words",
    [
        [],
        ["--port", "/dev/no-such-port"],
        ["--port", "simulated", "--run", "1"],
        ["--port", "simulated", "--all"],
        ["--port", "simulated", "--plan", "nowhere"],
        ["--port", "simulated", "--plan", "nowhere", "--record", "mine"],
        ["--port", "simulated", "--pressure", "60", "--seconds", "1"],
        ["--port", "simulated:0"],
    ],
)
def test_what_makes_no_sense_is_refused_and_leaves_nothing(words, tmp_path):
    done = in_process(["live", "paper-dome", *words], tmp_path)
    assert done.returncode == 2 and done.stderr.splitlines()[-1].startswith("error: ")
    assert list(tmp_path.iterdir()) == []
