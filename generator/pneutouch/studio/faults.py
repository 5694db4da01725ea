"""Errors of the library as the page takes them: a message for each field that caused one."""

import re
from collections.abc import Callable
from dataclasses import dataclass

from pydantic import BaseModel

from pneutouch.errors import ComputationError, InputError, PneutouchError
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import table_of
from pneutouch.spec.target import Target

BAD_INPUT = 422
FAILED = 500

_MODELS = (DesignFile, Target)
"""The files that the page has a form for; no two have a table of the same name."""


@dataclass(frozen=True, slots=True)
class PageProblem:
    """A problem with its words, which are the CLI's, and the fields, ``table.key``, that it stands at."""

    message: str
    fields: list[str]


@dataclass(frozen=True, slots=True)
class PageFault:
    """The problems of an error."""

    problems: list[PageProblem]


@dataclass(frozen=True, slots=True)
class PageResponse:
    """Status and content of a computation."""

    status: int
    content: object


def faults_of(error: PneutouchError) -> PageFault:
    """The problems of an error."""
    return PageFault([_problem(each) for each in (error, *error.others)])


def fault_status(error: PneutouchError) -> int:
    """The status of an answer: the input is wrong, or a computation could not be completed."""
    return BAD_INPUT if isinstance(error, InputError) else FAILED


def reported(compute: Callable[[], object]) -> PageResponse:
    """The response of a computation; an error is an answer too, without a traceback."""
    try:
        return PageResponse(200, compute())
    except PneutouchError as error:
        fault = error
    except MemoryError:
        fault = too_little_memory()
    except Exception as error:
        fault = ComputationError(f"internal fault ({type(error).__name__}: {error})", remedy="please report it")
    return PageResponse(fault_status(fault), faults_of(fault))


def too_little_memory() -> PneutouchError:
    """The error where memory is short."""
    return ComputationError("not enough memory", remedy="close other programs")


def _problem(error: PneutouchError) -> PageProblem:
    words = error.problem if not error.remedy else f"{error.problem}; {error.remedy}"
    alone = type(error)(words)
    return PageProblem(alone.message(), _fields(error))


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
