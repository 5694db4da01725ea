"""The commands by groups, and how a command is found, run and ended."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from importlib import import_module
from typing import Any, NamedTuple

import typer
from typer.core import TyperGroup
from typer.main import get_command_from_info

from pneutouch.cli.stop import stopped
from pneutouch.cli.terminal import notify
from pneutouch.errors import ComputationError, InputError, PneutouchError, nearest, one_line
from pneutouch.spec.values import plain_number
from pneutouch.stopping import refuse_stopped
from pneutouch.wording import data_of


def with_plain_numbers(command: Any) -> Any:
    """Make the number options of a command refuse texts that `plain_number` does not read; returns it."""
    for parameter in command.params:
        if isinstance(parameter.process_value, partial):
            # A command may be requested more than once.
            continue
        parameter.process_value = partial(_processed, parameter.name, parameter.process_value)
    return command


def _processed(name: str, process: Any, context: Any, given: Any) -> Any:
    """The value of a parameter. Raises InputError if it is a number and its text is not a plain one."""
    made = process(context, given)
    texts = given if isinstance(given, list | tuple) else [given]
    for text, value in zip(texts, made if isinstance(made, list | tuple) else [made], strict=False):
        if isinstance(text, str) and isinstance(value, int | float) and not isinstance(value, bool):
            try:
                plain_number(text)
            except ValueError:
                raise InputError("must be a number, such as 12.5", key=name, value=text) from None
    return made


class CommandEntry(NamedTuple):
    """The module of ``cli`` that registers a command, and the command's line in the list."""

    module: str
    summary: str


COMMANDS = {
    group: {name: CommandEntry(**entry) for name, entry in entries.items()}
    for group, entries in data_of(__file__).items()
}
"""The commands in the order of the help; a command's module loads when it is used."""

CHANGES = "pneutouch.changes"
"""Key in the context of a command under which it keeps the fields that --set changes."""

_USAGE_ERROR: Any = typer.BadParameter.__bases__[0]
"""Base class of Typer's errors on words: from Typer itself or from Click, depending on Typer's version."""


def _entries() -> dict[str, CommandEntry]:
    """The commands by name, in the order of the help."""
    return {name: entry for group in COMMANDS.values() for name, entry in group.items()}


class Commands(TyperGroup):
    """The group of all commands. An error of the library ends a command with a message and an exit code."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Names in the order of the help."""
        return list(_entries())

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """The command of a name, whose module is imported; None if there is none."""
        if cmd_name in _entries() and cmd_name not in self.commands:
            import_module(f"pneutouch.cli.{_entries()[cmd_name].module}")
            infos = import_module("pneutouch.cli.app").app.registered_commands
            (info,) = (one for one in infos if (one.name or one.callback.__name__) == cmd_name)
            self.add_command(get_command_from_info(info, pretty_exceptions_short=True, rich_markup_mode=None))
        command = super().get_command(ctx, cmd_name)
        return None if command is None else with_plain_numbers(command)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """The command of the first word. An unknown word is an error that names the nearest command."""
        if args[0] not in _entries() and not args[0].startswith("-") and not ctx.resilient_parsing:
            raise InputError(f"{args[0]}: no such command.{nearest(args[0], _entries())}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """One line a command, by groups, without loading any."""
        widest = max(map(len, _entries()))
        for group, entries in COMMANDS.items():
            with formatter.section(group):
                formatter.write_dl([(name.ljust(widest), entry.summary) for name, entry in entries.items()])

    def make_context(self, *given: Any, **more: Any) -> Any:
        """The context of the words given; Typer's message on a wrong word is put on one line."""
        with _reporting():
            return super().make_context(*given, **more)

    def invoke(self, ctx: Any) -> Any:
        """Run the command; an error of the library becomes a message, in the command's options, and an exit code."""
        try:
            with _reporting():
                return super().invoke(ctx)
        except KeyboardInterrupt as error:
            # Typer makes an exit code of it, and drops what the library adds to it.
            if stop := stopped():
                named = partial(option, self.get_command(ctx, ctx.invoked_subcommand or ""))
                stop.notes = [PneutouchError(note).message(named) for note in getattr(error, "__notes__", [])]
            raise
        except PneutouchError as error:
            refuse_stopped()
            command = self.get_command(ctx, ctx.invoked_subcommand or "")
            _leave_out_file(error, ctx.meta.get(CHANGES, ()))
            notify(f"error: {error.message(partial(option, command))}")
            raise typer.Exit(error.exit_code) from None


@contextmanager
def _reporting() -> Iterator[None]:
    """Turn errors of files and memory into the library's, and any other fault into a message and exit code 3.

    Messages of Typer's errors on words are put on one line, with control characters escaped, and long ones are cut.
    """
    try:
        yield
    except _USAGE_ERROR as error:
        error.message = one_line(str(error.message))
        raise
    except (typer.Exit, typer.Abort, PneutouchError):
        raise
    except OSError as error:
        refuse_stopped()
        # A name that no file can have, a folder that may not be read, a full disk: the system's own words.
        raise InputError(error.strerror or str(error), file=error.filename) from None
    except MemoryError:
        raise ComputationError("not enough memory", remedy="ask for less at once, or close other programs") from None
    except Exception as error:
        refuse_stopped()
        if os.environ.get("PNEUTOUCH_DEBUG"):
            raise
        notify(
            f"error: internal fault ({type(error).__name__}: {error}); please report it with the design file. "
            "PNEUTOUCH_DEBUG=1 shows where"
        )
        raise typer.Exit(3) from None


def _leave_out_file(error: PneutouchError, changed: Sequence[str]) -> None:
    """Take the file out of errors on fields that --set gave: their values are not in the file.

    An error on several fields of a table, or of the whole file, becomes one on the field that was changed.
    """
    for one in (error, *error.others):
        key = (one.key or "").split("[")[0]
        if one.file is not None and "." not in key:
            named = [name for name in changed if name in one.fields]
            if named:
                key = one.key = named[0]
        if any(key == name or key.startswith(f"{name}.") for name in changed):
            one.file = None


def option(command: Any, parameter: str) -> str | None:
    """Name that ``command`` gives a parameter of the library, such as --noise for noise_kPa; None if it has none."""
    known = {str(one.name).strip("_"): one for one in (command.params if command else ())}
    if "." in parameter:
        return f"--set {parameter}" if "set" in known else None
    names = sorted((name for name in known if f"_{name}_" in f"_{parameter}_"), key=len)
    # An option may be named by what it takes: --write NAME.
    named = [one for one in known.values() if one.metavar == parameter.upper()]
    if not names and not named:
        # A list of the library may be an option of one: --process for processes.
        named = [one for name, one in known.items() if parameter in (f"{name}s", f"{name}es")]
    if not names and not named:
        return None
    one = known[names[-1]] if names else named[0]
    return str(one.metavar or one.name).upper() if one.param_type_name == "argument" else max(one.opts, key=len)
