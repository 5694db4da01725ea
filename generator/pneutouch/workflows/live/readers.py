"""Readings of live samples: tare, drift of the zero, force of a dome, or force and place on a pad."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

from pneutouch.export.reader.pad_reading import PadForceReader, TouchReading
from pneutouch.export.reader.reading import ForceReader, ForceReading, Status

TARE_S, TARE_LEAST = 2.0, 20
"""Seconds of readings without contact that a tare takes, and least number of them: our choice, as in the sketch."""

_PAD_UNSTEADY = 4.0
"""Range of the readings of a tare of a pad over the rise from which a cell counts as touched, beyond which something
moves: that rise is four times the noise, and two hundred readings without contact have a range of six."""

TARING = "TARING"
"""Status while a tare collects readings."""

LiveReading = ForceReading | TouchReading


class LiveReader(Protocol):
    """Reader of a dome or a pad, as a live session asks it."""

    cells: int

    def tare(self, readings_kPa: Sequence[tuple[float, ...]]) -> str:
        """Take readings without contact as zero; returns the name of the status."""

    def follow(self, pressures_kPa: tuple[float, ...], seconds: float) -> None:
        """Follow the drift of the zero by a sample, ``seconds`` after the one before."""

    def read(self, pressures_kPa: tuple[float, ...]) -> LiveReading:
        """The contact at a sample."""

    def zero(self) -> tuple[tuple[float, ...], float, float]:
        """Pressures without contact now, noise at the tare, drift since; kPa, NaN where unknown."""


class DomeReader:
    """The reader of one sensor."""

    cells = 1

    def __init__(self, reader: ForceReader) -> None:
        self._reader = reader

    def tare(self, readings_kPa: Sequence[tuple[float, ...]]) -> str:
        """Take readings without contact as zero; returns the name of the status."""
        return self._reader.tare([row_kPa[0] for row_kPa in readings_kPa]).name

    def follow(self, pressures_kPa: tuple[float, ...], seconds: float) -> None:
        """Follow the drift of the zero by a sample."""
        self._reader.track(pressures_kPa[0], seconds)

    def read(self, pressures_kPa: tuple[float, ...]) -> ForceReading:
        """The force at a sample."""
        return self._reader.read(pressures_kPa[0])

    def zero(self) -> tuple[tuple[float, ...], float, float]:
        """Driving pressure, noise and drift."""
        one = self._reader
        return (one.driving_pressure_kPa,), one.noise_kPa, one.drift_kPa


class PadReader:
    """The reader of a pad, whose zeros follow the readings without contact by themselves."""

    def __init__(self, reader: PadForceReader) -> None:
        self._reader, self.cells = reader, len(reader.places)

    def tare(self, readings_kPa: Sequence[tuple[float, ...]]) -> str:
        """Take readings without contact as zero; returns the name of the status."""
        if not all(math.isfinite(one_kPa) for row_kPa in readings_kPa for one_kPa in row_kPa):
            return Status.NOT_A_NUMBER.name
        ranges_kPa = [max(cell_kPa) - min(cell_kPa) for cell_kPa in zip(*readings_kPa, strict=True)]
        if max(ranges_kPa) > _PAD_UNSTEADY * self._reader.table["touched_kPa"]:
            return Status.UNSTEADY_TARE.name
        self._reader.tare(readings_kPa)
        return Status.OK.name

    def follow(self, pressures_kPa: tuple[float, ...], seconds: float) -> None:
        """Nothing: `read` follows the zeros."""

    def read(self, pressures_kPa: tuple[float, ...]) -> TouchReading:
        """Force and place of the contact at a sample."""
        return self._reader.read(pressures_kPa)

    def zero(self) -> tuple[tuple[float, ...], float, float]:
        """Zeros of the cells, and the noise of the table."""
        return tuple(self._reader.zero_kPa), self._reader.table["noise_kPa"], math.nan


@dataclass
class Tare:
    """Readings without contact that a tare collects.

    Attributes:
        status: Name of the status of the last tare; `TARING` while readings are collected.
        held: True while they are collected until `finish`.
    """

    reader: LiveReader
    status: str = TARING
    held: bool = False
    _rows: list[tuple[float, ...]] = field(default_factory=list)
    _seconds: float = 0.0

    def begin(self, *, held: bool = False) -> None:
        """Collect readings anew; ``held``: until `finish`."""
        self.status, self._rows, self._seconds, self.held = TARING, [], 0.0, held

    def finish(self) -> str:
        """Take what was collected as zero; returns the status."""
        self.held = False
        self.status, self._rows = (self.reader.tare(self._rows) if self._rows else Status.NOT_TARED.name), []
        return self.status

    def forget(self) -> None:
        """Count the zero as unknown: the driving pressure changes."""
        self.status, self._rows, self.held = Status.NOT_TARED.name, [], False

    @property
    def runs(self) -> bool:
        """True while readings are collected."""
        return self.status == TARING

    @property
    def is_read(self) -> bool:
        """True if there is a zero, from which readings count."""
        return self.status in (Status.OK.name, Status.ABOVE_RATING.name)

    def add(self, pressures_kPa: tuple[float, ...], seconds: float) -> str:
        """Take a reading, ``seconds`` after the one before, and the tare once there are enough; returns the status."""
        self._rows.append(pressures_kPa)
        self._seconds += seconds
        if not self.held and self._seconds >= TARE_S and len(self._rows) >= TARE_LEAST:
            return self.finish()
        return self.status
