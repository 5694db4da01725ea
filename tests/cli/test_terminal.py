"""The command line fits the hand: help, completion, lists, colour, width, and streams that are closed."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys

import pytest

from pneutouch.cli.commands import COMMANDS
from pneutouch.cli.terminal import _wrapped
from pneutouch.parts.coupons import COUPONS
from pneutouch.spec.coupon import COUPON_NAMES
from pneutouch.spec.read import parse_changes

NAMES = [name for group in COMMANDS.values() for name in group]


def test_the_list_of_commands_is_in_groups_and_whole(command):
    lines = command("-h").stdout.splitlines()
    assert max(map(len, lines)) <= 80
    for group, entries in COMMANDS.items():
        start = lines.index(f"{group}:")
        assert [line.split()[0] for line in lines[start + 1 : start + 1 + len(entries)]] == list(entries)
    assert not [line for line in lines[1:] if line.endswith("...")]
    assert command("-h").stdout == command("--help").stdout


@pytest.mark.parametrize("name", NAMES)
def test_every_command_has_short_help(command, name):
    result = command(name, "-h")
    assert result.returncode == 0
    assert result.stdout.startswith(f"Usage: pneutouch {name} ")


def completed(line):
    """What bash is offered for the last word of a line, and the modules loaded for it."""
    code = "import sys\nfrom pneutouch.cli import run\ntry: run()\nfinally: print(*sys.modules, file=sys.stderr)"
    words = {"COMP_WORDS": line, "COMP_CWORD": str(len(line.split()) - 1), "_PNEUTOUCH_COMPLETE": "complete_bash"}
    result = subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, **words}, capture_output=True, text=True, check=False
    )
    return result.stdout.split(), result.stderr.split()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("pneutouch predict paper-d", ["paper-dome"]),
        ("pneutouch charac", ["characterize"]),
        ("pneutouch coupons --profile objet260-c", ["objet260-connex", "objet260-connex1", "objet260-connex3"]),
        ("pneutouch check x --set membrane.mat", ["membrane.material="]),
        ("pneutouch select --profile objet260-c", ["objet260-connex", "objet260-connex1", "objet260-connex3"]),
        ("pneutouch select --material TangoPlus,FLX9940,Agilus30", ["TangoPlus,FLX9940,Agilus30"]),
        ("pneutouch select --base paper-d", ["paper-dome"]),
        ("pneutouch coupons --material FLX9960,TangoP", ["FLX9960,TangoPlus"]),
        ("pneutouch simulate x --resins TangoP", ["TangoPlus"]),
        ("pneutouch compare soft-pad paper-d", ["paper-dome"]),
        ("pneutouch scan texture-s", ["texture-specimen"]),
        ("pneutouch sweep --over membrane.mat", ["membrane.material="]),
        ("pneutouch tray paper-d", ["paper-dome"]),
        ("pneutouch tray x --over membrane.mat", ["membrane.material="]),
        ("pneutouch coupons --only puck,le", ["puck,leak-cap"]),
        # Bash takes a word apart at these characters and completes what follows.
        ("pneutouch tray x --over membrane.material = TangoPlus,FLX9940,Agilus30", ["TangoPlus,FLX9940,Agilus30"]),
        ("pneutouch predict x --set connector.port = barb-4x", ["barb-4x2.5"]),
    ],
)
def test_names_and_keys_are_completed_without_numpy(line, offered):
    words, modules = completed(line)
    assert words == offered
    assert "numpy" not in modules


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("pneutouch compare soft-pad paper-dome @", ["@mine", "@other"]),
        ("pneutouch compare soft-pad paper-dome @ mi", ["@mine"]),
        ("pneutouch predict paper-dome @ mi", ["@mine"]),
        ("pneutouch predict paper-dome@mi", ["paper-dome@mine"]),
        ("pneutouch predict paper-dome --calibration mi", ["mine"]),
        ("pneutouch compare soft-pad@mine paper-d", ["paper-dome"]),
        ("pneutouch compare soft-pad @ mine paper-d", ["paper-dome"]),
    ],
)
def test_a_design_is_completed_with_its_calibration(line, offered, tmp_path, monkeypatch):
    (tmp_path / "calibrations").mkdir()
    for name in ("mine", "other"):
        (tmp_path / "calibrations" / f"{name}.toml").touch()
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    assert completed(line)[0] == offered


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash")
def test_bash_gets_what_follows_the_sign(tmp_path):
    """The shell itself splits the line and inserts the answer."""
    python = f"{shlex.quote(sys.executable)} -m pneutouch"
    (tmp_path / "pneutouch").write_text(f'#!/bin/sh\nexec {python} "$@"\n')
    (tmp_path / "pneutouch").chmod(0o755)
    script = f"""
        eval "$(_PNEUTOUCH_COMPLETE=source_bash {python})"
        COMP_WORDS=(pneutouch predict x --set membrane.material = TangoPlus,FLX99) COMP_CWORD=6
        _pneutouch_completion ./pneutouch
        printf '%s\n' "${{COMPREPLY[@]}}"
    """
    result = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert result.stderr == ""
    assert "TangoPlus,FLX9940" in result.stdout.splitlines()
    assert all(line.startswith("TangoPlus,FLX99") for line in result.stdout.splitlines())


def test_coupons_are_completed_by_their_names():
    assert list(COUPONS) == list(COUPON_NAMES)


def test_numbers_with_commas_are_a_list():
    given = ["pneumatics.driving_pressures_kPa=0,10", "document.title=a,b", "membrane.inner_radius_mm=6"]
    assert list(parse_changes(given).values()) == [[0, 10], "a,b", 6]


def test_errors_on_set_name_the_option(command):
    result = command("predict", "paper-dome", "--set", "membrane.material=Tanga")
    assert result.stderr == (
        "error: --set membrane.material=Tanga: no such name among the materials. Did you mean TangoPlus?\n"
    )


def test_lines_are_wrapped_with_the_indent_and_commands_stay_whole():
    text = "  warning: " + "word " * 30
    lines = _wrapped(text.rstrip(), 60).splitlines()
    assert max(map(len, lines)) <= 60 and all(line.startswith("    ") for line in lines[1:])
    command = "next: pneutouch " + "word " * 30
    assert _wrapped(command, 60) == command


@pytest.mark.parametrize(
    ("shell", "code"),
    [
        pytest.param("{python} -m pneutouch list 2>&-", 0, marks=pytest.mark.slow),
        pytest.param("{python} -m pneutouch list >&-", 0, marks=pytest.mark.slow),
        ("{python} -m pneutouch list 2>&- >&-", 0),
        ("{python} -m pneutouch list | head -1; exit ${{PIPESTATUS[0]}}", 0),
        ("{python} -m pneutouch list >/dev/full", 3),
    ],
)
def test_closed_streams_change_no_exit_code_and_bring_no_traceback(shell, code, tmp_path):
    line = shell.format(python=sys.executable)
    result = subprocess.run(["bash", "-c", line], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert result.returncode == code, result.stderr
    assert "Traceback" not in result.stderr and "Exception ignored" not in result.stderr


@pytest.mark.slow
@pytest.mark.parametrize(("names", "coloured"), [({}, False), ({"FORCE_COLOR": "1"}, True), ({"NO_COLOR": "1"}, False)])
def test_no_colour_in_a_pipe_unless_it_is_required(names, coloured, tmp_path):
    environment = {key: value for key, value in os.environ.items() if "COLOR" not in key}
    words = [sys.executable, "-m", "pneutouch", "predict", "none"]
    result = subprocess.run(words, env=environment | names, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ("\x1b[1;31merror\x1b[0m: " in result.stderr) == coloured
    assert coloured or result.stderr.startswith("error: ")


def test_a_stage_escapes_control_characters(capsys):
    from pneutouch.cli.terminal import bar

    with bar("reading \x1b[31mred") as report:
        report(0, 1, "evaluating a\x08b")
    said = capsys.readouterr().err
    assert "\x1b" not in said and "\x08" not in said and "red" in said
