"""Running the command line inside the process of the tests, and building what several tests read once for all workers."""

from __future__ import annotations

import contextlib
import fcntl
import io
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from unittest import mock

import pytest


@contextlib.contextmanager
def captured() -> Iterator[tuple[io.BytesIO, io.BytesIO]]:
    """The bytes that ``sys.stdout`` and ``sys.stderr`` take, neither of them a terminal."""
    out, err = io.BytesIO(), io.BytesIO()
    # As Python sets its own: what stderr cannot encode is written with a backslash.
    texts = [
        io.TextIOWrapper(stream, encoding="utf-8", errors=errors, write_through=True)
        for stream, errors in ((out, "strict"), (err, "backslashreplace"))
    ]
    with contextlib.redirect_stdout(texts[0]), contextlib.redirect_stderr(texts[1]):
        yield out, err
    for text in texts:
        text.detach()


class _Terminal(io.TextIOWrapper):
    """A stream that states that it is a terminal."""

    def isatty(self) -> bool:
        return True


@contextlib.contextmanager
def captured_together(kind: type[io.TextIOWrapper] = io.TextIOWrapper) -> Iterator[io.BytesIO]:
    """The bytes that ``sys.stdout`` and ``sys.stderr`` take in the order of their writing."""
    out = io.BytesIO()
    text = kind(out, encoding="utf-8", errors="backslashreplace", write_through=True)
    with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
        yield out
    text.detach()


def on_a_terminal(words: Sequence[str], folder: Path, columns: int) -> tuple[int, str]:
    """Exit code of ``pneutouch WORDS`` in this process, and what a terminal keeps: lines fitted to it, and no bar."""
    from pneutouch.cli import command_line, terminal
    from pneutouch.cli.stop import stop_signals

    with (
        contextlib.chdir(folder),
        mock.patch.object(sys, "argv", ["pneutouch", *words]),
        mock.patch.dict(os.environ, {"COLUMNS": str(columns), "NO_COLOR": "1"}),
        # A bar is gone from a terminal when its stage is done.
        mock.patch.object(terminal, "_moves", lambda: False),
        mock.patch.object(terminal, "_lines", lambda what: lambda done, total, what=None: None),
        captured_together(_Terminal) as out,
        stop_signals() as stop,
    ):
        code = command_line(stop)
    return code, out.getvalue().decode()


def in_process(words: Sequence[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """Run ``pneutouch WORDS`` in ``folder`` in this process: the same entry point, without the imports of a new one."""
    from pneutouch.cli import command_line
    from pneutouch.cli.stop import stop_signals

    with (
        contextlib.chdir(folder),
        mock.patch.object(sys, "argv", ["pneutouch", *words]),
        mock.patch.dict(os.environ, {"COLUMNS": "200"}),
        captured() as (out, err),
        stop_signals() as stop,
    ):
        code = command_line(stop)
    return subprocess.CompletedProcess(words, code, out.getvalue().decode(), err.getvalue().decode())


def in_new_process(
    words: Sequence[str], folder: Path, environment: dict[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """Run ``pneutouch WORDS`` in ``folder`` as a user does."""
    return subprocess.run(
        [sys.executable, "-m", "pneutouch", *words],
        cwd=folder,
        env={**os.environ, "COLUMNS": "200", **(environment or {})},
        capture_output=True,
        text=True,
        check=False,
    )


class Shared:
    """Folders that are filled once in a run of the tests, whichever worker of pytest-xdist asks first."""

    def __init__(self, factory: pytest.TempPathFactory) -> None:
        base = factory.getbasetemp()
        self._root = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "shared"

    def folder(self, name: str, fill: Callable[[Path], object]) -> Path:
        """The folder ``name``; ``fill`` is called with an empty one where no worker has filled it yet."""
        self._root.mkdir(exist_ok=True)
        target = self._root / name
        with (self._root / f"{name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not target.exists():
                fresh = Path(tempfile.mkdtemp(dir=self._root))
                try:
                    fill(fresh)
                except BaseException:
                    shutil.rmtree(fresh)
                    raise
                fresh.rename(target)
        return target


@contextlib.contextmanager
def files_of_at_most(size):
    """No file can grow beyond ``size`` bytes within the block, as on a disk that is full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
