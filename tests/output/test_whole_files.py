"""Files that are written whole or not at all: what was there stays where the new one cannot be written."""

from __future__ import annotations

import os
import signal
import stat

import pytest

from pneutouch.errors import InputError
from pneutouch.output.files import create_file, replace_file, replace_files
from pneutouch.output.new import new_design, new_from, write_design
from pneutouch.workflows.calibrate.calibration_files import SavedCalibration, save
from pneutouch.workflows.coupons import MeasuredProfile, write_profiles
from tests.refusals import refused
from tests.running import files_of_at_most


def everything(folder):
    return {path.name: path.read_bytes() if path.is_file() else None for path in folder.rglob("*")}


@pytest.mark.parametrize(
    "write",
    [
        lambda folder: new_design("mine", folder / "new"),
        lambda folder: new_design("mine", folder),
        lambda folder: new_from("campaign", "mine", folder),
        lambda folder: write_design("there", folder, "x" * 200, overwrite=True),
        lambda folder: write_profiles([MeasuredProfile(folder / f"{name}.toml", "x" * n, []) for name, n in SIZES]),
        lambda folder: replace_files({folder / f"{name}.toml": b"x" * n for name, n in SIZES}),
        lambda folder: create_file(folder / "a/b/c.toml", b"x" * 200),
    ],
    ids=["new folder", "new", "example", "overwrite", "profiles", "files", "created"],
)
def test_a_full_disk_leaves_what_was_there_and_nothing_else(write, tmp_path):
    (tmp_path / "there.toml").write_text("mine")
    with files_of_at_most(100), pytest.raises(InputError, match=r"File too large; give a folder you may write to"):
        write(tmp_path)
    assert everything(tmp_path) == {"there.toml": b"mine"}


SIZES = [("there", 50), ("other", 200)]


def test_the_command_reports_a_full_disk_in_one_line(command, tmp_path):
    with files_of_at_most(100):
        done = command("new", "mine", "--out", "made")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "error: --out: made/mine.toml: File too large; give a folder you may write to\n"
    assert everything(tmp_path) == {}


def test_a_new_file_never_replaces_one(tmp_path):
    (tmp_path / "mine.toml").write_text("mine")
    (tmp_path / "link.toml").symlink_to("nowhere")
    for name in ("mine", "link"):
        with pytest.raises(InputError, match="there is such a file already"):
            create_file(tmp_path / f"{name}.toml", b"x")
    with refused("out"):
        create_file(tmp_path / "mine.toml/other.toml", b"x")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link.toml", "mine.toml"]
    assert (tmp_path / "mine.toml").read_text() == "mine"


def test_a_place_without_second_names_of_files_takes_new_files_too(tmp_path, monkeypatch):
    def refuse(source, target):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", refuse)
    create_file(tmp_path / "a.toml", b"x")
    with pytest.raises(InputError, match="there is such a file already"):
        create_file(tmp_path / "a.toml", b"y")
    assert everything(tmp_path) == {"a.toml": b"x"}


@pytest.mark.parametrize("write", [create_file, replace_file])
def test_a_stop_while_a_file_is_written_finds_it_whole(write, tmp_path, monkeypatch):
    sync = os.fsync

    def stopped(handle):
        signal.raise_signal(signal.SIGINT)
        sync(handle)

    monkeypatch.setattr(os, "fsync", stopped)
    with pytest.raises(KeyboardInterrupt):
        write(tmp_path / "a.toml", b"whole")
    assert everything(tmp_path) == {"a.toml": b"whole"}
    assert stat.S_IMODE((tmp_path / "a.toml").stat().st_mode) == 0o644


def test_a_folder_is_not_replaced_and_the_parameter_is_named(tmp_path):
    (tmp_path / "a.svg").mkdir()
    with pytest.raises(InputError, match=r"^charts: .*a\.svg is not a file") as caught:
        replace_files({tmp_path / "b.svg": b"x", tmp_path / "a.svg": b"x"}, key="charts")
    assert caught.value.key == "charts"
    assert everything(tmp_path) == {"a.svg": None}


def test_a_calibration_that_cannot_be_saved_is_named_once(tmp_path):
    path = tmp_path / "mine.toml"
    with files_of_at_most(100), pytest.raises(InputError) as caught:
        save(SavedCalibration("mine", path, "x" * 200))
    assert str(caught.value) == f"{path}: File too large; take a user's folder you may write to"
    assert everything(tmp_path) == {}
