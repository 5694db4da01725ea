"""The command line. Heavy packages load inside the commands that use them: ``--help`` never pays."""

import gc
import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup
from typer.main import get_command_from_info

from pneutouch import __version__
from pneutouch.cli.next_step import report_next
from pneutouch.errors import ComputationError, InputError, PneutouchError

_MODULES = {"build": "build", "check": "build"} | {
    name: name
    for name in [
        "calibrate",
        "characterize",
        "compare",
        "coupons",
        "simulate",
        "plan",
        "scan",
        "select",
        "show",
        "sweep",
        "tray",
    ]
}
"""Modules by the commands that they register when they are imported."""

_OBJECTS_BEFORE_COLLECTION = 100_000
"""A command ends within seconds and keeps most of what it makes: collecting garbage at Python's 700 is a sixth of
the time that CadQuery and matplotlib take to load."""


class Commands(TyperGroup):
    """The commands. An error of the library ends one with a message in its own words, and the error's exit code."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Names in the order of the help."""
        return [*self.commands, *(name for name in _MODULES if name not in self.commands)]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """A command, whose module is imported; an unknown name imports all, for the suggestion."""
        for name in [cmd_name] if cmd_name in self.list_commands(ctx) else _MODULES:
            if name not in self.commands:
                import_module(f"pneutouch.cli.{_MODULES[name]}")
                (info,) = (one for one in app.registered_commands if one.callback and one.callback.__name__ == name)
                self.add_command(get_command_from_info(info, pretty_exceptions_short=True, rich_markup_mode=None))
        return super().get_command(ctx, cmd_name)

    def invoke(self, ctx: Any) -> Any:
        """Run the requested command."""
        try:
            return super().invoke(ctx)
        except PneutouchError as error:
            command = self.get_command(ctx, ctx.invoked_subcommand or "")
            typer.echo(f"error: {error.message(partial(option, command))}", err=True)
            raise typer.Exit(error.exit_code) from None


def option(command: Any, parameter: str) -> str | None:
    """What ``command`` calls a parameter of the library, such as --noise for noise_kPa; None where it has none."""
    known = {str(one.name).strip("_"): one for one in (command.params if command else ())}
    if "." in parameter:
        return f"--set {parameter}" if "set" in known else None
    names = sorted((name for name in known if f"_{name}_" in f"_{parameter}_"), key=len)
    # An option may be named by what it takes: --write NAME.
    named = [one for one in known.values() if one.metavar == parameter.upper()]
    if not names and not named:
        return None
    one = known[names[-1]] if names else named[0]
    return str(one.metavar or one.name).upper() if one.param_type_name == "argument" else max(one.opts, key=len)


app = typer.Typer(
    cls=Commands,
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Pneumatic touch sensors: from a design file to print files, a prediction and a datasheet.",
)

DesignArgument = Annotated[str, typer.Argument(metavar="DESIGN", help="Name of a design, or path of a TOML file.")]
SetOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="TABLE.KEY=VALUE", help="Override a field of the design; may be repeated."),
]
CalibrationOption = Annotated[
    str | None,
    typer.Option(
        "--calibration",
        metavar="NAME",
        help="Calibration of the sensor in hand, as DESIGN@NAME; none: without the design's.",
    ),
]
ModelOption = Annotated[
    str | None,
    typer.Option(
        "--model",
        help="Model: membrane, atlas, solid or auto (the cheapest that is good enough).",
        show_default="solid",
    ),
]
ToleranceOption = Annotated[
    str | None,
    typer.Option("--tolerance", metavar="SHARE", help="Numerical error that --model auto must meet, such as 2%."),
]
ClosureOption = Annotated[
    str, typer.Option("--closure", help="Contact closure of the membrane: variational or printed.")
]
ClampOption = Annotated[
    str, typer.Option("--clamp", help="Where the solid is held: base (plane) or flange (as printed).")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print one JSON document and nothing else.")]
OutOption = Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder that takes the output folder.")]
DesignFolderOption = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Folder of the design file.", show_default="designs in your folder"),
]


ForceOption = Annotated[bool, typer.Option("--force", help="Replace a design file of this name.")]


@contextmanager
def reporting() -> Iterator[None]:
    """Turn a fault of ours into one message on stderr and exit code 3; errors of the library go on to `Commands`."""
    try:
        yield
    except BrokenPipeError:
        sys.stderr.close()
        raise typer.Exit(0) from None
    except (typer.Exit, PneutouchError):
        raise
    except OSError as error:
        # A name that no file can have, a folder that may not be read, a full disk: the system's own words.
        raise InputError(error.strerror or str(error), file=error.filename) from None
    except MemoryError:
        raise ComputationError("not enough memory", remedy="request less at once, or close other programs") from None
    except Exception as error:
        if isinstance(error.__cause__ or error.__context__, KeyboardInterrupt):
            # A library that is interrupted while it loads reports that it cannot be loaded.
            raise typer.Abort from None
        if os.environ.get("PNEUTOUCH_DEBUG"):
            raise
        typer.echo(
            f"error: internal fault ({type(error).__name__}: {error}); please report it with the design file. "
            "PNEUTOUCH_DEBUG=1 shows where",
            err=True,
        )
        raise typer.Exit(3) from None


def _version(requested: bool) -> None:
    if requested:
        typer.echo(f"pneutouch {__version__}")
        raise typer.Exit


@app.callback()
def main(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
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
    monte_carlo: Annotated[
        int,
        typer.Option(
            metavar="N", min=0, max=1_000_000, help="Check the uncertainty by N samples; about 0.1 s for 1000 a state."
        ),
    ] = 0,
    aged: Annotated[
        bool,
        typer.Option("--aged", help="After a year in light and air: the modulus shifted by the resin's hardness then."),
    ] = False,
    json: JsonOption = False,
) -> None:
    """Predict the figures and their uncertainty."""
    with reporting():
        from pneutouch.evaluation.document import full_document
        from pneutouch.evaluation.evaluate import evaluate
        from pneutouch.mechanics.models import model_options

        evaluation = evaluate(
            design,
            changes(set_, calibration),
            closure=closure,
            clamp=clamp,
            aged=aged,
            **model_options(model, tolerance),
        )
        document = full_document(evaluation, monte_carlo)
        if json:
            print_json(document)
        else:
            from pneutouch.cli.text import prediction_text

            typer.echo(prediction_text(document))


@app.command("list")
def list_(
    kind: Annotated[
        str | None, typer.Argument(help="designs, specimens, examples, materials, mixing, printers or parts.")
    ] = None,
    json: JsonOption = False,
) -> None:
    """List designs, specimens, examples, materials, mixing curves, printers and parts."""
    with reporting():
        from pneutouch.catalogue.listing import listing
        from pneutouch.cli.text import listing_text

        content = listing(kind)
        if json:
            print_json(content)
        else:
            typer.echo(listing_text(content))


@app.command()
def new(
    name: Annotated[str | None, typer.Argument(help="Name of the new file: letters, digits, - and _.")] = None,
    from_: Annotated[
        str | None,
        typer.Option("--from", metavar="EXAMPLE", help="Copy a design, a specimen or an example: see pneutouch list."),
    ] = None,
    out: DesignFolderOption = None,
) -> None:
    """Write a commented design file, or a copy of an example."""
    with reporting():
        from pneutouch.output.new import NewFile, new_design, new_from

        if from_ is not None:
            made = new_from(from_, name, out)
        elif name is not None:
            path = new_design(name, design_folder(out))
            made = NewFile(path, ("check", name if out is None else str(path)))
        else:
            raise InputError("no name for the new design", remedy="give a name, or an example with `from`")
        typer.echo(str(made.path))
        report_next(*made.command)


def design_folder(out: Path | None) -> Path:
    """The folder given for a design file, else ``designs`` in the user's folder."""
    from pneutouch.catalogue import user_folder

    return user_folder() / "designs" if out is None else out


def changes(set_: list[str] | None, calibration: str | None = None) -> dict[str, Any]:
    """The fields that --set changes, and their values; --calibration is one of them."""
    from pneutouch.spec.read import parse_changes

    return parse_changes(set_ or []) | ({} if calibration is None else {"calibration": calibration})


def refuse_flags(context: typer.Context, flags: Mapping[str, str], what: str, file: str) -> None:
    """Raise InputError where one of ``flags`` (by parameter) was given, which does not go with ``what``."""

    given = [
        flag for key, flag in flags.items() if getattr(context.get_parameter_source(key), "name", "") == "COMMANDLINE"
    ]
    if given:
        raise InputError(f"{', '.join(given)} cannot be given with {what}", file=file)


def print_json(document: Any) -> None:
    """Print a document as JSON on stdout."""
    from pneutouch.output.files import json_bytes

    typer.echo(json_bytes(document).decode(), nl=False)


def run() -> None:
    """Entry point of the ``pneutouch`` command."""
    gc.set_threshold(_OBJECTS_BEFORE_COLLECTION, 50, 50)
    # The models have no plugins: to look for some, pydantic reads the metadata of every installed package.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    app()
