"""A bar of progress on a terminal."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol


class Report(Protocol):
    """Told how many of all are done, and what is being done."""

    def __call__(self, done: int, total: int, what: str | None = None) -> None:
        """Move the bar."""


@contextmanager
def bar(what: str) -> Iterator[Report]:
    """A bar on a terminal's stderr; silence elsewhere."""

    def silent(done: int, total: int, what: str | None = None) -> None:
        return None

    if not sys.stderr.isatty():
        yield silent
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (
        TextColumn("{task.description:<12}"), BarColumn(), TextColumn("{task.completed}/{task.total}"), TimeElapsedColumn(),
    )  # fmt: skip
    with Progress(*columns, console=Console(stderr=True), transient=True) as drawn:
        task = drawn.add_task(what, total=None)

        def report(done: int, total: int, what: str | None = None) -> None:
            drawn.update(task, description=what, completed=done, total=total)

        yield report
