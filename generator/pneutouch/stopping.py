"""Stop signals held back while files are moved or removed, so that a stop finds them whole or not at all."""

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
    """Hold back Ctrl-C and SIGTERM until the block ends; they then take their course.

    Keep the block short. Outside the main thread, which alone receives signals in Python, nothing has to be held.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    held: list[int] = []

    def hold(number: int, frame: FrameType | None) -> None:
        held.append(number)

    # What was not set from Python can neither be restored nor raises anything.
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
    """Raise KeyboardInterrupt after a stop that a library has swallowed: its results since then may be wrong."""
    if any(getattr(signal.getsignal(number), "received", None) is not None for number in STOPS):
        raise KeyboardInterrupt


def cleaned(clean: Callable[[], object]) -> None:
    """Run a clean-up, which may run twice, so that a stop signal neither skips it nor cuts it short."""
    try:
        with uninterrupted():
            clean()
    except KeyboardInterrupt:
        clean()
        raise


@contextlib.contextmanager
def temporary_folder(*, prefix: str = "pneutouch-", within: Path | None = None) -> Iterator[Path]:
    """A new folder, in ``within`` or in the system's folder for temporary files, removed with its content at the end.

    The standard library's own loses the folder where a stop comes between its making and its noting.
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
    """Make the folders that ``path`` lies in; those made here go again where the block ends by an error."""
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
