"""Devices and sessions for tests of the live view: a sensor known in closed form, and samples of it."""

from __future__ import annotations

import contextlib
import os
import threading
import time
import tty
from collections.abc import Iterator

from pneutouch.export.reader.reading import ForceReader
from pneutouch.workflows.live.protocol import DeviceSample, sample_line
from pneutouch.workflows.live.readers import DomeReader
from pneutouch.workflows.live.session import LiveSession
from tests.export.reader.records import record

REST_kPa = 12.0


def closed_form() -> LiveSession:
    """A session with the reader of `records.record`."""
    return LiveSession(DomeReader(ForceReader(record())))


def force_at(share: float) -> float:
    """Force of that sensor at a share of its travel at 12 kPa, N."""
    return (1 + REST_kPa / 20) * share * (1 + share)


def line(number: int, share: float = 0.0, **more: float) -> bytes:
    """A sample of that sensor, ten milliseconds after the one before."""
    noise = 1e-3 * (-1) ** number
    return sample_line(DeviceSample(number, 10.0 * number, (REST_kPa + (10 + REST_kPa / 10) * share + noise,), **more))


def rest(count: int = 202, start: int = 0) -> bytes:
    """Samples without contact, enough for a tare."""
    return b"".join(line(k) for k in range(start, start + count))


def wait_for(condition) -> None:
    """Wait until a condition holds: the port is read by a thread."""
    end = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < end, "it did not come"
        time.sleep(0.01)


class Cable:
    """A device at the end of a cable: ``port`` is its name, which stays when it is plugged in again."""

    def __init__(self, port) -> None:
        self.port = port
        self.master = -1
        self.plug_in()

    def plug_in(self) -> None:
        self.master, slave = os.openpty()
        tty.setraw(slave)
        self.slave = slave
        self.port.unlink(missing_ok=True)
        self.port.symlink_to(os.ttyname(slave))

    def send(self, content: bytes) -> None:
        left = content
        while left:
            left = left[os.write(self.master, left[:1024]) :]

    def pull(self) -> None:
        self.port.unlink()
        os.close(self.slave)
        os.close(self.master)


@contextlib.contextmanager
def plugged(folder) -> Iterator[Cable]:
    cable = Cable(folder / "ttyACM0")
    try:
        yield cable
    finally:
        with contextlib.suppress(OSError):
            cable.pull()


def threads() -> int:
    return threading.active_count()
