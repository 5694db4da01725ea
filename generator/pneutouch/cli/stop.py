"""Ctrl-C and SIGTERM: the command unwinds, which removes half written files, and ends with one line."""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.machinery import ExtensionFileLoader
from types import FrameType
from typing import Any

from pneutouch.stopping import STOPS

_AGAIN = 0.25
"""Seconds after which a stop is raised again: libraries swallow it in callbacks and by catching every exception."""


class StopSignals:
    """The handler of stop signals; it keeps the first in ``received``, for a library may swallow the exception."""

    def __init__(self) -> None:
        self.received: int | None = None
        self.notes: list[str] = []

    def __call__(self, number: int, frame: FrameType | None) -> None:
        """Raise KeyboardInterrupt where the program stands; a little later where a library is being loaded."""
        if self.received is None and number in STOPS:
            self.received = number
            signal.setitimer(signal.ITIMER_REAL, _AGAIN, _AGAIN)
        if not _loads_library(frame):
            raise KeyboardInterrupt

    def end(self) -> None:
        """End the timer that raises the stop again: the command has unwound."""
        signal.setitimer(signal.ITIMER_REAL, 0)

    def unraisable(self, fault: Any) -> None:
        """Replacement of ``sys.unraisablehook``: a stop that cannot be raised where it came is raised again later."""
        if self.received is None:
            sys.__unraisablehook__(fault)

    @property
    def exit_code(self) -> int:
        """Exit code of the command: 130 after Ctrl-C, 143 after SIGTERM."""
        return 128 + (self.received or 0)

    @property
    def line(self) -> str:
        """Text that names the signal that stopped the command, with the notes that the library added."""
        by = "stopped by Ctrl-C" if self.received == signal.SIGINT else "stopped by SIGTERM"
        return "; ".join([by, *self.notes])


def _loads_library(frame: FrameType | None) -> bool:
    """True while a compiled library is being loaded; manifold3d ends the process if Python raises in the middle."""
    while frame is not None:
        if isinstance(frame.f_locals.get("self"), ExtensionFileLoader):
            return True
        frame = frame.f_back
    return False


@contextmanager
def stop_signals(after: Any = None) -> Iterator[StopSignals]:
    """Handle the stop signals until the block ends; one that is ignored, as under nohup, stays ignored.

    ``after`` handles them from then on; None: the handlers that were there before. With it, the process is to end: what
    a pool of processes that was cut short cannot do at its exit (CPython's wakes a closed pipe) stays unsaid.
    """
    stop = StopSignals()
    numbers = [number for number in (*STOPS, signal.SIGALRM) if signal.getsignal(number) is not signal.SIG_IGN]
    before = {number: signal.signal(number, stop) for number in numbers}
    hook, sys.unraisablehook = sys.unraisablehook, stop.unraisable
    try:
        yield stop
    finally:
        stop.end()
        for number, handler in before.items():
            signal.signal(number, after or handler)
        sys.unraisablehook = hook if after is None or stop.received is None else stop.unraisable


def stopped() -> StopSignals | None:
    """The handler of the stop signals if one was received, else None."""
    handler = signal.getsignal(signal.SIGTERM)
    return handler if isinstance(handler, StopSignals) and handler.received is not None else None
