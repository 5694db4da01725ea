"""A command is one file for its work, one for its text, and one line of the table."""

import json
import sys
from types import ModuleType
from typing import Annotated

import pytest
import typer
from reference_pages import commands as pages

from pneutouch.cli import commands
from pneutouch.cli.app import DesignArgument, JsonOption, app, print_json
from pneutouch.cli.terminal import echo
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate


def wall_of(design: str, times: float) -> float:
    """The work: the wall of a design times a number."""
    if times <= 0.0:
        raise InputError("must be more than 0", key="times", value=times)
    return times * evaluate(design, model="membrane").sensor.dome.wall_thickness


@pytest.fixture
def _added(monkeypatch):
    """The text of the command in a module of its own, and its line."""

    @app.command("wall-times")
    def wall_times(
        design: DesignArgument,
        times: Annotated[float, typer.Option(help="Factor on the wall.")] = 2.0,
        json: JsonOption = False,
    ) -> None:
        """Multiply the wall of a design."""
        wall_mm = wall_of(design, times)
        print_json({"wall_mm": wall_mm}) if json else echo(f"{wall_mm:g} mm")

    module = ModuleType("pneutouch.cli.wall_times")
    module.app = app
    monkeypatch.setitem(sys.modules, module.__name__, module)
    line = {"wall-times": commands.CommandEntry("wall_times", "Multiply the wall of a design.")}
    monkeypatch.setitem(commands.COMMANDS, "Design", {**commands.COMMANDS["Design"], **line})
    yield
    app.registered_commands[:] = [one for one in app.registered_commands if one.name != "wall-times"]


@pytest.mark.usefixtures("_added")
def test_a_command_is_added_by_a_module_and_a_line(command, root):
    """It stands in the help and on the page, answers in text and JSON, and names its option in an error."""
    assert "wall-times" in command("--help", cwd=root).stdout
    assert command("wall-times", "paper-dome", cwd=root).stdout == "3 mm\n"
    document = json.loads(command("wall-times", "paper-dome", "--times", "3", "--json", cwd=root).stdout)
    assert document == {"wall_mm": pytest.approx(4.5, rel=1e-12)}
    wrong = command("wall-times", "paper-dome", "--times", "0", cwd=root)
    assert (wrong.returncode, wrong.stdout) == (2, "") and wrong.stderr.startswith("error: --times 0: ")
    assert "pneutouch wall-times" in pages.page() and "| `--times` |" in pages.section("wall-times")
