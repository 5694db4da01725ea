"""Options in per cent: ``5%`` and ``5`` are the same. What a plain number below 1 is taken as, a note states."""

import typer

from pneutouch.cli.terminal import notify
from pneutouch.errors import InputError
from pneutouch.spec.number import plain_number


def percent_of(text: str, parameter: str) -> float:
    """The per cent of a text, with or without its sign. Raises InputError naming the parameter."""
    value = _read(text, parameter)
    if _is_doubtful(text, value):
        flag = f"--{parameter.replace('_', '-')}"
        notify(f"note: {flag} {value:.12g} is taken as {value:.12g} %; a share of it is {flag} {100 * value:.12g}%")
    return value


def error_in_percent(context: typer.Context, parameter: typer.CallbackParam, text: str | None) -> str | None:
    """The numerical error of an option with its sign, as the library reads it. Raises InputError.

    A plain number below 1 is a share, as in Python: no model has an error of less than 1 %.
    """
    if text is None:
        return None
    value = _read(text, parameter.name or "")
    if _is_doubtful(text, value):
        notify(f"note: --{parameter.name} {value:.12g} is taken as a share, {100 * value:.12g} %")
        value *= 100.0
    return f"{value:.12g}%"


def _read(text: str, parameter: str) -> float:
    number = text.strip().removesuffix("%").strip()
    try:
        value = plain_number(number)
    except ValueError:
        value = float("nan")
    if not 0.0 < value <= 100.0:
        problem = "it must be a positive share of at most 100 %, such as 2% or 2"
        raise InputError(problem, key=parameter, value=text)
    return value


def _is_doubtful(text: str, value: float) -> bool:
    return value < 1.0 and "%" not in text
