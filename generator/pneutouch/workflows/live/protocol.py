"""Lines of a live device, one a sample, with version and checksum; what is damaged is counted and left out.

``P1,NUMBER,MS,pKPA[,pKPA...][,fN][,zMM]*CRC``: number of the sample and the device's milliseconds, both of 32 bits,
which may turn over; then values by letter: gauge pressure of a cell (p, in the order of the cells), force of a force
sensor beside it (f), travel of the stage (z). Values with other letters are left out, so that devices may send more.
``#P1,NAME,CELLS*CRC`` answers a question mark; lines that begin with a hash and a space are for people. The checksum is
CRC-16/CCITT-FALSE of all before the star. The time of the samples is steady where the counters jump or begin anew.
"""

import binascii
import math
import statistics
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

VERSION = "P1"

COMMENT = b"# "
"""Beginning of a line for people, which is left out."""

TURN = 1 << 32
"""Number at which a device's counters turn over."""

_LONGEST = 4096
"""Greatest length of a line in bytes: what comes without an end is no line."""


class DeviceSample(NamedTuple):
    """A sample: its number and time in the device's counters, pressure of every cell; NaN where nothing was read."""

    number: int
    time_ms: float
    pressures_kPa: tuple[float, ...]
    force_N: float = math.nan
    position_mm: float = math.nan


class DeviceName(NamedTuple):
    """Name of the reader that a device was made for, and its number of cells."""

    name: str
    cells: int


def checked(text: str) -> bytes:
    """A line with its checksum and its end."""
    body = text.encode("ascii")
    return b"%s*%04X\n" % (body, binascii.crc_hqx(body, 0xFFFF))


def sample_line(sample: DeviceSample) -> bytes:
    """The line of a sample."""
    values = [f"p{one_kPa:.4f}" for one_kPa in sample.pressures_kPa]
    values += [f"{key}{one:.4f}" for key, one in zip("fz", sample[3:], strict=True) if not math.isnan(one)]
    return checked(f"{VERSION},{sample.number % TURN},{round(sample.time_ms) % TURN},{','.join(values)}")


def name_line(name: DeviceName) -> bytes:
    """The line that names a device."""
    return checked(f"#{VERSION},{name.name},{name.cells}")


@dataclass
class LineReader:
    """Lines from bytes as they come, in pieces of any length.

    Attributes:
        received: Number of bytes so far.
        damaged: Number of lines with a wrong checksum or content; the first one may begin in the middle.
        other: Beginning of what came last and is no line of this protocol.
    """

    received: int = 0
    damaged: int = 0
    other: bytes = b""
    _rest: bytes = field(default=b"", repr=False)
    _begun: bool = field(default=False, repr=False)

    def feed(self, piece: bytes) -> Iterator[DeviceSample | DeviceName]:
        """The samples and names that are whole with this piece."""
        self.received += len(piece)
        *lines, self._rest = (self._rest + piece).split(b"\n")
        if len(self._rest) > _LONGEST:
            lines, self._rest = [*lines, self._rest], b""
        for line in lines:
            known = _parsed(line.removesuffix(b"\r"))
            if known is not None:
                yield known
            elif self._begun and line.strip() and not line.startswith(COMMENT):
                self.damaged += 1
                self.other = line[:40]
            self._begun = True

    def forget(self) -> None:
        """Forget half a line: the device was unplugged."""
        self._rest, self._begun = b"", False


def _parsed(line: bytes) -> DeviceSample | DeviceName | None:
    body, star, check = line.rpartition(b"*")
    if not star or len(line) > _LONGEST or check != b"%04X" % binascii.crc_hqx(body, 0xFFFF):
        return None
    try:
        head, *values = body.decode("ascii").split(",")
        if head == f"#{VERSION}":
            return DeviceName(values[0][:120], int(values[1]))
        if head != VERSION:
            return None
        number, time_ms = int(values[0]), float(values[1])
        cells, more = [], {}
        for one in values[2:]:
            if one[0] == "p":
                cells.append(_number(one[1:]))
            else:
                more[one[0]] = _number(one[1:])
        if not cells or not 0 <= number < TURN or not 0.0 <= time_ms < TURN:
            return None
        return DeviceSample(number, time_ms, tuple(cells), more.get("f", math.nan), more.get("z", math.nan))
    except (ValueError, IndexError):
        return None


def _number(text: str) -> float:
    """A number; what a board prints for one that it cannot write, ``ovf`` or ``inf``, is none."""
    try:
        value = float(text)
    except ValueError:
        if text != "ovf":
            raise
        return math.nan
    return value if math.isfinite(value) else math.nan


_STEPS = 64
"""Number of last steps whose median is the usual one."""

_JUMP_MS, _TIMES = 500.0, 20.0
"""Least step that may be a jump of the clock, and least multiple of the usual one: our choice."""

_LEAST_MS = 0.01
"""Least step between two samples."""

_FIRST_MS = 10.0
"""Step that stands for the usual one before there is any."""


@dataclass
class DeviceClock:
    """Seconds since the first sample, by the device's own clock, ascending.

    Attributes:
        lost: Number of samples that were sent and did not arrive.
        said: Called with a sentence for each time the device began anew or its clock jumped.
    """

    said: Callable[[str], None]
    lost: int = 0
    seconds: float = 0.0
    _true: float = 0.0
    _was_away: bool = False
    _last: DeviceSample | None = None
    _steps: deque[float] = field(default_factory=lambda: deque(maxlen=_STEPS))

    @property
    def usual_ms(self) -> float:
        """Usual step between two samples; the mean where most are within one tick of the clock."""
        if not self._steps:
            return _FIRST_MS
        return statistics.median(self._steps) or max(statistics.fmean(self._steps), _LEAST_MS)

    @property
    def rate_Hz(self) -> float | None:
        """Samples a second; None before there are any."""
        return 1e3 / max(statistics.fmean(self._steps), _LEAST_MS) if self._steps else None

    def away(self) -> None:
        """Note that the device was unplugged: its counters mean nothing to those before."""
        self._was_away = True

    def step(self, sample: DeviceSample, waited_s: float) -> float:
        """Seconds from the sample before to this one; ``waited_s`` passed on this machine, which counts where the
        device began anew."""
        last, self._last = self._last, sample
        if last is None:
            return 0.0
        count = (sample.number - last.number) % TURN
        moved_ms = (sample.time_ms - last.time_ms) % TURN
        if self._was_away or count == 0 or count > TURN // 2:
            self.said("the device was away" if self._was_away else "the device began anew: its counter went back")
            self._was_away = False
            seconds = max(waited_s, 1e-3 * self.usual_ms)
        elif moved_ms > TURN / 2 or (moved_ms > _JUMP_MS and moved_ms > self._most(count, waited_s)):
            self.said("the clock of the device jumped: time goes on by its usual step")
            self.lost += count - 1
            seconds = 1e-3 * count * self.usual_ms
        else:
            self.lost += count - 1
            self._steps.append(moved_ms / count)
            seconds = 1e-3 * moved_ms
        self._true += seconds
        # Samples within one tick of the device's clock come one after the other.
        step = max(self._true - self.seconds, 1e-3 * _LEAST_MS)
        self.seconds += step
        return step

    def _most(self, count: int, waited_s: float) -> float:
        """Greatest step of the clock over ``count`` samples, ms: a pause of the device is one here too."""
        return max(_JUMP_MS + 2e3 * waited_s, _TIMES * count * self.usual_ms)
