"""Files of a person in an output folder: none is overwritten or removed, and those out of the way stay."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from pneutouch.errors import InputError
from pneutouch.formats import format_of
from pneutouch.output import files as output_files
from pneutouch.output.files import check_writable, replacing, with_manifest, write_folder
from tests.refusals import refused

OLD = with_manifest({"sheet.md": b"sheet", "runs/a.csv": b"a", "runs/old.csv": b"old"}, "x", {})
NEW = with_manifest({"sheet.md": b"new", "runs/a.csv": b"b", "runs/b.csv": b"b", "extra/c.csv": b"c"}, "x", {})


def content(folder: Path) -> dict[str, object]:
    """What lies below a folder: bytes of a file, target of a link, None for all else."""
    return {
        path.relative_to(folder).as_posix(): (
            path.readlink() if path.is_symlink() else path.read_bytes() if path.is_file() else None
        )
        for path in folder.rglob("*")
    }


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_folder(tmp_path / "x", OLD)
    return tmp_path / "x"


def linked(path: Path) -> None:
    """The same bytes, kept elsewhere."""
    kept = path.rename(path.parents[1] / f"kept-{path.name}")
    path.symlink_to(kept)


def emptied(path: Path) -> None:
    path.unlink()
    path.mkdir()


def piped(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


@pytest.mark.parametrize("name", ["runs/a.csv", "runs/old.csv"], ids=["written again", "to be removed"])
@pytest.mark.parametrize("change", [lambda path: path.write_bytes(b"measured"), linked, emptied, piped])
def test_a_file_that_was_changed_is_refused_before_any_work(folder: Path, name: str, change) -> None:  # type: ignore[no-untyped-def]
    change(folder / name)
    before = content(folder.parent)
    with refused(None, file=folder / name, remedy="`out`"):
        check_writable(folder)
    with refused(None, file=folder / name, remedy="`out`"):
        write_folder(folder, NEW)
    assert content(folder.parent) == before


def measured(path: Path) -> Path:
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(b"measured")
    return path


def in_place_of_a_folder(folder: Path) -> Path:
    return measured(folder / "extra")


def in_a_folder_in_place_of_a_file(folder: Path) -> Path:
    return measured(folder / "runs/b.csv/mine.csv")


def deep_in_place_of_a_file(folder: Path) -> Path:
    (folder / "extra/c.csv/deep").mkdir(parents=True)
    return measured(folder / "extra/c.csv/deep/mine.csv")


def an_empty_folder_in_place_of_a_file(folder: Path) -> Path:
    (folder / "runs/b.csv").mkdir()
    return folder / "runs/b.csv"


def a_linked_folder(folder: Path) -> Path:
    """The folder of the runs lies on another disk, every file in it as it was."""
    (folder / "runs").rename(folder.parent / "disk")
    (folder / "runs").symlink_to(folder.parent / "disk")
    return folder / "runs"


def a_link_to_nothing(folder: Path) -> Path:
    (folder / "runs/b.csv").symlink_to("nowhere")
    return folder / "runs/b.csv"


def a_pipe(folder: Path) -> Path:
    os.mkfifo(folder / "pipe")
    return folder / "pipe"


@pytest.mark.parametrize(
    "put",
    [
        lambda folder: measured(folder / "runs/b.csv"),
        in_place_of_a_folder,
        in_a_folder_in_place_of_a_file,
        deep_in_place_of_a_file,
        an_empty_folder_in_place_of_a_file,
        a_linked_folder,
        a_link_to_nothing,
        a_pipe,
    ],
)
def test_what_a_person_put_in_the_way_is_refused_and_nothing_is_written(folder: Path, put) -> None:  # type: ignore[no-untyped-def]
    path = put(folder)
    before = content(folder.parent)
    with refused(None, file=path, remedy="`out`"):
        write_folder(folder, NEW)
    assert content(folder.parent) == before


def test_what_is_put_in_the_way_while_the_new_output_is_made_is_found(folder: Path) -> None:
    with refused(None, file=folder / "sheet.md"), replacing(folder) as fresh:
        (fresh / "sheet.md").write_bytes(b"new")
        (folder / "sheet.md").write_bytes(b"annotated")
    assert (folder / "sheet.md").read_bytes() == b"annotated"


def test_what_a_person_put_out_of_the_way_stays(folder: Path) -> None:
    own = {"notes.txt": b"mine", "runs/mine.csv": b"measured", "deep/er/x.csv": b"measured"}
    for name, data in own.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    (folder / "runs/old.csv").unlink()
    write_folder(folder, NEW)
    written = {name: data for name, data in content(folder).items() if data is not None}
    assert written == {**NEW, **own}


def test_the_modes_of_folders_stay(folder: Path) -> None:
    (folder / "mine").mkdir()
    (folder / "mine" / "notes.md").write_bytes(b"notes")
    modes = {folder: 0o750, folder / "runs": 0o700, folder / "mine": 0o711}
    for path, mode in modes.items():
        path.chmod(mode)
    write_folder(folder, NEW)
    assert {path: path.stat().st_mode & 0o777 for path in modes} == modes


def test_a_recording_in_the_folder_goes_on(folder: Path) -> None:
    with (folder / "runs/mine.csv").open("w") as recording:
        recording.write("1\n")
        recording.flush()
        write_folder(folder, NEW)
        recording.write("2\n")
    assert (folder / "runs/mine.csv").read_text() == "1\n2\n"


def test_a_place_without_second_names_of_files_keeps_them_too(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", refuse)
    measured(folder / "runs/mine.csv")
    (folder / "link").symlink_to("nowhere")
    write_folder(folder, NEW)
    assert (folder / "runs/mine.csv").read_bytes() == b"measured" and (folder / "link").is_symlink()


def test_an_output_as_it_was_written_is_replaced_by_any_other(folder: Path) -> None:
    for files in (OLD, NEW, with_manifest({"runs": b"a file now"}, "x", {}), OLD):
        write_folder(folder, files)
        assert {name: data for name, data in content(folder).items() if data is not None} == files


def test_a_folder_without_a_manifest_is_a_person_s(folder: Path) -> None:
    (folder / "manifest.json").unlink()
    before = content(folder)
    with refused("out"):
        write_folder(folder, NEW)
    assert content(folder) == before


@pytest.mark.parametrize("entry", ["{}", "[]", '{"sha256": null}', '"x"'])
def test_a_file_whose_digest_the_manifest_does_not_give_is_not_ours(folder: Path, entry: str) -> None:
    manifest = folder / "manifest.json"
    manifest.write_text(f'{{"format": "{format_of("manifest")}", "files": {{"sheet.md": {entry}}}}}')
    shutil.rmtree(folder / "runs")
    before = content(folder)
    with pytest.raises(InputError):
        write_folder(folder, NEW)
    assert content(folder) == before


def rename_by_way_of_a_third(monkeypatch: pytest.MonkeyPatch) -> None:
    """A system that cannot exchange two names in one step."""
    monkeypatch.setattr(output_files, "_at_once", lambda one, other: False)


@pytest.mark.parametrize("prepare", [lambda patch: None, rename_by_way_of_a_third], ids=["at once", "by a third name"])
def test_a_file_that_comes_while_the_names_are_exchanged_stays(folder: Path, prepare, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    prepare(monkeypatch)
    keep = output_files._keep_foreign

    def late(old: Path, new: Path, *, again: bool = False) -> None:
        keep(old, new, again=again)
        if not again:
            (folder / "runs" / "late.csv").write_bytes(b"measured meanwhile")

    monkeypatch.setattr(output_files, "_keep_foreign", late)
    write_folder(folder, NEW)
    assert (folder / "runs" / "late.csv").read_bytes() == b"measured meanwhile"
    assert (folder / "sheet.md").read_bytes() == b"new"
    assert [path.name for path in folder.parent.iterdir()] == ["x"]


@pytest.mark.parametrize("prepare", [lambda patch: None, rename_by_way_of_a_third], ids=["at once", "by a third name"])
def test_a_file_of_ours_that_is_changed_while_the_names_are_exchanged_stays(folder: Path, prepare, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    prepare(monkeypatch)
    keep = output_files._keep_foreign

    def late(old: Path, new: Path, *, again: bool = False) -> None:
        keep(old, new, again=again)
        if not again:
            (folder / "sheet.md").write_bytes(b"annotated meanwhile")

    monkeypatch.setattr(output_files, "_keep_foreign", late)
    with pytest.raises(InputError):
        write_folder(folder, NEW)
    assert (folder / "sheet.md").read_bytes() == b"annotated meanwhile"
    assert [path.name for path in folder.parent.iterdir()] == ["x"]


KILLED = """
import os, sys
from pathlib import Path
from pneutouch.output import files

files._at_once = lambda one, other: False
rename = Path.rename

def killed(self, target):
    rename(self, target)
    if str(target).endswith(".old"):
        os._exit(9)

Path.rename = killed
files.write_folder(Path(sys.argv[1]), {"manifest.json": b"{}"})
"""


def test_a_process_killed_between_two_renames_leaves_the_folder_to_be_found(folder: Path) -> None:
    (folder / "notes.md").write_bytes(b"a person's")
    done = subprocess.run([sys.executable, "-c", KILLED, str(folder)], check=False)
    assert done.returncode == 9 and not folder.exists()
    write_folder(folder, NEW)
    assert (folder / "notes.md").read_bytes() == b"a person's"
    assert (folder / "sheet.md").read_bytes() == b"new"


ROUNDS = """
import sys
from pathlib import Path
from pneutouch.output.files import with_manifest, write_folder

folder, name = Path(sys.argv[1]), sys.argv[2]
for number in range(15):
    write_folder(folder, with_manifest({f"{name}.txt": b"%d" % number, "both.txt": name.encode()}, "x", {}))
"""


def test_two_processes_in_one_folder_lose_no_file_of_a_person(folder: Path) -> None:
    (folder / "notes.md").write_bytes(b"a person's")
    both = [subprocess.Popen([sys.executable, "-c", ROUNDS, str(folder), name]) for name in ("first", "second")]
    assert [process.wait() for process in both] == [0, 0]
    assert (folder / "notes.md").read_bytes() == b"a person's"
    last = (folder / "both.txt").read_bytes().decode()
    assert content(folder).keys() == {"notes.md", "both.txt", f"{last}.txt", "manifest.json"}
    assert [path.name for path in folder.parent.iterdir()] == ["x"]
