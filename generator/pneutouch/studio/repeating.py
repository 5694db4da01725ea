"""The commands that repeat the page's work on measured runs."""

import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch.spec.options import CalibrationOptions, option_words
from pneutouch.studio.question import Question

_MARKS = {"\t": "tab", " ": "space"}

Parameters = list[tuple[str, str]]
"""Names of a command's parameters with their texts; a text is empty if the name alone states it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandWords:
    """The command that repeats a job, and the steps before it."""

    command: str
    before: str


def characterize_words(data: Path, question: Question | None, arguments: Mapping[str, Any]) -> CommandWords:
    """The command, and the steps before it."""
    parameters: Parameters = []
    if question is not None:
        parameters.append(("design", arguments["bases"][question.base]))
        parameters += [("set", f"{key}={text}") for key, text in question.values.items() if text is not None]
    return _words("characterize", data, [*parameters, *_reading_words(arguments)], _kept(question))


def _kept(question: Question | None) -> str:
    """Keys that the page leaves out of the design file: no option of a command does."""
    left = [] if question is None else [key for key, text in question.values.items() if text is None]
    return f"it keeps {', '.join(left)} of the design file, which the page leaves out" if left else ""


def calibrate_words(
    data: Path, question: Question | None, arguments: Mapping[str, Any], options: CalibrationOptions
) -> CommandWords:
    """The command, and the steps before it: it takes no changes of a design."""
    changed = question is not None and any(key != "calibration" for key in question.values)
    parameters: Parameters = []
    if question is not None:
        parameters.append(("design", "DESIGN" if changed else arguments["bases"][question.base]))
    parameters += option_words(options if options.save else options.model_copy(update={"replace": False}))
    return _words(
        "calibrate", data, [*parameters, *_reading_words(arguments)], _saving(question, arguments) if changed else ""
    )


def _saving(question: Question | None, arguments: Mapping[str, Any]) -> str:
    """Instruction to save a changed design first."""
    assert question is not None
    changes = [("from", arguments["bases"][question.base])]
    changes += [("set", f"{key}={text}") for key, text in question.values.items() if text is not None]
    return f"before it, with a name for DESIGN: {_command('new', 'DESIGN', changes)}"


def _reading_words(arguments: Mapping[str, Any]) -> Parameters:
    stated = {"columns": (arguments.get("columns") or "").strip(), **(arguments.get("format") or {})}
    return [(name, _MARKS.get(value, str(value))) for name, value in stated.items() if value not in (None, "")]


def _words(command: str, data: Path, parameters: Parameters, before: str) -> CommandWords:
    return CommandWords(command=_command(command, str(data), parameters), before=before)


def _command(command: str, given: str, parameters: Parameters) -> str:
    words = ["pneutouch", command, given]
    for name, text in parameters:
        words += [f"--{name.replace('_', '-')}", *([text] if text else [])]
    return shlex.join(words)
