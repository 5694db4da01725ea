"""The process for computations that take a second: one line of JSON in, one out, until its input ends."""

import json
import signal
import sys
from collections.abc import Iterable, Mapping
from typing import Any, BinaryIO

from pneutouch.catalogue import Library
from pneutouch.results.record import plain
from pneutouch.studio.answer import full_answer
from pneutouch.studio.faults import PageResponse, reported
from pneutouch.studio.question import PageLibrary, Question


def answered(request: Mapping[str, Any], library: Library) -> PageResponse:
    """Status and content of the answer to a request with ``question`` and ``bases``; an error is an answer too."""
    return reported(lambda: full_answer(Question.of(request["question"]), request["bases"], library))


def work(requests: Iterable[bytes], answers: BinaryIO) -> None:
    """Answer every request in turn."""
    library = PageLibrary(Library.default().folders)
    for line in requests:
        answers.write(json.dumps(plain(answered(json.loads(line), library))).encode() + b"\n")
        answers.flush()


if __name__ == "__main__":
    # The studio ends this process: Ctrl-C in its terminal is no affair of this one.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    work(sys.stdin.buffer, sys.stdout.buffer)
