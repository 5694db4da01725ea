"""Fields of a file as keyword arguments, named by their key, or ``table_key`` if an earlier table has the same key."""

import typing
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from itertools import islice
from os import PathLike
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from pneutouch.errors import InputError, PneutouchError, nearest, shown
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import is_one_of_list, table_of
from pneutouch.spec.options import AnyOptions, options_of
from pneutouch.spec.values import finite_numbers, is_finite

WHERE = "the keyword arguments"
"""Name in place of a file's for values from keyword arguments; `named_by_keyword` takes it out of an error."""


_MOST = 100_000
"""Greatest number of entries of a list that are read: no field takes as many."""


@cache
def keywords(model: type[BaseModel]) -> dict[str, str]:
    """Every field of a file's ``model`` as ``table.key``, by its keyword; the first table of a key keeps the bare name.

    Keys of the model's ``prefixed`` tables always have the table's name; a key outside tables is its keyword, and last.
    """
    fields: dict[str, str] = {}
    for name in model.model_fields:
        table = table_of(model, name)
        for key in table.model_fields if table else ():
            bare = key not in fields and name not in getattr(model, "prefixed", ())
            fields[key if bare else f"{name}_{key}"] = f"{name}.{key}"
    return fields | {name: name for name in model.model_fields if table_of(model, name) is None}


def plain(value: Any) -> Any:
    """A value as a file holds it: arrays, tuples and ranges as lists, scalars of NumPy as Python's."""
    if hasattr(value, "tolist") and not isinstance(value, type):
        return value.tolist()
    if isinstance(value, list | tuple | range | Iterator):
        # A range or an iterator may have no end.
        return [plain(item) for item in islice(value, _MOST)]
    return {key: plain(item) for key, item in value.items()} if isinstance(value, Mapping) else value


def _of_keyword(name: str, value: Any) -> Any:
    try:
        return plain(value)
    except RecursionError:
        raise InputError("nested too deep", key=name, remedy="give a value, or a list of values") from None


def numbers_of(values: Any, name: str) -> tuple[float, ...]:
    """Finite numbers given as the keyword ``name``. Raises InputError."""
    given = _of_keyword(name, values)
    if not isinstance(given, list):
        remedy = f"write [{shown(given)}]" if is_finite(given) else None
        raise InputError("must be a list of numbers", key=name, value=given, remedy=remedy)
    return tuple(finite_numbers(given, name))


def number_of(value: Any, name: str) -> float | None:
    """A finite number that was given as the keyword ``name``, or None. Raises InputError."""
    if isinstance(value, str):
        raise InputError("must be a finite number", key=name, value=value, remedy="write a number without quotes")
    return None if value is None else numbers_of([value], name)[0]


def paths_of(values: Any, name: str, remedy: str) -> tuple[Path, ...]:
    """Paths that were given as the keyword ``name``, in a list or as one path. Raises InputError."""
    given = _entries(values)
    return tuple(path_of(each, name, remedy) for each in (given if isinstance(given, list) else [given]))


def _entries(values: Any) -> Any:
    """A set, a generator or another collection as a list; any other value is returned as it is."""
    if isinstance(values, Iterable) and not isinstance(values, str | Mapping):
        return list(islice(values, _MOST))
    return values


def path_of(value: Any, name: str, remedy: str) -> Path:
    """A path that was given as the keyword ``name``. Raises InputError with the ``remedy`` for anything else."""
    if not isinstance(value, str | PathLike):
        raise InputError("must be a path", key=name, value=value, remedy=remedy)
    return Path(value)


def changes(model: type[BaseModel], arguments: Mapping[str, Any]) -> dict[str, Any]:
    """Keyword arguments as values by ``table.key``; a table may be given whole, as a mapping. Raises InputError."""
    known = keywords(model)
    fields: dict[str, Any] = {}
    for name, given in arguments.items():
        value = _of_keyword(name, given)
        if name in known:
            entries = {known[name]: value}
        elif name in model.model_fields and isinstance(value, Mapping):
            entries = {f"{name}.{key}": item for key, item in value.items()}
        elif name in model.model_fields:
            raise InputError("must be a mapping of the table's keys", key=name, value=value)
        else:
            raise InputError(f"unknown.{nearest(name, known)}", key=name, value=value)
        for key in entries.keys() & fields.keys():
            raise InputError(f"{key} is given twice", key=name, value=value)
        fields |= entries
    return fields


def keyword_options(model: type[AnyOptions], arguments: Mapping[str, Any]) -> AnyOptions:
    """The options of ``model`` among the arguments; one number or text is a list of one. Raises InputError."""
    content = {}
    for key in model.model_fields.keys() & arguments.keys():
        value = _of_keyword(key, _entries(arguments[key]))
        listed = typing.get_origin(model.model_fields[key].annotation) is list
        alone = (listed and isinstance(value, str | PathLike)) or is_one_of_list(model, key, value)
        content[key] = [value] if alone else value
    return options_of(model, content)


@contextmanager
def named_by_keyword(model: type[BaseModel] = DesignFile) -> Iterator[None]:
    """In an error about a value that was given as a keyword, name the keyword and no file."""
    try:
        yield
    except PneutouchError as error:
        names = {key: name for name, key in keywords(model).items()}
        for each in (error, *error.others):
            if each.file == WHERE:
                key, bracket, index = (each.key or "").partition("[")
                each.file, each.key = None, f"{names.get(key, key)}{bracket}{index}" or None
        raise
