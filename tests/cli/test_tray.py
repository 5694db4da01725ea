"""``pneutouch tray`` as a user meets it; tests/test_pages.py runs the commands of docs/howto/tray.md."""

from __future__ import annotations

import json
import re
import shutil

import pytest

from tests.cli.test_commands import modules_after
from tests.conftest import ROOT

TEXT = (ROOT / "docs/howto/tray.md").read_text(encoding="utf-8")
EXAMPLE = "seven-resins.toml"


@pytest.fixture
def bench(tmp_path):
    """A folder with the example in it that the page names."""
    shutil.copy(ROOT / "docs/examples" / EXAMPLE, tmp_path)
    return tmp_path


@pytest.mark.slow
def test_the_page_s_file_runs(command, bench):
    (text,) = re.findall(r"```toml\n(.*?)```", TEXT, re.DOTALL)
    (bench / "walls.toml").write_text(text)
    result = command("tray", "walls.toml", "--json")
    assert result.returncode == 0, result.stderr
    assert json.loads(result.stdout)["parts"] == 2 * (3 * 2 + 1)


@pytest.mark.slow
def test_json_is_one_document_and_progress_goes_to_stderr(command, bench):
    result = command("tray", EXAMPLE, "--json", "--out", "trays")
    document = json.loads(result.stdout)
    assert document["folder"] == "trays/seven-resins"
    assert document["resin_changes"] == "one job, no resin change"
    assert [row["label"] for row in document["labels"]][:4] == ["A1", "A2", "A3", "B1"]
    assert document["jobs"][0]["fill"]["bounding_boxes"] == pytest.approx(0.2214, abs=1e-4)
    assert "3MF" in result.stderr


@pytest.mark.slow
def test_what_is_left_out_is_said(command, bench):
    result = command("tray", "paper-dome")
    assert "not on this tray: connector of paper-dome: for the ABS filament printer" in result.stderr


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nope.toml"], "nope.toml: no such file"),
        (["paper-dom"], "Did you mean paper-dome?"),
        pytest.param(
            ["paper-dome", "--copies", "90"], "64 of 90 parts fit on the tray of 255 x 252 mm", marks=pytest.mark.slow
        ),
        (["paper-dome", "--over", "membrane.material"], "write table.key=VALUES"),
        (["paper-dome", "--over", "membrane.materia=X"], "Did you mean material?"),
        (["paper-dome", "--over", "a.b=1", "--over", "c.d=1"], "it must vary one key"),
        (["paper-dome", "--copies", "0"], "--copies 0: must be from 1 to 200"),
        (["paper-dome", "--over", "membrane.wall_thickness_mm=nan"], "wall_thickness_mm: nan: must be a finite number"),
        (["paper-dome", "--over", "membrane.wall_thickness_mm=[1,2]"], "wall_thickness_mm = [1, 2]: must be a number"),
        (["paper-dome", "--marks", "etched"], 'must be "engraved", "raised" or "none"'),
        ([EXAMPLE, "--copies", "2"], "a tray file and --copies"),
        ([EXAMPLE, "--set", "membrane.inner_radius_mm=900"], "membrane.inner_radius_mm"),
    ],
)
def test_bad_input_is_said_and_nothing_is_written(words, message, command, bench):
    result = command("tray", *words)
    assert result.returncode == 2, result.stdout + result.stderr
    assert message in result.stderr
    assert "Traceback" not in result.stderr
    assert not (bench / "outputs").exists()


@pytest.mark.slow
def test_cadquery_is_not_loaded(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert not modules_after("tray", "paper-dome") & {"cadquery", "OCP", "typst"}
