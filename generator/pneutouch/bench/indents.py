"""Plate movements of a characterization (paper, section 3, Supplements C and D), and readings of each indentation."""

import math
from dataclasses import dataclass, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.excursions import Excursion, excursions, kind_of
from pneutouch.bench.first_contact import (
    BEFORE,
    COARSE,
    Baseline,
    ContactOnset,
    baseline,
    first_baseline,
    onsets,
    showing_contact,
    step_share,
    threshold,
)
from pneutouch.bench.record import GAP, Blocks, MeasuredIndentation
from pneutouch.spec.campaign import RunKind

STEP, SHARE = 0.5, 0.75
"""Step in mm, and greatest depth as a share of the dome's inner height, R0 in the paper (section 3-B)."""

HOLD, REST, SHORT_REST, RELAXATION = 4.0, 30.0, 2.0, 600.0
"""Seconds: hold and rest of the sensitivity test (3-B), rest of the saturation test (3-C), relaxation (Suppl. D)."""

REPETITIONS = 3
"""Runs at each driving pressure (paper, section 3-B)."""

SPEED = 5.0
"""Speed of the plate, mm/s: our choice, the paper gives none; its actuator (Actuonix L16-63) reaches 20 mm/s."""

CLEARANCE = 1.0
"""Distance between plate and dome before and after each indentation, mm: our choice."""

DEEPEST = 0.90
"""Depth of the saturation run as that share: our choice, near the seat; the paper says "until it saturates"."""

CYCLES = 3
"""Cycles of the loading and unloading loop: our choice."""


@dataclass(frozen=True, slots=True)
class RunProtocol:
    """Movements of the plate in one run. Lengths mm, times s, speed mm/s.

    Attributes:
        kind: The kind of run.
        depths: Plate travels after first contact at which the plate stays, in order; in a loop, its deepest point.
        hold: Time that the plate stays at each depth; 0 in a loop.
        rest: Time that the plate waits without contact before each indentation.
        reset: True if the cavity is vented and set to its driving pressure again in every rest.
        speed: Speed of the plate.
    """

    kind: RunKind
    depths: tuple[float, ...]
    hold: float
    rest: float
    reset: bool
    speed: float = SPEED

    @property
    def duration(self) -> float:
        """Seconds from beginning to end."""
        moves = 2 * (sum(self.depths) + len(self.depths) * CLEARANCE) / self.speed
        return moves + len(self.depths) * (self.hold + self.rest)

    def quicker(self, rest: float, hold: float | None = None) -> "RunProtocol":
        """The protocol with another rest (s) and, if given, another hold (s)."""
        return replace(self, rest=rest, hold=self.hold if hold is None else hold)

    def knots(self) -> tuple[Array, Array]:
        """Times (n,) s and plate travels (n,) mm of a piecewise linear motion; below zero there is no contact."""
        times, travels = [0.0], [-CLEARANCE]
        for depth in self.depths:
            for seconds, travel in (
                (self.rest, -CLEARANCE),
                ((depth + CLEARANCE) / self.speed, depth),
                (self.hold, depth),
                ((depth + CLEARANCE) / self.speed, -CLEARANCE),
            ):
                times.append(times[-1] + seconds)
                travels.append(travel)
        return np.array(times), np.array(travels)


def stairs(depth: float) -> tuple[float, ...]:
    """Depths at equal steps, mm, ending with ``depth``, even if the last step is shorter."""
    count = int(np.ceil(depth / STEP - 1e-6))
    return tuple(float(min(STEP * (k + 1), depth)) for k in range(count))


def protocol(kind: RunKind, height: float) -> RunProtocol:
    """Protocol of the paper for a run kind and a dome of inner ``height``, mm. Raises ValueError without a plate."""
    shallow, deep = SHARE * height, DEEPEST * height
    if kind == "steps":
        return RunProtocol(kind, stairs(shallow), HOLD, REST, True)
    if kind == "saturation":
        return RunProtocol(kind, stairs(deep), HOLD, SHORT_REST, False)
    if kind == "loop":
        return RunProtocol(kind, (shallow,) * CYCLES, 0.0, SHORT_REST, False)
    if kind == "relaxation":
        return RunProtocol(kind, (shallow,), RELAXATION, REST, True)
    raise ValueError(f"{kind} has no plate")


READ, READ_LONGEST = 0.25, 1.0
"""The read window is the last quarter of the hold, at most its last second: our choice, the paper does not state it. A
dome settles as an exponential does, most at first, and of the paper's 4 s the last one changes least; its 100 blocks
leave no noise."""

MARGIN = 0.01
"""Share of the hold, at least one block, that is left out between window and release, to exclude motion."""

RELEASED = 0.01
"""Contact is lost where the force stays below this share of the hold's, or within the noise, for `_STAYS` blocks."""

_STAYS = 3

EARLY = 3
"""Number of first indentations whose median contact is the run's: our choice, enough that the noise of one does not
matter. After deep indentations the wall has not recovered and contact comes deeper, while the model counts from the
dome as it was."""


TREMBLES = 0.5
"""Share of the greatest force by which a hand must let go to begin another press: our choice."""

FREE = 0.02
"""Least travel before first contact, as a share of the deepest indentation: our choice. Where the plate begins to move
and the force to rise at one place, the sensor may have been pressed before."""


@dataclass(frozen=True, slots=True)
class RunIndentations:
    """The indentations of a run, with the stretches behind them, in order of time.

    Attributes:
        parts: Block numbers of the indentations.
        bases: Baselines of force and pressure before contact.
        contacts: First contacts, None if there is none.
        indents: Readings of the indentations.
        pressed: True if the record begins with the sensor pressed.
        sign: -1 where the force falls as the sensor is pressed.
        least: Least force that counts as contact, N.
        onset: Plate position at the run's first contact, mm; NaN if there is none.
        coarse: Step in which the channel that shows first contact is read, as a share of its greatest change.
        free: Travel before the first contact, mm.
    """

    parts: list[Excursion]
    bases: list[Baseline]
    contacts: list[ContactOnset | None]
    indents: tuple[MeasuredIndentation, ...]
    pressed: bool
    sign: int
    least: float
    onset: float
    coarse: float = 0.0
    free: float = math.inf

    @property
    def at_once(self) -> bool:
        """True if the force rises as soon as the plate moves."""
        return self.free < FREE * max((one.indentation for one in self.indents if one.indentation > 0), default=0.0)

    @property
    def hidden(self) -> bool:
        """True if the place of `onset` is not known: read in too coarse steps, or without free travel before it."""
        return self.coarse > COARSE or self.at_once

    @property
    def onset_error(self) -> float:
        """Standard error of `onset`, mm, as of one contact, as all share a fitted shape; infinite if not known."""
        if self.hidden:
            return math.inf
        errors = [one.error for one in self.contacts if one is not None and one.fitted][:EARLY]
        return float(np.median(errors)) if errors else math.inf

    def kind(self, blocks: Blocks) -> RunKind:
        """Kind of run, by the indentations with contact."""
        touching = [one for one, contact in zip(self.parts, self.contacts, strict=True) if contact is not None]
        return kind_of(blocks, touching)


def find_indents(blocks: Blocks, *, by_hand: bool = False) -> RunIndentations:
    """Cut a run into indentations, one for each step of a loading, and read them; ``by_hand``: one for each press, even
    if the hand trembles. Raises InputError if the plate does not move."""
    parts, pressed = excursions(blocks, steps=False, turn=TREMBLES) if by_hand else excursions(blocks)
    if not parts:
        return RunIndentations([], [], [], (), pressed, 1, 0.0, math.nan)
    bases = [first_baseline(blocks, one) for one in parts]
    least, sign = threshold(blocks, bases, parts)
    seen, levels = (blocks, bases) if by_hand else showing_contact(blocks, bases)
    contacts = onsets(seen, parts, levels, *threshold(seen, levels, parts))
    bases = [_just_before(blocks, base, contact) for base, contact in zip(bases, contacts, strict=True)]
    fitted = [contact.position for contact in contacts if contact is not None and contact.fitted][:EARLY]
    onset = float(np.median(fitted)) if fitted else math.nan
    indents = tuple(
        _indent(blocks, one, base, contact, onset, (least, sign))
        for one, base, contact in zip(parts, bases, contacts, strict=True)
    )
    first = next((one for one, contact in zip(parts, contacts, strict=True) if contact is not None), None)
    free = math.inf if first is None or by_hand else onset - float(blocks.position[slice(*first.clear)].min())
    coarse = 0.0 if by_hand else max(step_share(seen, levels), min(blocks.joined))
    return RunIndentations(parts, bases, contacts, indents, pressed, sign, least, onset, coarse, free)


def read_window(blocks: Blocks, hold: tuple[int, int]) -> tuple[int, int]:
    """First block, and one after the last, of the window that is read in a hold."""
    begin, end = hold
    length = float(blocks.time[end - 1] - blocks.time[begin])
    last = max(int(np.searchsorted(blocks.time, blocks.time[end - 1] - MARGIN * length)), begin)
    last = min(last, max(end - 2, begin))
    start = int(np.searchsorted(blocks.time, blocks.time[last] - min(READ * length, READ_LONGEST)))
    return max(start, begin), last + 1


def _read_times(blocks: Blocks, hold: tuple[int, int]) -> tuple[float, float]:
    """Begin and end of the window read in a hold, s; a nominal begin where a gap covers the actual one."""
    start, end = read_window(blocks, hold)
    length = min(READ * float(blocks.time[hold[1] - 1] - blocks.time[hold[0]]), READ_LONGEST)
    first, last = float(blocks.time[start]), float(blocks.time[end - 1])
    lost = first - (last - length) > max(GAP, 2 * blocks.size / blocks.rate)
    return (last - length if lost else first), last


def _just_before(blocks: Blocks, base: Baseline, contact: ContactOnset | None) -> Baseline:
    """Baseline over the last `BEFORE` seconds before contact, ending a block before it; ``base`` if too short."""
    if contact is None:
        return base
    end = int(np.searchsorted(blocks.time, contact.time - 1.5 * blocks.size / blocks.rate))
    start = max(base.start, int(np.searchsorted(blocks.time, contact.time - BEFORE)))
    return baseline(blocks, start, end) if end - start >= max(4, (base.end - base.start) // 2) else base


def _indent(
    blocks: Blocks, one: Excursion, base: Baseline, contact: ContactOnset | None, onset: float, limit: tuple[float, int]
) -> MeasuredIndentation:
    least, sign = limit
    start, end = read_window(blocks, one.hold)
    at = slice(start, end)
    force = float(blocks.force[at].mean()) - base.mean[0]
    return MeasuredIndentation(
        contact=math.nan if contact is None else contact.time,
        hold=(float(blocks.time[one.hold[0]]), float(blocks.time[one.hold[1] - 1])),
        read=_read_times(blocks, one.hold),
        release=math.nan if contact is None else _release(blocks, one, base, max(RELEASED * sign * force, least), sign),
        onset=math.nan if contact is None else contact.position,
        fitted=contact is not None and contact.fitted,
        indentation=math.nan if contact is None else float(blocks.position[at].mean()) - onset,
        force=force,
        rise=float(blocks.pressure[at].mean()) - base.mean[1],
        driving=base.mean[1],
        zero_force=base.mean[0],
    )


def _release(blocks: Blocks, one: Excursion, base: Baseline, least: float, sign: int) -> float:
    start = one.hold[1]
    free = sign * (blocks.force[start : one.out] - base.mean[0]) <= least
    if free.size < _STAYS:
        return math.nan
    stays = np.lib.stride_tricks.sliding_window_view(free, _STAYS).all(axis=1)
    return float(blocks.time[start + int(stays.argmax())]) if stays.any() else math.nan
