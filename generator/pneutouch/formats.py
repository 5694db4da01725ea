"""Versions of the files that the program writes to be read later, all in one place.

Every such file states ``format = "pneutouch/NAME/VERSION"``; a campaign states it in ``campaign_format``, because its
``format`` is that of the measured files. A version is raised by a change after which an older program would misread the
file, not by added keys.
"""

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

from pneutouch.errors import InputError, shown
from pneutouch.wording import data_of

KEY = "format"
"""The key that states the format."""


class StoredFormat(NamedTuple):
    """The version of a format, and in words the file that has this format."""

    version: int
    file: str


FORMATS: Mapping[str, StoredFormat] = {name: StoredFormat(**entry) for name, entry in data_of(__file__).items()}
"""Every format by name."""

_STATED = re.compile(r"pneutouch/([a-z-]+)/([1-9][0-9]{0,5})")


def format_of(name: str) -> str:
    """Value of the key ``format`` for the format ``name`` of `FORMATS`, such as ``pneutouch/prediction/1``."""
    return f"pneutouch/{name}/{FORMATS[name].version}"


def version_of(name: str) -> int:
    """Version of the document ``name``; 1 for one without a format, which people write or commands only print."""
    return FORMATS[name].version if name in FORMATS else 1


def versioned(name: str, document: Mapping[str, Any]) -> dict[str, Any]:
    """A copy of ``document`` that begins with the key ``format`` for the format ``name``."""
    return {KEY: format_of(name), **document}


def problem_of(name: str, stated: object) -> tuple[str, str] | None:
    """Problem and remedy if ``stated``, a file's format (None: no key), is not ``name`` or is newer; else None."""
    match = _STATED.fullmatch(stated) if isinstance(stated, str) else None
    if match is None or match[1] != name:
        problem = "missing" if stated is None else "not the format of this file"
        return problem, f"it must be {shown(format_of(name))}"
    if int(match[2]) > FORMATS[name].version:
        return (
            "of a later version",
            f"this pneutouch reads {shown(format_of(name))}: take a newer one, or write it again",
        )
    return None


def check_format(name: str, content: Mapping[str, Any], file: object, key: str = KEY) -> None:
    """Raise InputError if ``content[key]`` is missing, not the format ``name``, or of a later version."""
    problem = problem_of(name, content.get(key))
    if problem is not None:
        raise InputError(problem[0], file=str(file), key=key, value=content.get(key), remedy=problem[1])
