"""Errors carry what is wrong in fields; the command line alone speaks of its options."""

from __future__ import annotations

import ast
import datetime
import pickle
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

import pneutouch
from pneutouch.errors import (
    BeyondLimitError,
    ComputationError,
    InputError,
    PneutouchError,
    RuleBrokenError,
    joined,
    one_line,
    shown,
)
from pneutouch.mechanics.solid.newton import NoConvergenceError
from pneutouch.spec.design import DesignFile
from pneutouch.spec.read import validate
from tests.trees import nodes_of

PACKAGE = Path(pneutouch.__file__).parent
OPTION = re.compile(r"(?<![\w-])--[a-z]")
COMMAND_LINE = re.compile(r"\bpneutouch [a-z-]+ [^`\n]*")


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({}, "wrong"),
        ({"remedy": "mend it"}, "wrong; mend it"),
        ({"file": "a.toml"}, "a.toml: wrong"),
        ({"file": Path("a.toml"), "key": "membrane.material"}, "a.toml: membrane.material: wrong"),
        ({"file": "a.toml", "key": "x", "value": 1.5, "remedy": "mend it"}, "a.toml: x = 1.5: wrong; mend it"),
        ({"key": "noise_kPa", "value": "loud"}, 'noise_kPa = "loud": wrong'),
        ({"key": "x", "value": "a" * 300}, f'x = "{"a" * 199}...: wrong'),
        (
            {"file": "a\x1b[2J.toml", "key": "x", "value": "\x1b]0;y\x07"},
            'a\\u001B[2J.toml: x = "\\u001b]0;y\\u0007": wrong',
        ),
    ],
)
def test_a_message_is_composed_of_the_fields(fields, message):
    error = InputError("wrong", **fields)
    assert str(error) == message
    assert error.problem == "wrong"
    for name in ("file", "key", "value", "remedy"):
        given = fields.get(name)
        assert getattr(error, name) == (str(given) if name == "file" and given else given)


@pytest.mark.parametrize(
    "value",
    [
        "",
        'a "b" \\ c',
        "two\nlines\t\x7f\x85",
        True,
        3,
        2.5,
        1e-9,
        ["a", "b"],
        [[1, 2], []],
        {"a": 1, "b": {"c": "d"}},
        {},
        datetime.date(2026, 11, 21),
        float("inf"),
    ],
)
def test_a_value_is_shown_as_toml_that_reads_back(value):
    assert tomllib.loads(f"value = {shown(value)}")["value"] == value
    assert shown(value).isprintable()


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (np.float64(1.5), "1.5"),
        (np.array([1, 2]), "[1, 2]"),
        (Path("a/b"), '"a/b"'),
        (("a", None), '["a", nothing]'),
        (..., "a Python object of type ellipsis"),
        ([10**5000], "[a number of more than 200 digits]"),
        ({"b", "a"}, '["a", "b"]'),
    ],
)
def test_no_value_is_shown_as_python_shows_it(value, text):
    assert shown(value) == text


def test_the_command_line_turns_parameters_into_its_options():
    options = {"noise_kPa": "--noise", "out": "--out"}
    error = InputError("too loud", key="noise_kPa", value=2.50, remedy="give less, or another `out` than `here`")
    assert error.message(options.get) == "--noise 2.5: too loud; give less, or another --out than `here`"
    assert str(error) == "noise_kPa = 2.5: too loud; give less, or another `out` than `here`"
    in_a_file = InputError("too loud", file="scan.toml", key="out", value=3)
    assert in_a_file.message(options.get) == str(in_a_file) == "scan.toml: out = 3: too loud"


def test_several_errors_are_one_that_shows_all():
    with pytest.raises(InputError) as caught:
        validate(DesignFile, {"membrane": {"inner_radius_mm": 0.5, "materials": "Agilus30"}}, "a.toml")
    first, *others = str(caught.value).splitlines()
    assert first == "a.toml: membrane.inner_radius_mm = 0.5: must be from 1 to 100 mm"
    assert others == ["a.toml: membrane.materials: unknown key. Did you mean material?"]
    assert (caught.value.file, caught.value.key, caught.value.value) == ("a.toml", "membrane.inner_radius_mm", 0.5)
    assert [error.key for error in caught.value.others] == ["membrane.materials"]


@pytest.mark.parametrize(
    "error",
    [
        InputError("wrong", file="a.toml", key="x", value=3, remedy="mend it"),
        RuleBrokenError("thin"),
        BeyondLimitError(0.05, 0.04, "it lies beyond the limit point"),
        NoConvergenceError("first contact", "the last step failed", "a finer mesh"),
        joined([InputError("one", key="a"), InputError("two", key="b")]),
    ],
    ids=lambda error: type(error).__name__,
)
def test_errors_survive_the_way_between_processes(error):
    found = pickle.loads(pickle.dumps(error))
    assert type(found) is type(error) and str(found) == str(error)
    assert {k: v for k, v in vars(found).items() if k != "others"} == {
        k: v for k, v in vars(error).items() if k != "others"
    }


def test_there_are_three_kinds_with_an_exit_code_each():
    assert [kind.exit_code for kind in (RuleBrokenError, InputError, ComputationError)] == [1, 2, 3]
    kinds = [*PneutouchError.__subclasses__()]
    assert {kind.__name__ for kind in kinds} == {"RuleBrokenError", "InputError", "ComputationError"}


def texts(path):
    """Texts of a file, docstrings included, each with its line."""
    for node in nodes_of(path):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


def test_the_library_never_speaks_of_options():
    found = [
        f"{path}:{line}: {text[:100]}"
        for path in PACKAGE.rglob("*.py")
        if "cli" not in path.relative_to(PACKAGE).parts
        for line, text in texts(path)
        if OPTION.search(COMMAND_LINE.sub("", text))
    ]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("predict", "paper-dome", "--model", "exact"), "error: --model exact: unknown model."),
        (("predict", "paper-dome", "--tolerance", "never"), "error: --tolerance never: it must be a positive share"),
        (("predict", "paper-dome", "--set", "wall=2"), "error: --set wall=2: write table.key=value"),
        (
            ("predict", "paper-dome", "--set", "membrane.wall_thickness_mm=9.5"),
            "error: --set membrane.wall_thickness_mm: wall_thickness_mm = 9.5 must be less than",
        ),
        (("select", "--sensitivity", "2", "--at", "1200"), "error: --at 1200: must be from 0 to 1000 kPa"),
        (
            ("select", "--sensitivity", "2", "--tolerance", "500"),
            "error: --tolerance 500: it must be a positive share of",
        ),
        (("select", "--sensitivity", "2", "--same-within", "much"), "error: --same-within much: it must be a positive"),
        (("build", "paper-dome", "--out", "a-file"), "error: --out"),
        (("new", "a b"), "error: NAME"),
    ],
)
def test_a_user_of_the_command_line_reads_its_own_words(command, tmp_path, words, message):
    (tmp_path / "a-file").write_text("")
    result = command(*words)
    assert result.returncode == 2
    assert result.stderr.startswith(message), result.stderr


def test_words_and_lines_without_end_are_cut_and_control_characters_escaped():
    message = InputError(
        f"{'x' * 5000}: no such thing, {'a b ' * 5000}", key="k", value="\x1b[31m\n" + "y" * 5000
    ).message()
    assert len(message) < 4100 and "x" * 401 not in message and "y" * 201 not in message
    assert "\\u001b[31m\\n" in message and "\x1b" not in message and "\n" not in message
    assert one_line("a\x1b\n\u202e" + "z" * 500) == "a\\u001B\\u000A\\u202E" + "z" * 181 + "..."


@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("radius", "inner_radius_mm"),
        ("diameter", "inner_radius_mm"),
        ("wall", "wall_thickness_mm"),
        ("thickness", "wall_thickness_mm"),
        ("resin", "material"),
        ("pressure", "driving_pressures_kPa"),
    ],
)
def test_everyday_names_lead_to_the_fields_that_they_mean(name, key):
    with pytest.raises(InputError) as caught:
        pneutouch.Design(**{name: 6})
    assert key in caught.value.problem
