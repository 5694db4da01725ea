"""Stop signals held back while files are moved or removed, so that a stop leaves no file or folder half done."""

import contextlib
import shutil
import signal
import tempfile
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType

STOPS = (signal.SIGINT, signal.SIGTERM)
"""Signals by which a user or a system ends a command."""


@contextlib.contextmanager
def uninterrupted() -> Iterator[None]:
    """Hold back Ctrl-C, SIGTERM and SIGALRM while the block runs, then deliver the first one that came.

    Only signals with a Python handler are held, and only in the main thread, which alone receives them. Keep it short.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    held: list[int] = []

    def hold(number: int, frame: FrameType | None) -> None:
        held.append(number)

    # A handler that was not set from Python cannot be restored, and it raises no exception in the block.
    before = {number: handler for number in (*STOPS, signal.SIGALRM) if callable(handler := signal.getsignal(number))}
    try:
        for number in before:
            signal.signal(number, hold)
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if held:
            signal.raise_signal(held[0])


def refuse_stopped() -> None:
    """Raise KeyboardInterrupt if the command line got a stop that a library swallowed: its results may be wrong."""
    if any(getattr(signal.getsignal(number), "received", None) is not None for number in STOPS):
        raise KeyboardInterrupt


def cleaned(clean: Callable[[], object]) -> None:
    """Run ``clean`` so that a stop signal neither skips it nor cuts it short; after a stop it runs a second time."""
    try:
        with uninterrupted():
            clean()
    except KeyboardInterrupt:
        clean()
        raise


@contextlib.contextmanager
def temporary_folder(*, prefix: str = "pneutouch-", within: Path | None = None) -> Iterator[Path]:
    """A new folder in ``within`` (None: the system's temporary folder), removed with its content after the block.

    `tempfile.TemporaryDirectory` leaves the folder behind if a stop signal comes just after its creation.
    """
    folder: Path | None = None

    def remove() -> None:
        if folder is not None:
            shutil.rmtree(folder, ignore_errors=True)

    try:
        with uninterrupted():
            folder = Path(tempfile.mkdtemp(prefix=prefix, dir=within))
        yield folder
    finally:
        cleaned(remove)


@contextlib.contextmanager
def parent_folders(path: Path) -> Iterator[None]:
    """Make the folders that contain ``path``; if the block raises, those made here are removed again if empty."""
    made = [folder for folder in path.absolute().parents if not folder.exists()]

    def remove() -> None:
        for folder in made:
            with contextlib.suppress(OSError):
                folder.rmdir()

    try:
        path.absolute().parent.mkdir(parents=True, exist_ok=True)
        yield
    except BaseException:
        cleaned(remove)
        raise
