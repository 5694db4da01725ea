"""Options that are numbers take plain digits alone: ``1_0`` is a slip of the keyboard, not ten."""

from functools import partial
from typing import Any

from pneutouch.errors import InputError
from pneutouch.spec.number import plain_number


def with_plain_numbers(command: Any) -> Any:
    """The command, whose number options refuse texts that `plain_number` does not read."""
    for parameter in command.params:
        if isinstance(parameter.process_value, partial):
            # A command may be requested more than once.
            continue
        parameter.process_value = partial(_processed, parameter.name, parameter.process_value)
    return command


def _processed(name: str, process: Any, context: Any, given: Any) -> Any:
    """The value of a parameter. Raises InputError if a text that is no number was made one."""
    made = process(context, given)
    texts = given if isinstance(given, list | tuple) else [given]
    values = made if isinstance(made, list | tuple) else [made]
    for text, value in zip(texts, values, strict=False):
        if isinstance(text, str) and isinstance(value, int | float) and not isinstance(value, bool):
            try:
                plain_number(text)
            except ValueError:
                raise InputError("must be a number, such as 12.5", key=name, value=text) from None
    return made
