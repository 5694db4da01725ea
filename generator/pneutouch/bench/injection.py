"""Runs without a plate: air pushed into the closed line, and the line left to itself."""

import math
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.reading import scaled
from pneutouch.bench.record import Blocks
from pneutouch.bench.source import MeasuredFile
from pneutouch.bench.statistics import Mean
from pneutouch.errors import InputError
from pneutouch.tables.read import whole

LEAST_POINTS = 3

INJECTION = ("volume", "pressure")
"""Channels of an injection run."""

_LEAST_BLOCKS = 10
_BATCHES = 10
"""Parts of a leak run whose means give the slope's error: correlated noise would make it too small."""

_ABSOLUTE = 0.7
"""Share of the ambient pressure above which a table that begins there is taken for one of absolute pressures."""


def read_injection(source: MeasuredFile) -> tuple[Array, Array]:
    """Injected volume (mm3, at ambient pressure) and gauge pressure (MPa), (n,) each, in the file's order.

    Raises InputError as `tables.read.chunks`, for fewer than three rows, a volume that does not vary, and a
    pressure that does not rise with it.
    """
    path, columns = source.path, source.columns
    rows, values = whole(path, [getattr(columns, key).name for key in INJECTION], source.layout)
    volume, pressure = scaled(path, columns, INJECTION, rows, values)
    if rows.size < LEAST_POINTS:
        raise InputError(f"{rows.size} rows", file=path, remedy=f"at least {LEAST_POINTS}, for a line and its error")
    if np.ptp(volume) <= 0:
        raise InputError(
            f"column {columns.volume.name}: does not vary",
            file=path,
            remedy="must be the volumes injected one after another",
        )
    if np.ptp(pressure) <= 0 or float(np.corrcoef(volume, pressure)[0, 1]) <= 0:
        raise InputError(
            f"column {columns.pressure.name}: does not rise with {columns.volume.name}",
            file=path,
            remedy="are the columns swapped, or a sign wrong (columns.volume.sign)?",
        )
    return volume, pressure


def dead_volume_of_cap(volume: Array, pressure: Array, ambient: float) -> Mean:
    """Volume behind a rigid cap, mm3, from injected volumes (mm3, at ambient pressure) and gauge pressures (MPa).

    Boyle: pressure = pressure_0 + ambient / V volume, by least squares with both free (a gauge's zero, or a first push
    that was lost, does not matter). ``value`` is V, ``spread`` its standard error (count 1). Raises ValueError for
    fewer than three points and where the pressure does not rise."""
    if volume.size < LEAST_POINTS:
        raise ValueError(f"{volume.size} points of injected volume; at least {LEAST_POINTS}")
    centred = volume - volume.mean()
    square = float(centred @ centred)
    slope = float(centred @ pressure) / square if square > 0 else 0.0
    if slope <= 0:
        raise ValueError("the pressure must rise with the injected volume")
    if float(pressure.min()) > _ABSOLUTE * ambient and float(pressure.min()) < 2 * ambient and volume.min() <= 0:
        raise ValueError("the pressure begins near the ambient one; it must be gauge pressure")
    rest = pressure - pressure.mean() - slope * centred
    error = math.sqrt(float(rest @ rest) / (volume.size - 2) / square)
    dead = ambient / slope
    return Mean(dead, dead * error / slope, 1)


class Leak(NamedTuple):
    """Leak of a closed line: rate and its standard error (MPa/s, positive for a loss of pressure), its 95 % interval,
    and the time constant in s of an exponential decay (infinite without a loss)."""

    rate: float
    error: float
    interval: tuple[float, float]
    time_constant: float


def leak_of(time: Array, pressure: Array) -> Leak:
    """Leak of a closed line from times (s) and gauge pressures (MPa), (n,) each.

    The rate is the slope of the least-squares line, its error from the scatter of the means of ten equal parts about
    that line (noise that is alike from sample to sample is so counted; eight degrees of freedom, Student's t in the
    interval). The time constant is that of p = p0 exp(-t/T), by the line through log p. Raises InputError for fewer
    than ten points.
    """
    if time.size < _LEAST_BLOCKS:
        raise InputError(f"a leak run of {time.size} points; at least {_LEAST_BLOCKS}")
    parts = np.array_split(np.arange(time.size), _BATCHES)
    at = np.array([time[part].mean() for part in parts])
    mean = np.array([pressure[part].mean() for part in parts])
    centred = at - at.mean()
    square = float(centred @ centred)
    slope = float(centred @ mean) / square
    rest = mean - mean.mean() - slope * centred
    error = math.sqrt(float(rest @ rest) / (_BATCHES - 2) / square)
    constant = math.inf
    if slope < 0 and mean.min() > 0:
        decay = float(centred @ np.log(mean)) / square
        constant = -1 / decay if decay < 0 else math.inf
    # Student's t at 97.5 % with 8 degrees of freedom (NIST/SEMATECH e-Handbook, 1.3.6.7.2).
    half = 2.306 * error
    return Leak(-slope, error, (-slope - half, -slope + half), constant)


def leak_rate(blocks: Blocks) -> tuple[float, float]:
    """Leak rate of a leak run and its standard error, MPa/s. Raises InputError for a run of fewer than ten blocks."""
    try:
        leak = leak_of(blocks.time, blocks.pressure)
    except InputError as error:
        raise InputError(f"{error}", file=blocks.file) from None
    return leak.rate, leak.error
