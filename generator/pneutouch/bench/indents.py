"""Each loading and unloading to an indentation: the readings before contact and at the end of the hold."""

import math
from dataclasses import dataclass

import numpy as np

from pneutouch.bench.blocks import GAP
from pneutouch.bench.excursions import Excursion, excursions, kind_of
from pneutouch.bench.first_contact import BEFORE, Baseline, ContactOnset, baseline, first_baseline, onsets, threshold
from pneutouch.bench.record import Blocks, MeasuredIndentation
from pneutouch.spec.campaign import RunKind

READ, READ_LONGEST = 0.25, 1.0
"""The read window is the last quarter of the hold, at most its last second: our choice, the paper does not state it. A
dome settles as an exponential does, most at first, and of the paper's 4 s the last one changes least; its 100 blocks
leave no noise."""

MARGIN = 0.01
"""Share of the hold, at least one block, that is left between window and release, so that no motion gets in."""

RELEASED = 0.01
"""Contact is lost where the force is below this share of the hold's, or within the noise, for `_STAYS` blocks."""

_STAYS = 3

EARLY = 3
"""Indentations whose first contacts, in the median, are the run's: the wall stays behind after deep ones, so that later
contacts come deeper, while the model counts from the dome as it was. Enough that noise of one does not matter: our
choice."""


BIAS = 0.02
"""Bias of a first contact, mm, that its interval counts as a standard error: half of the one tested for a dome."""


@dataclass(frozen=True, slots=True)
class RunIndentations:
    """The indentations of a run, with the stretches behind them, in order of time.

    Attributes:
        parts: Block numbers.
        bases: Force and pressure before contact.
        contacts: First contacts, None if there is none.
        indents: Readings of the indentations.
        pressed: True if the record begins with the plate in.
        sign: -1 where the force falls as the sensor is pressed.
        least: Least force that counts as contact, N.
        onset: Plate position at the run's first contact, mm; NaN if there is none.
    """

    parts: list[Excursion]
    bases: list[Baseline]
    contacts: list[ContactOnset | None]
    indents: tuple[MeasuredIndentation, ...]
    pressed: bool
    sign: int
    least: float
    onset: float

    @property
    def onset_error(self) -> float:
        """Standard error of `onset`, infinite without one: that of one contact, as all share the fitted shape."""
        errors = [one.error for one in self.contacts if one is not None and one.fitted][:EARLY]
        return math.hypot(BIAS, float(np.median(errors))) if errors else math.inf

    def kind(self, blocks: Blocks) -> RunKind:
        """The kind of run that the indentations make."""
        touching = [one for one, contact in zip(self.parts, self.contacts, strict=True) if contact is not None]
        return kind_of(blocks.position, touching)


def find_indents(blocks: Blocks, *, steps: bool = True) -> RunIndentations:
    """Cut a run into its indentations, one each of the ``steps`` of a loading, and read them. Raises InputError if the
    plate does not move."""
    parts, pressed = excursions(blocks, steps=steps)
    if not parts:
        return RunIndentations([], [], [], (), pressed, 1, 0.0, math.nan)
    bases = [first_baseline(blocks, one) for one in parts]
    least, sign = threshold(blocks, bases, parts)
    contacts = onsets(blocks, parts, bases, least, sign)
    bases = [_just_before(blocks, base, contact) for base, contact in zip(bases, contacts, strict=True)]
    fitted = [contact.position for contact in contacts if contact is not None and contact.fitted][:EARLY]
    onset = float(np.median(fitted)) if fitted else math.nan
    indents = tuple(
        _indent(blocks, one, base, contact, onset, (least, sign))
        for one, base, contact in zip(parts, bases, contacts, strict=True)
    )
    return RunIndentations(parts, bases, contacts, indents, pressed, sign, least, onset)


def read_window(blocks: Blocks, hold: tuple[int, int]) -> tuple[int, int]:
    """Block numbers of the window read in a hold; at least one block."""
    begin, end = hold
    length = float(blocks.time[end - 1] - blocks.time[begin])
    last = max(int(np.searchsorted(blocks.time, blocks.time[end - 1] - MARGIN * length)), begin)
    last = min(last, max(end - 2, begin))
    start = int(np.searchsorted(blocks.time, blocks.time[last] - min(READ * length, READ_LONGEST)))
    return max(start, begin), last + 1


def _read_times(blocks: Blocks, hold: tuple[int, int]) -> tuple[float, float]:
    """Begin and end of the window read in a hold, s: of its blocks, or before a gap that covers its begin."""
    start, end = read_window(blocks, hold)
    length = min(READ * float(blocks.time[hold[1] - 1] - blocks.time[hold[0]]), READ_LONGEST)
    first, last = float(blocks.time[start]), float(blocks.time[end - 1])
    lost = first - (last - length) > max(GAP, 2 * blocks.size / blocks.rate)
    return (last - length if lost else first), last


def _just_before(blocks: Blocks, base: Baseline, contact: ContactOnset | None) -> Baseline:
    """Baseline over the last `BEFORE` seconds before contact, a block short of it."""
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
