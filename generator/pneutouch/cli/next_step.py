"""The last line of a command between a target and a measured sensor: the command that comes next."""

import shlex
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from pneutouch.cli.terminal import echo, notify


class DesignPlace(NamedTuple):
    """Place where a design that was found is to be saved, and whether that replaces a file."""

    name: str
    folder: Path
    overwrite: bool


def report_next(*words: object, first: str = "") -> None:
    """Print ``next: pneutouch WORDS`` on stderr, quoted so that it works as it stands; ``first`` is done by hand."""
    command = shlex.join(["pneutouch", *map(str, words)])
    notify(f"{first}, then: {command}" if first else f"next: {command}")


def set_words(assignments: Iterable[str] | None, calibration: str | None = None) -> list[str]:
    """The ``--set`` options and the ``--calibration`` of a command, to be given to the next one."""
    named = [] if calibration is None else ["--calibration", calibration]
    return [*(word for text in assignments or () for word in ("--set", text)), *named]


def report_written(path: Path) -> None:
    """Report a design file that was written, and that it is to be checked: by its name where that is found."""
    from pneutouch.catalogue import Library

    echo(f"\nwritten: {path}")
    known = Library.default().paths("designs").get(path.stem)
    report_next("check", path.stem if known is not None and known.resolve() == path.resolve() else path)
