"""A named pipe in the place of a file: every reader refuses it and names it; none waits for somebody to write into it."""

from __future__ import annotations

import contextlib
import os
import shutil
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

import pneutouch as pt
from pneutouch.export.voxels.stack import read_stack
from pneutouch.spec.coupon import read_results
from pneutouch.spec.tasks import read_tasks
from pneutouch.workflows.sweep.dataset import stored_dataset, stored_fingerprint
from tests.refusals import refused

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")

PATIENCE = 60.0
"""Seconds after which a reader is taken to wait for ever."""


@contextlib.contextmanager
def pipe(path: Path) -> Iterator[Path]:
    """A named pipe at ``path``. A reader that waits at it is let go after a long time, and the test fails then."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.unlink(missing_ok=True)
    os.mkfifo(path)
    ended, waited = threading.Event(), []

    def let_go() -> None:
        while not ended.wait(0.1 if waited else PATIENCE):
            waited.append(path)
            # Without a reader there is nothing to open.
            with contextlib.suppress(OSError):
                os.close(os.open(path, os.O_WRONLY | os.O_NONBLOCK))

    watch = threading.Thread(target=let_go, daemon=True)
    watch.start()
    try:
        yield path
    finally:
        ended.set()
        watch.join()
        assert not waited, f"waits at {path}"


SWEEP = "sweep --design paper-dome --over membrane.wall_thickness_mm=1,2 --model membrane --out a.nc"
LINES = [
    ("predict ./a.toml", "a.toml"),
    ("check a.toml", "a.toml"),
    ("build a.toml", "a.toml"),
    ("build a.3mf", "a.3mf"),
    ("show a.3mf", "a.3mf"),
    ("show stack", "stack/stack.json"),
    ("select a.toml", "a.toml"),
    ("sweep a.toml", "a.toml"),
    (SWEEP, "a.nc"),
    *((SWEEP, f"a.nc.parts/{name}") for name in ("journal", "journal.new", "inputs", "dataset", "lock")),
    (SWEEP.replace("wall_thickness_mm=1,2", "material=TangoPlus,Mine"), "printprofiles/materials/Mine.toml"),
    (SWEEP, "printprofiles/objet260-connex.toml"),
    (SWEEP, "parts/tubes/4x2.5.toml"),
    ("tray a.toml", "a.toml"),
    ("new mine --from a.toml", "a.toml"),
    ("plan paper-dome --rig a.toml", "a.toml"),
    ("simulate folder", "folder/campaign.toml"),
    ("characterize folder", "folder/campaign.toml"),
    ("characterize a.toml", "a.toml"),
    ("characterize a.csv --design paper-dome", "a.csv"),
    ("calibrate folder --sensor A", "folder/campaign.toml"),
    ("compare folder paper-dome", "folder/manifest.json"),
    ("coupons --results a.toml", "a.toml"),
    ("predict paper-dome --tasks a.csv", "a.csv"),
    ("predict paper-dome --tasks a.toml", "a.toml"),
    ("predict paper-dome --for sensitivity=1 --leak a.toml", "a.toml"),
    ("predict paper-dome --for sensitivity=1 --leak folder", "folder/figures.json"),
    ("predict paper-dome --set membrane.material=Mine", "printprofiles/materials/Mine.toml"),
    ("predict mine", "designs/mine.toml"),
    ("predict paper-dome@mine", "calibrations/mine.toml"),
    *(
        (f"{line} a.{suffix}", f"a.{suffix}")
        for suffix in ("csv", "xlsx", "parquet", "tdms")
        for line in (
            "fit-material --name Ours --like DragonSkin20",
            "fit-material --name Ours --density 1.1 --puck 20x6",
            "scan texture-specimen --design paper-dome --data",
        )
    ),
]
"""Commands, and the file of theirs that is a pipe."""


@pytest.mark.slow
@pytest.mark.parametrize(("line", "name"), LINES, ids=[f"{line}, {name}" for line, name in LINES])
def test_a_command_refuses_a_pipe_and_names_it(line, name, command, tmp_path):
    with pipe(tmp_path / name):
        done = command(*line.split())
    assert done.returncode == 2, done.stderr
    assert name in done.stderr.splitlines()[-1], done.stderr
    made = {path.name for path in tmp_path.rglob("*") if path.is_file()}
    assert not made, made


RUN = "runs/TangoPlus-1-0kPa-steps-1"


@pytest.fixture
def piped(campaign_of_steps, tmp_path, request) -> Iterator[Path]:
    """A campaign of two runs, one of them a pipe."""
    folder, suffix = tmp_path / "folder", request.param
    shutil.copytree(campaign_of_steps, folder)
    file = folder / "campaign.toml"
    file.write_text(file.read_text().replace(f"{RUN}.csv", f"{RUN}.{suffix}"))
    with pipe(folder / f"{RUN}.{suffix}"):
        yield folder


@pytest.mark.parametrize("piped", ["csv", "xlsx", "parquet", "tdms"], indirect=True)
def test_a_run_that_is_a_pipe_is_one_that_cannot_be_read(piped):
    (failure,) = pt.characterize(piped, model="atlas")["failures"]
    assert failure["file"].startswith(RUN) and "pipe" in failure["message"]


@pytest.mark.parametrize("piped", ["csv"], indirect=True)
def test_a_sensor_is_calibrated_without_a_run_that_is_a_pipe(piped, command):
    done = command("calibrate", "folder", "--fit", "modulus")
    assert done.returncode == 3 and RUN in done.stdout, done


def test_a_target_that_is_a_pipe(campaign_of_steps, tmp_path):
    with pipe(tmp_path / "target.toml") as path, refused(None, file=path):
        pt.characterize(campaign_of_steps, target=path, model="atlas")


@pytest.mark.parametrize("read", [stored_dataset, stored_fingerprint, read_stack, read_results, read_tasks])
def test_a_reader_refuses_a_pipe(read, tmp_path):
    inside = "stack.json" if read is read_stack else "a"
    with pipe(tmp_path / inside) as path, refused(None, file=path):
        read(tmp_path if read is read_stack else path)


def test_a_manifest_that_is_a_pipe_is_not_ours(command, tmp_path):
    with pipe(tmp_path / "outputs/paper-dome-plan/manifest.json") as path:
        done = command("plan", "paper-dome")
    assert done.returncode == 2 and path.parent.name in done.stderr, done.stderr
    assert path.is_fifo()
