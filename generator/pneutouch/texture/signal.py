"""A pressure signal sampled at equal time steps, and its decimation.

A measured signal is read from a CSV or parquet file with times in s and pressures in kPa.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.tables.read import whole
from pneutouch.units import KPA

OVERSAMPLING = 5.0
"""Least sampling rate that is kept, over the highest target frequency."""

_PASSED = 1.6
"""Highest frequency passed, over the highest target frequency: the Morse response (3, 60) has fallen to 2e-5 there."""

_STOP_DB = 100.0
"""Attenuation in dB of the part that is aliased, and of the ripple in the pass band: 1e-5 of the amplitude."""

MOST = 1e6 * KPA
"""Greatest plausible pressure, MPa: a million kPa."""

_OFF = 0.25
"""Greatest deviation of a time from the even grid, in steps, that is ascribed to rounding and not to a lost sample."""


@dataclass(frozen=True, slots=True)
class Signal:
    """Pressure in MPa gauge, (n,), sampled every ``step`` s from ``start`` s."""

    start: float
    step: float
    pressure: Array

    @property
    def rate(self) -> float:
        """Samples a second, Hz."""
        return 1 / self.step

    @property
    def time(self) -> Array:
        """Times in s, (n,)."""
        return np.asarray(self.start + self.step * np.arange(len(self.pressure)), float)

    @property
    def duration(self) -> float:
        """Time from the first sample to the last, s."""
        return self.step * (len(self.pressure) - 1)


def signal(time: Array, pressure: Array, where: str = "signal", rows: Sequence[int] | None = None) -> Signal:
    """Signal from times in s and pressures in MPa, (n,) each.

    ``where`` names the source, ``rows`` (n,) its rows in messages; if None, rows count from 1. Raises InputError for
    fewer than 4 rows, values that are not finite or no pressure, and times that do not rise evenly.
    """
    numbers = range(1, len(time) + 1) if rows is None else rows
    if len(time) != len(pressure):
        raise InputError(f"{len(time)} times and {len(pressure)} pressures", file=where, remedy="must be as many")
    if len(time) < 4:
        raise InputError(f"{len(time)} rows", file=where, remedy="a signal needs at least 4")
    for name, values, unit in (("time_s", time, 1.0), ("pressure_kPa", pressure, KPA)):
        wrong = np.flatnonzero(~np.isfinite(values))
        if wrong.size:
            at = int(wrong[0])
            raise InputError(
                f"row {numbers[at]}: {name} = {values[at] / unit:g}", file=where, remedy="must be a finite number"
            )
    far = np.flatnonzero(np.abs(pressure) > MOST)
    if far.size:
        at = int(far[0])
        raise InputError(
            f"row {numbers[at]}: pressure_kPa = {pressure[at] / KPA:g}", file=where, remedy="is this in kPa?"
        )
    _check_steps(time, where, numbers)
    return Signal(float(time[0]), float(time[-1] - time[0]) / (len(time) - 1), np.asarray(pressure, float))


def _check_steps(time: Array, where: str, rows: Sequence[int]) -> None:
    steps = np.diff(time)
    usual = float(np.median(steps))
    back = np.flatnonzero(steps <= 0)
    if back.size:
        at = int(back[0]) + 1
        raise InputError(
            f"row {rows[at]}: time_s = {time[at]:.9g} after {time[at - 1]:.9g}",
            file=where,
            remedy="time must run forwards",
        )
    gap = np.flatnonzero(steps > (1 + 2 * _OFF) * usual * (1 + 1e-6))
    if gap.size:
        at = int(gap[0]) + 1
        raise InputError(
            f"row {rows[at]}: time_s = {time[at]:.9g} after {time[at - 1]:.9g}: a gap of {steps[at - 1]:.6g} "
            f"s where steps are {usual:.6g} s",
            file=where,
            remedy="fill it, or give the longer piece alone",
        )
    even = np.linspace(time[0], time[-1], len(time))
    off = np.abs(time - even)
    at = int(np.argmax(off))
    if off[at] > _OFF * float(steps.mean()) * (1 + 1e-6):
        raise InputError(
            f"row {rows[at]}: time_s = {time[at]:.9g} where even steps of {steps.mean():.6g} s would have "
            f"{even[at]:.9g}",
            file=where,
            remedy="resample the signal to even steps",
        )


def decimated(given: Signal, highest: float) -> Signal:
    """Signal with every q-th sample, without aliases; q is the largest that keeps a rate of `OVERSAMPLING` x
    ``highest`` Hz.

    A Kaiser low-pass without delay, evaluated only at the samples kept (polyphase), with mirrored ends: up to 1.6
    ``highest`` it keeps amplitudes within 1e-5. If q is 1, the signal itself.
    """
    from scipy.signal import firwin, kaiser_beta, upfirdn

    factor = math.floor(given.rate / (OVERSAMPLING * highest) * (1 + 1e-9))
    if factor < 2:
        return given
    rate = given.rate / factor
    stop = rate - _PASSED * highest
    # Kaiser's estimate of the length; half of it is a multiple of the factor: kept samples fall on filter outputs.
    length = (_STOP_DB - 7.95) / (2.285 * 2 * math.pi * (stop - _PASSED * highest) / given.rate)
    blocks = math.ceil(length / 2 / factor)
    half = blocks * factor
    taps = firwin(2 * half + 1, (stop + _PASSED * highest) / 2, window=("kaiser", kaiser_beta(_STOP_DB)), fs=given.rate)
    mean = given.pressure.mean()
    padded = np.pad(given.pressure - mean, half, mode="reflect")
    kept = (len(given.pressure) - 1) // factor + 1
    filtered = upfirdn(taps, padded, 1, factor)[2 * blocks : 2 * blocks + kept]
    return Signal(given.start, given.step * factor, np.asarray(filtered + mean, float))


@dataclass(frozen=True, slots=True)
class RecordColumns:
    """Names of the columns in the file's header; their units are s and kPa gauge, whatever the names."""

    time_s: str = "time_s"
    pressure_kPa: str = "pressure_kPa"


def read_signal(path: Path, columns: RecordColumns = RecordColumns()) -> Signal:
    """Signal in a file; other columns are ignored.

    Raises InputError as `tables.read.chunks` and `signal`, and if one column is named for both time and pressure.
    """
    names = columns.time_s, columns.pressure_kPa
    if names[0] == names[1]:
        problem = "declared for both time and pressure"
        raise InputError(problem, file=path, key=f"column {names[0]}", remedy="must be two columns")
    rows, (time, pressure_kPa) = whole(path, names)
    return signal(time, pressure_kPa * KPA, str(path), [int(row) for row in rows])
