"""Excursions of the plate into the sensor, found from its position alone, and the kind of run they make up."""

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.record import Blocks
from pneutouch.bench.source import exchanged, otherwise
from pneutouch.errors import InputError
from pneutouch.spec.campaign import RunKind

NOISE = 5.0
"""Standard deviations of the position within which the plate counts as still: one false alarm in a million."""

TURN = 0.05
"""Share of the whole travel by which the plate must turn back to begin another indentation. The paper's smallest
indentation (0.5 mm of 6.9 mm, and the clearance) is three times as long."""

NEAR, STAY = 0.02, 0.005
"""Tolerances of a stay: overshoot as a share of the run's whole travel, and deviation as a share of the indentation."""

WIDE, FEW = 0.05, 8
"""Share of the travel, and number of blocks: with fewer than `FEW` blocks at the clear end, as in a loop without rest,
blocks within `WIDE` of that end are taken."""

_LEAST_SHARE = 20.0
"""Least travel of a record, in standard deviations of the position, at which the plate counts as moving."""

_ACTIVE = 5.0
"""Ratio of the force's variation at the low end of the position to that at the high end, above which it is reversed."""

_MOVES = 0.2
"""Share of its greatest speed from which on the plate is taken to move."""


_SPREADS = 1.7
"""Greatest ratio, for a stay, of the time within four times a small distance of the deep end to the time within that
distance: about 1 for a stay, 2 for a sine, 4 for a turn at constant speed."""

_LINGERS = 4.0
"""Least ratio of the time at a stay on the way in to the time at the other places of the way: our choice."""

_AS_LONG, _INSIDE = 0.7, 0.1
"""Least time at the deep end, as a share of those at the stays before it, that makes it one too, and share of the way
in from which on these count, as a sine begins slowly: our choice."""

_SCATTERED = 1.5
"""Greatest ratio of blocks from a stay's first to its last to blocks at its depth; above it the plate came twice."""

LONG = 5.0
"""Seconds above which a stay at one depth, if also longer than the way in, is a relaxation: our choice."""


_LATEST, _ALIKE, _COMPARED = 2.0, 0.05, 4000
"""Longest time in s by which a channel is tried to come early or late, least gain in its correlation with the travel by
which it does, and most blocks that are compared: our choice."""

_RESTS, _GOES_ON, _CONCAVE = 0.01, 0.05, 0.6
"""Share of a channel's span within which it rests, of another's by which that goes on then, and of its rise that it has
at half of the first one's: our choice."""


class Excursion(NamedTuple):
    """One loading and unloading, or one step of a loading in steps; block numbers, ends exclusive.

    ``clear`` is the stretch before it with the plate at its clear end, ``hold`` the stay at its deep end, ``out`` the
    end of the unloading (the next clear stretch, or the end of the record). ``held`` is True if the plate stays at the
    deep end and False if it just turns. Steps of one loading share ``clear`` and ``out``.
    """

    clear: tuple[int, int]
    hold: tuple[int, int]
    out: int
    held: bool = True


def excursions(blocks: Blocks, *, steps: bool = True, turn: float = TURN) -> tuple[list[Excursion], bool]:
    """All loadings and unloadings, and True if the record begins with the sensor pressed; that press is left out.

    With ``steps`` a loading gives one excursion for each of its stays. ``turn`` is the share of the whole travel by
    which the plate must turn back before another excursion can begin.

    No speed and no length is presumed: all limits are shares of the travel or multiples of the position's noise, so
    that a run in a wrong unit is still segmented correctly, and its magnitude reveals the unit. Missed samples matter
    little: differences of neighbours only give the noise and the direction. Raises InputError if the plate does not
    move, or moves out of the sensor when it presses."""
    place = smoothed(blocks.position)
    noise, span = position_noise(blocks.position), float(np.ptp(place))
    if span <= _LEAST_SHARE * noise or place.size < FEW:
        raise InputError(
            f"position: the plate never moves: from {place.min():.4g} to {place.max():.4g} mm",
            file=blocks.file,
            remedy="is it the right column? `columns` names another, as position=NAME",
        )
    _check_direction(blocks, place, span)
    turns = _turns(place, max(2 * NOISE * noise, turn * span))
    tops = [at for at, high in turns if high]
    lows = [at for at, high in turns if not high]
    parts: list[Excursion] = []
    previous = 0
    for top in tops:
        before = [low for low in lows if low < top]
        after = next((low for low in lows if low > top), place.size - 1)
        if not before:
            previous = after
            continue
        start = max(previous, parts[-1].hold[1] if parts else 0)
        way = place[before[-1] : after + 1]
        first, last = _stay(way, span, noise)
        hold = (first + before[-1], last + before[-1])
        clear = _clear(place[start : hold[0]], float(way[0]), float(place[top]), noise)
        held = _held(way, float(np.median(way[first:last])), noise)
        parts.append(Excursion((clear[0] + start, clear[1] + start), hold, place.size, held))
        previous = after
    ends = [*(one.clear[0] for one in parts[1:]), place.size]
    parts = [one._replace(out=end) for one, end in zip(parts, ends, strict=True)]
    if steps:
        parts = [step for one in parts for step in _steps(place, one, noise)]
    return parts, bool(tops) and (not lows or tops[0] < lows[0])


def check_exchanged(blocks: Blocks) -> None:
    """Raise InputError if position and force look exchanged: the force comes in from the clear while the position
    rests, and then rises most at first, as the travel of a dome does over its force."""
    place, force = blocks.position, blocks.force
    # No quantiles: in a long hold the clear may be less than a hundredth of the rows.
    low, high = smoothed(place).min(), smoothed(place).max()
    rests, half = place <= low + _RESTS * (high - low), np.abs(place - 0.5 * (low + high)) <= 0.1 * (high - low)
    clear, contact = np.quantile(force[rests], (0.02, 0.98))
    middle, deep = np.median(force[half]) if half.any() else np.nan, float(np.quantile(force, 0.99))
    if contact - clear > _GOES_ON * (deep - clear) and middle - contact > _CONCAVE * (deep - contact) > 0:
        of = blocks.columns.position.name, blocks.columns.force.name
        raise InputError(
            f"columns {of[0]} and {of[1]} look exchanged: {of[0]} rests while {of[1]} begins to rise, as a force does "
            "before the plate touches",
            file=blocks.file,
            remedy=exchanged(blocks.columns, "position", "force"),
        )


def position_noise(position: Array) -> float:
    """Standard deviation of a block's position, mm, from second differences, which are zero at constant speed."""
    if position.size < 3:
        return 0.0
    return float(1.4826 * np.median(np.abs(np.diff(position, 2))) / np.sqrt(6))


def smoothed(values: Array) -> Array:
    """Running median of three, so that a single wild value makes no turn; the same shape."""
    if values.size < 3:
        return values
    inner = np.median(np.stack([values[:-2], values[1:-1], values[2:]]), axis=0)
    return np.concatenate([values[:1], inner, values[-1:]])


def _check_direction(blocks: Blocks, place: Array, span: float) -> None:
    # While the plate moves, for a channel may also change in a rest, as a pressure does that is reset.
    speed = np.abs(np.gradient(place, blocks.time))
    moving = speed > _MOVES * speed.max()
    low = blocks.force[moving & (place < place.min() + 0.1 * span)]
    high = blocks.force[moving & (place > place.max() - 0.1 * span)]
    if min(low.size, high.size) < 3:
        return
    if low.std() > _ACTIVE * high.std() and np.ptp(low) > TURN * np.ptp(blocks.force):
        if lag := rough_lag(blocks, "force"):
            first, then = ("travel", "force") if lag > 0 else ("force", "travel")
            raise InputError(
                f"the {then} comes {abs(lag):.2g} s after the {first}: a filter, slow gauge or other clock delays it",
                file=blocks.file,
                remedy="shift the column by that, or press much slower",
            )
        raise InputError(
            f"the force changes where position is low ({place.min():.4g} mm) and is constant where it is high "
            f"({place.max():.4g} mm)",
            file=blocks.file,
            remedy=f"position must count into the sensor: {otherwise(blocks.columns, 'position')}",
        )


def rough_lag(blocks: Blocks, key: str) -> float:
    """Time in s by which a channel follows the travel, to a few hundredths, where it is clearly more like it then than
    as read or with the other sign; else 0."""
    some = slice(None, None, max(blocks.time.size // _COMPARED, 1))
    time, place, values = blocks.time[some], blocks.position[some], getattr(blocks, key)[some]
    # On a way in alone a dome, which stiffens, comes late.
    if min(np.ptp(place), np.ptp(values)) <= 0 or place[-1] > 0.5 * (place.min() + place.max()):
        return 0.0
    lags = np.linspace(-_LATEST, _LATEST, 81)
    moved = np.array([np.interp(time + lag, time, values) for lag in (*lags, 0.0)])
    moved, place = moved - moved.mean(axis=1, keepdims=True), place - place.mean()
    *alike, now = moved @ place / np.maximum(np.linalg.norm(moved, axis=1) * np.linalg.norm(place), 1e-300)
    # Of cycles the nearest.
    best = int(np.argmax(np.array(alike) - _ALIKE * np.abs(lags)))
    return float(lags[best]) if alike[best] > _ALIKE + abs(now) else 0.0


def _turns(place: Array, least: float) -> list[tuple[int, bool]]:
    """Turning points with at least ``least`` mm between neighbours, in order: block number, and True for a deep one."""
    turns: list[tuple[int, bool]] = []
    values = place.tolist()
    low = high = 0
    rising: bool | None = None
    for k, value in enumerate(values):
        if value > values[high]:
            high = k
        if value < values[low]:
            low = k
        if rising is not False and values[high] - value > least:
            turns.append((high, True))
            rising, low = False, k
        elif rising is not True and value - values[low] > least:
            turns.append((low, False))
            rising, high = True, k
    if rising is not None:
        turns.append((high, True) if rising else (low, False))
    return turns


def _stay(place: Array, span: float, noise: float) -> tuple[int, int]:
    """Blocks for which the plate stays at the deep end of an excursion: the first, and the one after the last. It may
    overshoot by `NEAR` of the run's whole travel ``span`` (mm)."""
    top, low = float(place.max()), float(place[0])
    level = float(np.median(place[place >= top - max(NEAR * span, NOISE * noise)]))
    at = np.flatnonzero(np.abs(place - level) <= max(STAY * (top - low), NOISE * noise))
    if not at.size:
        peak = int(place.argmax())
        return peak, peak + 1
    return int(at[0]), int(at[-1]) + 1


def _clear(place: Array, low: float, top: float, noise: float) -> tuple[int, int]:
    """Blocks for which the plate is at its clear end before it goes in: the first, and the one after the last."""
    at = np.flatnonzero(place <= low + max(STAY * (top - low), NOISE * noise))
    if at.size < FEW:
        at = np.flatnonzero(place <= low + WIDE * (top - low))
    return int(at[0]), int(at[-1]) + 1


def _held(way: Array, level: float, noise: float) -> bool:
    """True if the plate stays at the deep end ``level`` of a way in and out, judged by the time spent near it."""
    near = max(STAY * (level - float(way.min())), NOISE * noise)
    short, long = (int((np.abs(way - level) <= factor * near).sum()) for factor in (1, 4))
    return short >= FEW and long < _SPREADS * short


def _steps(place: Array, one: Excursion, noise: float) -> list[Excursion]:
    """The stays of a loading, each as an excursion with the same clear stretch, the deep end last."""
    start = one.clear[1] - 1
    way = place[start : one.hold[0]]
    holds = [(first + start, last + start) for first, last in _stays(way, float(place[one.hold[0]]), noise)]
    # After slow steps a short stay at the deep end looks like a slow turn.
    low, top = place[start], place[one.hold[0]]
    inside = [last - first for first, last in holds if place[first] > low + _INSIDE * (top - low)]
    long = bool(inside) and one.hold[1] - one.hold[0] >= _AS_LONG * float(np.median(inside))
    return [*(one._replace(hold=hold, held=True) for hold in holds), one._replace(held=one.held or long)]


def _stays(way: Array, top: float, noise: float) -> list[tuple[int, int]]:
    """Stays on a way in, short of ``top``: the first block of each, and the one after its last."""
    if way.size < 2 * FEW:
        return []
    low = float(way[0])
    near = max(STAY * (top - low), NOISE * noise)
    levels = np.arange(low + 4 * near, top - 4 * near, near / 2)
    if not levels.size:
        return []
    places = np.sort(way)
    count = np.searchsorted(places, levels + near, side="right") - np.searchsorted(places, levels - near)
    least = max(FEW, _LINGERS * float(np.median(count)))
    stays: list[tuple[int, int]] = []
    for k in np.argsort(-count, kind="stable"):
        if count[k] < least:
            break
        at = np.flatnonzero(np.abs(way - levels[k]) <= near)
        first, last = int(at[0]), int(at[-1]) + 1
        apart = all(last <= begin or first >= end for begin, end in stays)
        if apart and last - first <= _SCATTERED * at.size:
            stays.append((first, last))
    return sorted(stays)


def kind_of(blocks: Blocks, parts: list[Excursion]) -> RunKind:
    """Kind of a run by those of its excursions that touch: steps where the plate stays at several depths, a relaxation
    where it stays long at one, else a loop."""
    held = [one for one in parts if one.held]
    if 2 * len(held) < len(parts) or not parts:
        return "loop"
    depths = [float(np.median(blocks.position[slice(*one.hold)])) for one in held]
    if np.ptp(depths) > TURN * np.ptp(blocks.position):
        return "steps"
    times = blocks.time[[(one.clear[1] - 1, one.hold[0], one.hold[1] - 1) for one in held]]
    way, stay = np.diff(times, axis=1).T
    return "relaxation" if (stay > np.maximum(LONG, way)).all() else "loop"
