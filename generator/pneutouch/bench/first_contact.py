"""First contact of each loading: detected against the force's noise, then extrapolated to zero force."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.excursions import Excursion
from pneutouch.bench.record import Blocks

BEFORE = 1.0
"""Seconds before contact over which force and pressure are averaged: short enough that a reset has settled, and long
enough that the mean adds little noise. Our choice."""

THRESHOLD = 6.0
"""Deviation of the force, in noise standard deviations of a block, that counts as contact: one false alarm in 10^9."""

LEAST_FORCE = 1e-3
"""Least force of a contact as a share of the run's greatest force, for a channel with next to no noise."""

FIRST, CLEARLY = 0.01, 20.0
"""Loadings are fitted up to this share of the run's greatest force, or this multiple of the noise if that is more. A
dome's force grows a hundredfold over its range; only its first hundredth is of one power of the travel."""

BENDS = tuple(np.linspace(0.0, 1.0, 21).tolist())
"""F ~ (1 - w) x + w x^2 near contact, x the travel over that of the fitted stretch: w = 0 for a shell or an inflated
membrane, which begin linearly, w = 1 for a dome whose stiffness grows from zero; a solid sphere lies between them
(Hertz, x^1.5) to a few hundredths of the stretch. One w is fitted for all of a run."""

UNSURE = 4.0
"""Ratio of an onset's standard error to the run's median above which a contact is too light for a fit: our choice."""

BIAS = 0.04
"""Bias of an onset as a share of the fitted stretch, included as a standard error: half of that tested for a dome."""

_LEAST_POINTS, _MOST_POINTS, _NO_LENGTH = 6, 200, 1e-8
_BACK = 3
"""Length of the stretch without contact in the fit, as a multiple of that with contact."""

_GRID = 81

_UNKNOWN = 10.0
"""Standard error of an onset, in lengths of the fitted stretch, above which the onset is undetermined."""


COARSE = 2e-3
"""Step of a channel, as a share of its greatest change, that hides first contact: our choice. The force of the paper's
dome changes by half of it in 2 % of the travel."""


class Baseline(NamedTuple):
    """Blocks without contact: numbers; mean, slope (1/s), variance about it and in blocks, of force and pressure."""

    start: int
    end: int
    mean: tuple[float, float]
    slope: tuple[float, float]
    between: tuple[float, float]
    within: tuple[float, float]


class ContactOnset(NamedTuple):
    """First contact: time (s), plate position (mm) and its standard error; ``fitted`` is False where the position is
    the median of the fitted ones."""

    time: float
    position: float
    fitted: bool
    error: float = np.inf


def baseline(blocks: Blocks, start: int, end: int) -> Baseline:
    """Baseline of force and pressure over blocks ``start`` to ``end`` (exclusive), at least one."""
    time = blocks.time[start:end]
    centred = time - time.mean()
    means, slopes, between, within = [], [], [], []
    for values, spread in ((blocks.force, blocks.force_spread), (blocks.pressure, blocks.pressure_spread)):
        part = values[start:end]
        slope = float(centred @ part) / float(centred @ centred) if part.size > 2 else 0.0
        rest = part - part.mean() - slope * centred
        means.append(float(part.mean()))
        slopes.append(slope)
        between.append(float(rest @ rest) / max(part.size - 2, 1))
        within.append(float(np.mean(spread[start:end] ** 2)))
    return Baseline(
        start, end, (means[0], means[1]), (slopes[0], slopes[1]), (between[0], between[1]), (within[0], within[1])
    )


def first_baseline(blocks: Blocks, one: Excursion) -> Baseline:
    """Baseline over the last `BEFORE` seconds at the clear end, at most its later half, so that a reset is over."""
    start, end = one.clear
    late = int(np.searchsorted(blocks.time[start:end], blocks.time[end - 1] - BEFORE)) + start
    begin = max(late, (start + end) // 2)
    return baseline(blocks, min(begin, max(end - 4, start)), max(end, start + 1))


def step_share(blocks: Blocks, bases: list[Baseline]) -> float:
    """Step in which the force is read, as a share of its greatest change; 0 where the samples' noise covers it."""
    noise = float(np.mean([base.between[0] + base.within[0] for base in bases]))
    top = float(np.abs(blocks.force - bases[0].mean[0]).max())
    return blocks.steps[0] / top if noise < (0.5 * blocks.steps[0]) ** 2 else 0.0


def showing_contact(blocks: Blocks, bases: list[Baseline]) -> tuple[Blocks, list[Baseline]]:
    """Blocks and bases with, in place of a force whose steps hide first contact, a pressure that is finer."""
    if step_share(blocks, bases) <= COARSE and not blocks.joined[0]:
        return blocks, bases
    turned = replace(blocks, force=blocks.pressure, force_spread=blocks.pressure_spread, steps=blocks.steps[::-1])
    swapped = [Baseline(base.start, base.end, *(pair[::-1] for pair in base[2:])) for base in bases]
    finer = blocks.joined[0] > blocks.joined[1] or step_share(turned, swapped) < step_share(blocks, bases)
    return (turned, swapped) if finer else (blocks, bases)


def threshold(blocks: Blocks, bases: list[Baseline], parts: list[Excursion]) -> tuple[float, int]:
    """Least force in N that counts as contact, and the sign of the pressed force (-1 if the column's sign is wrong)."""
    noise = float(np.sqrt(np.mean([base.between[0] for base in bases])))
    off = [blocks.force[one.clear[1] : one.hold[1]] - base.mean[0] for one, base in zip(parts, bases, strict=True)]
    high, low = max(float(part.max()) for part in off), min(float(part.min()) for part in off)
    return max(THRESHOLD * noise, LEAST_FORCE * max(high, -low)), 1 if high >= -low else -1


def onsets(
    blocks: Blocks, parts: list[Excursion], bases: list[Baseline], least: float, sign: int
) -> list[ContactOnset | None]:
    """First contact of each loading; None for a loading without one.

    Contact begins in the block after the last one of the loading that is within ``least`` N of the force without
    contact. From there F = c ((1 - w) x + w x^2), x = position - onset, is fitted up to a small force (`FIRST`), with a
    stretch without contact before it, by least squares with onset and c free for each loading and w common to all.
    Where a hold presses but its loading is too light to be fitted (`UNSURE`), the onset is the median of the others.

    Bias, as tested, at 5 mm/s with 0.02 N of noise a sample at 4 kHz, in the median of a run: below 0.01 mm for a force
    that grows evenly, 0.04 mm for one that begins evenly and grows a hundredfold as a dome's does, 0.05 mm for
    travel^1.5 and 0.09 mm for travel^1.8, which begins with next to no force. A force that lags by a time constant T
    comes out late by at most speed times T."""
    crossed = [_crossing(blocks, one, base, least, sign) for one, base in zip(parts, bases, strict=True)]
    top = max(
        float((sign * (blocks.force[one.hold[0] : one.hold[1]] - base.mean[0])).max())
        for one, base in zip(parts, bases, strict=True)
    )
    limit = max(FIRST * top, CLEARLY / THRESHOLD * least)
    loadings = [
        None if at is None else _loading(blocks, one, base, at, limit, sign)
        for at, one, base in zip(crossed, parts, bases, strict=True)
    ]
    # A coarse force may pass from nothing to the limit within a block: such a loading has no travel to fit.
    real = [loading for loading in loadings if loading is not None and loading.length > _NO_LENGTH]
    if not real:
        return [None] * len(parts)
    # A loading that ends before the fitted force gives its onset late; where all do, there is no better.
    some = any(loading.reaches for loading in real)
    # Nor does it tell the shape where its readings begin inside, as from one step of stairs to the next.
    real = [one for one in real if one.reaches or not some or one.low > one.position.min()]
    length = float(np.median([loading.length for loading in real]))
    bends = np.array(BENDS)
    bend = bends[[int(np.argmin(np.sum([_search(loading, bends, length)[1] for loading in real], axis=0)))]]
    fits = [None if loading is None else float(_search(loading, bend, length)[0][0]) for loading in loadings]
    errors = [
        np.inf
        if loading is None or loading.length <= _NO_LENGTH or fit is None or (some and not loading.reaches)
        else _error(loading, fit, float(bend[0]), length)
        for loading, fit in zip(loadings, fits, strict=True)
    ]
    limit_error = UNSURE * float(np.median([error for error in errors if error < np.inf]))
    middle = float(
        np.median([fit for fit, error in zip(fits, errors, strict=True) if fit is not None and error <= limit_error])
    )
    contacts: list[ContactOnset | None] = []
    for fit, error, one, base, loading in zip(fits, errors, parts, bases, loadings, strict=True):
        fitted = fit is not None and error <= limit_error
        place = fit if fit is not None and fitted else middle
        touches = fitted or _presses(blocks, one, base, least, sign, middle)
        free = np.inf if loading is None else _error(loading, place, float(bend[0]), length, bends=True)
        free = float(np.hypot(BIAS * length, free))
        contacts.append(ContactOnset(_time_at(blocks, one, place), place, fitted, free) if touches else None)
    return contacts


def _presses(blocks: Blocks, one: Excursion, base: Baseline, least: float, sign: int, onset: float) -> bool:
    """True if a hold presses, by the mean of its later half, although no single block of the loading shows it."""
    at = slice((one.hold[0] + one.hold[1]) // 2, one.hold[1])
    force = sign * (blocks.force[at] - base.mean[0])
    count = min(force.size, base.end - base.start)
    return bool(blocks.position[at].mean() > onset and force.mean() > least * np.sqrt(2 / count))


def _error(loading: "_Loading", onset: float, bend: float, length: float, *, bends: bool = False) -> float:
    """Standard error of a fitted onset, mm, with the factor c free; with ``bends`` the shape is free too."""
    over = np.maximum(loading.position - onset, 0.0) / length
    shape = (1 - bend) * over + bend * over**2
    slope = (over > 0) * ((1 - bend) + 2 * bend * over) / length
    square = float(shape @ shape)
    if square <= 0:
        return float(np.inf)
    factor = float(loading.force @ shape) / square
    rest = loading.force - factor * shape
    others = np.stack([shape, over**2 - over] if bends else [shape], axis=1)
    slope = factor * (slope - others @ np.linalg.lstsq(others, slope, rcond=None)[0])
    steep = float(slope @ slope)
    error = float(np.sqrt(rest @ rest / max(loading.force.size - 2, 1) / steep)) if steep > 0 else float(np.inf)
    # A place that the data do not determine has an error of rounding alone.
    return error if error < _UNKNOWN * length else float(np.inf)


def _crossing(blocks: Blocks, one: Excursion, base: Baseline, least: float, sign: int) -> int | None:
    """First block of the loading from which on the force exceeds ``least``; None if there is none."""
    start, end = one.clear[1] - 1, max(one.hold[0] + 1, one.clear[1] + 1)
    force = sign * (blocks.force[start:end] - base.mean[0])
    peak = int(force.argmax())
    if force[peak] <= least:
        return None
    below = np.flatnonzero(force[:peak] <= least)
    return start + (int(below[-1]) + 1 if below.size else 0)


class _Loading(NamedTuple):
    """First part of a loading: position (mm), force less the one without contact (N), bounds of the onset, travel;
    ``reaches`` is True if the force comes to the limit up to which loadings are fitted."""

    position: Array
    force: Array
    low: float
    high: float
    length: float
    reaches: bool


def _loading(blocks: Blocks, one: Excursion, base: Baseline, at: int, limit: float, sign: int) -> _Loading:
    deepest = max(one.hold[0] + 1, at + 2)
    beyond = np.flatnonzero(sign * (blocks.force[at:deepest] - base.mean[0]) > limit)
    end = min(at + max(int(beyond[0]) if beyond.size else deepest, _LEAST_POINTS), deepest)
    start = max(one.clear[1] - 1, at - _BACK * max(end - at, _LEAST_POINTS))
    position, force = blocks.position[start:end], sign * (blocks.force[start:end] - base.mean[0])
    first, last = float(blocks.position[at]), float(blocks.position[end - 1])
    step = (last - first) / max(end - 1 - at, 1)
    low = max(first - 1.5 * (last - first) - 2 * step, float(position.min()))
    if position.size > _MOST_POINTS:
        starts = np.linspace(0, position.size, _MOST_POINTS, endpoint=False).astype(int)
        counts = np.diff(np.append(starts, position.size))
        position, force = np.add.reduceat(position, starts) / counts, np.add.reduceat(force, starts) / counts
    return _Loading(
        position, force, min(low, first), first + 0.5 * step, max(last - first, step, 1e-9), beyond.size > 0
    )


def _search(loading: _Loading, bends: Array, length: float) -> tuple[Array, Array]:
    """Best onset and its squared misfit for each bend, (m,): a grid search, refined twice."""
    low, high = np.full(bends.size, loading.low), np.full(bends.size, loading.high)
    best, misfit = low, np.zeros(bends.size)
    for _ in range(3):
        tries = low[:, None] + (high - low)[:, None] * np.linspace(0, 1, _GRID)
        over = np.maximum(loading.position - tries[..., None], 0.0) / length
        shape = over * (1 - bends[:, None, None] * (1 - over))
        square = np.maximum((shape * shape).sum(axis=-1), 1e-300)
        left = (loading.force @ loading.force) - (shape @ loading.force) ** 2 / square
        at = left.argmin(axis=1)
        row = np.arange(bends.size)
        best, misfit = tries[row, at], left[row, at]
        step = (high - low) / (_GRID - 1)
        low, high = np.maximum(best - 2 * step, loading.low), np.minimum(best + 2 * step, loading.high)
    return best, misfit


def _time_at(blocks: Blocks, one: Excursion, onset: float) -> float:
    """Time at which the plate passes the onset."""
    start = max(one.clear[1] - 1, 0)
    below = np.flatnonzero(blocks.position[start : one.hold[0] + 1] < onset)
    k = start + (int(below[-1]) if below.size else 0)
    if k + 1 >= blocks.time.size or blocks.position[k + 1] <= blocks.position[k]:
        return float(blocks.time[k])
    return float(np.interp(onset, blocks.position[k : k + 2], blocks.time[k : k + 2]))
