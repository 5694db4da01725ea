"""The schema of a document from the record that declares it."""

import ast
import dataclasses
import inspect
import itertools
import sys
import textwrap
import types
import typing
from collections.abc import Mapping
from typing import Any, Literal, Union

from pneutouch.schemas.pieces import Schema, any_of, items, mapping, or_null, record

_PLAIN: dict[Any, str] = {str: "string", float: "number", int: "integer", bool: "boolean"}


def of_record(kind: type, instead: Mapping[str, Schema] | None = None) -> Schema:
    """The schema of a record; what its fields say of themselves describes its keys.

    ``instead`` are schemas of keys whose values are no records, by ``Record.key``.
    """
    given = instead or {}
    hints = typing.get_type_hints(kind, vars(sys.modules[kind.__module__]))
    helps = {name: text for base in reversed(kind.__mro__) for name, text in _helps(base).items()}
    keys, optional = {}, []
    for field in dataclasses.fields(kind):
        hint, has_default = hints[field.name], field.default is not dataclasses.MISSING
        if has_default and field.default is None:
            left = tuple(each for each in typing.get_args(hint) if each is not types.NoneType)
            hint = Union[left]  # noqa: UP007
        made = given.get(f"{kind.__name__}.{field.name}") or _of_hint(hint, given)
        keys[field.name] = {**made, "description": helps[field.name]}
        optional += [field.name] if has_default else []
    help = " ".join((kind.__doc__ or "").replace("``", "`").split())
    return record(help, keys, optional=optional)


def _helps(kind: type) -> dict[str, str]:
    """The texts below the fields of a class, by field."""
    if not dataclasses.is_dataclass(kind):
        return {}
    (tree,) = ast.parse(textwrap.dedent(inspect.getsource(kind))).body
    assert isinstance(tree, ast.ClassDef)
    texts = {}
    for one, below in itertools.pairwise(tree.body):
        if isinstance(one, ast.AnnAssign) and isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
            texts[ast.unparse(one.target)] = " ".join(str(below.value.value).split())
    return texts


def _of_hint(hint: Any, given: Mapping[str, Schema]) -> Schema:
    origin, inner = typing.get_origin(hint), typing.get_args(hint)
    if dataclasses.is_dataclass(hint):
        assert isinstance(hint, type)
        return of_record(hint, given)
    if origin is tuple:
        if inner[-1] is Ellipsis:
            return items(_of_hint(inner[0], given))
        return {**items(_of_hint(inner[0], given)), "minItems": len(inner), "maxItems": len(inner)}
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return mapping(_of_hint(inner[1], given))
    if origin in (Union, types.UnionType):
        kinds = [_of_hint(each, given) for each in inner if each is not types.NoneType]
        one = kinds[0] if len(kinds) == 1 else any_of(*kinds)
        return or_null(one) if types.NoneType in inner else one
    if origin is Literal:
        return {"enum": list(inner)}
    if origin in (list, dict):
        return items(_of_hint(inner[0], given)) if origin is list else mapping(_of_hint(inner[1], given))
    return {"type": _PLAIN[hint]} if hint in _PLAIN else {}
