"""Indentations of a run, found from the position alone: clear of the sensor, going in, staying."""

from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.record import Blocks
from pneutouch.errors import InputError

NOISE = 5.0
"""Standard deviations of the position within which the plate is taken to stay: a false alarm in a million."""

TURN = 0.05
"""Share of the whole travel by which the plate must turn back to begin another indentation. The smallest of the paper's
(0.5 mm of 6.9 mm, and the clearance) is three times as long."""

NEAR, STAY = 0.02, 0.005
"""Shares of an indentation's travel: the first for overshoot at its end, the second for the hold."""

WIDE, FEW = 0.05, 8
"""Share of the travel, and number of blocks: with fewer than `FEW` blocks at the clear end, as in a loop without rest,
those within `WIDE` of it count."""

_LEAST_SHARE = 20.0
"""The plate moves where its travel is more than so many standard deviations of its position."""

_ACTIVE = 5.0
"""Position is reversed where the force varies so many times more at its low end than at its high end."""

_MOVES = 0.2
"""Share of its greatest speed from which on the plate is taken to move."""


class Excursion(NamedTuple):
    """One loading and unloading, as block numbers, ends exclusive.

    ``clear`` is the stretch before it with the plate at its clear end, ``hold`` the stay at its deep end, ``out`` where
    the unloading ends (the next clear stretch, or the record).
    """

    clear: tuple[int, int]
    hold: tuple[int, int]
    out: int


def excursions(blocks: Blocks) -> tuple[list[Excursion], bool]:
    """All loadings and unloadings, and whether the record begins with the plate in (that one is left out).

    No speed and no length is presumed: all limits are shares of the travel or multiples of the position's noise, so
    that a run in a wrong unit is still segmented correctly, and its magnitude reveals the unit. Missed samples do not
    matter, as no differences of neighbours are taken. Raises InputError if the plate does not move, or moves out of
    the sensor when it presses."""
    place = _smooth(blocks.position)
    noise, span = position_noise(blocks.position), float(np.ptp(place))
    if span <= _LEAST_SHARE * noise or place.size < FEW:
        raise InputError(
            f"position: the plate never moves: from {place.min():.4g} to {place.max():.4g} mm",
            file=blocks.file,
            remedy="is columns.position the right column?",
        )
    _check_direction(blocks, place, span)
    turns = _turns(place, max(2 * NOISE * noise, TURN * span))
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
        hold = _stay(place[before[-1] : after + 1], place[before[-1]], noise)
        hold = (hold[0] + before[-1], hold[1] + before[-1])
        clear = _clear(place[start : hold[0]], float(place[before[-1]]), float(place[top]), noise)
        parts.append(Excursion((clear[0] + start, clear[1] + start), hold, place.size))
        previous = after
    ends = [*(one.clear[0] for one in parts[1:]), place.size]
    parts = [one._replace(out=end) for one, end in zip(parts, ends, strict=True)]
    return parts, bool(tops) and (not lows or tops[0] < lows[0])


def position_noise(position: Array) -> float:
    """Standard deviation of a block's position, mm, from second differences, which an even move does not enter."""
    if position.size < 3:
        return 0.0
    return float(1.4826 * np.median(np.abs(np.diff(position, 2))) / np.sqrt(6))


def _smooth(values: Array) -> Array:
    """Running median of three: a single wild position is no turn."""
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
        raise InputError(
            f"the force changes where position is low ({place.min():.4g} mm) and is constant where it is high "
            f"({place.max():.4g} mm)",
            file=blocks.file,
            remedy="position must count into the sensor: invert columns.position.sign",
        )


def _turns(place: Array, least: float) -> list[tuple[int, bool]]:
    """Turning points with at least ``least`` mm between neighbours: block and whether it is a high one, in order."""
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


def _stay(place: Array, low: float, noise: float) -> tuple[int, int]:
    """Blocks for which the plate stays at the deep end of an excursion: the first, and the one after the last."""
    top = float(place.max())
    level = float(np.median(place[place >= top - max(NEAR * (top - low), NOISE * noise)]))
    at = np.flatnonzero(np.abs(place - level) <= max(STAY * (top - low), NOISE * noise))
    if not at.size:
        peak = int(place.argmax())
        return peak, peak + 1
    return int(at[0]), int(at[-1]) + 1


def _clear(place: Array, low: float, top: float, noise: float) -> tuple[int, int]:
    """Blocks for which the plate is at its clear end before it goes in, first and last."""
    at = np.flatnonzero(place <= low + max(STAY * (top - low), NOISE * noise))
    if at.size < FEW:
        at = np.flatnonzero(place <= low + WIDE * (top - low))
    return int(at[0]), int(at[-1]) + 1
