"""An output folder read back: the files that its manifest lists, as they were written."""

import csv
import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pneutouch.errors import InputError
from pneutouch.formats import check_format
from pneutouch.output.files import MANIFEST, digest
from pneutouch.spec.files import read_bytes
from pneutouch.spec.number import is_finite

_MOST_BYTES = 100_000_000
"""Size of the largest file that is read: hundreds of times a usual one."""


def manifest_of(folder: Path) -> dict[str, Any]:
    """The manifest of an output folder. Raises InputError if there is none, or if it is damaged."""
    if not os.path.lexists(folder / MANIFEST):
        raise InputError(
            f"holds no {MANIFEST}: neither a build nor a characterization",
            file=folder,
            remedy="give a folder that pneutouch build or characterize wrote, or a design",
        )
    text = read_bytes(folder / MANIFEST, _MOST_BYTES, "manifest")
    try:
        content = json.loads(text)
        listed = content["files"]
        check_format("manifest", content, folder / MANIFEST)
        if isinstance(listed, dict) and all(isinstance(entry["sha256"], str) for entry in listed.values()):
            return dict(content)
    except (ValueError, KeyError, TypeError, RecursionError):
        pass
    raise InputError(f"its {MANIFEST} is damaged or not ours", file=folder, remedy="make the folder again")


_MISFORMED = (KeyError, ValueError, TypeError, AttributeError, IndexError, OverflowError, RecursionError, csv.Error)
"""Exceptions that content of another form raises in use: whoever changed a file can change its hash in the manifest."""


@contextmanager
def as_written(folder: Path, name: str, remedy: str) -> Iterator[None]:
    """Use the content of a file of ours. Raises InputError in place of the exceptions that content of another form
    raises."""
    try:
        yield
    except _MISFORMED as error:
        problem = f"{name} is not as this version writes it ({type(error).__name__}: {error})"
        raise InputError(problem, file=folder, remedy=remedy) from None


def interval_of(entry: Mapping[str, Any]) -> tuple[float, float | None, float | None]:
    """Value, low and high of a figure, the last two None if it has no interval. Raises ValueError for all else."""
    value, low, high = entry["value"], entry["low"], entry["high"]
    numbers([value, *(each for each in (low, high) if each is not None)])
    if low is not None and high is not None and low > high:
        raise ValueError(f"an interval from {low} to {high}")
    return value, low, high


def numbers(values: Any) -> list[float]:
    """The values of a list. Raises ValueError if one is no finite number, TypeError for anything but a list."""
    for value in values:
        if not is_finite(value):
            raise ValueError(f"{value!r:.40} is no finite number")
    return list(values)


def listed_file(folder: Path, name: str, manifest: dict[str, Any]) -> bytes:
    """A file of an output folder. Raises InputError if it is missing or not as it was written."""
    entry = manifest["files"].get(name)
    if entry is None or not os.path.lexists(folder / name):
        raise InputError(f"holds no {name}", file=folder, remedy="make the folder again")
    content = read_bytes(folder / name, _MOST_BYTES, "file of an output folder")
    if digest(content) != entry["sha256"]:
        raise InputError("was changed after it was written", file=folder / name, remedy="make the folder again")
    return content
