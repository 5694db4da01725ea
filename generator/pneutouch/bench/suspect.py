"""Warnings about a run, each with its time interval and reason; nothing is dropped without one."""

import itertools
import math
from collections.abc import Sequence
from types import MappingProxyType

import numpy as np

from pneutouch.bench.contact import Baseline
from pneutouch.bench.indents import RunIndentations, read_window
from pneutouch.bench.protocol import HOLD, RELAXATION
from pneutouch.bench.record import Blocks, MeasuredIndentation, SuspectInterval
from pneutouch.spec.campaign import CampaignRun
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
    usual = RELAXATION if run.kind == "relaxation" else HOLD
    for number, indent in enumerate(indentations.indents, start=1):
        warnings += _of_one(number, indent, blocks, indentations, usual, run.kind != "loop")
    if run.kind != "loop":
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
    if math.isnan(indent.release):
        lasting = f"indentation {number}: no release: the force does not go back"
        warnings.append(SuspectInterval(end, float(blocks.time[-1]), lasting, True))
    return warnings


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
