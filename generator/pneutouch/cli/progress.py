"""A progress bar."""

import contextlib
import sys
from collections.abc import Iterator
from typing import Protocol


class ProgressCallback(Protocol):
    """Receives how many of all are done and, where it changes, the current task."""

    def __call__(self, done: int, total: int, what: str | None = None) -> None:
        """Move the bar."""


@contextlib.contextmanager
def bar(what: str) -> Iterator[ProgressCallback]:
    """A progress bar over ``what`` on stderr where that is a terminal; silence elsewhere."""

    def silent(done: int, total: int, what: str | None = None) -> None:
        return None

    if not sys.stderr.isatty():
        yield silent
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed}/{task.total}"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(what, total=None)

        def report(done: int, total: int, what: str | None = None) -> None:
            shown.update(task, description=what, completed=done, total=total)

        yield report
