"""Which inputs of a fuzzing are kept: the smallest that reach steps, from line to line of the package, that no other does."""

from __future__ import annotations

import hashlib
import sys
import tempfile
from pathlib import Path
from types import FrameType
from typing import Any

from tests.fuzzing.corpus import CORPUS
from tests.fuzzing.judge import judge
from tests.fuzzing.seeds import seeds
from tests.fuzzing.targets import TARGETS

MOST_BYTES, MOST_FILES = 20_000, 24
"""Of a target's inputs, besides its seeds, which are made anew, and those that were kept before: some 700 kB in all."""

Step = tuple[str, int, int]


def keep(name: str, inputs: list[bytes]) -> list[bytes]:
    """Write the inputs, smallest first, that reach steps which seeds and kept inputs do not; all that is kept now.

    What was kept before stays: much of it was once a fault.
    """
    folder = CORPUS / name
    folder.mkdir(parents=True, exist_ok=True)
    known = [path.read_bytes() for path in sorted(folder.iterdir())]
    reached = set[Step]().union(*(steps(name, content) for content in (*known, *seeds(name))))
    chosen: list[bytes] = []
    for content in sorted(set(inputs) - {*known, *seeds(name)}, key=lambda each: (len(each), each)):
        if len(chosen) == MOST_FILES or sum(map(len, chosen)) + len(content) > MOST_BYTES:
            break
        if new := steps(name, content) - reached:
            reached |= new
            chosen.append(content)
    for content in chosen:
        (folder / hashlib.sha256(content).hexdigest()[:16]).write_bytes(content)
    return known + chosen


def steps(name: str, content: bytes) -> set[Step]:
    """Pairs of lines of the package that follow one another while the target reads ``content``."""
    found: set[Step] = set()
    last = 0

    def trace(frame: FrameType, event: str, argument: Any) -> Any:
        nonlocal last
        file = frame.f_code.co_filename
        if "/pneutouch/" not in file:
            return None
        found.add((file, last, frame.f_lineno))
        last = frame.f_lineno
        return trace

    before = sys.gettrace()
    with tempfile.TemporaryDirectory() as folder:
        sys.settrace(trace)
        try:
            judge(TARGETS[name], content, Path(folder))
        finally:
            sys.settrace(before)
    return found
