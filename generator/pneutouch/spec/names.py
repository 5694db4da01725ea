"""Names of designs, specimens, trays, sweeps and calibrations: one rule, for they name files and bodies of a 3MF."""

import re
from os import PathLike
from pathlib import Path

from pneutouch.errors import InputError

NAME_RULE = "use letters, digits, . _ and -, starting with a letter or digit, at most 100 characters"

_NAME = re.compile(r"[^\W_][\w.-]*")
_MOST = 100
_MOST_BYTES = 200
"""File systems take 255 bytes; endings such as ``-voxels`` and ``.3mf`` come on top."""


def plain_name(name: str, *, key: str | None = None, file: str | PathLike[str] | None = None) -> str:
    """Return a name that obeys the rule. Raises InputError."""
    if not (_NAME.fullmatch(name) and len(name) <= _MOST and len(name.encode()) <= _MOST_BYTES):
        raise InputError("cannot be a name", file=file, key=key, value=name, remedy=NAME_RULE)
    return name


def name_of(path: Path) -> str:
    """The name that a file gives its content: its own without the suffix. Raises InputError for a file name that is no
    name."""
    try:
        return plain_name(path.stem)
    except InputError:
        problem = f"the file's name without {path.suffix or 'a suffix'} is the name of its content"
        raise InputError(problem, file=path, remedy=f"rename the file: {NAME_RULE}") from None


def file_name(text: str) -> str:
    """A text as part of a file's name: on one line, no folder, not hidden, and not too long for a file system."""
    plain = "".join(c if c.isprintable() and c not in "/\\" else "-" for c in text).lstrip(".")[:_MOST]
    return plain.encode()[:_MOST_BYTES].decode(errors="ignore") or "unnamed"
