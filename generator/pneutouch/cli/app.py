"""The command line: common options, ``predict`` and ``list``, and how words are run. Heavy packages load later."""

import io
import os
import re
import shlex
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from typing import Annotated, Any

import typer

from pneutouch import __version__
from pneutouch.cli.commands import CHANGES, Commands
from pneutouch.cli.complete import assignment, error_in_percent, parameters_of
from pneutouch.cli.terminal import bar, echo, notify, open_closed_streams, put
from pneutouch.errors import InputError

parameter = parameters_of(__file__)

app = typer.Typer(
    cls=Commands,
    context_settings={"help_option_names": ["-h", "--help"]},
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Pneumatic touch sensors: from a design file to print files, a prediction and a datasheet.",
)

DesignArgument = Annotated[str, parameter("design")]


def _keep_keys(context: typer.Context, assignments: list[str] | None) -> list[str] | None:
    """Note the fields that ``--set`` gives, so that an error on one of them does not name the design's file."""
    context.meta.setdefault(CHANGES, []).extend(text.partition("=")[0].strip() for text in assignments or [])
    return assignments


def _keep_calibration(context: typer.Context, name: str | None) -> str | None:
    if name is not None:
        context.meta.setdefault(CHANGES, []).append("calibration")
    return name


SetOption = Annotated[list[str] | None, parameter("set", callback=_keep_keys, autocompletion=assignment)]
CalibrationOption = Annotated[str | None, parameter("calibration", callback=_keep_calibration)]
AnywhereOption = Annotated[bool, parameter("anywhere")]
ModelOption = Annotated[str | None, parameter("model")]
AnswerModelOption = Annotated[str | None, parameter("model", show_default="auto")]
ToleranceOption = Annotated[str | None, parameter("tolerance", callback=error_in_percent)]
ClosureOption = Annotated[str, parameter("closure")]
ClampOption = Annotated[str, parameter("clamp")]
JsonOption = Annotated[bool, parameter("json")]
OutOption = Annotated[Path, parameter("out")]
DesignFolderOption = Annotated[Path | None, parameter("design_folder")]
ForOption = Annotated[list[str] | None, parameter("for")]
TasksOption = Annotated[Path | None, parameter("tasks")]
LeakOption = Annotated[Path | None, parameter("leak")]
ForceOption = Annotated[bool, parameter("force")]


def _version(requested: bool) -> None:
    if requested:
        echo(f"pneutouch {__version__}")
        raise typer.Exit


@app.callback()
def main(version: Annotated[bool, parameter("version", callback=_version)] = False) -> None:
    """Pneumatic touch sensors: from a design file to print files, a prediction and a datasheet."""


@app.command()
def predict(
    design: DesignArgument,
    set_: SetOption = None,
    calibration: CalibrationOption = None,
    model: ModelOption = None,
    tolerance: ToleranceOption = None,
    closure: ClosureOption = "variational",
    clamp: ClampOption = "base",
    monte_carlo: Annotated[int, parameter("monte_carlo")] = 0,
    aged: Annotated[bool, parameter("aged")] = False,
    anywhere: AnywhereOption = False,
    for_: ForOption = None,
    tasks: TasksOption = None,
    leak: LeakOption = None,
    json: JsonOption = False,
) -> None:
    """Predict the figures and their uncertainty, or the driving pressure that gives one (--for)."""
    if for_ or tasks is not None:
        from pneutouch.cli.driving import report_driving
        from pneutouch.mechanics.models.choice import model_options

        if monte_carlo:
            raise InputError("cannot be given with `for_` or `tasks`", key="monte_carlo", value=monte_carlo)
        options = {"closure": closure, "clamp": clamp, "aged": aged, **model_options(model or "auto", tolerance)}
        fields, words = changes(set_, calibration, anywhere=anywhere), (set_, calibration)
        report_driving(design, fields, for_ or [], tasks, leak, words, json=json, **options)
        return
    if leak is not None:
        raise InputError("needs `for_` or `tasks`", key="leak", value=str(leak))
    from pneutouch.evaluation.evaluate import evaluate
    from pneutouch.evaluation.result import predicted_in_full
    from pneutouch.mechanics.models.choice import model_options

    evaluation = evaluate(
        design,
        changes(set_, calibration, anywhere=anywhere),
        closure=closure,
        clamp=clamp,
        aged=aged,
        **model_options(model, tolerance),
    )
    with bar("predicting"):
        prediction = predicted_in_full(evaluation, monte_carlo)
    if json:
        print_json(prediction)
    else:
        from pneutouch.cli.prediction_text import prediction_text

        echo(prediction_text(prediction))


def design_folder(out: Path | None) -> Path:
    """The folder given for a design file, else ``designs`` in the user's folder."""
    from pneutouch.catalogue import user_folder

    return user_folder() / "designs" if out is None else out


def changes(set_: list[str] | None, calibration: str | None = None, *, anywhere: bool = False) -> dict[str, Any]:
    """Values by ``table.key``, from the options --set, --calibration and --contact-anywhere."""
    from pneutouch.spec.read import parse_changes

    named = {} if calibration is None else {"calibration": calibration}
    return parse_changes(set_ or []) | named | ({"contact.anywhere": True} if anywhere else {})


def refuse_flags(context: typer.Context, flags: Mapping[str, str], what: str, file: str) -> None:
    """Raise InputError if one of ``flags`` (flag by parameter), which cannot be given with ``what``, was given."""

    given = [
        flag for key, flag in flags.items() if getattr(context.get_parameter_source(key), "name", "") == "COMMANDLINE"
    ]
    if given:
        raise InputError(f"{', '.join(given)} cannot be given with {what}", file=file)


def print_json(document: Any, **more: Any) -> None:
    """Print a document, or a record as one, with ``more`` keys at its end, as JSON on stdout."""
    from pneutouch.output.files import json_bytes
    from pneutouch.results.record import plain

    put(json_bytes({**plain(document), **more}).decode())


def print_answer(record: Any, text: Callable[[Any], str], folder: Path | None = None, *, json: bool) -> None:
    """Print a record, with the folder that it was written to if there is one: as JSON, or as ``text`` returns it."""
    if json:
        print_json(record, **({} if folder is None else {"folder": str(folder)}))
    else:
        echo(text(record) if folder is None else f"{text(record)}\n\n{folder}")


_BREAKS = "=@:"
"""Characters in words of this program at which bash, with its default COMP_WORDBREAKS, ends a word."""


def joined(pieces: Sequence[str], at: int) -> tuple[list[str], int, str]:
    """The words as typed, the number of the one to complete, and its part before the piece that bash completes.

    ``pieces`` are COMP_WORDS, in which a run of `_BREAKS` is a piece of its own; ``at`` is COMP_CWORD. Bash completes
    an @ with what follows it: it may begin the name of a host.
    """
    words: list[str] = []
    place, before, open_ = None, "", False
    for number, piece in enumerate(pieces):
        breaks = bool(piece) and not piece.strip(_BREAKS)
        begun = words.pop() if words and (breaks or open_) else ""
        if number == at:
            place, before = len(words), begun + piece if breaks else begun
        words.append(begun + piece)
        open_ = breaks
    return words, len(words) if place is None else place, before.removesuffix("@")


@contextmanager
def words_of_bash(write: Callable[[str], object]) -> Iterator[None]:
    """Complete whole words where bash requests completions, and ``write`` the words that bash may insert."""
    requested = os.environ.get("_PNEUTOUCH_COMPLETE") == "complete_bash"
    try:
        pieces, at = shlex.split(os.environ["COMP_WORDS"]), int(os.environ["COMP_CWORD"])
    except (KeyError, ValueError):
        # A quote is open, or bash requests nothing.
        requested = False
    if not requested:
        yield
        return
    words, place, before = joined(pieces, at)
    os.environ |= {"COMP_WORDS": shlex.join(words), "COMP_CWORD": str(place)}
    offered = io.StringIO()
    try:
        with redirect_stdout(offered):
            yield
    finally:
        write("".join(f"{line.removeprefix(before)}\n" for line in offered.getvalue().splitlines()))


def invoked(words: list[str]) -> int:
    """Run the command of ``words`` and return its exit code; words that are no command end in one line and code 2."""
    open_closed_streams()
    try:
        with words_of_bash(sys.stdout.write):
            outcome = app(args=words or ["--help"], prog_name="pneutouch", standalone_mode=False)
    except Exception as error:
        # Typer has its own errors and click's, by its version; each formats its message.
        if not hasattr(error, "format_message"):
            raise
        notify(f"error: {_about(error)}")
        return getattr(error, "exit_code", 2)
    return outcome if isinstance(outcome, int) else 0


def _about(error: Any) -> str:
    """Message of an error in the words of a command line, with the command that lists the options."""
    message = re.sub(r"'(-[^' ]*)'", r"\1", error.format_message()).replace("'", '"').rstrip(".")
    message = re.sub(r"Input should be (a )?(valid )?", r"must be \1", message).split(", unable to parse")[0]
    message = message.replace("a integer", "a whole number")
    context = getattr(error, "ctx", None)
    command = context.command_path if context else "pneutouch"
    return f"{message[:1].lower()}{message[1:]}; {command} -h lists what it takes"
