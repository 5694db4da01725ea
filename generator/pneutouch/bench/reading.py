"""Reading of a measured file into blocks, in the program's units and signs; evaluation of injection and leak runs."""

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.bench.record import BlockCollector, Blocks, SuspectInterval, stretches
from pneutouch.bench.run_warnings import refreshed
from pneutouch.bench.source import MeasuredFile, as_option, otherwise
from pneutouch.bench.statistics import Mean
from pneutouch.errors import InputError
from pneutouch.spec.campaign import Column, ColumnMap, Rig
from pneutouch.tables.read import chunks, whole
from pneutouch.tables.unit_words import ABSOLUTE, UNITS
from pneutouch.units import KPA, STANDARD_ATMOSPHERE

CLIPPED = 0.98
"""Share of an instrument's range from which a reading counts as clipped: our choice, makers specify the whole range."""

BEYOND = 1.2
"""Multiple of its range that no instrument reads: a longer reading beyond it means a wrong unit or stated range, not
clipping; a short one (`SPIKE`) a fault of the line."""

SPIKE, FEW = 0.1, 3
"""Duration in s, or number of blocks if longer, below which that is a spike: our choice, a plate stays longer."""

GREATEST = 1e100
"""Greatest reading in internal units: no instrument reads more, and squares of much larger ones would overflow."""

_USED = 0.1
"""Least share of its range that a press takes of an instrument whose unit is asked about: our choice."""

FLAT, ALIKE = 0.1, 0.05
"""A flat top lasts longer than this, in s, and less than this share of other blocks repeat the one before: a coarse or
noiseless channel repeats everywhere. Our choice."""

_PRESSED = 30.0
"""Change of the force, in noise standard deviations, that shows that the plate moved: our choice."""

PLATE, HAND, LEAK = ("time", "position", "force", "pressure"), ("time", "force", "pressure"), ("time", "pressure")
"""Channels of a run with a plate, of a run pressed by hand, whose travel is unknown, and of a run without contact."""

_COPIED, _LINEAR = 3e-4, 0.03
"""Difference, as a share of its span and beyond rounding, up to which a channel is a copy of another; the greatest with
rounding: our choice. No two instruments agree so closely, and no dome is so linear: those known bend by 0.045."""

_MEANS, _PARTS, _LEAST_PARTS, _BENT, _APART = 1000, 20, 8, 0.005, 6.0
"""Means over time and parts of the rise in which force and pressure are compared, least number of parts with means,
greatest uncertainty of their bend, as a share of the force, and standard errors by which the noise of one is not in the
other: our choice. No dome of the atlas bends by less than 0.0015, root mean square, and few by less than 0.005."""

_STILL, _GROWN, _RISEN = 1e-3, 0.02, 0.2
"""Shares of a channel's span: within the first of its greatest value it stays there; growth over as much travel before,
and rise of the force under a position that stays, above which it is at the end of its range: our choice."""

_EXACT = 1e-9
"""Relative difference up to which two blocks hold the same number: summing rounds."""


def read_blocks(
    source: MeasuredFile,
    rig: Rig,
    progress: Callable[[float], None] = lambda share: None,
    ambient: float = STANDARD_ATMOSPHERE,
) -> Blocks:
    """Blocks of a measured file, in s, mm, N, MPa; ``progress`` is called with the share read, 0 to 1.

    About `record.BLOCK_RATE` blocks a second, or one sample each up to `record.SLOW` Hz. The file is read in one pass
    and is never in memory as a whole. Gaps, clipped parts and a last row that may be cut are among the warnings.

    Position and force are zero in a run without a plate (the source has the channels `LEAK`), the position in one by
    hand (`HAND`). ``ambient`` (MPa) is subtracted from absolute pressures.

    Raises InputError, naming file, column and row, as `tables.read.chunks`, for time that does not increase, more than
    half of the samples missing, a dead channel (not in a run in which nothing moves, as a leak run), or two channels
    that are multiples of each other."""
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
    blocks, warnings = refreshed(replace(collector.blocks(), columns=columns), keys)
    if cut:
        end, why = float(blocks.time[-1]), "last row left out: no line end, so its last number may be cut"
        warnings.append(SuspectInterval(end, end, why, False))
    if "position" in keys:
        blocks = replace(blocks, position=blocks.position - rig.compliance_mm_per_N * blocks.force)
    if pressed:
        _check_apart(blocks, columns, keys)
        warnings += _copied(blocks)
        if "position" in keys:
            _check_alive(blocks, names)
            warnings += _at_end(blocks, "position")
    tops = {"force": (rig.force_range_N, 1.0, "N"), "pressure": (rig.pressure_range_kPa, KPA, "kPa")}
    for key in (key for key in keys if key in tops):
        found = _clipped(blocks, key, getattr(blocks, key), getattr(blocks, f"{key}_extreme"), *tops[key])
        clipped = any(one.kind == "clipped" for one in found)
        warnings += found if clipped or not pressed else [*found, *_at_end(blocks, key)]
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

    ``ambient`` (MPa) is subtracted from absolute pressures.

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


def _at_end(blocks: Blocks, key: str) -> list[SuspectInterval]:
    """Question on a channel that stays at its greatest value, noise aside, while another goes on; none if none does."""
    moved = bool(np.ptp(blocks.position) > 0)
    other = "position" if moved and key != "position" else "pressure" if not moved and key == "force" else "force"
    values, follows = getattr(blocks, key), getattr(blocks, other)
    noise = float(np.median(np.abs(np.diff(values, 2)))) if values.size > 2 else 0.0
    within = max(4.0 * noise, _STILL * float(np.ptp(values)))
    before = 0
    for start, end in stretches(values >= values.max() - within):
        went = float(follows[start:end].max() - follows[start])
        earlier = before + np.flatnonzero(follows[before:start] <= follows[start] - went)
        before, ended = end, False
        # A position that stays is a hold, in which the force relaxes: at its end alone the force goes on to rise.
        if key == "position":
            ended = went > _RISEN * float(np.ptp(follows)) > 0.0
        elif earlier.size and went > 0.0:
            slope = (values[start] - values[earlier[-1]]) / (follows[start] - follows[earlier[-1]])
            ended = bool(slope * went > max(3.0 * within, _GROWN * float(np.ptp(values))))
        if ended:
            why = f"the {key} stays at its greatest value while the {other} goes on: is that the end of its range?"
            return [SuspectInterval(float(blocks.time[start]), float(blocks.time[end - 1]), why, True, "asked")]
    return []


def _check_apart(blocks: Blocks, columns: ColumnMap, keys: Sequence[str]) -> None:
    """Raise InputError if one channel is a linear function of another, as when a column is copied or named twice, or
    the very time while others turn back."""
    known = [(key, getattr(blocks, key)) for key in PLATE if key in keys]
    steps = dict(zip(PLATE[2:], blocks.steps, strict=True))
    for (first, one), (second, other) in itertools.combinations(known, 2):
        spans = float(np.ptp(one)), float(np.ptp(other))
        if one.size < 3 or min(spans) <= 0:
            continue
        slope, level = np.polyfit(one, other, 1)
        rounding = 0.55 * (steps.get(second, 0.0) + abs(slope) * steps.get(first, 0.0))
        if np.abs(other - slope * one - level).max() <= min(_COPIED * spans[1] + rounding, _LINEAR * spans[1]):
            if first == "time" and not any(values[-1] < 0.5 * values.max() for _, values in known[1:]):
                continue
            of = [getattr(columns, key) for key in (first, second)]
            scale = [UNITS[key][column.unit] * column.sign for key, column in zip((first, second), of, strict=True)]
            times = slope * scale[0] / scale[1]
            raise InputError(
                f"columns {of[0].name} and {of[1].name} hold the same values"
                + ("" if math.isclose(times, 1.0, rel_tol=1e-3) else f", times {times:.4g}")
                + (" and an offset" if abs(level) > _COPIED * spans[1] else ""),
                file=blocks.file,
                remedy=f"{first} and {second} must be measured apart: was one column copied, or named twice?",
            )


def _copied(blocks: Blocks) -> list[SuspectInterval]:
    """Question on a force that is the pressure, or a multiple of it, and white noise; none where noise could hide
    how a dome bends it."""
    size = max(blocks.time.size // _MEANS, 1)
    whole = blocks.time.size // size * size
    means = np.stack([blocks.pressure[:whole], blocks.force[:whole]]).reshape(2, -1, size).mean(axis=2)
    spans = np.ptp(means, axis=1, keepdims=True)
    if spans.min() <= 0 or max(blocks.joined):
        return []
    rise, force = (means - means.min(axis=1, keepdims=True)) / spans
    part = np.minimum((rise * _PARTS).astype(int), _PARTS - 1)
    # All parts of the rise count alike, however long a hold is; the first is that without contact.
    rise, force, part = rise[part > 0], force[part > 0], part[part > 0]
    counts = np.bincount(part)
    if np.count_nonzero(counts) < _LEAST_PARTS:
        return []
    weights = 1 / counts[part] / np.count_nonzero(counts)
    off = force - np.polyval(np.polyfit(rise, force, 1, w=np.sqrt(weights)), rise)
    curve = np.polyval(np.polyfit(rise, off, 4, w=np.sqrt(weights)), rise)
    noise, bend = float(np.mean(np.diff(off) ** 2)) / 2, math.sqrt(weights @ curve**2)
    is_white = weights @ (off - curve) ** 2 < 2 * noise
    # A copy has the noise of the other too, and its own may hide that.
    rough = np.diff(np.stack([blocks.pressure, blocks.force]) / spans, 2)
    squares = np.maximum((rough**2).sum(axis=1), 1e-300)
    shared = 1 - float(rough[0] @ rough[1]) / squares
    apart = (shared > _APART * np.sqrt(squares[::-1] / squares / rough.shape[1])).all()
    if apart or not (is_white and bend < 4 * math.sqrt(noise * float(weights @ weights)) < _BENT):
        return []
    why = "the force follows the pressure in a straight line but for noise: was one made of the other?"
    return [SuspectInterval(float(blocks.time[0]), float(blocks.time[-1]), why, True, "asked")]


def _check_alive(blocks: Blocks, names: dict[str, str]) -> None:
    """Raise InputError for a channel constant while the plate moves, or a position while the force changes."""
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
    """Suspect intervals of a channel: at the end of the instrument's range, beyond it, or at a flat top below it."""
    beyond = extreme / unit > BEYOND * top
    # A stretch too short to come from the plate is a fault of the line.
    most = max(SPIKE * blocks.rate / blocks.size, FEW)
    short = [(start, end) for start, end in stretches(beyond) if end - start < most]
    spikes: Flags = np.zeros(beyond.size, bool)
    for start, end in short:
        spikes[start:end] = True
    if (beyond & ~spikes).any():
        why = f"{key} goes to {extreme.max() / unit:.4g} {name}, beyond the rig's range of {top:g}: is its unit right, "
        units = _within(getattr(blocks.columns, key), key, float(extreme.max()) / unit / top)
        why += "; ".join(["or the rig's range?", *units])
        return [SuspectInterval(float(blocks.time[0]), float(blocks.time[-1]), why, True, "asked")]
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
    width, excess = blocks.size / blocks.rate / 2, f"{name}, beyond the rig's range of {top:g}, for a moment"
    for start, end in short:
        why = f"{key} spike: {extreme[start:end].max() / unit:.4g} {excess}: a fault of the line?"
        at = float(blocks.time[start]) - width, float(blocks.time[end - 1]) + width
        warnings.append(SuspectInterval(*at, why, False, "spike"))
    return warnings


def _within(column: Column, key: str, times: float) -> list[str]:
    """Questions on units of a channel that bring it, at so many times its instrument's range, well within it."""
    declared, gauges = UNITS[key][column.unit], {u: by for u, by in UNITS[key].items() if ABSOLUTE not in u}
    found = [unit for unit, factor in gauges.items() if _USED < times * factor / declared <= BEYOND]
    options = (as_option(**{key: column.model_copy(update={"unit": unit})}) for unit in found)
    return [f"is it in {unit} ({option})?" for unit, option in zip(found, options, strict=True)]


def _flat_top(blocks: Blocks, values: Array, spread: Array, extreme: Array) -> Flags:
    """Flags (n,) of blocks that hold only the extreme value, for long; none if the channel is coarse or noiseless."""
    close = _EXACT * extreme.max()
    quiet = spread <= close
    again = quiet & (np.abs(np.diff(values, prepend=np.nan)) <= close)
    top = quiet & (np.abs(values) >= extreme.max() - close)
    least = max(FLAT * blocks.rate / blocks.size, 5)
    others = ~top
    if top.sum() < least or not others.any() or again[others].mean() > ALIKE:
        return np.zeros(values.size, bool)
    long: Flags = np.zeros(values.size, bool)
    for start, end in stretches(top):
        long[start:end] = end - start >= least
    return long


def _parts(blocks: Blocks, mask: Flags) -> list[tuple[float, float]]:
    """Begin and end in s of the parts in which ``mask`` holds; parts less than `FLAT` apart count as one."""
    parts: list[tuple[float, float]] = []
    width = blocks.size / blocks.rate
    for start, end in stretches(mask):
        begin, finish = float(blocks.time[start] - width / 2), float(blocks.time[end - 1] + width / 2)
        if parts and begin - parts[-1][1] < FLAT:
            parts[-1] = (parts[-1][0], finish)
        else:
            parts.append((begin, finish))
    return parts


LEAST_POINTS = 3

INJECTION = ("volume", "pressure")
"""Channels of an injection run."""

_BATCHES = 10
"""Parts of a leak run whose means give the slope's error: from single samples, correlated noise makes it too small."""

_ABSOLUTE = 0.7
"""Least pressure of a table over the ambient pressure above which the pressures look absolute."""


def read_injection(source: MeasuredFile, ambient: float = STANDARD_ATMOSPHERE) -> tuple[Array, Array]:
    """Injected volume (mm3, at ambient pressure) and gauge pressure (MPa), (n,) each, in the file's order.

    ``ambient`` (MPa) is subtracted from absolute pressures.

    Raises InputError for what `tables.read.chunks` does, for fewer than three rows, a volume that does not vary, and a
    pressure that does not rise with it, or begins near the ambient one.
    """
    path, columns = source.path, source.columns
    rows, values = whole(path, [getattr(columns, key).name for key in INJECTION], source.layout)
    volume, pressure = scaled(path, columns, INJECTION, rows, values, ambient)
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
            remedy=f"are the columns swapped, or is a sign wrong: {otherwise(columns, 'volume')}",
        )
    if _ABSOLUTE * ambient < float(pressure.min()) < 2 * ambient and volume.min() <= 0:
        right = otherwise(columns, "pressure", f"{columns.pressure.unit}{ABSOLUTE}")
        raise InputError(f"column {columns.pressure.name}: begins near the ambient pressure", file=path, remedy=right)
    return volume, pressure


def dead_volume_of_cap(volume: Array, pressure: Array, ambient: float) -> Mean:
    """Volume behind a rigid cap, mm3, from injected volumes (mm3, at ambient pressure) and gauge pressures (MPa).

    Boyle: pressure = pressure_0 + ambient / V volume, by least squares with both free (a gauge's zero, or a first push
    that was lost, does not matter), of at least `LEAST_POINTS` that rise. ``value`` is V, ``spread`` its standard error
    (count 1)."""
    centred = volume - volume.mean()
    square = float(centred @ centred)
    slope = float(centred @ pressure) / square
    rest = pressure - pressure.mean() - slope * centred
    error = math.sqrt(float(rest @ rest) / (volume.size - 2) / square)
    dead = ambient / slope
    return Mean(dead, dead * error / slope, 1)


def leak_rate(time: Array, pressure: Array) -> tuple[float, float]:
    """Leak rate of a closed line and its standard error (MPa/s, positive for a loss of pressure) from times (s) and
    gauge pressures (MPa), (n,) each.

    The rate is the slope of the least-squares line, its error from the scatter of the means of ten equal parts about
    that line (this takes correlated noise into account). Raises InputError for fewer than ten points."""
    if time.size < _BATCHES:
        raise InputError(f"a leak run of {time.size} points; at least {_BATCHES}")
    parts = np.array_split(np.arange(time.size), _BATCHES)
    at = np.array([time[part].mean() for part in parts])
    mean = np.array([pressure[part].mean() for part in parts])
    centred = at - at.mean()
    square = float(centred @ centred)
    slope = float(centred @ mean) / square
    rest = mean - mean.mean() - slope * centred
    return -slope, math.sqrt(float(rest @ rest) / (_BATCHES - 2) / square)
