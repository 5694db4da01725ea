"""Users' files lie in their own folder, never among the shipped ones."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from pneutouch.catalogue import Library, user_folder
from pneutouch.catalogue.library import shipped_root
from tests.conftest import ROOT


@pytest.fixture
def checkout(tmp_path):
    """A folder that looks like a checkout of the program, with its shipped designs."""
    place = tmp_path / "checkout"
    (place / "generator/pneutouch/catalogue").mkdir(parents=True)
    shutil.copy(ROOT / "generator/pneutouch/catalogue/library.py", place / "generator/pneutouch/catalogue")
    shutil.copytree(ROOT / "designs", place / "designs")
    return place


def test_what_is_shipped_is_that_of_the_checkout():
    """Installed, it is a copy."""
    for name in ("designs", "printprofiles"):
        own, shipped = ({p.name: p.read_bytes() for p in (r / name).glob("*.toml")} for r in (ROOT, shipped_root()))
        assert own == shipped != {}


def test_the_users_folder_is_the_working_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert user_folder() == Path()
    assert Library.default().folders == (tmp_path, shipped_root())


def test_in_a_checkout_it_is_a_folder_that_git_ignores(checkout, monkeypatch):
    monkeypatch.chdir(checkout)
    assert user_folder() == Path("user")
    assert "user/" in (ROOT / ".gitignore").read_text().splitlines()
    monkeypatch.chdir(ROOT)
    assert Library.default().folders == (ROOT / "user", shipped_root())


def test_a_variable_names_it_everywhere(checkout, tmp_path, monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path / "lab"))
    monkeypatch.chdir(checkout)
    assert user_folder() == tmp_path / "lab"
    monkeypatch.setenv("PNEUTOUCH_HOME", "~/lab")
    assert user_folder() == Path.home() / "lab"
    monkeypatch.setenv("PNEUTOUCH_HOME", "")
    assert user_folder() == Path("user")


def test_a_design_written_in_a_checkout_is_found_again_and_not_among_the_shipped(command, checkout, monkeypatch):
    shipped = sorted((checkout / "designs").iterdir())
    done = command("new", "mine", cwd=checkout)
    assert (done.returncode, done.stdout.strip()) == (0, "user/designs/mine.toml")
    assert sorted((checkout / "designs").iterdir()) == shipped
    found = json.loads(command("list", "designs", "--json", cwd=checkout).stdout)["designs"]
    assert {"mine", "paper-dome"} <= {entry["name"] for entry in found}


def test_the_users_design_comes_before_the_shipped_one_of_its_name(command, tmp_path, monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path / "lab"))
    (tmp_path / "lab/designs").mkdir(parents=True)
    (tmp_path / "lab/designs/paper-dome.toml").write_text("[membrane]\ninner_radius_mm = 7\n")
    assert Library.default().paths("designs")["paper-dome"] == tmp_path / "lab/designs/paper-dome.toml"
