"""The commands of docs/howto/select.md run, and its example file is the target of the command line's page."""

from __future__ import annotations

import re
import shlex
import shutil
import tomllib

import pytest

from tests.conftest import ROOT
from tests.selection.targets import FINGERTIP

TEXT = (ROOT / "docs" / "howto" / "select.md").read_text(encoding="utf-8")
COMMANDS = [line for block in re.findall(r"```sh\n(.*?)```", TEXT, re.DOTALL) for line in block.splitlines()]


@pytest.mark.slow
@pytest.mark.parametrize("line", COMMANDS)
def test_command_runs(line, command, tmp_path):
    if "--from" not in line:
        shutil.copy(ROOT / "docs/examples/fingertip.toml", tmp_path)
    done = command(*shlex.split(line)[1:])
    assert done.returncode == 0, done.stderr


def test_the_example_asks_for_the_fingertip():
    example = tomllib.loads((ROOT / "docs" / "examples" / "fingertip.toml").read_text())
    assert {key: example["target"][key] for key in FINGERTIP} == FINGERTIP
