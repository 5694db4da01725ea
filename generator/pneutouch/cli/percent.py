"""Options in per cent: ``5%``, ``5`` and ``0.05`` are the same; below 1 a note says so."""

import typer

from pneutouch.cli.terminal import notify
from pneutouch.errors import InputError
from pneutouch.spec.number import plain_number


def percent_of(text: str, parameter: str) -> float:
    """The per cent of a text; without a sign a number below 1 is a share, as in Python. Raises InputError."""
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
    """The numerical error of an option with its sign, as the library reads it. Raises InputError."""
    return None if text is None else f"{percent_of(text, parameter.name or ''):.12g}%"
