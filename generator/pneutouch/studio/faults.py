"""Errors of the library as the page takes them: a message for each field that caused one."""

import re
from collections.abc import Callable
from typing import Any

from pydantic import BaseModel

from pneutouch.errors import ComputationError, InputError, PneutouchError
from pneutouch.results.record import plain
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import table_of
from pneutouch.spec.target import Target

BAD_INPUT = 422
FAILED = 500

_MODELS = (DesignFile, Target)
"""The files that the page has a form for; no two have a table of the same name."""


def fault_document(error: PneutouchError) -> dict[str, Any]:
    """Every problem with its words and the fields, ``table.key``, that it stands at; the words are the CLI's."""
    return {"problems": [_problem(each) for each in (error, *error.others)]}


def fault_status(error: PneutouchError) -> int:
    """The status of an answer: the input is wrong, or a computation could not be completed."""
    return BAD_INPUT if isinstance(error, InputError) else FAILED


def reported(compute: Callable[[], object]) -> dict[str, Any]:
    """``status`` and ``content`` of a computation; an error is an answer too, without a traceback."""
    try:
        return {"status": 200, "content": plain(compute())}
    except PneutouchError as error:
        fault = error
    except MemoryError:
        fault = too_little_memory()
    except Exception as error:
        fault = ComputationError(f"internal fault ({type(error).__name__}: {error})", remedy="please report it")
    return {"status": fault_status(fault), "content": fault_document(fault)}


def too_little_memory() -> PneutouchError:
    """The error where memory is short."""
    return ComputationError("not enough memory", remedy="close other programs")


def _problem(error: PneutouchError) -> dict[str, Any]:
    words = error.problem if not error.remedy else f"{error.problem}; {error.remedy}"
    alone = type(error)(words)
    return {"message": alone.message(), "fields": _fields(error)}


def _fields(error: PneutouchError) -> list[str]:
    """Fields of an error: its key, or, for one on a table or on the file, those that its words name."""
    key = (error.key or "").partition("[")[0]
    table, _, field = key.partition(".")
    if field or (key in DesignFile.model_fields and table_of(DesignFile, key) is None):
        return [key]
    named = []
    for name, model in _tables():
        if table and name != table:
            continue
        named += [f"{name}.{each}" for each in model.model_fields if f"{name}.{each}" in error.problem]
        if table == name:
            named += [f"{name}.{each}" for each in model.model_fields if _is_named(each, error.problem)]
    return list(dict.fromkeys(named))


def _tables() -> list[tuple[str, type[BaseModel]]]:
    tables = [(name, table_of(file, name)) for file in _MODELS for name in file.model_fields]
    return [(name, model) for name, model in tables if model is not None]


def _is_named(field: str, problem: str) -> bool:
    return re.search(rf"\b{field}\b", problem) is not None
