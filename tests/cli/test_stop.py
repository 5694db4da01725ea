"""Ctrl-C and SIGTERM at random moments of every command: one line, 130 or 143, nothing half written, nothing left."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from pneutouch.cli.commands import COMMANDS

MOMENTS = 20
ENDS = {signal.SIGINT: "stopped by Ctrl-C", signal.SIGTERM: "stopped by SIGTERM"}

SWEEP = "sweep --design paper-dome --out made/s.nc --over membrane.wall_thickness_mm=1:1.6:"
LINES = [
    "list",
    "table paper-dome --set membrane.shape=cap --set indentation.depth_mm=2 --check",
    "new mine --out made",
    "predict paper-dome",
    "export-reader paper-dome --out made",
    "respond paper-dome --step 2N --out made",
    "check paper-dome",
    "select --sensitivity 2 --at 10 --write found --out made --charts charts",
    "build paper-dome --out made",
    "build texture-specimen --out made",
    "build agilus-dome --voxels --out made",
    "compare paper-dome soft-pad --out made",
    f"{SWEEP}9 --model solid --workers 1",
    f"{SWEEP}400 --model membrane --workers 2",
    "tray paper-dome soft-pad --out made",
    "coupons --out made",
    "fit-material campaign/tension.csv --name mine --like DragonSkin20 --out made",
    "schema design --json",
    "show campaign/paper-dome.3mf",
    "plan paper-dome --out made",
    "simulate paper-dome --specimens 2 --rate 20 --out made",
    "characterize campaign --out made",
    "calibrate campaign --sensor TangoPlus-1 --fit modulus --save mine --out made",
    "scan texture-specimen --design paper-dome --out made",
    "discriminate paper-dome",
]


@pytest.fixture(scope="session")
def campaign(shared, built):
    """A folder with the simulated runs of one sensor in ``campaign``, and next to them its 3MF."""

    def fill(folder):
        words = [
            "simulate",
            "paper-dome",
            "--specimens",
            "1",
            "--runs",
            "1",
            "--kinds",
            "steps",
            "--rate",
            "20",
            "--out",
            "made",
        ]
        subprocess.run([sys.executable, "-m", "pneutouch", *words], cwd=folder, check=True, capture_output=True)
        next((folder / "made").iterdir()).rename(folder / "campaign")
        (folder / "made").rmdir()
        shutil.copy(built("paper-dome") / "paper-dome.3mf", folder / "campaign")
        rows = [f"{1 + k / 50:.3f},{0.15 * (1 + k / 50 - (1 + k / 50) ** -2):.6f}" for k in range(1, 101)]
        (folder / "campaign/tension.csv").write_text("\n".join(["stretch,stress (MPa)", *rows]) + "\n")

    return shared.folder("stopped-campaign", fill)


def started(words, folder):
    """The command as a process of its own session, whose temporary files lie in ``folder/tmp``."""
    (folder / "tmp").mkdir(parents=True)

    def listening():
        # A shell's background jobs ignore Ctrl-C, and so would all that they start.
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    return subprocess.Popen(
        [sys.executable, "-m", "pneutouch", *words],
        cwd=folder,
        env={**os.environ, "TMPDIR": str(folder / "tmp")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=listening,
    )


def catches(process):
    """Whether a process has set its handler of SIGTERM; before that Python itself starts."""
    try:
        status = Path(f"/proc/{process.pid}/status").read_text()
    except OSError:
        return False
    caught = next((line for line in status.splitlines() if line.startswith("SigCgt")), "SigCgt: 0")
    return bool(int(caught.split()[1], 16) >> (signal.SIGTERM - 1) & 1)


def ready(process):
    """Wait until the program handles signals, or has ended; returns the time."""
    while process.poll() is None and not catches(process):
        time.sleep(0.001)
    return time.monotonic()


def tree(folder):
    """Files below a folder with their content, those of the campaign left out."""
    paths = [path for path in folder.rglob("*") if path.relative_to(folder).parts[0] != "campaign"]
    return {str(p.relative_to(folder)): p.read_bytes() if p.is_file() else None for p in paths}


def check_left(found, whole, outcome):
    """What is there after a stop is whole; a sweep's progress is kept where the line states so."""
    kept = {name for name in found if ".nc.parts" in name}
    assert not kept or "points are done and kept in" in outcome.stderr
    left = {name: content for name, content in found.items() if name not in kept}
    assert left.items() <= whole.items(), left.keys() - whole.keys()
    for manifest in (name for name in whole if Path(name).name == "manifest.json"):
        output = str(Path(manifest).parent)
        inside = {name for name in whole if name == output or name.startswith(f"{output}/")}
        assert inside <= left.keys() or not inside & left.keys()
    # A folder that was made for the output is not left without it.
    for name, content in left.items():
        assert content is not None or name == "tmp" or any(other.startswith(f"{name}/") for other in found)


def stopped_at(share, number, words, folder, took):
    """Send a signal at a share of the time the command takes, wait for its end, and return the outcome."""
    process = started(words, folder)
    begun = ready(process)
    time.sleep(max(0.0, begun + share * took - time.monotonic()))
    children = []
    if process.poll() is None:
        children = psutil.Process(process.pid).children(recursive=True)
        # A terminal sends Ctrl-C to all processes of a command, a system SIGTERM to the one it started.
        os.killpg(process.pid, number) if number == signal.SIGINT else process.send_signal(number)
    stdout, stderr = process.communicate()
    assert not psutil.wait_procs(children, timeout=60)[1]
    return subprocess.CompletedProcess(words, process.returncode, stdout, stderr)


@pytest.mark.slow
@pytest.mark.parametrize("line", LINES)
def test_a_stop_at_any_moment_leaves_all_or_nothing(line, campaign, tmp_path):
    words = line.split()
    shutil.copytree(campaign, tmp_path / "whole")
    process = started(words, tmp_path / "whole")
    begun = ready(process)
    _, stderr = process.communicate()
    took, code = time.monotonic() - begun, process.returncode
    assert code in (0, 1), stderr
    whole, luck = tree(tmp_path / "whole"), random.Random(line)
    for moment in range(MOMENTS):
        number, share = luck.choice(list(ENDS)), luck.random()
        folder = tmp_path / str(moment)
        shutil.copytree(campaign, folder)
        outcome = stopped_at(share, number, words, folder, took)
        where = f"{signal.Signals(number).name} at {share:.3f}: {outcome.returncode}: {outcome.stderr}"
        assert outcome.returncode in (code, 128 + number), where
        for noise in ("Traceback", "Exception ignored", "internal fault", "leaked"):
            assert noise not in outcome.stderr, where
        if outcome.returncode == 128 + number:
            assert outcome.stderr.splitlines()[-1].startswith(ENDS[number]), where
            assert outcome.stderr.count("stopped by") == 1, where
            assert "error:" not in outcome.stderr, where
            check_left(tree(folder), whole, outcome)
        shutil.rmtree(folder)


def test_every_command_is_stopped():
    commands = [name for group in COMMANDS.values() for name in group]
    # They run until they are stopped: tests/studio/test_serve.py, tests/cli/test_live.py.
    assert {line.split()[0] for line in LINES} == set(commands) - {"studio", "live"}


def test_a_stop_is_held_back_while_files_move(tmp_path):
    from pneutouch.stopping import temporary_folder, uninterrupted

    done = []
    with pytest.raises(KeyboardInterrupt), temporary_folder(within=tmp_path) as folder:
        (folder / "a").write_text("x")
        with uninterrupted():
            signal.raise_signal(signal.SIGINT)
            done.append("after the signal")
        done.append("after the block")
    assert done == ["after the signal"]
    assert not list(tmp_path.iterdir())


STOPPED_WITH_SHAPES = """
import os, signal
from pneutouch.cli import app, run

def invoked(words):
    from manifold3d import CrossSection
    shapes = [CrossSection.square((1.0, 1.0))]
    shapes.append(shapes)
    os.kill(os.getpid(), signal.SIGTERM)

app.invoked = invoked
run()
"""


def test_shapes_of_a_stopped_command_are_not_reported_as_leaked():
    """Frames that a stop unwinds may hold them in cycles, which only Python's search for garbage resolves."""
    words = [sys.executable, "-c", STOPPED_WITH_SHAPES]
    ended = subprocess.run(words, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (143, "stopped by SIGTERM\n")


_LOADING = """
import enum, os, signal, time
from pneutouch.cli.stop import stop_signals

make, sent = enum.EnumType.__call__, []

def stopping(*words, **named):
    if not sent:
        sent.append(os.kill(os.getpid(), signal.SIGINT))
    return make(*words, **named)

with stop_signals() as stop:
    enum.EnumType.__call__ = stopping
    import manifold3d
    assert sent and stop.received == signal.SIGINT
    try:
        while True:
            time.sleep(0.01)
    except KeyboardInterrupt:
        print("stopped with", manifold3d.Manifold.cube().volume())
"""


def test_a_stop_waits_until_a_compiled_library_is_loaded():
    # Its module makes enumerations in Python while it is loaded.
    done = subprocess.run([sys.executable, "-c", _LOADING], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "stopped with 1.0\n"), done.stderr


_ENDING = """
import os, signal, threading
from pneutouch.cli.stop import stop_signals

def wake():
    raise OSError("Bad file descriptor")

threading._register_atexit(wake)
with stop_signals(after=signal.SIG_IGN) as stop:
    try:
        {end}
    except KeyboardInterrupt:
        pass
"""


@pytest.mark.parametrize(("end", "said"), [("os.kill(os.getpid(), signal.SIGTERM)", False), ("pass", True)])
def test_what_a_pool_cannot_do_at_exit_is_unsaid_after_a_stop_alone(end, said):
    done = subprocess.run([sys.executable, "-c", _ENDING.format(end=end)], capture_output=True, text=True, check=False)
    assert ("Traceback" in done.stderr) is said
