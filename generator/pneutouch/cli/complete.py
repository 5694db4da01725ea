"""Options and arguments as files state them, and completion of names and keys after a tab.

To complete a name, files of the library are listed and none is read, so it takes no time.
"""

from collections.abc import Callable
from typing import Any

import typer

from pneutouch.cli.terminal import notify
from pneutouch.errors import InputError
from pneutouch.spec.values import plain_number
from pneutouch.wording import data_of


def parameters_of(module: str) -> Callable[..., Any]:
    """A function that makes an option or an argument by its name in the TOML beside ``module``, a ``__file__``.

    An entry holds keywords of Typer, and ``flag``, the option's word, ``names``, the kinds of names that complete it,
    and ``argument``, true for an argument. The keywords of the function are added to them.
    """
    stated = data_of(module)

    def parameter(name: str, **more: Any) -> Any:
        """The option or argument."""
        given = stated[name] | more
        flags = [given.pop("flag")] if "flag" in given else []
        if "names" in given:
            given["autocompletion"] = names(*given.pop("names"), listed=given.pop("listed", False))
        return typer.Argument(**given) if given.pop("argument", False) else typer.Option(*flags, **given)

    return parameter


def names(*kinds: str, listed: bool = False) -> Callable[[str], list[str]]:
    """A function that completes names of these kinds, such as materials; designs also as ``DESIGN@CALIBRATION``.

    With ``listed`` it completes the last of several names with commas between.
    """

    def complete(incomplete: str) -> list[str]:
        """Completions of ``incomplete``; with ``listed`` of its last name, with the others before it."""
        from pneutouch.catalogue.library import Library

        library = Library.default()
        before, comma, word = incomplete.rpartition(",") if listed else ("", "", incomplete)
        design, at, _ = word.rpartition("@") if "designs" in kinds else ("", "", word)
        if at:
            known = [f"{design}@{name}" for name in library.paths("calibrations")]
        else:
            known = [name for kind in kinds for name in library.paths(kind)]
        return [f"{before}{comma}{name}" for name in known if name.startswith(word)]

    return complete


def assignment(incomplete: str) -> list[str]:
    """Completions of ``table.key=``, and after it of a name where the key takes one."""
    from pneutouch.spec.design import DesignFile
    from pneutouch.spec.fields import declarations, table_of

    fields = {
        f"{table}.{field.key}": field
        for table in DesignFile.model_fields
        if (model := table_of(DesignFile, table)) is not None
        for field in declarations(model)
    }
    key, equals, word = incomplete.partition("=")
    if not equals:
        return [f"{name}=" for name in fields if name.startswith(incomplete)]
    registry = fields[key].registry if key in fields else None
    return [f"{key}={name}" for name in names(registry, listed=True)(word)] if registry else []


def percent_of(text: str, parameter: str) -> float:
    """Percentage that a text states, above 0, at most 100; below 1 without % it is a share. Raises InputError."""
    number = text.strip().removesuffix("%").strip()
    try:
        value = plain_number(number)
    except ValueError:
        value = float("nan")
    if not 0.0 < value <= 100.0:
        problem = "it must be a positive share of at most 100 %, such as 2%, 2 or 0.02"
        raise InputError(problem, key=parameter, value=text)
    if value < 1.0 and "%" not in text:
        flag = f"--{parameter.replace('_', '-')}"
        notify(
            f"note: {flag} {number} is taken as a share, {100 * value:.12g} %; {number} per cent is {flag} {number}%"
        )
        value *= 100.0
    return value


def error_in_percent(context: typer.Context, parameter: typer.CallbackParam, text: str | None) -> str | None:
    """Text of a numerical error in percent, with the sign; None if none is given. Raises InputError."""
    return None if text is None else f"{percent_of(text, parameter.name or ''):.12g}%"
