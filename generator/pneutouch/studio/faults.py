"""Errors of the library as the page takes them: a message for each field that caused one."""

from collections.abc import Callable
from dataclasses import dataclass

from pneutouch.errors import ComputationError, InputError, PneutouchError
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import table_of

BAD_INPUT = 422
FAILED = 500


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
    return PageProblem(PneutouchError(words).message(), _fields(error))


def _fields(error: PneutouchError) -> list[str]:
    """Fields of an error: its key, or those that one on a table or on the file is about."""
    key = (error.key or "").partition("[")[0]
    alone = "." in key or (key in DesignFile.model_fields and table_of(DesignFile, key) is None)
    return [key] if alone else list(error.fields)
