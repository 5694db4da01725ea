"""The form of a table as a message shows it: ``{ value = ..., source = "..." }``."""

import typing

from pydantic import BaseModel

from pneutouch.spec.fields import table_of
from pneutouch.spec.quantity import Quantity

_MOST_KEYS = 8
"""Keys that a message shows: a table of more is looked up."""


def table_form(owner: type[BaseModel] | None, key: str) -> str:
    """The form of the table ``key`` of ``owner`` with its needed keys; empty if these are none or too many."""
    table = None if owner is None else table_of(owner, key)
    if table is None:
        return ""
    needed = [name for name, field in table.model_fields.items() if field.is_required()]
    if issubclass(table, Quantity):
        # It takes a range in place of the value.
        needed = ["value", *needed]
    if not 0 < len(needed) <= _MOST_KEYS:
        return ""
    entries = (f"{name} = {_FORMS.get(table.model_fields[name].annotation, '...')}" for name in needed)
    return f"{{ {', '.join(entries)} }}"


_FORMS: dict[typing.Any, str] = {str: '"..."'}
