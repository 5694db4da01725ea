"""The journal: finished points on disk, one checksummed line a chunk, so that a kill loses at most the line it tore.

A line is ``checksum json``. What does not agree with its checksum was torn by a kill or damaged since: it is dropped
and its points are computed again.
"""

import json
import os
from pathlib import Path
from typing import Any

from pneutouch.errors import InputError
from pneutouch.output.files import digest, write_synced
from pneutouch.spec.files import read_bytes
from pneutouch.workflows.sweep.work import Record

_CHECKSUM_DIGITS = 16


MOST_BYTES = 2**30
"""Largest size of a journal: some million points."""


class Journal:
    """The finished points of the sweep ``fingerprint`` in the file ``path``."""

    def __init__(self, path: Path, fingerprint: str) -> None:
        self.path, self.fingerprint = path, fingerprint

    def read(self) -> dict[int, Record]:
        """Finished points by number. Damaged lines are cut out of the file.

        Raises InputError if the journal is another sweep's.
        """
        if not self.path.exists():
            return {}
        lines = read_bytes(self.path, MOST_BYTES, "journal").split(b"\n")
        whole = [line for line in lines if _content(line) is not None]
        records: dict[int, Record] = {}
        for line in whole:
            content = _content(line)
            assert content is not None
            if content["sweep"] != self.fingerprint:
                problem = (
                    "holds the progress of another sweep: the design, a material, the printer, the model, the values "
                    "or "
                    "the version has changed"
                )
                remedy = "`fresh` starts over, or give another `out`"
                raise InputError(problem, file=self.path.parent, remedy=remedy)
            records |= {record["point"]: record for record in content["records"]}
        if lines != [*whole, b""]:
            self._rewrite(whole)
        return records

    def append(self, records: list[Record]) -> None:
        """Add finished points; they are on the disk when this returns."""
        text = json.dumps({"sweep": self.fingerprint, "records": records}, ensure_ascii=False).encode()
        with self.path.open("ab") as file:
            file.write(_checksum(text) + b" " + text + b"\n")
            file.flush()
            os.fsync(file.fileno())

    def _rewrite(self, lines: list[bytes]) -> None:
        """Keep these lines alone: a line appended to a torn one would be lost with it."""
        fresh = self.path.with_name(f"{self.path.name}.new")
        replace_whole(fresh, self.path, b"".join(line + b"\n" for line in lines))


def replace_whole(fresh: Path, target: Path, content: bytes) -> None:
    """Write ``content`` to ``fresh``, on the disk, then rename it to ``target``: never half a file under that name.

    For files of the locked work folder, where a kill leaves ``fresh`` under a name that the next sweep clears. Raises
    OSError, so that a sweep can report which points are kept.
    """
    write_synced(fresh, content)
    fresh.replace(target)


def _checksum(text: bytes) -> bytes:
    return digest(text)[:_CHECKSUM_DIGITS].encode()


def _content(line: bytes) -> dict[str, Any] | None:
    """The content of a line, or None if it does not agree with its checksum or is of another form."""
    checksum, space, text = line.partition(b" ")
    if not space or checksum != _checksum(text):
        return None
    try:
        content = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return content if _is_entry(content) else None


def _is_entry(content: Any) -> bool:
    """True if a line is one that `Journal.append` writes; a checksum alone proves nothing."""
    if not isinstance(content, dict) or not isinstance(content.get("sweep"), str):
        return False
    records = content.get("records")
    return isinstance(records, list) and all(
        isinstance(record, dict)
        and type(record.get("point")) is int
        and isinstance(record.get("states"), list)
        and all(isinstance(state, dict) and "status" in state for state in record["states"])
        and isinstance(record.get("values"), dict)
        for record in records
    )
