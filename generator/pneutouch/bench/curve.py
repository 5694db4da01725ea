"""A run's blocks to its curve: points read at the ends of holds, or the loading of a run without holds.

Warnings about a run, each with its time interval and reason; nothing is dropped without one.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.excursions import NEAR, Excursion
from pneutouch.bench.first_contact import BEFORE, Baseline, baseline
from pneutouch.bench.indents import HOLD, RELAXATION, RunIndentations, find_indents, read_window
from pneutouch.bench.record import Blocks, MeasuredCurve, MeasuredIndentation, SuspectInterval
from pneutouch.errors import InputError
from pneutouch.spec.campaign import CampaignRun, Rig, RunKind
from pneutouch.units import KPA

SHORT = 0.5
"""A hold is short below this share of the paper's: our choice."""

SETTLED = 0.01
"""Share of the force or the rise by which the two halves of a read window may differ: our choice."""

LEAK = 0.02
"""Share of the greatest rise that a leak may take in a hold: our choice, about the difference between three runs."""

SAME_DEPTH = 0.03
"""mm within which two indentations have one depth: some standard deviations of an onset (0.004 to 0.01 mm)."""

MOST = 20
"""Gaps, clipped parts and spikes that are listed one by one, of each kind: our choice, for a readable list."""

_MANY = MappingProxyType({"gap": "gaps", "clipped": "clipped parts", "spike": "spikes"})

MISSING, PRESSED = 0.1, 0.002
"""Share of a loading that may be missing, and of its force that the force may change by before contact: our choice."""

_SURELY = 8.0
"""Standard errors of that change that are no chance, noise alike from sample to sample included: our choice."""

_SIGNIFICANT = 4.0
"""Standard errors that a change must exceed before it is reported: one false alarm in 10^4."""


def untrusted(blocks: Blocks, indent: MeasuredIndentation, before: float) -> str | None:
    """Reason why an indentation cannot be used: a channel clipped before contact or while read, or half of it missing;
    None if it can."""
    lost = 0.0
    for warning in blocks.warnings:
        if warning.used:
            continue
        in_read = min(warning.end, indent.read[1]) - max(warning.start, indent.read[0])
        if warning.kind == "gap":
            lost += max(in_read, 0.0)
        elif in_read >= 0 or (warning.end >= indent.contact - before and warning.start <= indent.contact):
            return warning.why
    return "most of its samples are missing" if lost > 0.5 * (indent.read[1] - indent.read[0]) else None


def listed(warnings: Sequence[SuspectInterval]) -> list[SuspectInterval]:
    """Warnings as listed: of gaps, clipped parts and spikes the first `MOST` of each and a sum of the others."""
    shown = [warning for warning in warnings if warning.kind not in _MANY]
    for kind, name in _MANY.items():
        alike = [warning for warning in warnings if warning.kind == kind]
        shown += alike[:MOST]
        more = alike[MOST:]
        if more:
            lasts = sum(warning.end - warning.start for warning in more)
            first, last = min(warning.start for warning in more), max(warning.end for warning in more)
            why = f"{len(more)} more {name}: {lasts:.3g} s in all"
            shown.append(SuspectInterval(first, last, why, False, more[0].kind))
    return shown


def run_warnings(run: CampaignRun, blocks: Blocks, indentations: RunIndentations) -> list[SuspectInterval]:
    """Warnings about holds, contacts, releases, depths and the pressure without contact, in order of time."""
    warnings: list[SuspectInterval] = []
    if indentations.pressed:
        end = indentations.parts[0].clear[0] if indentations.parts else blocks.time.size - 1
        why = "the record begins with the plate in; left out"
        warnings.append(SuspectInterval(float(blocks.time[0]), float(blocks.time[end]), why, False))
    usual, turns = RELAXATION if run.kind == "relaxation" else HOLD, run.kind in ("loop", "hand")
    for number, indent in enumerate(indentations.indents, start=1):
        warnings += _of_one(number, indent, blocks, indentations, usual, not turns)
    if not turns:
        warnings += _of_depths([indent for indent in indentations.indents if not math.isnan(indent.contact)])
    return warnings + _leak(blocks, indentations)


def _of_one(
    number: int, indent: MeasuredIndentation, blocks: Blocks, indentations: RunIndentations, usual: float, held: bool
) -> list[SuspectInterval]:
    begin, end = indent.hold
    if math.isnan(indent.contact):
        return [SuspectInterval(begin, end, f"indentation {number}: no contact found", False)]
    warnings = []
    contact = indentations.contacts[number - 1]
    if contact is not None and not contact.fitted:
        light = "too light for an onset by itself; its onset is the median of the others"
        warnings.append(SuspectInterval(indent.contact, begin, f"indentation {number}: {light}", True))
    if held and end - begin < SHORT * usual:
        short = f"indentation {number}: held for {end - begin:.3g} s, usual are {usual:g} s"
        warnings.append(SuspectInterval(begin, end, short, True))
    elif held and (why := _unsettled(blocks, indentations, number - 1)):
        warnings.append(SuspectInterval(*indent.read, f"indentation {number}: {why}", True))
    if math.isnan(indent.release) and not _goes_on(indentations, number - 1):
        lasting = f"indentation {number}: no release: the force does not go back"
        warnings.append(SuspectInterval(end, float(blocks.time[-1]), lasting, True))
    return warnings


def _goes_on(indentations: RunIndentations, number: int) -> bool:
    """True if the next indentation is a further step of the same loading."""
    parts = indentations.parts
    return number + 1 < len(parts) and parts[number + 1].clear == parts[number].clear


def _unsettled(blocks: Blocks, indentations: RunIndentations, number: int) -> str | None:
    start, end = read_window(blocks, indentations.parts[number].hold)
    middle, indent = (start + end) // 2, indentations.indents[number]
    if end - start < 4:
        return None
    for key, values, whole in (("force", blocks.force, indent.force), ("pressure", blocks.pressure, indent.rise)):
        first, last = values[start:middle], values[middle:end]
        change = float(last.mean() - first.mean())
        error = math.sqrt(first.var() / first.size + last.var() / last.size)
        if abs(change) > max(SETTLED * abs(whole), _SIGNIFICANT * error):
            return f"{key} not settled: changes by {100 * change / whole:.2g} % within the stretch that is read"
    return None


def _of_depths(indents: list[MeasuredIndentation]) -> list[SuspectInterval]:
    warnings = []
    for before, after in itertools.pairwise(indents):
        if after.indentation < before.indentation - SAME_DEPTH:
            why = f"out of order: {after.indentation:.3g} mm after {before.indentation:.3g} mm; sorted by depth"
            warnings.append(SuspectInterval(*after.hold, why, True))
    by_depth = sorted(indents, key=lambda one: one.indentation)
    for less, more in itertools.pairwise(by_depth):
        if more.indentation - less.indentation <= SAME_DEPTH:
            later = max(less, more, key=lambda one: one.contact)
            why = f"two indentations at one depth, {less.indentation:.4g} and {more.indentation:.4g} mm"
            warnings.append(SuspectInterval(*later.hold, why, True))
    return warnings


def _leak(blocks: Blocks, indentations: RunIndentations) -> list[SuspectInterval]:
    """A drift of the pressure without contact: during a hold by more than a share of the greatest rise."""
    touched = [
        (base, one)
        for base, one in zip(indentations.bases, indentations.indents, strict=True)
        if not math.isnan(one.contact) and base.end - base.start > 3
    ]
    if not touched:
        return []
    slopes = np.array([base.slope[1] for base, _ in touched])
    longest = max(one.hold[1] - one.contact for _, one in touched)
    top = max(abs(one.rise) for _, one in touched)
    slope = float(slopes.mean())
    error = math.sqrt(sum(_slope_variance(blocks, base) for base, _ in touched)) / slopes.size
    if abs(slope) * longest <= LEAK * top or abs(slope) <= _SIGNIFICANT * error:
        return []
    first, last = touched[0][0], touched[-1][0]
    why = (
        f"pressure without contact drifts by {60 * slope / KPA:.3g} kPa a minute, "
        f"{100 * abs(slope) * longest / top:.2g} % of the greatest rise during an indentation: a leak, or a reset "
        "that has not settled"
    )
    return [SuspectInterval(float(blocks.time[first.start]), float(blocks.time[last.end - 1]), why, True)]


def _slope_variance(blocks: Blocks, base: Baseline) -> float:
    time = blocks.time[base.start : base.end]
    return base.between[1] / float(((time - time.mean()) ** 2).sum())


LOADING_POINTS = 25
"""Points of the loading of a loop or a relaxation run: our choice, about twice as many as the stairs have."""

_BEYOND_TRAVEL = 1.05


def curve_of(run: CampaignRun, blocks: Blocks, rig: Rig) -> MeasuredCurve:
    """The curve of a run with a plate; its first point is the origin.

    A run without a stated kind is of that which its record shows. Steps and saturation: one point for each stay, sorted
    by depth. Loop, relaxation and a press by hand: the loading, averaged over the cycles, at `LOADING_POINTS` even
    depths, or forces by hand. A force or rise that falls as the sensor is pressed stays negative (see
    `run_checks.check_plausible`). Noise is that of single samples without contact, from the spread within blocks and
    that between their means about a straight line; drift is the slope before the first contact.

    Raises InputError if the plate does not move or moves backwards, or there is no contact.
    """
    if run.kind in ("leak", "injection"):
        raise InputError(f"a {run.kind} run has no plate and no curve", file=blocks.file)
    travels = _travel(blocks, rig)
    if run.kind == "hand":
        blocks = _by_force(blocks)
    indentations = find_indents(blocks, steps=run.kind != "hand")
    shows: RunKind = "hand" if run.kind == "hand" else indentations.kind(blocks)
    told = "kind" not in run.model_fields_set
    if told:
        run = run.model_copy(update={"kind": shows})
    touched = [k for k, contact in enumerate(indentations.contacts) if contact is not None]
    if not touched:
        raise InputError(_no_contact(blocks, indentations))
    warnings = [*listed(blocks.warnings), *travels, *run_warnings(run, blocks, indentations)]
    kept, left_out = _kept(blocks, indentations, touched)
    warnings += left_out
    if not kept:
        reasons = "; ".join(sorted({warning.why for warning in left_out}))
        raise InputError(f"none of {len(touched)} indentations can be used: {reasons}", file=blocks.file)
    turns = run.kind in ("loop", "hand")
    loadings = [_loading(blocks, indentations, k) for k in kept] if turns or run.kind == "relaxation" else []
    points = _averaged(loadings) if loadings else _points(indentations, kept)
    indents = indentations.indents
    if run.kind == "hand":
        points = np.full(points[0].size, np.nan), *points[1:]
        indents = tuple(replace(one, onset=math.nan, indentation=math.nan) for one in indents)
    bases = [indentations.bases[k] for k in kept]
    return MeasuredCurve(
        run,
        *points,
        driving=float(np.mean([base.mean[1] for base in bases])),
        indents=indents,
        loop=tuple(_cycle(blocks, indentations, k) for k in kept) if turns else (),
        relaxation=_relaxation(blocks, indentations, kept[0]) if run.kind == "relaxation" else None,
        noise=(_noise(bases, 0), _noise(bases, 1)),
        drift=_drift(blocks, indentations),
        onset_error=indentations.onset_error,
        shows=shows,
        told=told,
        warnings=tuple(sorted(warnings, key=lambda warning: (warning.start, warning.end, warning.why))),
    )


def _by_force(blocks: Blocks) -> Blocks:
    """A press by hand with its force in place of the travel, which nobody knows: loadings are found by it."""
    rest = float(np.median(blocks.force[: max(blocks.force.size // 50, 3)]))
    if rest - float(blocks.force.min()) > float(blocks.force.max()) - rest:
        raise InputError(
            f"column of the force: falls by {rest - float(blocks.force.min()):.3g} N as the sensor is pressed",
            file=blocks.file,
            remedy="it must rise: set columns.force.sign, or give `columns` with a minus before its name",
        )
    return replace(blocks, position=blocks.force)


def _no_contact(blocks: Blocks, indentations: RunIndentations) -> str:
    if not indentations.parts:
        span = f"from {blocks.position.min():.4g} to {blocks.position.max():.4g} mm"
        return f"{blocks.file}: no contact: the plate never goes in and out; {span}"
    noise = _noise(indentations.bases, 0)
    over = max(
        float(np.abs(blocks.force[one.clear[1] : one.hold[1]] - base.mean[0]).max())
        for one, base in zip(indentations.parts, indentations.bases, strict=True)
    )
    return (
        f"{blocks.file}: no contact: the force never leaves its noise: at most {over:.3g} N beyond what it is "
        f"without, with {noise:.3g} N of noise, in {len(indentations.parts)} indentations; did the plate reach the "
        "sensor, is columns.force the right column?"
    )


def _travel(blocks: Blocks, rig: Rig) -> list[SuspectInterval]:
    span = float(np.ptp(blocks.position))
    if span <= _BEYOND_TRAVEL * rig.travel_mm:
        return []
    why = f"position covers {span:.4g} mm, the rig's travel is {rig.travel_mm:g}: is its unit right?"
    return [SuspectInterval(float(blocks.time[0]), float(blocks.time[-1]), why, True)]


def _kept(blocks: Blocks, indentations: RunIndentations, touched: list[int]) -> tuple[list[int], list[SuspectInterval]]:
    kept, warnings = [], []
    for k in touched:
        indent, part = indentations.indents[k], indentations.parts[k]
        why = untrusted(blocks, indent, BEFORE)
        if not part.held and k - 1 in touched and _goes_on(indentations, k - 1):
            why = why or "the plate does not stay there, as it does at the steps before"
        why = why or _cut(blocks, indent, part.held) or _pressed(blocks, part, indent)
        if why is None:
            kept.append(k)
        else:
            message = f"indentation {k + 1}, {indent.indentation:.4g} mm, left out: {why}"
            warnings.append(SuspectInterval(*indent.read, message, False))
    return kept, warnings


def _cut(blocks: Blocks, indent: MeasuredIndentation, held: bool) -> str | None:
    """Reason why a loading without a stay cannot be used: much of it was not recorded, its deep end perhaps."""
    if held:
        return None
    begin, end = indent.contact, indent.hold[1] + max(indent.hold[1] - indent.contact, 0.0)
    gaps = [warning for warning in blocks.warnings if warning.kind == "gap"]
    lost = sum(max(min(gap.end, end) - max(gap.start, begin), 0.0) for gap in gaps)
    return "much of its way in and out is missing" if lost > MISSING * (end - begin) else None


def _pressed(blocks: Blocks, part: Excursion, indent: MeasuredIndentation) -> str | None:
    """Reason why an indentation cannot be used: the force rises with the plate already where it should be clear."""
    end = int(np.searchsorted(blocks.time, indent.contact))
    start = part.clear[0]
    # Where the plate rests first, the force may change for other reasons, and contact is found against its level.
    rests = np.ptp(blocks.position[slice(*part.clear)]) <= NEAR * indent.indentation
    if rests or end - start < 4:
        return None
    base = baseline(blocks, start, end)
    change = abs(base.slope[0]) * float(blocks.time[end - 1] - blocks.time[start])
    noise = math.sqrt(12 * base.between[0] / (end - start))
    if change <= max(_SURELY * noise, PRESSED * abs(indent.force)):
        return None
    return f"the force changes by {change:.2g} N before contact: the record begins with the sensor pressed"


def _points(indentations: RunIndentations, kept: Sequence[int]) -> tuple[Array, Array, Array]:
    points = np.array(
        [(0.0, 0.0, 0.0), *((one.indentation, one.force, one.rise) for one in (indentations.indents[k] for k in kept))]
    )
    depth, force, rise = points[np.argsort(points[:, 0], kind="stable")].T
    return depth, force, rise


def _loading(blocks: Blocks, indentations: RunIndentations, k: int) -> tuple[Array, Array, Array]:
    """Indentation, force and rise of the blocks of a loading, from contact to the deepest point."""
    part, base, indent = indentations.parts[k], indentations.bases[k], indentations.indents[k]
    start = int(np.searchsorted(blocks.time, indent.contact))
    end = _deepest(blocks, part.hold) + 1
    at = slice(min(start, end - 1), end)
    return blocks.position[at] - indentations.onset, blocks.force[at] - base.mean[0], blocks.pressure[at] - base.mean[1]


def _deepest(blocks: Blocks, hold: tuple[int, int]) -> int:
    """Block at which the loading ends: the deepest of a short stay, else the first at the depth of the stay."""
    begin, end = hold
    place = blocks.position[begin:end]
    return begin + int(place.argmax() if end - begin < LOADING_POINTS else (place >= np.median(place)).argmax())


def _averaged(loadings: list[tuple[Array, Array, Array]]) -> tuple[Array, Array, Array]:
    """Loadings at even depths from the origin, averaged."""
    depth = np.linspace(0.0, min(float(loading[0].max()) for loading in loadings), LOADING_POINTS + 1)
    curves = np.zeros((2, len(loadings), depth.size))
    for k, (place, force, rise) in enumerate(loadings):
        order = np.argsort(place, kind="stable")
        for row, values in enumerate((force, rise)):
            curves[row, k, 1:] = np.interp(depth[1:], np.append(0.0, place[order]), np.append(0.0, values[order]))
    force, rise = curves.mean(axis=1)
    return depth, force, rise


def _cycle(blocks: Blocks, indentations: RunIndentations, k: int) -> tuple[Array, Array, Array, Array]:
    _, force, rise = _loading(blocks, indentations, k)
    part, base, indent = indentations.parts[k], indentations.bases[k], indentations.indents[k]
    start = _deepest(blocks, part.hold)
    end = part.out if math.isnan(indent.release) else int(np.searchsorted(blocks.time, indent.release))
    out = slice(start, max(end, start + 1))
    return force, rise, blocks.force[out] - base.mean[0], blocks.pressure[out] - base.mean[1]


def _relaxation(blocks: Blocks, indentations: RunIndentations, k: int) -> tuple[Array, Array, Array]:
    at, base = slice(*indentations.parts[k].hold), indentations.bases[k]
    time = blocks.time[at]
    return time - time[0], blocks.force[at] - base.mean[0], blocks.pressure[at] - base.mean[1]


def _drift(blocks: Blocks, indentations: RunIndentations) -> tuple[float, float]:
    """Slope of the pressure over the last third of the first stretch without contact, and its standard error.

    There a reset is over and nothing was pressed yet: after an indentation the wall still recovers.
    """
    start, end = indentations.parts[0].clear
    base = baseline(blocks, end - max((end - start) // 3, 1), end)
    return base.slope[1], math.sqrt(_slope_variance(blocks, base)) if base.end - base.start > 3 else math.inf


def _noise(bases: Sequence[Baseline], channel: int) -> float:
    """Noise of a channel: scatter of single samples about a straight line, pooled over the stretches."""
    count = np.array([max(base.end - base.start - 2, 1) for base in bases], float)
    variance = np.array([base.between[channel] + base.within[channel] for base in bases])
    return float(np.sqrt(count @ variance / count.sum()))
