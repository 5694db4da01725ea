"""The serial port of a live device, read by a thread; a device that was unplugged is opened again when it is back."""

import contextlib
import termios
import threading
import time
from typing import Any

from pneutouch.errors import InputError
from pneutouch.workflows.live.session import LiveSession

BAUD = 115_200
"""Bits a second of the sketch."""

_WAIT_S, _AGAIN_S, _ASK_S = 0.02, 0.5, 1.0
"""Longest wait for bytes, and times between two attempts to open the port again and two questions for the name."""

_FAULTS = (OSError, termios.error)
"""Errors of a port whose device goes away; those of the terminal are none of the system's in Python."""


def _pyserial() -> Any:
    """The package serial. Raises InputError without it."""
    try:
        import serial
        import serial.tools.list_ports
    except ImportError:
        remedy = "install it: pip install 'pneutouch[live]'"
        raise InputError("a live device needs the package pyserial", remedy=remedy) from None
    return serial


def ports() -> list[str]:
    """Names of the serial ports of this machine that a device is at. Raises InputError without pyserial."""
    listed = _pyserial().tools.list_ports.comports()
    return sorted(one.device for one in listed if one.vid is not None or "USB" in one.device or "ACM" in one.device)


def open_port(name: str, baud: int = BAUD) -> Any:
    """Open a port for this process alone. Raises InputError for one that is not there, busy, or not to be opened."""
    serial = _pyserial()
    try:
        return serial.Serial(name, baud, timeout=_WAIT_S, write_timeout=1.0, exclusive=True)
    except (*_FAULTS, ValueError) as error:
        known = ", ".join([*ports(), "simulated"])
        words = str(error).lower()
        problem, use = f"cannot be opened: {error}", "give another"
        if "lock" in words or "busy" in words:
            problem, use = "is in use by another program", "close that, or give another"
        elif "no such file" in words or "could not find" in words:
            problem = "is not there"
        raise InputError(problem, key="port", value=name, remedy=f"{use}: {known}") from None


class PortThread:
    """Feeds a session with what comes from a port, until it is closed."""

    def __init__(self, session: LiveSession, name: str, baud: int = BAUD) -> None:
        """Open the port and begin. Raises InputError as `open_port`."""
        self._session, self._name, self._baud = session, name, baud
        self._serial: Any = open_port(name, baud)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        asked = 0.0
        while not self._ended.is_set():
            # A board that begins anew as the port is opened does not hear the first question.
            if not self._session.is_named and time.monotonic() - asked > _ASK_S:
                asked = time.monotonic()
                self._ask()
            if self._serial is None:
                self._again()
                continue
            try:
                piece = self._serial.read(max(1, self._serial.in_waiting))
            except _FAULTS:
                self._lost()
                continue
            if piece:
                self._session.take(piece)

    def _ask(self) -> None:
        """Ask the device for its name; one that cannot be written to has none."""
        with contextlib.suppress(*_FAULTS):
            if self._serial is not None:
                self._serial.write(b"?")

    def _lost(self) -> None:
        if self._serial is not None:
            with contextlib.suppress(*_FAULTS):
                self._serial.close()
        self._serial = None
        if not self._ended.is_set():
            self._session.plugged(False)

    def _again(self) -> None:
        try:
            self._serial = open_port(self._name, self._baud)
        except InputError:
            time.sleep(_AGAIN_S)
            return
        self._session.plugged(True)

    def close(self) -> None:
        """End the thread and close the port."""
        self._ended.set()
        self._thread.join()
        self._lost()
