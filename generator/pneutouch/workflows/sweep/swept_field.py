"""The kinds of value that a field of the design takes, for the axes of a sweep."""

from typing import Literal, get_origin

from pydantic.fields import FieldInfo

from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import table_of


def _field(key: str) -> FieldInfo | None:
    """The declaration of ``table.key``; None if there is none."""
    table_name, _, name = key.partition(".")
    table = table_of(DesignFile, table_name)
    return None if table is None else table.model_fields.get(name)


def takes_flags(key: str) -> bool:
    """True if the field is true or false."""
    field = _field(key)
    return field is not None and field.annotation is bool


def takes_infinity(key: str) -> bool:
    """True if the field's number may be infinite."""
    field = _field(key)
    return field is not None and any(getattr(entry, "allow_inf_nan", False) for entry in field.metadata)


def takes_words(key: str) -> bool:
    """True if the field is one of a few words, or true or false."""
    field = _field(key)
    return field is not None and (field.annotation is bool or get_origin(field.annotation) is Literal)
