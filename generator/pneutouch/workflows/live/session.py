"""A live session: samples of a device become readings, and a recording; events are noted."""

import math
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from pneutouch.export.reader.reading import ForceReading
from pneutouch.results.live import LiveState
from pneutouch.workflows.live.protocol import DeviceClock, DeviceName, DeviceSample, LineReader
from pneutouch.workflows.live.readers import TARING, LiveReader, LiveReading, Tare
from pneutouch.workflows.live.recording import Recording

KEPT_S = 30.0
"""Seconds of samples that are kept to be shown."""

_MOST_KEPT = 60_000
_MOST_SAID = 8
_SILENT_S = 1.0
_RECENT = 500
"""Number of last samples by which it is known what the device sends."""

_FOREIGN = 200
"""Bytes without a line of the protocol from which a device counts as one that sends something else."""


class LivePoint(NamedTuple):
    """A sample with its number since the session began, its time in s, and what was read from it; None: nothing yet."""

    number: int
    time_s: float
    sample: DeviceSample
    reading: LiveReading | None


class LiveSession:
    """Takes bytes of a device as they come. Its methods may be called from any thread.

    ``each`` makes a reading of every sample; without it `newest` reads the last one alone, as is best for a pad.
    """

    def __init__(self, reader: LiveReader, *, each: bool = True) -> None:
        self._reader, self._each, self._lock = reader, each, threading.RLock()
        self._lines, self._clock = LineReader(), DeviceClock(self.say)
        self._points: deque[LivePoint] = deque(maxlen=_MOST_KEPT)
        self._said: deque[str] = deque(maxlen=_MOST_SAID)
        self._tare = Tare(reader)
        self._device: DeviceName | None = None
        self._recording: Recording | None = None
        self._recorded_from: int | None = None
        self._status, self._arrived, self._unplugged = "", time.monotonic(), False
        self._step: Callable[[float], tuple[str, float]] | None = None
        self._zero: Callable[[float], bool] | None = None
        self.samples, self.greatest_force_N = 0, math.nan
        self.failure: OSError | None = None

    def say(self, words: str) -> None:
        """Note an event, with its time."""
        with self._lock:
            self._said.append(f"{self._clock.seconds:.1f} s: {words}")

    def take(self, piece: bytes) -> None:
        """Take bytes from the device."""
        with self._lock:
            damaged = self._lines.damaged
            for item in self._lines.feed(piece):
                if isinstance(item, DeviceName):
                    if item != self._device:
                        self.say(f"the device is made for {item.name}")
                    self._device = item
                else:
                    self._add(item)
            if self._lines.damaged > damaged and self.samples:
                self.say(f"{self._lines.damaged - damaged} damaged lines left out")

    def _add(self, sample: DeviceSample) -> None:
        if len(sample.pressures_kPa) != self._reader.cells:
            self._lines.damaged += 1
            self._lines.other = f"{len(sample.pressures_kPa)} pressures, not {self._reader.cells}".encode()
            return
        now = time.monotonic()
        lost = self._clock.lost
        seconds = self._clock.step(sample, now - self._arrived)
        if self._clock.lost > lost:
            self.say(f"{self._clock.lost - lost} samples lost")
        self._arrived, self.samples = now, self.samples + 1
        reading = self._taken(sample, seconds)
        self._points.append(LivePoint(self.samples, self._clock.seconds, sample, reading))
        while self._points[-1].time_s - self._points[0].time_s > KEPT_S:
            self._points.popleft()
        self._record(sample, seconds)

    def _taken(self, sample: DeviceSample, seconds: float) -> LiveReading | None:
        """The reading of a sample, or None while it is one of a tare, without a zero, or left to `newest`."""
        if self._zero is not None and self._recording is not None and self._recorded_from is None:
            self._zero_of_run(self._zero(self._recording.seconds))
        if self._tare.runs:
            self._status = self._tare.add(sample.pressures_kPa, seconds)
            if self._status != TARING:
                self.say(f"tare: {self._status}")
        elif not self._tare.is_read:
            self._status = self._tare.status
        elif self._each:
            if seconds > 0.0:
                self._reader.follow(sample.pressures_kPa, seconds)
            return self._read(sample)
        return None

    def _zero_of_run(self, is_due: bool) -> None:
        """Take the zero anew while the run's rest ends; its driving pressure was set again."""
        if is_due and not self._tare.runs:
            self._tare.begin(held=True)
        elif not is_due and self._tare.held:
            self._status = self._tare.finish()

    def _read(self, sample: DeviceSample) -> LiveReading:
        reading = self._reader.read(sample.pressures_kPa)
        self._status = reading.status.name if isinstance(reading, ForceReading) else reading.kind
        self.greatest_force_N = max(reading.force_N, self.greatest_force_N, key=_or_less)
        return reading

    def _record(self, sample: DeviceSample, seconds: float) -> None:
        if self._recording is None or (self._recorded_from is not None and sample.number < self._recorded_from):
            return
        self._recorded_from = None
        try:
            self._recording.add(sample, seconds)
        except OSError as error:
            self._fail(error)

    def _fail(self, error: OSError) -> None:
        """End a recording that cannot be written; what is on the disk stays, and the command ends with the words of the
        system."""
        if self._recording is not None:
            self._recording.abandon()
        self.failure, self._recording = error, None
        self.walk(None)
        self.say(f"the recording ended: {error.strerror}")

    def newest(self) -> LivePoint | None:
        """The last sample with its reading; None before the first."""
        with self._lock:
            if not self._points:
                return None
            point = self._points[-1]
            if not self._tare.is_read:
                return point
            return point if point.reading is not None else point._replace(reading=self._read(point.sample))

    def since(self, number: int) -> list[LivePoint]:
        """The kept samples after the one of a number, oldest first."""
        with self._lock:
            first = self._points[0].number if self._points else 0
            skipped = max(number + 1 - first, 0)
            return [self._points[k] for k in range(skipped, len(self._points))]

    def tare(self) -> None:
        """Take the zero anew from the next seconds, without contact."""
        with self._lock:
            self._tare.begin()

    @property
    def is_named(self) -> bool:
        """True if the device said for which design it was made."""
        return self._device is not None

    @property
    def tared(self) -> bool:
        """True if there is a zero."""
        return self._tare.is_read

    def record(self, recording: Recording, first: int | None = None) -> None:
        """Record from the next sample on, or from that of the device's number ``first``. Raises InputError as
        `Recording.check`."""
        recording.check()
        with self._lock:
            recent = [one.sample for one in list(self._points)[-_RECENT:]]
            recording.beside = (
                any(not math.isnan(one.position_mm) for one in recent),
                any(not math.isnan(one.force_N) for one in recent),
            )
            self._recording, self._recorded_from = recording, first

    def recorded(self) -> float:
        """Seconds that are recorded so far."""
        return 0.0 if self._recording is None else self._recording.seconds

    def is_full(self) -> bool:
        """True if the recording has its length."""
        return self._recording is not None and self._recording.full

    def stop_recording(self) -> Recording | None:
        """End the recording, which the caller closes; None without one."""
        with self._lock:
            recording, self._recording = self._recording, None
            return recording

    def walk(
        self, step: Callable[[float], tuple[str, float]] | None, zero: Callable[[float], bool] | None = None
    ) -> None:
        """Show the steps of a run by the seconds that are recorded: the step and what is left of it. The zero is taken
        anew where ``zero`` is true; until then it is unknown."""
        with self._lock:
            self._step, self._zero = step, zero
            if zero is not None or self._tare.held:
                self._tare.forget()

    def plugged(self, is_plugged: bool) -> None:
        """Note that the device was unplugged, or is there again."""
        with self._lock:
            if self._unplugged == is_plugged:
                self._lines.forget()
                self._clock.away()
                self.say("the device is there again" if is_plugged else "the device was unplugged")
            self._unplugged = not is_plugged
            if self._recording is not None and not is_plugged:
                try:
                    self._recording.flush()
                except OSError as error:
                    self._fail(error)

    @property
    def link(self) -> str:
        """Link to the device, as `LiveState.link`."""
        if self._unplugged:
            return "unplugged"
        late = time.monotonic() - self._arrived > _SILENT_S
        if self.samples and not late:
            return "reading"
        if late and self._lines.received > _FOREIGN and not self.samples:
            return "foreign"
        return "silent" if late else "waiting"

    @property
    def heard(self) -> bytes:
        """Beginning of what the device sends in place of lines of the protocol."""
        return self._lines.other

    @property
    def state(self) -> LiveState:
        """State of the device, the reader and the recording now."""
        with self._lock:
            zeros, noise_kPa, drift_kPa = self._reader.zero()
            known = [None if math.isnan(one) else one for one in (*zeros, noise_kPa, drift_kPa)]
            step, left_s = ("", 0.0) if self._step is None else self._step(self.recorded())
            return LiveState(
                device=None if self._device is None else self._device.name,
                link=self.link,
                status=self._status or "NOT_TARED",
                driving_pressures_kPa=tuple(known[:-2]) if self._tare.is_read else (None,) * len(zeros),
                noise_kPa=known[-2] if self._tare.is_read else None,
                drift_kPa=known[-1] if self._tare.is_read else None,
                rate_Hz=self._clock.rate_Hz,
                samples=self.samples,
                lost=self._clock.lost,
                damaged=self._lines.damaged,
                recording=None if self._recording is None else str(self._recording.path),
                recorded_s=self.recorded(),
                step=step,
                step_left_s=left_s,
                said=tuple(self._said),
            )

    @property
    def seconds(self) -> float:
        """Time from the first sample to the last, by the device's clock."""
        return self._clock.seconds


def _or_less(value: float) -> float:
    return -math.inf if math.isnan(value) else value
