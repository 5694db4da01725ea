"""A run between file and figures: blocks of samples, indentations, a curve.

A run thinned for looking at: few enough points to plot, and where it was read.
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.spec.campaign import CampaignRun, RunKind

SuspectKind = Literal["gap", "clipped", "spike", "note", "other"]


class SuspectInterval(NamedTuple):
    """A time interval (s) of a run that may be wrong, and the reason.

    ``used``: whether it is used nevertheless.  ``kind``: a gap, a channel at the end of its range, a reading beyond
    that, a note of a usual defect, or another."""

    start: float
    end: float
    why: str
    used: bool
    kind: SuspectKind = "other"


@dataclass(frozen=True, slots=True)
class Blocks:
    """A file's samples averaged over blocks of ``size``, in the file's order; s, mm, N, MPa, arrays (n,).

    ``spread`` are standard deviations (ddof 0) within the blocks, ``extreme`` the greatest magnitude in them,
    ``first_row`` the row of the file (the header is row 1) with which each begins. ``rate`` is the sampling rate of the
    file, Hz."""

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


@dataclass(frozen=True, slots=True)
class MeasuredIndentation:
    """One indentation as read from a record. Times in s; mm, N, MPa.

    Attributes:
        contact: Time of first contact; of an indentation without, NaN.
        hold: Begin and end of the hold.
        read: Begin and end of the stretch that was averaged: the last part of the hold.
        release: Time at which contact is lost.
        onset: Plate position at its own first contact.
        fitted: True if that was fitted; else it is the median of those that were.
        indentation: Plate travel to the hold from the run's first contact (`indents.EARLY`).
        force: Mean over ``read`` less the mean before contact.
        rise: The same of the pressure.
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
    """The curve of a run: points in order of their depth, from first contact, (n,) mm, N, MPa; the first is the origin.

    Attributes:
        run: Its entry in the campaign; of a run without a kind with the one that the record shows.
        indentation, force, rise: Loading points.
        driving: Pressure before contact as it was read, MPa, mean over the indentations.
        indents: The indentations behind the points.
        loop: Of a loop run: force and rise going in, force and rise coming out, of each cycle.
        relaxation: Of a relaxation run: seconds since the hold began, force, rise.
        noise: Standard deviations of a sample of force (N) and pressure (MPa) without contact, trend taken out; NaN
            if nothing was without contact.
        drift: Slope of the pressure before the first contact, MPa/s, and its standard error.
        onset_error: Standard error of the place of first contact, mm; infinite if it is not known.
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
    drift: tuple[float, float] = (float("nan"), float("nan"))
    onset_error: float = float("inf")
    shows: RunKind = "steps"
    told: bool = False
    warnings: tuple[SuspectInterval, ...] = field(default=())


MOST = 3000
"""Points of a trace: more than a page shows. Even, as two are kept of each stretch."""


class Trace(NamedTuple):
    """A run thinned, (n,): s, mm, N, MPa.

    Two points stand for each stretch of it: time and position are those of its first and its last block, force and
    pressure its least and greatest, whichever came first before the other. So a spike or a short clip is seen, at most
    a stretch off its time.
    """

    time: Array
    position: Array
    force: Array
    pressure: Array


def trace(blocks: Blocks) -> Trace:
    """The blocks as they are where they are at most `MOST`, else thinned evenly to that."""
    size = blocks.time.size
    if size <= MOST:
        return Trace(blocks.time.copy(), blocks.position.copy(), blocks.force.copy(), blocks.pressure.copy())
    edges = np.linspace(0, size, MOST // 2 + 1).astype(int)
    ends = np.stack([edges[:-1], edges[1:] - 1], axis=1).ravel()
    return Trace(blocks.time[ends], blocks.position[ends], _span(blocks.force, edges), _span(blocks.pressure, edges))


def _span(values: Array, edges: Indices) -> Array:
    """Least and greatest of the stretches between ``edges`` (m + 1,), in the order in which they come, (2 m,)."""
    starts = edges[:-1]
    within = np.repeat(np.arange(starts.size), np.diff(edges))
    place = np.arange(values.size)
    low, high = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    never = values.size
    first_low = np.minimum.reduceat(np.where(values == low[within], place, never), starts)
    first_high = np.minimum.reduceat(np.where(values == high[within], place, never), starts)
    falls = first_high < first_low
    return np.stack([np.where(falls, high, low), np.where(falls, low, high)], axis=1).ravel()
