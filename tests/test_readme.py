"""The README and what it leads to first: the commands, the design file and the Python of the reference are run."""

from __future__ import annotations

import re
import shlex

import pytest

from pneutouch.spec.design import DesignFile
from pneutouch.spec.read import validate
from tests.conftest import ROOT
from tests.pages import blocks

README = (ROOT / "README.md").read_text(encoding="utf-8")
REFERENCE = ROOT / "docs" / "reference"
FILES = (REFERENCE / "files.md").read_text(encoding="utf-8")
COMMAND_LINE = (REFERENCE / "command-line.md").read_text(encoding="utf-8")
LINES = 45
"""One screen."""

COMMANDS = [
    line for block in blocks(COMMAND_LINE, "sh") for line in block.splitlines() if line.startswith("pneutouch ")
]
SERVING = [line for line in COMMANDS if line.startswith("pneutouch studio ")]
"""They run until they are stopped: tests/studio starts and stops the studio."""


def cost(line):
    """The command as a parameter; those that take long, and other figures of a command, are left to the slow run."""
    verb, *more = shlex.split(line, comments=True)[1:]
    dear = verb in ("plan", "scan", "build", "simulate", "select", "check") or (
        verb == "predict" and more != ["paper-dome"]
    )
    return pytest.param(line, marks=pytest.mark.slow if dear else ())


@pytest.mark.parametrize("line", [cost(line) for line in COMMANDS if line not in SERVING])
def test_command_runs(line, command, built_as_a_user):
    words = shlex.split(line.replace("/tmp/sensors", "sensors"), comments=True)[1:]
    # A build is run once for all tests, by these words and --json.
    result = built_as_a_user[0] if [*words, "--json"] == built_as_a_user[0].args else command(*words)
    assert result.returncode == 0, result.stderr


def test_the_two_commands_are_targets_of_the_makefile():
    makefile = (ROOT / "Makefile").read_text()
    for line in blocks(README, "sh")[0].splitlines():
        target = line.split("#")[0].split()[1]
        assert re.search(rf"^{target}:", makefile, re.MULTILINE)


def test_the_design_file_is_valid():
    import tomllib

    for block in blocks(FILES, "toml"):
        assert validate(DesignFile, tomllib.loads(block), "files.md").membrane.inner_radius_mm == 6


@pytest.mark.slow
def test_the_python_runs_builds_and_predicts_a_figure_within_its_interval(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    block = blocks((REFERENCE / "python.md").read_text(encoding="utf-8"), "python")[1]
    names = {}
    exec(compile(block, "python.md", "exec"), names)
    sensitivity = names["prediction"].at(10).sensitivity
    assert sensitivity.interval[0] < sensitivity.value < sensitivity.interval[1] and sensitivity.unit == "kPa/N"
    assert (tmp_path / "outputs" / "design" / "design.3mf").is_file()


def test_every_file_the_reference_names_is_built(built):
    table = FILES[FILES.index("| in `outputs/paper-dome/`") :].split("\n\n")[0]
    rows = re.findall(r"^\| (`.*?) \|", table, re.MULTILINE)
    files = {part for row in rows for part in re.findall(r"`([^`]+)`", row)}
    folder = built("paper-dome")
    assert {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()} == files


def test_every_link_leads_somewhere():
    for target in re.findall(r"\]\(([^)]+)\)", README):
        assert (ROOT / target).is_file(), target


def test_the_readme_is_one_screen():
    assert len(README.splitlines()) <= LINES
    assert max(map(len, README.splitlines())) <= 200
    assert (ROOT / "docs" / "filmstrip.png").stat().st_size <= 1_000_000
