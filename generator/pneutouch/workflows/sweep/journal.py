"""Progress of a sweep: finished points on disk, one line with checksum a chunk, so that a kill loses one line.

A line is ``checksum json``. One that does not agree with its checksum was cut off by a kill or damaged later: it is
dropped, and its points are computed again."""

import contextlib
import fcntl
import json
import os
import shutil
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from io import FileIO
from itertools import zip_longest
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple

import numpy as np

from pneutouch.arrays import Index
from pneutouch.errors import ComputationError, InputError
from pneutouch.output.files import digest, write_synced
from pneutouch.spec.files import check_plain
from pneutouch.stopping import cleaned, uninterrupted
from pneutouch.workflows.sweep.variables import POINT, STATE
from pneutouch.workflows.sweep.work import Record, SweepStudy

_CHECKSUM_DIGITS = 16


MOST_LINE = 2**26
"""Bytes of a line that are read at once: ten times those of a chunk with fifty driving pressures a point."""


class FinishedPoints:
    """Points of a sweep that are done, and their places in the journal: memory does not grow with their figures.

    ``widths``: bytes of the longest text of each variable of texts; ``bases``: bases of the errors; ``counts``: states
    by their status. A dataset states all three before its first point.
    """

    def __init__(self, study: SweepStudy) -> None:
        self.study = study
        self._done = np.zeros(study.plan.count, dtype=bool)
        self._places: dict[int, int] = {}
        self.widths = {v.name: 1 for v in (*STATE, *POINT) if v.text}
        self.bases: set[str] = set()
        self.counts: Counter[str] = Counter()

    @property
    def done(self) -> int:
        """Number of points that are done."""
        return int(np.count_nonzero(self._done))

    @property
    def missing(self) -> Index:
        """Numbers of the points that are not done, ascending."""
        return np.flatnonzero(~self._done)

    def take(self, records: list[Record], place: int) -> None:
        """Count in the points of a line that begins at the byte ``place`` of the journal; one without a state for each
        of its driving pressures is left to be computed again, with all of its chunk."""
        for record in records:
            i, values, states = record["point"], record["values"], record["states"]
            if not 0 <= i < self._done.size or len(states) != len(self.study.point(i).driving_pressures_kPa):
                continue
            if not self._done[i]:
                self.counts.update(state["status"] for state in states)
            self._done[i] = True
            self.bases.add(values.get("error_sensitivity_basis") or "")
            for name, width in self.widths.items():
                texts = (each.get(name) or "" for each in (values, *states))
                self.widths[name] = max(width, *(len(text.encode()) for text in texts))
        if records:
            self._places[records[0]["point"]] = place

    def records(self, journal: "Journal") -> Iterator[Record]:
        """Records of all points in their order. Raises ComputationError for a journal that was changed meanwhile."""
        found = journal.at(place for _, place in sorted(self._places.items()))
        for expected, record in zip_longest(range(self._done.size), found):
            if record is None or record["point"] != expected:
                raise ComputationError(f"{journal.path}: was changed while the dataset was written")
            yield record


class Journal:
    """Finished points, in the file ``path``, of the sweep with a ``fingerprint``."""

    def __init__(self, path: Path, fingerprint: str) -> None:
        self.path, self.fingerprint = path, fingerprint

    def read(self, keep: Callable[[list[Record], int], None]) -> None:
        """Hand over the finished points, line by line, and where each line begins; damaged lines are removed from the
        file. Raises InputError for another sweep's journal."""
        if not self.path.exists():
            return
        check_plain(self.path, "journal")
        whole, place = True, 0
        for line in self._lines():
            text = line.removesuffix(b"\n")
            entry = _entry(text)
            whole = whole and entry is not None and line.endswith(b"\n")
            if entry is not None and entry.sweep != self.fingerprint:
                problem = (
                    "holds the progress of another sweep: the design, a material, the printer, the model, the values "
                    "or the version has changed"
                )
                remedy = "`fresh` starts over, or give another `out`"
                raise InputError(problem, file=self.path.parent, remedy=remedy)
            if entry is not None:
                keep(entry.records, place)
                place += len(text) + 1
        if not whole:
            self._rewrite()

    def at(self, places: Iterable[int]) -> Iterator[Record]:
        """Records of the lines that begin at these bytes."""
        with self.path.open("rb") as file:
            for place in places:
                file.seek(place)
                entry = _entry(file.readline(MOST_LINE).removesuffix(b"\n"))
                yield from () if entry is None else entry.records

    def append(self, records: list[Record]) -> int:
        """Add finished points, which are on the disk when this returns; the byte at which their line begins."""
        text = json.dumps({"sweep": self.fingerprint, "records": records}, ensure_ascii=False).encode()
        with self.path.open("ab") as file:
            place = file.tell()
            file.write(_checksum(text) + b" " + text + b"\n")
            file.flush()
            os.fsync(file.fileno())
        return place

    def _lines(self) -> Iterator[bytes]:
        """Lines of the file; a longer one than any entry in parts, of which none is one."""
        with self.path.open("rb") as file:
            while line := file.readline(MOST_LINE):
                yield line

    def _rewrite(self) -> None:
        """Rewrite the file with its whole lines, because a line appended to a cut one would be lost with it."""
        texts = (line.removesuffix(b"\n") for line in self._lines())
        kept = (text + b"\n" for text in texts if _entry(text) is not None)
        fresh = self.path.with_name(f"{self.path.name}.new")
        replace_whole(fresh, self.path, lambda path: write_synced(path, kept))


def replace_whole(fresh: Path, target: Path, write: Callable[[Path], object]) -> None:
    """Let ``write`` write ``fresh``, sync it to disk, then rename it to ``target``, so that this is never half a file.

    For files of the locked work folder, where a kill leaves ``fresh`` under a name that the next sweep clears. Raises
    OSError, so that a sweep can report which points are kept."""
    write(fresh)
    sync(fresh)
    fresh.replace(target)


def _checksum(text: bytes) -> bytes:
    return digest(text)[:_CHECKSUM_DIGITS].encode()


class _Entry(NamedTuple):
    """A line of the journal: fingerprint of the sweep, and finished points."""

    sweep: str
    records: list[Record]


def _entry(line: bytes) -> _Entry | None:
    """Entry of a line; None if the line does not agree with its checksum or has another form."""
    checksum, space, text = line.partition(b" ")
    if not space or checksum != _checksum(text):
        return None
    try:
        content = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return _Entry(content["sweep"], content["records"]) if _is_entry(content) else None


def _is_entry(content: Any) -> bool:
    """True if the content of a line is such as `Journal.append` writes; a checksum alone does not prove it."""
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


_LOCK, _JOURNAL, _FILES, _DATASET = "lock", "journal", "inputs", "dataset"
_WRITTEN = {_LOCK, _JOURNAL, f"{_JOURNAL}.new", _FILES, _DATASET}


class WorkFolder:
    """Folder ``OUT.parts/``, locked from entering to leaving the context.

    The lock is the kernel's and ends with its process, however that ends; the number in the file is for messages."""

    def __init__(self, out: Path) -> None:
        """Raises InputError if ``out`` cannot be the file of a dataset."""
        check_output(out)
        self.out, self.path = out, out.with_name(f"{out.name}.parts")
        self.journal, self.files = self.path / _JOURNAL, self.path / _FILES
        self._lock: FileIO | None = None
        self._made: list[Path] = []

    def __enter__(self) -> "WorkFolder":
        """Make and lock the folder. Raises InputError if that fails, another process holds it, or it has other
        files."""
        try:
            with uninterrupted():
                self._enter()
        except OSError as error:
            raise InputError(
                f"{self.path}: {error.strerror}", key="out", remedy="give a file where you may write"
            ) from None
        except KeyboardInterrupt:
            cleaned(self._leave)
            raise
        return self

    def _enter(self) -> None:
        while self._lock is None:
            self._made = self._made or [folder for folder in self.path.absolute().parents if not folder.exists()]
            self.path.mkdir(parents=True, exist_ok=True)
            for path in sorted(self.path.iterdir()):
                # To open, or even to remove, a pipe as if it were a folder waits for ever.
                if path.name not in _WRITTEN or not (path.is_file() or path.is_dir()):
                    raise InputError("no sweep wrote it", file=path, remedy="move it away, or give another `out`")
            self._lock = self._take()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Release the lock; a folder without progress in it is removed."""
        cleaned(self._leave)

    def _leave(self) -> None:
        if self._lock is None:
            return
        if not self.journal.exists() or self.journal.stat().st_size == 0:
            self._clear()
        self._lock.close()

    def restart(self) -> None:
        """Delete all progress."""
        self.journal.unlink(missing_ok=True)

    def finish(self, write: Callable[[Path], None] | None) -> None:
        """Let ``write`` write the dataset, put it in its place, and delete the progress; None leaves the dataset."""
        with uninterrupted():
            self._put(write)

    def _put(self, write: Callable[[Path], None] | None) -> None:
        if write is not None:
            replace_whole(self.path / _DATASET, self.out, write)
            sync(self.out.parent)
        self.journal.unlink(missing_ok=True)

    def _clear(self) -> None:
        shutil.rmtree(self.files, ignore_errors=True)
        for name in (_JOURNAL, f"{_JOURNAL}.new", _DATASET, _LOCK):
            (self.path / name).unlink(missing_ok=True)
        for folder in (self.path, *self._made):
            with contextlib.suppress(OSError):
                folder.rmdir()

    def _take(self) -> FileIO | None:
        """The lock; None if its file was removed, by a sweep that ended, between opening and locking it."""
        try:
            file = FileIO(os.open(self.path / _LOCK, os.O_RDWR | os.O_CREAT, 0o644), "r+")
        except FileNotFoundError:
            return None
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if self._is_current(file):
                file.truncate(0)
                file.write(f"{os.getpid()}\n".encode())
                return file
        except BlockingIOError:
            holder = file.read(20).decode(errors="replace").strip() or "another process"
            file.close()
            raise InputError(
                f"{self.out}: process {holder} is sweeping into it",
                key="out",
                remedy="wait for it, or give another `out`",
            ) from None
        file.close()
        return None

    def _is_current(self, file: FileIO) -> bool:
        try:
            return os.path.samestat(os.fstat(file.fileno()), (self.path / _LOCK).stat())
        except FileNotFoundError:
            return False


def check_output(out: Path) -> None:
    """Raise InputError if ``out`` cannot be the file of a dataset."""
    if out.suffix != ".nc":
        raise InputError(f"{out}: a dataset is a netCDF file", key="out", remedy="give a name that ends in .nc")
    if out.is_symlink() or (out.exists() and not out.is_file()):
        raise InputError(f"{out} is not a plain file", key="out", remedy="give the name of a file")
    parent = next(path for path in out.absolute().parents if path.exists())
    if not parent.is_dir() or not os.access(parent, os.W_OK | os.X_OK):
        raise InputError(f"{parent} is no folder that you may write to", key="out", remedy="give a file in one")


def sync(path: Path) -> None:
    """Sync a file, or a folder with the names in it, to disk, so that it survives a power cut."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
