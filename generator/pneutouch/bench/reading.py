"""A measured file to blocks: units and signs, and values that a channel cannot have measured."""

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.bench.blocks import BlockCollector
from pneutouch.bench.record import Blocks, SuspectInterval
from pneutouch.bench.source import MeasuredFile
from pneutouch.errors import InputError
from pneutouch.spec.campaign import ColumnMap, Rig
from pneutouch.tables.read import chunks
from pneutouch.tables.unit_words import ABSOLUTE, UNITS
from pneutouch.units import KPA, STANDARD_ATMOSPHERE

CLIPPED = 0.98
"""Share of an instrument's range at which it is taken for clipped: our choice, makers specify up to the range."""

BEYOND = 1.2
"""No instrument reads beyond this share of its range: where a channel does for long, its unit or the stated range is
wrong and nothing is clipped at that range; where it does for a moment, that is a fault of the line."""

SPIKE, FEW = 0.1, 3
"""A moment is shorter than this, in s, or than this many blocks if that is longer: our choice, a plate stays longer."""

GREATEST = 1e100
"""Greatest readings in internal units; no instrument reads more, and its square would overflow."""

FLAT, ALIKE = 0.1, 0.05
"""A flat top lasts longer than this, in s, and less than this share of the other blocks repeats the one before: a
coarse or noiseless channel repeats everywhere. Our choice."""

_PRESSED = 30.0
"""Noise standard deviations by which the force must change as evidence of movement: our choice."""

PLATE, HAND, LEAK = ("time", "position", "force", "pressure"), ("time", "force", "pressure"), ("time", "pressure")
"""Channels of a run with a plate, of one pressed by hand, whose travel nobody knows, and of one without a contact."""

_COPIED = 1e-6
"""Share of its span by which a channel that is a copy of another may differ from it, by rounding: our choice. No two
instruments agree so."""

_EXACT = 1e-9
"""Relative difference at which two blocks hold one and the same number, summing aside."""


def read_blocks(
    source: MeasuredFile,
    rig: Rig,
    progress: Callable[[float], None] = lambda share: None,
    ambient: float = STANDARD_ATMOSPHERE,
) -> Blocks:
    """Blocks of a measured file, in s, mm, N, MPa; ``progress`` is called with the share read, 0 to 1.

    About `blocks.BLOCK_RATE` blocks a second, or one sample each up to `blocks.SLOW` Hz. The file is read in one pass
    and never is in memory as a whole. Gaps, clipped parts and a last row that may be cut are among the warnings.

    Of a run without a plate (the source has the channels of `LEAK`) position and force are zero; of one pressed by hand
    (`HAND`) the position is. Of absolute pressures ``ambient`` (MPa) is subtracted.

    Raises InputError, naming file, column and row, as `tables.read.chunks`, for time that does not increase, more than
    half of the samples missing, and a channel that is dead; a run in which nothing moves, as a leak run, has no dead
    channel."""
    path, columns, keys = source.path, source.columns, source.channels
    pressed = "force" in keys
    names = {key: getattr(columns, key).name for key in keys}
    read = [PLATE.index(key) for key in keys]
    collector = BlockCollector(path, names=names)
    cut = False
    for chunk in chunks(path, [names[key] for key in keys], source.layout):
        collector.total = chunk.total
        samples = np.zeros((len(PLATE), chunk.rows.size))
        samples[read] = scaled(path, columns, keys, chunk.rows, chunk.values, ambient)
        collector.take(chunk.rows, samples)
        cut = cut or chunk.last is not None
        progress(chunk.share)
    blocks = collector.blocks()
    end = float(blocks.time[-1])
    warnings = [SuspectInterval(end, end, "last row left out: no line end, so its last number may be cut", False)][:cut]
    if pressed:
        _check_apart(blocks, names)
        if "position" in keys:
            _check_alive(blocks, names)
        warnings += _clipped(blocks, "force", blocks.force, blocks.force_extreme, rig.force_range_N, 1.0, "N")
    top_kPa = rig.pressure_range_kPa
    warnings += _clipped(blocks, "pressure", blocks.pressure, blocks.pressure_extreme, top_kPa, KPA, "kPa")
    return replace(blocks, warnings=(*blocks.warnings, *warnings))


def scaled(
    path: Path,
    columns: ColumnMap,
    keys: Sequence[str],
    rows: Array,
    values: Array,
    ambient: float = STANDARD_ATMOSPHERE,
) -> Array:
    """Values (k, n) of the columns ``keys`` in internal units, with their signs; ``rows`` (n,) are row numbers.

    Of absolute pressures ``ambient`` (MPa) is subtracted.

    Raises InputError, naming column and row, for a number beyond `GREATEST`.
    """
    factor = np.array([[UNITS[key][getattr(columns, key).unit] * getattr(columns, key).sign] for key in keys])
    with np.errstate(over="ignore"):
        converted: Array = values * factor
    if not (np.abs(converted) <= GREATEST).all():
        place, at = np.argwhere(~(np.abs(converted) <= GREATEST))[0]
        column = getattr(columns, keys[place])
        raise InputError(
            f"row {rows[at]:.0f}: column {column.name}: {values[place, at]:.3g} {column.unit}: no instrument "
            "reads that",
            file=path,
            remedy="must be a measured number",
        )
    for place, key in enumerate(keys):
        if getattr(columns, key).unit.endswith(ABSOLUTE):
            converted[place] -= ambient
    return converted


def _check_apart(blocks: Blocks, names: dict[str, str]) -> None:
    """Refuse two channels of which one is the other times a number, as one column given twice or copied is."""
    known = [(key, getattr(blocks, key)) for key in PLATE[1:] if key in names]
    for (first, one), (second, other) in itertools.combinations(known, 2):
        spans = float(np.ptp(one)), float(np.ptp(other))
        if blocks.size < 1 or one.size < 3 or min(spans) <= 0:
            continue
        slope, level = np.polyfit(one, other, 1)
        if np.abs(other - slope * one - level).max() <= _COPIED * spans[1]:
            raise InputError(
                f"columns {names[first]} and {names[second]} hold the same values"
                + ("" if math.isclose(slope, 1.0, rel_tol=1e-3) else f", times {slope:.4g}"),
                file=blocks.file,
                remedy=f"{first} and {second} must be measured apart: was one column copied, or named twice?",
            )


def _check_alive(blocks: Blocks, names: dict[str, str]) -> None:
    """Check force and pressure while the plate moves, the position where the force shows that it must have moved."""
    problem = f"dead: reads one and the same number from row {blocks.first_row[0]:.0f} on"
    question = "; was the right column named, the sensor connected?"
    moved = np.abs(np.diff(blocks.position, prepend=blocks.position[0]))
    if np.ptp(blocks.position) <= _EXACT * float(np.abs(blocks.position).max()):
        noise = float(np.median(blocks.force_spread))
        if blocks.size > 1 and np.ptp(blocks.force) > _PRESSED * noise:
            raise InputError(
                f"column {names['position']}: {problem} while the force changes{question}", file=blocks.file
            )
        return
    # Across a gap the plate has moved far between two blocks; that is no motion that was recorded.
    steps = np.diff(blocks.time, prepend=blocks.time[0] - np.median(np.diff(blocks.time)))
    moved = np.where(steps <= 2 * np.median(steps), moved, 0.0)
    moving = moved > 0.1 * moved.max()
    for key, values, spread in (
        ("force", blocks.force, blocks.force_spread),
        ("pressure", blocks.pressure, blocks.pressure_spread),
    ):
        close = _EXACT * float(np.abs(values).max())
        if spread[moving].max() <= close and np.ptp(values[moving]) <= close:
            raise InputError(f"column {names[key]}: {problem} whenever the plate moves{question}", file=blocks.file)


def _clipped(
    blocks: Blocks, key: str, values: Array, extreme: Array, top: float, unit: float, name: str
) -> list[SuspectInterval]:
    """Parts at the end of an instrument's range, or at a flat top below it."""
    beyond = extreme / unit > BEYOND * top
    spikes = _short(blocks, beyond)
    if (beyond & ~spikes).any():
        why = (
            f"{key} goes to {extreme.max() / unit:.4g} {name}, beyond the rig's range of {top:g}: is its unit right, "
            "or the rig's range?"
        )
        return [SuspectInterval(float(blocks.time[0]), float(blocks.time[-1]), why, True)]
    warnings = [
        SuspectInterval(
            start, end, f"{key} clipped: at {CLIPPED:g} of the range of {top:g} {name} or beyond", False, "clipped"
        )
        for start, end in _parts(blocks, (extreme / unit >= CLIPPED * top) & ~spikes)
    ]
    rest = np.where(spikes, 0.0, extreme)
    flat = _flat_top(blocks, values, getattr(blocks, f"{key}_spread"), rest)
    if not warnings:
        why = f"{key} clipped: a flat top at {rest.max() / unit:.4g} {name}"
        warnings = [SuspectInterval(start, end, why, False, "clipped") for start, end in _parts(blocks, flat)]
    return [*warnings, *_spikes(blocks, key, extreme / unit, spikes, f"{name}, beyond the rig's range of {top:g}")]


def _short(blocks: Blocks, beyond: Flags) -> Flags:
    """Those of the flagged blocks, (n,), that are in parts too short to come from the plate."""
    most = max(SPIKE * blocks.rate / blocks.size, FEW)
    short: Flags = np.zeros(beyond.size, bool)
    for start, end in _runs(beyond):
        short[start:end] = end - start < most
    return short


def _spikes(blocks: Blocks, key: str, extreme: Array, spikes: Flags, excess: str) -> list[SuspectInterval]:
    width = blocks.size / blocks.rate / 2
    return [
        SuspectInterval(
            float(blocks.time[start]) - width,
            float(blocks.time[end - 1]) + width,
            f"{key} spike: {extreme[start:end].max():.4g} {excess}, for a moment: a fault of the line?",
            False,
            "spike",
        )
        for start, end in _runs(spikes)
    ]


def _flat_top(blocks: Blocks, values: Array, spread: Array, extreme: Array) -> Flags:
    """Blocks that hold nothing but the extreme value, (n,); none where the channel is coarse or without noise."""
    close = _EXACT * extreme.max()
    quiet = spread <= close
    again = quiet & (np.abs(np.diff(values, prepend=np.nan)) <= close)
    top = quiet & (np.abs(values) >= extreme.max() - close)
    least = max(FLAT * blocks.rate / blocks.size, 5)
    others = ~top
    if top.sum() < least or not others.any() or again[others].mean() > ALIKE:
        return np.zeros(values.size, bool)
    long: Flags = np.zeros(values.size, bool)
    for start, end in _runs(top):
        long[start:end] = end - start >= least
    return long


def _runs(mask: Flags) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(np.int8), [0]])))
    return [(int(start), int(end)) for start, end in zip(edges[::2], edges[1::2], strict=True)]


def _parts(blocks: Blocks, mask: Flags) -> list[tuple[float, float]]:
    """Begin and end in s of the parts in which ``mask`` holds; those less than `FLAT` apart are one."""
    parts: list[tuple[float, float]] = []
    width = blocks.size / blocks.rate
    for start, end in _runs(mask):
        begin, finish = float(blocks.time[start] - width / 2), float(blocks.time[end - 1] + width / 2)
        if parts and begin - parts[-1][1] < FLAT:
            parts[-1] = (parts[-1][0], finish)
        else:
            parts.append((begin, finish))
    return parts
