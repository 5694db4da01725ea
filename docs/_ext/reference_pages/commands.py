"""The page of every command, from the declarations of the command line."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typer

from pneutouch.cli.app import app
from pneutouch.cli.commands import COMMANDS
from reference_pages import markdown
from reference_pages.markdown import cell, code, plain, table

EXAMPLES = {
    "new": "pneutouch new my-dome --process casting --material DragonSkin20",
    "list": "pneutouch list materials",
    "select": "pneutouch select --sensitivity 1.9 --at 12 --force-range 15",
    "predict": "pneutouch predict paper-dome --model atlas --json",
    "check": "pneutouch check paper-dome",
    "compare": "pneutouch compare paper-dome soft-pad",
    "sweep": "pneutouch sweep --design paper-dome --over membrane.wall_thickness_mm=1:2:3 --model atlas",
    "studio": "pneutouch studio paper-dome",
    "table": "pneutouch table soft-pad --set membrane.shape=cap --set membrane.rise_mm=4",
    "build": "pneutouch build paper-dome --set membrane.material=FLX9960",
    "tray": "pneutouch tray paper-dome --over membrane.material=TangoPlus,FLX9940 --copies 2",
    "coupons": "pneutouch coupons --profile j735 --material Agilus30",
    "fit-material": "pneutouch fit-material pull.csv --name Ours --like DragonSkin20",
    "show": "pneutouch show outputs/paper-dome/paper-dome.3mf",
    "schema": "pneutouch schema design",
    "plan": "pneutouch plan paper-dome --specimens 2",
    "simulate": "pneutouch simulate paper-dome --pressures 0,12 --runs 1",
    "characterize": "pneutouch characterize my-campaign --design paper-dome",
    "calibrate": "pneutouch calibrate my-campaign --design paper-dome --save dome-1",
    "export-reader": "pneutouch export-reader paper-dome",
    "respond": "pneutouch respond paper-dome --step 2N",
    "scan": "pneutouch scan texture-specimen --design paper-dome",
}
"""One command line for each command, which a test takes apart."""

_FORMS = {
    "str": "text",
    "int": "whole number",
    "float": "number",
    "Path": "path",
    "list": "texts, with commas",
    "bool": "true or false",
}
"""Kinds of values by the type that declares them."""

_INTRO = (
    "Every command with its arguments and options, made from the declarations that the command line itself is made "
    "from. `pneutouch COMMAND -h` shows the same. The order of use, the forms of values and the exit codes are on "
    "[The command line](../command-line.md)."
)


def _group() -> Any:
    return typer.main.get_command(app)


def parsed(name: str) -> Any:
    """A command as the command line reads it."""
    return _group().get_command(typer.Context(_group()), name)


def page() -> str:
    """The page."""
    groups = ["\n\n".join([f"## {group}", *(section(name) for name in entries)]) for group, entries in COMMANDS.items()]
    return markdown.page("Commands", _INTRO, *groups)


def section(name: str) -> str:
    """The section of a command: what it does, how it is called, an example, arguments and options."""
    command = parsed(name)
    parameters = [each for each in command.params if each.name != "help"]
    arguments = [each for each in parameters if each.param_type_name == "argument"]
    options = [each for each in parameters if each.param_type_name == "option"]
    words = ["pneutouch", name, "[OPTIONS]", *map(_usage, arguments)]
    parts = [f"### {name}", plain(" ".join((command.help or "").split()))]
    parts += [f"```text\n{' '.join(words)}\n```", *([f"For example `{EXAMPLES[name]}`."] if name in EXAMPLES else [])]
    if arguments:
        rows = [(code(_name(each)), _help(each), _kind(each), _default(each)) for each in arguments]
        parts.append(table(("argument", "meaning", "takes", "default"), rows))
    if options:
        rows = [(_flags(each), _help(each), _kind(each), _default(each)) for each in options]
        parts.append(table(("option", "meaning", "takes", "default"), rows))
    return "\n\n".join(parts)


def _name(parameter: Any) -> str:
    return str(parameter.metavar or parameter.name.upper())


def _usage(argument: Any) -> str:
    """An argument as it stands in the usage: in brackets where it may be left out, with dots where it may be many."""
    name = f"{_name(argument).removesuffix('...')}..." if argument.nargs == -1 else _name(argument)
    return name if argument.required else f"[{name}]"


def _help(parameter: Any) -> str:
    help = plain(cell(parameter.help or ""))
    return f"{help} *Required.*" if parameter.required else help


def _flags(option: Any) -> str:
    return ", ".join(code(flag) for flag in [*option.opts, *option.secondary_opts])


def _kind(parameter: Any) -> str:
    """The form of the value, with its bounds where it has some; nothing of a switch."""
    annotation = str(getattr(parameter.type_descriptor.annotation, "__name__", "str"))
    if getattr(parameter, "is_flag", False):
        return ""
    option = parameter.param_type_name == "option"
    if annotation == "list" and not option:
        return "texts"
    form = code(parameter.metavar) if option and parameter.metavar else _FORMS[annotation]
    ends = [f"{word} {end:g}" for word, end in (("from", parameter.min), ("to", parameter.max)) if end is not None]
    return " ".join([form, *ends])


def _default(parameter: Any) -> str:
    """The default as the help shows it."""
    if isinstance(parameter.show_default, str):
        return plain(parameter.show_default)
    default = parameter.default
    known = isinstance(default, str | int | float | Path) and not isinstance(default, bool)
    return code(str(default)) if known else ""
