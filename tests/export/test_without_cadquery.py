"""Without CadQuery, which is an extra, everything but STEP works and says so."""

from __future__ import annotations

import json
import sys
from importlib.metadata import PackageNotFoundError

import pytest

from pneutouch.export.step import step_obstacle
from pneutouch.output import files

WHY = 'CadQuery is not installed; pip install "pneutouch[cad]" adds it'


@pytest.fixture
def no_cadquery(monkeypatch):
    """The state of an installation without the extra."""
    installed = files.importlib.metadata.version

    def version(name):
        if name in ("cadquery", "cadquery-ocp"):
            raise PackageNotFoundError(name)
        return installed(name)

    monkeypatch.setattr(files.importlib.metadata, "version", version)
    for name in [name for name in sys.modules if name.partition(".")[0] in ("cadquery", "OCP")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "cadquery", None)
    monkeypatch.setitem(sys.modules, "OCP", None)


@pytest.mark.slow
def test_a_sensor_is_built_without_its_step_file_and_says_so(no_cadquery, command, tmp_path, built):
    done = command("build", "paper-dome", "--json")
    assert done.returncode == 0, done.stderr
    assert f"note: paper-dome.step is not written: {WHY}" in done.stderr
    folder = tmp_path / json.loads(done.stdout)["folder"]
    whole = built("paper-dome")
    names = {path.relative_to(whole).as_posix() for path in whole.rglob("*") if path.is_file()}
    assert {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()} == names - {
        "paper-dome.step"
    }
    about = json.loads((folder / "manifest.json").read_text())
    assert about["left_out"] == {"paper-dome.step": WHY}
    assert "cadquery" not in about["versions"] and "paper-dome.step" not in about["files"]
    assert f"Not written: `paper-dome.step`. {WHY}." in (folder / "print-sheet.md").read_text()
    assert (folder / "prediction.json").read_bytes() == (whole / "prediction.json").read_bytes()
    shown = command("show", str(folder / "paper-dome.3mf"))
    assert shown.returncode == 0, shown.stderr
    assert command("build", str(folder / "paper-dome.3mf"), "--out", "again").returncode == 0


@pytest.mark.slow
def test_a_specimen_is_built_without_its_step_file_and_says_so(no_cadquery, command, tmp_path, root):
    (tmp_path / "bars.toml").write_text((root / "designs/specimens/texture-specimen.toml").read_text())
    done = command("build", "bars.toml")
    assert done.returncode == 0, done.stderr
    about = json.loads((tmp_path / "outputs/bars/manifest.json").read_text())
    sheet = (tmp_path / "outputs/bars/print-sheet.md").read_text()
    assert about["left_out"] == {"bars.step": WHY}
    assert f"note: bars.step is not written: {WHY}" in done.stderr
    assert f"Not written: `bars.step`. {WHY}." in sheet


def test_a_library_that_cannot_be_loaded_is_named(monkeypatch):
    class Broken:
        def find_spec(self, name, path=None, target=None):
            if name == "OCP":
                raise ImportError("libGL.so.1: cannot open shared object file")

    monkeypatch.delitem(sys.modules, "OCP", raising=False)
    monkeypatch.setattr(sys, "meta_path", [Broken(), *sys.meta_path])
    assert step_obstacle() == "CadQuery's kernel cannot be loaded: libGL.so.1: cannot open shared object file"


def test_the_manifest_of_a_whole_build_leaves_nothing_out(built):
    about = json.loads((built("paper-dome") / "manifest.json").read_text())
    assert "left_out" not in about and {"cadquery", "cadquery-ocp"} <= set(about["versions"])
