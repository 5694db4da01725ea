"""The public names: all there, typed, and loaded only when they are used."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import pneutouch as pt
from tests.conftest import ROOT
from tests.pages import blocks

PACKAGE = Path(pt.__file__).parent


def test_importing_loads_neither_numpy_nor_pydantic_nor_a_part_of_the_package():
    code = "import sys; import pneutouch; print(*sorted(sys.modules))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not {"numpy", "pydantic", "scipy", "typer", "xarray"} & set(loaded)
    assert [name for name in loaded if name.startswith("pneutouch")] == ["pneutouch"]


def test_all_names_are_there_listed_and_documented():
    assert set(dir(pt)) == set(pt.__all__)
    for name in set(pt.__all__) - {"__version__"}:
        assert getattr(pt, name).__doc__, name
    with pytest.raises(AttributeError, match="no attribute 'Desing'"):
        _ = pt.Desing


def test_the_stub_declares_the_names_that_are_there():
    declared = set()
    for node in ast.parse((PACKAGE / "__init__.pyi").read_text()).body:
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                assert getattr(pt, alias.asname).__module__ == node.module
                declared.add(alias.asname)
    assert declared == set(pt.__all__) - {"__version__"}
    assert (PACKAGE / "py.typed").is_file()


def test_the_page_runs(capsys):
    text = (ROOT / "docs" / "reference" / "python.md").read_text()
    block = blocks(text, "python")[0]
    exec(compile(block, "python.md", "exec"), {})
    assert "kPa/N" in capsys.readouterr().out


def test_a_file_that_cannot_be_read_is_listed_with_what_is_wrong(tmp_path, monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    (tmp_path / "designs").mkdir()
    (tmp_path / "designs/torn.toml").write_text("membrane = 1\n")
    assert pt.designs()["torn"].startswith("cannot be read: membrane = 1")
    assert pt.designs()["paper-dome"] == "The paper's sensor"
