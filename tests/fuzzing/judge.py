"""One input read: its answer, its refusal, or a finding."""

from __future__ import annotations

import contextlib
import resource
import time
import traceback
import warnings
from pathlib import Path
from typing import NamedTuple

from tests.fuzzing.targets import Target

SECONDS, MEBIBYTES = 2.0, 128.0
"""Processor time, and growth of the greatest memory, for one input of at most some ten thousand bytes: our choice."""


class Finding(NamedTuple):
    """What an input did that it should not: where (kind, error, the innermost line of the project), and in words."""

    where: str
    words: str


def judge(target: Target, content: bytes, folder: Path) -> Finding | None:
    """Read ``content`` as a file in ``folder``; None where it gives an answer or one of the target's errors."""
    path = folder / target.name
    path.write_bytes(target.written(content))
    forget_peak()
    before, memory = time.process_time(), peak()
    error = None
    try:
        with warnings.catch_warnings():
            # numpy's warnings would reach the user's terminal.
            warnings.simplefilter("error", RuntimeWarning)
            target.read(path)
    except target.allowed as refusal:
        # Its words must be there for everything that was given.
        error = _spoilt(str(refusal))
    except Exception as raised:
        error = raised
    seconds, mebibytes = time.process_time() - before, peak() - memory
    if error is not None:
        return _of_error(error)
    if seconds > SECONDS:
        return Finding("time", f"{seconds:.1f} s of processor time")
    if mebibytes > MEBIBYTES:
        return Finding("memory", f"{mebibytes:.0f} MiB more")
    return None


def _spoilt(message: str) -> Exception | None:
    """An error about the words of an error: they must be text that can be written, and none of Python's."""
    try:
        message.encode()
    except UnicodeEncodeError as error:
        return error
    return AssertionError(f"words of Python: {message[:300]}") if "Traceback" in message else None


def _of_error(error: Exception) -> Finding:
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if "/pneutouch/" in frame.filename]
    place = f"{frames[-1].filename.rpartition('/pneutouch/')[2]}:{frames[-1].lineno}" if frames else "-"
    words = " ".join(str(error).encode("utf-8", "replace").decode().split())[:200]
    return Finding(f"{type(error).__name__} {place}", words)


def forget_peak() -> None:
    """Let the peak begin anew, where the system can: an earlier test may have had more than this input takes."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def peak() -> float:
    """Greatest resident memory since then, MiB."""
    with contextlib.suppress(OSError):
        for line in Path("/proc/self/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
