"""The schema of a document from the typed dictionary that the code declares it by."""

import types
import typing
from collections.abc import Mapping
from typing import Any, Literal, NotRequired, Union

from pneutouch.schemas.helps import help_of
from pneutouch.schemas.shape import Schema, any_of, items, mapping, or_null, record

_PLAIN: dict[Any, str] = {str: "string", float: "number", int: "integer", bool: "boolean"}


def typed(kind: Any, instead: Mapping[str, Schema], known: Mapping[str, Any] | None = None) -> Schema:
    """The schema of a typed dictionary.

    ``instead`` are schemas of keys that it declares as a dictionary of anything; ``known`` are names that its module
    imports for a type checker alone.
    """
    hints = typing.get_type_hints(kind, localns=dict(known or {}), include_extras=True)
    left_out, keys = [], {}
    for key, hint in hints.items():
        if typing.get_origin(hint) is NotRequired:
            (hint,) = typing.get_args(hint)
            left_out.append(key)
        made = instead[key] if key in instead else _schema(hint, instead, known)
        keys[key] = {**made, "description": help_of(key, kind.__name__)}
    help = " ".join((kind.__doc__ or "").replace("``", "`").split())
    return record(help, keys, optional=[*left_out, *kind.__optional_keys__])


def _schema(hint: Any, instead: Mapping[str, Schema], known: Mapping[str, Any] | None) -> Schema:
    origin, inner = typing.get_origin(hint), typing.get_args(hint)
    if hint in _PLAIN:
        return {"type": _PLAIN[hint]}
    if typing.is_typeddict(hint):
        return typed(hint, instead, known)
    if origin is Literal:
        return {"enum": list(inner)}
    if origin is list:
        return items(_schema(inner[0], instead, known))
    if origin is dict:
        return mapping(_schema(inner[1], instead, known))
    if origin in (Union, types.UnionType):
        kinds = [_schema(each, instead, known) for each in inner if each is not types.NoneType]
        one = kinds[0] if len(kinds) == 1 else any_of(*kinds)
        return or_null(one) if types.NoneType in inner else one
    return {}
