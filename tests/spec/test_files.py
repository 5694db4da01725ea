"""Files that others wrote: bounded, plain, inside their folder; and names that can name a file."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from pneutouch.errors import InputError
from pneutouch.spec.files import design_inside, inside, read_bytes
from pneutouch.spec.read import read_toml, toml_value
from pneutouch.spec.values import file_name, name_of, plain_name
from tests.refusals import refused


@pytest.mark.parametrize("name", ["a.csv", "runs/a.csv", "runs/../a.csv", "not-there.csv"])
def test_a_path_within_the_folder_is_that_path(name, tmp_path):
    (tmp_path / "runs").mkdir()
    assert inside(tmp_path, name, file="x.toml", key="file") == tmp_path / name


@pytest.mark.parametrize(
    "name", ["../a.csv", "runs/../../a.csv", "/etc/passwd", "link/a.csv", "alias.csv", "loop", "a\0b"]
)
def test_a_path_that_leads_out_is_refused(name, tmp_path):
    folder = tmp_path / "campaign"
    folder.mkdir()
    (tmp_path / "a.csv").write_text("secret")
    (folder / "link").symlink_to(tmp_path)
    (folder / "alias.csv").symlink_to(tmp_path / "a.csv")
    (folder / "loop").symlink_to(folder / "loop")
    with pytest.raises(InputError) as caught:
        inside(folder, name, file="x.toml", key="runs[0].file")
    assert "leads out of the folder" in str(caught.value) and "secret" not in str(caught.value)
    assert (caught.value.file, caught.value.key, caught.value.value) == ("x.toml", "runs[0].file", name)


def test_a_link_within_the_folder_and_a_folder_that_is_a_link_are_right(tmp_path):
    folder = tmp_path / "campaign"
    folder.mkdir()
    (folder / "a.csv").write_text("1")
    (folder / "b.csv").symlink_to(folder / "a.csv")
    (tmp_path / "other").symlink_to(folder)
    assert read_bytes(inside(tmp_path / "other", "b.csv", file="x.toml", key="file")) == b"1"


def test_a_design_is_a_name_of_the_catalogue_or_a_path_inside(tmp_path):
    assert design_inside(tmp_path, "paper-dome", file="x.toml", key="design") == "paper-dome"
    assert design_inside(tmp_path, "mine.toml", file="x.toml", key="design") == str(tmp_path / "mine.toml")
    for name in ("../mine.toml", "/etc/passwd", "../paper-dome", "..\\mine.toml"):
        if name != "..\\mine.toml":
            with refused("design"):
                design_inside(tmp_path, name, file="x.toml", key="design")


def test_devices_pipes_folders_and_large_files_are_not_read(tmp_path):
    pipe = tmp_path / "pipe.toml"
    os.mkfifo(pipe)
    large = tmp_path / "large.toml"
    with large.open("wb") as file:
        file.truncate(2_000_000_000)
    for path, why in (
        ("/dev/zero", "not a plain file, but a device or a pipe; give a TOML file"),
        (pipe, "not a plain file"),
        (tmp_path, "this is a folder; give a TOML file"),
        (large, f"larger than 1 MB: {large.stat().st_size} bytes"),
        (tmp_path / ("x" * 300), "cannot be read: File name too long"),
        (tmp_path / "none", "no such file"),
    ):
        with pytest.raises(InputError, match=why):
            read_toml(tmp_path / path)


def test_toml_that_python_cannot_hold_is_bad_input(tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(f"a = {'9' * 5000}")
    with pytest.raises(InputError, match="holds a value that cannot be read: Exceeds the limit"):
        read_toml(path)
    for number in ("9" * 400, "9_" * 20 + "9", "0x" + "f" * 17, "-9223372036854775809"):
        path.write_text(f"[x]\na = [1, {{b = {number}}}]")
        with pytest.raises(InputError, match="holds a value that cannot be read: a whole number of more than 64 bits"):
            read_toml(path)
        assert toml_value(number) == number
    path.write_text("a = 9223372036854775807")
    assert read_toml(path) == {"a": 2**63 - 1}
    path.write_text(f"a = {'[' * 5000}")
    with pytest.raises(InputError, match="nested too deep"):
        read_toml(path)


@pytest.mark.parametrize("name", ["a", "paper-dome", "v1.2_b", "Größe-3", "9mm", "x" * 100])
def test_a_name(name):
    assert plain_name(name) == name


@pytest.mark.parametrize(
    "name",
    ["", ".", "..", ".hidden", "-x", "_x", "a/b", "a\\b", "a\nb", "a b", "a\x1b", "x" * 101, "字" * 70, "a\udc80"],
)
def test_no_name(name, tmp_path):
    with refused("name"):
        plain_name(name, key="name")


def test_a_file_names_what_is_in_it(tmp_path):
    assert name_of(tmp_path / "mine.toml") == "mine"
    for file in ("..toml", "a\nb.toml", "a\\b.toml", f"{'x' * 120}.toml"):
        with pytest.raises(InputError, match="rename the file"):
            name_of(tmp_path / file)


def test_any_text_makes_part_of_a_file_name():
    assert file_name("run 3 (a)") == "run 3 (a)"
    assert file_name("../../a\nb") == "-..-a-b"
    assert file_name("...") == file_name("") == "unnamed"
    assert len(file_name("字" * 300).encode()) <= 200


def test_a_path_that_may_not_be_read_is_not_said_to_lead_out(tmp_path, monkeypatch):
    def refused(path):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(Path, "is_symlink", refused)
    with pytest.raises(InputError, match="Permission"):
        inside(tmp_path, "a.csv", file="x.toml", key="file")
