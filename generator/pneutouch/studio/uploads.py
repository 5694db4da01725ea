"""Files that the page was given: kept under names of our own, limited in size and number."""

import re
from collections.abc import AsyncIterator
from pathlib import Path
from typing import NamedTuple

from pneutouch.errors import InputError

LARGEST_FILE = 64 << 20
"""Bytes of one file."""

_LARGEST_SUM = 256 << 20
"""Bytes of all files; the oldest goes first."""

_MOST_FILES = 500
_LONGEST_NAME = 120
_NAME = re.compile(r"[\w][\w .,()+@=-]*", re.ASCII)


class Upload(NamedTuple):
    """A file that was given: its name in the user's folder, where it lies, and its bytes."""

    name: str
    path: Path
    bytes: int


class Uploads:
    """Keeps files in ``folder`` by number. A file lies in a folder of its own, under its checked name: readers go by
    the name's ending, and messages state the name."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._files, self._number = folder, dict[int, Upload](), 0

    def __getitem__(self, number: int) -> Upload:
        """A file by its number. Raises KeyError if unknown, or no longer."""
        return self._files[number]

    async def add(self, name: str, stream: AsyncIterator[bytes]) -> int:
        """Keep a file; returns its number. Raises InputError if the name is no file name or the file is too large."""
        if not _NAME.fullmatch(name) or len(name) > _LONGEST_NAME:
            remedy = "use letters, digits and . _ - + = @ ( ) , alone, and begin with a letter or a digit"
            raise InputError("not a name for a file", key="name", value=name[:_LONGEST_NAME], remedy=remedy)
        self._number += 1
        number, size = self._number, 0
        path = self._folder / f"upload-{number}" / name
        path.parent.mkdir(parents=True)
        try:
            with path.open("xb") as file:
                async for part in stream:
                    size += len(part)
                    if size > LARGEST_FILE:
                        remedy = f"give files of at most {LARGEST_FILE >> 20} MB, or use the commands"
                        raise InputError("the file is too large", key=name, remedy=remedy)
                    file.write(part)
        except BaseException:
            path.unlink(missing_ok=True)
            path.parent.rmdir()
            raise
        self._files[number] = Upload(name, path, size)
        self._drop_oldest(number)
        return number

    def _drop_oldest(self, newest: int) -> None:
        for number in [number for number in self._files if number != newest]:
            if sum(each.bytes for each in self._files.values()) <= _LARGEST_SUM and len(self._files) <= _MOST_FILES:
                return
            old = self._files.pop(number)
            old.path.unlink(missing_ok=True)
            old.path.parent.rmdir()
