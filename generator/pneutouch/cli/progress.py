"""Progress of a command: a bar on a terminal, one line a stage elsewhere, on stderr both."""

import contextlib
import sys
from collections.abc import Iterator
from typing import Protocol

from pneutouch.cli.terminal import notify
from pneutouch.errors import one_line


class ProgressCallback(Protocol):
    """Receives how many of all are done and, where it changes, the current task."""

    def __call__(self, done: int, total: int, what: str | None = None) -> None:
        """Move the bar."""


@contextlib.contextmanager
def bar(what: str, *, unit: str = "") -> Iterator[ProgressCallback]:
    """A stage, such as "reading runs", or "" where the callback names its stages; a bar that moves by the callback.

    ``unit`` is that of the counts at the bar, where they are not of things."""
    if not sys.stderr.isatty():
        yield _lines(what)
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    counts = (MofNCompleteColumn(), TextColumn(unit)) if unit else (MofNCompleteColumn(),)
    columns = (TextColumn("{task.description}"), BarColumn(), *counts, TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(what, total=None)

        def report(done: int, total: int, what: str | None = None) -> None:
            shown.update(task, description=what if what is None else one_line(what), completed=done, total=total)

        yield report


def _lines(what: str) -> ProgressCallback:
    """One line a stage, the first at once."""
    last = what
    if what:
        notify(f"{one_line(what)} ...")

    def report(done: int, total: int, what: str | None = None) -> None:
        nonlocal last
        if what is not None and what != last:
            last = what
            notify(f"{one_line(what)} ...")

    return report
