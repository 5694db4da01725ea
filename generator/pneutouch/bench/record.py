"""Data of a run between file and figures: samples averaged into blocks of equal time, indentations, and a curve."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.errors import InputError
from pneutouch.spec.campaign import CampaignRun, ColumnMap, RunKind

SuspectKind = Literal["gap", "clipped", "spike", "note", "asked", "late", "other"]


class SuspectInterval(NamedTuple):
    """Time interval (s) of a run that may be wrong, and the reason.

    ``used``: True if its data are used nevertheless. ``kind``: a gap, a channel at the end of its range (clipped), a
    reading beyond that (spike), a usual defect (note), a doubt to ask about (asked; late: of a channel), or another."""

    start: float
    end: float
    why: str
    used: bool
    kind: SuspectKind = "other"


@dataclass(frozen=True, slots=True)
class Blocks:
    """A file's samples averaged over blocks of ``size`` samples, in the file's order; s, mm, N, MPa, arrays (n,).

    ``spread`` are standard deviations (ddof 0) within the blocks, ``extreme`` the greatest magnitude in them,
    ``first_row`` the row of the file (the header is row 1) with which each block begins. ``rate`` is the sampling rate
    of the file, Hz; ``steps`` the least changes between two of its samples of force and pressure, 0 without any;
    ``joined`` the greatest shares of a press between two readings of them that lines join, 0 without such lines;
    ``columns`` those that were read."""

    file: Path
    rate: float
    size: int
    first_row: Array
    time: Array
    position: Array
    force: Array
    pressure: Array
    force_spread: Array
    pressure_spread: Array
    force_extreme: Array
    pressure_extreme: Array
    warnings: tuple[SuspectInterval, ...] = ()
    steps: tuple[float, float] = (0.0, 0.0)
    joined: tuple[float, float] = (0.0, 0.0)
    columns: ColumnMap = field(default_factory=ColumnMap)


@dataclass(frozen=True, slots=True)
class MeasuredIndentation:
    """One indentation as read from a record. Times in s; mm, N, MPa.

    Attributes:
        contact: Time of first contact; NaN if there is none.
        hold: Begin and end of the hold.
        read: Begin and end of the stretch that was averaged: the last part of the hold.
        release: Time at which contact is lost; NaN if it is not.
        onset: Plate position at first contact of this indentation; NaN without contact.
        fitted: True if ``onset`` was fitted; else it is the median of the fitted ones.
        indentation: Plate travel to the hold from the run's first contact (`indents.EARLY`); NaN without contact.
        force: Mean over ``read`` less the mean before contact.
        rise: Mean pressure over ``read`` less the mean before contact.
        driving: Pressure before contact.
        zero_force: Force before contact.
    """

    contact: float
    hold: tuple[float, float]
    read: tuple[float, float]
    release: float
    onset: float
    fitted: bool
    indentation: float
    force: float
    rise: float
    driving: float
    zero_force: float


@dataclass(frozen=True, slots=True)
class MeasuredCurve:
    """The curve of a run: points in order of depth, from first contact; the first is the origin.

    Attributes:
        run: Entry of the run in the campaign; a kind that it leaves out is the one that the record shows.
        indentation, force, rise: Loading points, (n,) mm, N, MPa; by hand the indentation is NaN.
        driving: Pressure before contact as it was read, MPa, mean over the indentations.
        indents: The indentations behind the points.
        loop: For each cycle of a loop run: force and rise going in, force and rise coming out.
        relaxation: For a relaxation run: seconds since the hold began, force, rise.
        noise: Standard deviations of a sample of force (N) and pressure (MPa) without contact, trend taken out; NaN if
            not known.
        step_error: Standard error of a force by the steps in which it is read, N; 0 where noise covers them.
        drift: Slope of the pressure before the first contact, MPa/s, and its standard error.
        onset_error: Standard error of the place of first contact, mm; infinite if it is not known.
        at_once: True if the force rises as soon as the plate moves.
        shows: Kind of run that the plate's travel shows, whatever the campaign states.
        told: True if ``run`` has its kind from the record.
        warnings: Intervals that may be wrong.
    """

    run: CampaignRun
    indentation: Array
    force: Array
    rise: Array
    driving: float
    indents: tuple[MeasuredIndentation, ...] = ()
    loop: tuple[tuple[Array, Array, Array, Array], ...] = ()
    relaxation: tuple[Array, Array, Array] | None = None
    noise: tuple[float, float] = (float("nan"), float("nan"))
    step_error: float = 0.0
    drift: tuple[float, float] = (float("nan"), float("nan"))
    onset_error: float = float("inf")
    at_once: bool = False
    shows: RunKind = "steps"
    told: bool = False
    warnings: tuple[SuspectInterval, ...] = field(default=())

    @property
    def late(self) -> str | None:
        """Question on a channel that comes behind another; None if none does."""
        return next((warning.why for warning in self.warnings if warning.kind == "late"), None)


def stretches(mask: Flags) -> list[tuple[int, int]]:
    """Stretches of an array (n,) in which ``mask`` holds: the first place of each, and the one after its last."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(np.int8), [0]])))
    return [(int(start), int(end)) for start, end in zip(edges[::2], edges[1::2], strict=True)]


MOST = 3000
"""Greatest number of points of a trace: more than a page shows; even, because each stretch keeps two."""


class Trace(NamedTuple):
    """Thinned run, (n,): time s, position mm, force N, pressure MPa.

    Two points stand for each stretch: times and positions of its first and last block, and its least and greatest force
    and pressure, in the order in which they occur. A spike or a short clip stays visible, at most a stretch off its
    time.
    """

    time: Array
    position: Array
    force: Array
    pressure: Array


def trace(blocks: Blocks) -> Trace:
    """Trace of a run: its blocks if they are at most `MOST`, else thinned evenly to that number."""
    size = blocks.time.size
    if size <= MOST:
        return Trace(blocks.time.copy(), blocks.position.copy(), blocks.force.copy(), blocks.pressure.copy())
    edges = np.linspace(0, size, MOST // 2 + 1).astype(int)
    ends = np.stack([edges[:-1], edges[1:] - 1], axis=1).ravel()
    return Trace(blocks.time[ends], blocks.position[ends], _span(blocks.force, edges), _span(blocks.pressure, edges))


def _span(values: Array, edges: Indices) -> Array:
    """Least and greatest value of each stretch between ``edges`` (m + 1,), in the order in which they occur, (2 m,)."""
    starts = edges[:-1]
    within = np.repeat(np.arange(starts.size), np.diff(edges))
    place = np.arange(values.size)
    low, high = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    never = values.size
    first_low = np.minimum.reduceat(np.where(values == low[within], place, never), starts)
    falls = np.minimum.reduceat(np.where(values == high[within], place, never), starts) < first_low
    return np.stack([np.where(falls, high, low), np.where(falls, low, high)], axis=1).ravel()


BLOCK_RATE = 100.0
"""Blocks a second: our choice; at 5 mm/s a plate moves 0.05 mm in a block, and ten minutes are 60 000 blocks."""

SLOW = 200.0
"""Hz: a file of this rate or less keeps one sample a block; averages of one or two would gain nothing."""

MOST_BLOCKS = 400_000
"""Largest number of blocks, so that a slow file of any length stays small in memory."""

LEAST_STEP = 1e-6
"""Least time between two samples, s: our choice, below that of any converter of force or pressure."""

_MOST_LOST = 2.0**53

MISSED, GAP = 1.5, 0.1
"""Time step in sampling periods above which samples are missing, and in s above which that is listed as a gap."""

ISOLATED, RARE = 2, 1e-3
"""Most samples missing in a row, and share of the run's samples missing in all, that are only noted: our choice. No
block then loses more than a few of its samples, and its mean moves within its noise."""

_NAMES = {"time": "time", "position": "position", "force": "force", "pressure": "pressure"}
_EXTREMES = ("force_spread", "pressure_spread", "force_extreme", "pressure_extreme")
BLOCK_ARRAYS = ("first_row", "time", "position", "force", "pressure", *_EXTREMES)
"""Fields of `Blocks` in the order of the averaged rows."""

_ROUNDING, _ROUNDED = 1e-6, 1e-9
"""Share of a block by which rounding may move a time before the beginning of its block; relative difference up to which
two samples hold the same number."""


@dataclass
class BlockCollector:
    """Averages samples in internal units (s, mm, N, MPa), taken chunk by chunk, into `Blocks`.

    ``rate`` in Hz and samples a block ``size`` are found from the first chunk if None (the median step of time;
    `BLOCK_RATE`); ``total`` is about how many samples will come. ``names`` are the columns' names for messages."""

    file: Path
    rate: float | None = None
    size: int | None = None
    total: int = 0
    names: Mapping[str, str] = field(default_factory=lambda: _NAMES)
    _parts: list[Array] = field(default_factory=list)
    _held: Array = field(default_factory=lambda: np.empty((5, 0)))
    _first: float | None = None
    _last: float = 0.0
    _samples: int = 0
    _missed: list[tuple[float, float, int]] = field(default_factory=list)
    _short: list[int] = field(default_factory=lambda: [0, 0, 0])
    _steps: Array = field(default_factory=lambda: np.full(2, np.inf))

    def take(self, rows: Array, samples: Array) -> None:
        """Take samples (4, n) and their rows (n,). Raises InputError if time rises too little or not at all."""
        if not rows.size:
            return
        time = samples[0]
        self._check_time(rows, time)
        if self._first is None:
            self._first = float(time[0])
        if self.rate is None:
            if time.size < 2:
                raise InputError("1 row", file=self.file, remedy="at least 2, for a sampling rate")
            step = float(np.median(np.diff(time)))
            if step < LEAST_STEP:
                problem = f"column {self.names['time']}: rises by {step:.3g} s from row to row"
                remedy = "no instrument samples as often: is its unit right, or are they days (unit d)?"
                raise InputError(problem, file=self.file, remedy=remedy)
            self.rate = 1 / step
        if self.size is None:
            usual = 1 if self.rate <= SLOW else round(self.rate / BLOCK_RATE)
            self.size = max(usual, -(-self.total // MOST_BLOCKS))
        self._find_missed(time)
        change = np.abs(np.diff(samples[2:]))
        real = change > _ROUNDED * np.abs(samples[2:]).max(axis=1, keepdims=True)
        self._steps = np.minimum(self._steps, change.min(axis=1, initial=np.inf, where=real))
        self._samples, self._last = self._samples + time.size, float(time[-1])
        self._average(np.concatenate([self._held, np.vstack([rows, samples])], axis=1))

    def _check_time(self, rows: Array, time: Array) -> None:
        before = np.concatenate([[self._last if self._samples else -np.inf], time[:-1]])
        if (time > before).all():
            return
        at = int(np.flatnonzero(time <= before)[0])
        does = "stands still" if time[at] == before[at] else "runs backwards"
        raise InputError(
            f"row {rows[at]:.0f}: column {self.names['time']}: time {does}: {time[at]:.9g} s after {before[at]:.9g} s",
            file=self.file,
            remedy="must rise from row to row: write seconds with all decimals (or are two recordings in one file?)",
        )

    def _find_missed(self, time: Array) -> None:
        assert self.rate is not None
        period = 1 / self.rate
        joined = np.concatenate([[self._last], time]) if self._samples else time
        step = np.diff(joined)
        at = np.flatnonzero(step > MISSED * period)
        lost = np.minimum(np.round(step[at] * self.rate), _MOST_LOST).astype(int) - 1
        long = step[at] > max(GAP, MISSED * period)
        self._missed += [
            (float(joined[k]), float(joined[k + 1]), max(int(n), 1)) for k, n in zip(at[long], lost[long], strict=True)
        ]
        short = np.maximum(lost[~long], 1)
        self._short[0] += int(short.sum())
        self._short[1] += short.size
        self._short[2] = max(self._short[2], int(short.max(initial=0)))

    def _average(self, samples: Array, end: bool = False) -> None:
        """Average the blocks that are whole; the last one is held back until ``end``, as more of it may come."""
        assert self.size is not None and self.rate is not None and self._first is not None
        if self.size == 1:
            starts = np.arange(samples.shape[1])
        else:
            block = np.floor((samples[1] - self._first) * self.rate / self.size + _ROUNDING)
            starts = np.concatenate([[0], np.flatnonzero(np.diff(block)) + 1])
            if not end:
                samples, self._held, starts = samples[:, : starts[-1]], samples[:, starts[-1] :], starts[:-1]
        if not starts.size:
            return
        counts = np.diff(np.append(starts, samples.shape[1]))
        means = np.add.reduceat(samples[1:], starts, axis=1) / counts
        off = samples[3:] - np.repeat(means[2:], counts, axis=1)
        spreads = np.sqrt(np.add.reduceat(off * off, starts, axis=1) / counts)
        extremes = np.maximum.reduceat(np.abs(samples[3:]), starts, axis=1)
        self._parts.append(np.vstack([samples[:1, starts], means, spreads, extremes]))

    def blocks(self, warnings: tuple[SuspectInterval, ...] = ()) -> Blocks:
        """The blocks, with gaps as warnings. Raises InputError for no samples, or more than half of them missing."""
        if self.rate is None or self.size is None or self._first is None:
            raise InputError("no samples", file=self.file)
        if self._held.size:
            self._average(self._held, end=True)
        lost = self._short[0] + sum(count for *_, count in self._missed)
        if lost > self._samples:
            raise InputError(
                f"{self._samples} samples are there and {lost} are missing, at {self.rate:.4g} Hz: more than half",
                file=self.file,
                remedy=f"column {self.names['time']} must be that of one recording",
            )
        columns = dict(zip(BLOCK_ARRAYS, np.concatenate(self._parts, axis=1), strict=True))
        force, pressure = np.where(np.isfinite(self._steps), self._steps, 0.0).tolist()
        warned = (*self._gaps(), *warnings)
        return Blocks(self.file, self.rate, self.size, warnings=warned, steps=(force, pressure), **columns)

    def _gaps(self) -> list[SuspectInterval]:
        warnings = [
            SuspectInterval(start, end, f"gap: {count} samples missing", False, "gap")
            for start, end, count in self._missed
        ]
        count, times, longest = self._short
        if count:
            why = f"{count} of {self._samples + count} samples missed, in {times} places of at most {GAP:g} s"
            rare = longest <= ISOLATED and count < RARE * (self._samples + count)
            warnings.append(SuspectInterval(self._first or 0.0, self._last, why, True, "note" if rare else "other"))
        return warnings
