"""The output folder: complete, repeatable, whole or not at all."""

from __future__ import annotations

import hashlib
import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from pneutouch.errors import InputError, RuleBrokenError
from pneutouch.output.files import check_writable, replacing, with_manifest, write_folder
from pneutouch.workflows.build import STEPS, build
from tests.refusals import refused

FILES = {
    "assembly.svg",
    "paper-dome.3mf",
    "jobs/paper-dome-connector.3mf",
    "jobs/paper-dome-connector.ini",
    "jobs/paper-dome-membrane.3mf",
    "stl/membrane.stl",
    "stl/connector.stl",
    "paper-dome.step",
    "paper-dome.glb",
    "paper-dome-pressed.glb",
    "paper-dome-pressed.png",
    "datasheet.html",
    "datasheet.pdf",
    "prediction.json",
    "print-sheet.md",
    "manifest.json",
}


def content(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_every_named_file_is_there_and_in_the_manifest(built):
    folder = built("paper-dome")
    assert set(content(folder)) == FILES
    manifest = json.loads((folder / "manifest.json").read_text())
    assert set(manifest["files"]) == FILES - {"manifest.json"}
    for name, entry in manifest["files"].items():
        data = (folder / name).read_bytes()
        assert entry == {"sha256": hashlib.sha256(data).hexdigest(), "bytes": len(data)}
    for mesh in manifest["mesh"].values():
        assert 0 < mesh["measured_deviation_mm"] <= mesh["tolerance_mm"]


def listed(**files: bytes) -> dict[str, bytes]:
    """Files and their manifest; in a name ``__`` stands for a slash and ``_`` for a point."""
    named = {name.replace("__", "/").replace("_", "."): data for name, data in files.items()}
    return with_manifest(named, "x", {})


OLD = listed(old_txt=b"old")


@pytest.mark.slow
def test_a_build_touches_nothing_before_it_writes_and_repeats_the_bytes_of_another_process(built, evaluated, tmp_path):
    """The other process has a hash seed of its own."""
    write_folder(tmp_path / "paper-dome", OLD)
    steps = []

    def untouched(step: str) -> None:
        steps.append(step)
        assert content(tmp_path / "paper-dome") == OLD
        assert len(list(tmp_path.iterdir())) == 1

    build(evaluated("paper-dome"), tmp_path, untouched)
    assert steps == list(STEPS)
    assert content(tmp_path / "paper-dome") == content(built("paper-dome"))


def test_a_broken_rule_writes_nothing(evaluated, tmp_path):
    broken = evaluated("stiff-dome", "membrane.wall_thickness_mm=0.5")
    with pytest.raises(RuleBrokenError, match=r"0\.6 mm"):
        build(broken, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_build_that_fails_while_it_writes_leaves_the_previous_output_whole(tmp_path, monkeypatch):
    folder = tmp_path / "paper-dome"
    write_folder(folder, OLD)
    before = content(tmp_path)
    with pytest.raises(KeyboardInterrupt), replacing(folder) as fresh:
        (fresh / "new.txt").write_bytes(b"new")
        raise KeyboardInterrupt
    assert content(tmp_path) == before

    original = Path.write_bytes
    written = []

    def full(self, data):
        written.append(self)
        if len(written) > 3:
            raise OSError(28, "No space left on device")
        return original(self, data)

    monkeypatch.setattr(Path, "write_bytes", full)
    with refused("out"):
        write_folder(folder, {f"{k}.txt": b"x" for k in range(9)} | {"manifest.json": b"{}"})
    monkeypatch.undo()
    assert content(tmp_path) == before


KILLS = {
    "at the first file": "Path.write_bytes = die",
    "at the third file": "left = [die, Path.write_bytes, Path.write_bytes]\nPath.write_bytes = lambda *a: left.pop()(*a)",
    "before the exchange": "files.exchange = die",
}


@pytest.mark.parametrize("moment", KILLS)
def test_a_build_killed_while_it_writes_leaves_the_previous_output_whole(moment, tmp_path):
    """Before it writes, a build touches nothing: see above."""
    folder = tmp_path / "paper-dome"
    write_folder(folder, OLD)
    code = (
        "import os\nfrom pathlib import Path\nfrom pneutouch.output import files\n"
        f"def die(*_): os.kill(os.getpid(), 9)\n{KILLS[moment]}\n"
        f"files.write_folder(Path({str(folder)!r}), dict.fromkeys(['a', 'b', 'c', 'manifest.json'], b'new'))"
    )
    killed = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert killed.returncode == -signal.SIGKILL, killed.stderr
    assert content(folder) == OLD


def test_a_new_build_replaces_our_files_and_keeps_other_peoples(tmp_path):
    folder = tmp_path / "x"
    write_folder(folder, listed(a_txt=b"1", b__c_txt=b"1"))
    (folder / "notes").mkdir()
    (folder / "notes/mine.csv").write_text("measured")
    write_folder(folder, listed(a_txt=b"2"))
    assert content(folder) == {**listed(a_txt=b"2"), "notes/mine.csv": b"measured"}
    assert list(tmp_path.iterdir()) == [folder]


def test_links_and_empty_folders_of_other_people_are_kept(tmp_path):
    folder, elsewhere = tmp_path / "x", tmp_path / "data"
    elsewhere.mkdir()
    write_folder(folder, listed())
    (folder / "link").symlink_to(elsewhere)
    (folder / "empty").mkdir()
    write_folder(folder, listed(a_txt=b"1"))
    assert (folder / "link").is_symlink()
    assert (folder / "empty").is_dir()
    (tmp_path / "alias").symlink_to(folder)
    with refused("out"):
        write_folder(tmp_path / "alias", {"manifest.json": b"{}"})


def test_a_damaged_manifest_is_refused_before_any_work(tmp_path):
    for text in ("", "[]", '{"file": 1}'):
        folder = tmp_path / "x"
        folder.mkdir(exist_ok=True)
        (folder / "manifest.json").write_text(text)
        with pytest.raises(InputError, match="damaged"):
            check_writable(folder)


def test_folders_that_are_not_ours_are_not_touched(tmp_path):
    other = tmp_path / "photos"
    other.mkdir()
    (other / "cat.jpg").write_bytes(b"meow")
    with refused("out"):
        write_folder(other, {"manifest.json": b"{}"})
    assert content(other) == {"cat.jpg": b"meow"}
    with refused("out"):
        write_folder(other / "cat.jpg", {"manifest.json": b"{}"})
    with refused("out"):
        write_folder(other / "cat.jpg" / "x", {"manifest.json": b"{}"})


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs a folder that nobody can write to")
def test_a_folder_that_cannot_be_written_is_an_input_error():
    with refused("out"):
        write_folder(Path("/proc/self/outputs"), {"manifest.json": b"{}"})


@pytest.mark.slow
def test_input_hash_changes_with_the_inputs_alone(evaluated):
    from pneutouch.workflows.build import input_hash

    assert input_hash(evaluated("paper-dome")) == input_hash(evaluated("paper-dome"))
    assert input_hash(evaluated("paper-dome")) != input_hash(evaluated("paper-dome", "membrane.inner_radius_mm=9.26"))
