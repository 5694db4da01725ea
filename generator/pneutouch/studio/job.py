"""The process of one job: a request on its input, lines of progress and then the answer on its output."""

import json
import os
import resource
import signal
import sys
import threading
from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any, BinaryIO

from pneutouch.results.record import plain
from pneutouch.stopping import STOPS
from pneutouch.studio.guard import PageResponse, reported

KINDS: dict[str, str] = {
    "build": "design_jobs:build_design",
    "open": "design_jobs:open_file",
    "map": "design_jobs:map_design",
    "pad": "pads:tabulate",
    "select": "search:search",
    "recognise": "measuring:recognised",
    "characterize": "measuring:characterize",
    "calibrate": "measuring:calibrate",
}
"""Function by kind of job, ``module:name`` below this package: ``run(arguments, folder, report)`` returns the content,
a record.

``arguments`` is the JSON of the page, with ``files`` (name, path) and ``bases``; ``folder`` is for the files it makes;
``report(done, total, what)`` states its progress.
"""

BRIEF = ("open", "recognise")
"""Kinds that take a moment: one job of these kinds may run beside one of the other kinds."""

LARGEST_MEMORY = 12 << 30
"""Greatest address space of a job, in bytes."""

Report = Callable[[int, int, str | None], None]


def answered(request: Mapping[str, Any], report: Report) -> PageResponse:
    """Status and content of a job; an error is an answer too."""
    module, _, name = KINDS[request["kind"]].partition(":")

    job = getattr(import_module(f"pneutouch.studio.{module}"), name)
    return reported(lambda: job(request["arguments"], Path(request["folder"]), report))


def work(request: bytes, out: BinaryIO) -> None:
    """Do the job of a request; write its progress and its answer as JSON lines."""

    def write(line: Mapping[str, Any]) -> None:
        out.write(json.dumps(line).encode() + b"\n")
        out.flush()

    def report(done: int, total: int, what: str | None = None) -> None:
        write({"progress": {"done": done, "total": total, "what": what}})

    write(plain(answered(json.loads(request), report)))


def _stop(number: int, frame: Any) -> None:
    """Raise KeyboardInterrupt once, so that half-written files are removed."""
    for each in STOPS:
        signal.signal(each, signal.SIG_IGN)
    raise KeyboardInterrupt


def _end_with_input() -> None:
    """Stop the process when its input ends early: the studio was killed, and no page takes the answer."""
    os.read(sys.stdin.fileno(), 1)
    os.kill(os.getpid(), signal.SIGTERM)


def main() -> None:
    """Read one request, write its lines, end."""
    # The studio ends this process: Ctrl-C in its terminal comes as SIGTERM from there.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, _stop)
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    limit = LARGEST_MEMORY if most == resource.RLIM_INFINITY else min(most, LARGEST_MEMORY)
    resource.setrlimit(resource.RLIMIT_AS, (limit, most))
    # What libraries print is no answer.
    out = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    try:
        request = sys.stdin.buffer.readline()
        threading.Thread(target=_end_with_input, daemon=True).start()
        work(request, out)
    except KeyboardInterrupt:
        sys.exit(143)


if __name__ == "__main__":
    main()
