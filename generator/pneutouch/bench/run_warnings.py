"""Warnings about a run, each with its time interval and reason, and reasons why an indentation cannot be used."""

import itertools
import math
from collections.abc import Sequence
from types import MappingProxyType

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.excursions import NEAR, Excursion
from pneutouch.bench.first_contact import COARSE, Baseline, baseline, step_share
from pneutouch.bench.indents import HOLD, RELAXATION, RunIndentations, read_window
from pneutouch.bench.record import Blocks, MeasuredIndentation, SuspectInterval, SuspectKind
from pneutouch.spec.campaign import CampaignRun
from pneutouch.units import KPA

SHORT = 0.5
"""Share of the paper's hold below which a hold is reported as short: our choice."""

SETTLED = 0.01
"""Share of the force or the rise by which the two halves of a read window may differ: our choice."""

LEAK, ASKED = 0.02, 0.05
"""Shares of the greatest rise that a leak may take during an indentation before it is noted, and before it is asked
about: our choice, the first about the difference between three runs."""

SAME_DEPTH = 0.03
"""Difference in mm up to which two depths are the same: some standard deviations of an onset (0.004 to 0.01 mm)."""

MOST = 20
"""Gaps, clipped parts and spikes that are listed one by one, of each kind: our choice, for a readable list."""

_MANY = MappingProxyType({"gap": "gaps", "clipped": "clipped parts", "spike": "spikes"})

MISSING, PRESSED = 0.1, 0.002
"""Share of a loading that may be missing, and of its force by which the force may change before contact: our choice."""

SURELY = 8.0
"""Multiple of its noise above which a change of the force is no chance, even with correlated noise: our choice."""

_SIGNIFICANT = 4.0
"""Standard errors that a change must exceed before it is reported: one false alarm in 10^4."""


def untrusted(blocks: Blocks, indent: MeasuredIndentation, before: float) -> str | None:
    """Reason why an indentation cannot be used: a channel clipped while read or within ``before`` s before contact, or
    half of the read samples missing; None if it can be used."""
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
    """Warnings as listed: the first `MOST` gaps, clipped parts and spikes each and a sum of the rest; all others."""
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
    """Warnings about holds, contacts, releases, depths and the pressure without contact."""
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
    # By hand the stretch before contact is found by the force itself, and ends a little late for a slope.
    return warnings if run.kind == "hand" else warnings + _leak(blocks, indentations) + _place(blocks, indentations)


def _place(blocks: Blocks, indentations: RunIndentations) -> list[SuspectInterval]:
    """Doubt about the place of first contact: hidden by the steps of the channels, or by a plate that is not clear."""
    if indentations.bases and step_share(blocks, indentations.bases) > COARSE:
        why = f"the force is read in steps of {blocks.steps[0]:.2g} N; first contact is found by the pressure"
        if indentations.hidden:
            why = (
                f"first contact is hidden by steps of {blocks.steps[0]:.2g} N and {blocks.steps[1] / KPA:.2g} kPa, and "
                "figures over travel are uncertain by more than 2 %: can the instruments be set to a finer range?"
            )
    elif indentations.hidden:
        why = (
            f"the plate moves {max(indentations.free, 0.0):.2g} mm before the force rises, so first contact was not "
            "seen: was the sensor pressed already? Start the recording, and zero force and gauge, clear of the dome"
        )
    else:
        return []
    kind: SuspectKind = "asked" if indentations.hidden else "other"
    return [SuspectInterval(float(blocks.time[0]), float(blocks.time[-1]), why, True, kind)]


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
        warnings.append(SuspectInterval(indent.contact, begin, f"indentation {number}: {light}", True, "note"))
    if held and end - begin < SHORT * usual:
        short = f"indentation {number}: held for {end - begin:.3g} s, usual are {usual:g} s"
        warnings.append(SuspectInterval(begin, end, short, True))
    elif held and (why := _unsettled(blocks, indentations, number - 1)):
        warnings.append(SuspectInterval(*indent.read, f"indentation {number}: {why}", True))
    if math.isnan(indent.release) and not goes_on(indentations, number - 1):
        lasting = f"indentation {number}: no release: the force does not go back"
        warnings.append(SuspectInterval(end, float(blocks.time[-1]), lasting, True))
    return warnings


def goes_on(indentations: RunIndentations, number: int) -> bool:
    """True if the indentation after ``number`` (counted from 0) is a further step of the same loading."""
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
    """Warning about a drift without contact that takes more than `LEAK` of the greatest rise during an indentation."""
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
    error = math.sqrt(sum(slope_variance(blocks, base) for base, _ in touched)) / slopes.size
    if abs(slope) * longest <= LEAK * top or abs(slope) <= _SIGNIFICANT * error:
        return []
    first, last = touched[0][0], touched[-1][0]
    why = (
        f"pressure without contact drifts by {60 * slope / KPA:.3g} kPa a minute, "
        f"{100 * abs(slope) * longest / top:.2g} % of the greatest rise during an indentation: a leak, or a reset "
        "that has not settled"
    )
    kind: SuspectKind = "asked" if abs(slope) * longest > ASKED * top else "other"
    return [SuspectInterval(float(blocks.time[first.start]), float(blocks.time[last.end - 1]), why, True, kind)]


def slope_variance(blocks: Blocks, base: Baseline) -> float:
    """Variance of the slope of the pressure over a stretch without contact, (MPa/s)^2."""
    time = blocks.time[base.start : base.end]
    return base.between[1] / float(((time - time.mean()) ** 2).sum())


def cut_short(blocks: Blocks, indent: MeasuredIndentation, held: bool) -> str | None:
    """Reason why a loading without a stay cannot be used: much of it was not recorded; None if it can be."""
    if held:
        return None
    begin, end = indent.contact, indent.hold[1] + max(indent.hold[1] - indent.contact, 0.0)
    gaps = [warning for warning in blocks.warnings if warning.kind == "gap"]
    lost = sum(max(min(gap.end, end) - max(gap.start, begin), 0.0) for gap in gaps)
    return "much of its way in and out is missing" if lost > MISSING * (end - begin) else None


def pressed_before(blocks: Blocks, part: Excursion, indent: MeasuredIndentation) -> str | None:
    """Reason why an indentation cannot be used: the force changes where the plate should be clear; else None."""
    end = int(np.searchsorted(blocks.time, indent.contact))
    start = part.clear[0]
    # Where the plate rests first, the force may change for other reasons, and contact is found against its level.
    rests = np.ptp(blocks.position[slice(*part.clear)]) <= NEAR * indent.indentation
    if rests or end - start < 4:
        return None
    base = baseline(blocks, start, end)
    change = abs(base.slope[0]) * float(blocks.time[end - 1] - blocks.time[start])
    noise = math.sqrt(12 * base.between[0] / (end - start))
    if change <= max(SURELY * noise, PRESSED * abs(indent.force)):
        return None
    return f"the force changes by {change:.2g} N before contact: the record begins with the sensor pressed"


_BEND, _MOST_LAG = 0.2, 0.6
"""Time over which a bend of force or pressure is measured, and greatest lag that is looked for, s: our choice."""

_MATCHED, _BLURRED, _LAG_COUNTS = 0.9, 0.5, 0.01
"""Correlation of the bends above which their lag is known, greatest one at other lags, and change of the rise at its
steepest, as a share of its span, above which a lag is asked about: our choice."""


def lagging(blocks: Blocks) -> list[SuspectInterval]:
    """Doubt about the time between force and pressure, or none: both bend where the plate turns, so must coincide."""
    if blocks.time.size < 3:
        return []
    step = float(np.median(np.diff(blocks.time)))
    even = np.arange(blocks.time[0], blocks.time[-1], step)
    force, rise = (np.interp(even, blocks.time, values) for values in (blocks.force, blocks.pressure))
    lag = _lag(force, rise, step)
    span = float(np.ptp(rise))
    if abs(lag) < 2 * step or float(np.abs(np.diff(rise)).max()) * abs(lag) / step < _LAG_COUNTS * span:
        return []
    first, later = ("pressure", "force") if lag < 0 else ("force", "pressure")
    why = f"{later} turns {abs(lag):.2g} s after the {first}: does a filter or another clock delay one of the channels?"
    return [SuspectInterval(float(blocks.time[0]), float(blocks.time[-1]), why, True, "asked")]


def _lag(force: Array, rise: Array, step: float) -> float:
    """Time in s by which the bends of the rise follow those of the force, both (n,) at even times; 0 if not known.

    The second differences over `_BEND` are correlated. A smooth press or a resin that relaxes fast has no sharp
    maximum."""
    half, reach = max(round(_BEND / step), 2), round(_MOST_LAG / step)
    if force.size < 8 * half or reach < 2:
        return 0.0
    bends = [x[2 * half :] - 2 * x[half:-half] + x[: -2 * half] for x in (force, rise)]
    of_force, of_rise = (bend - bend.mean() for bend in bends)
    scale = math.sqrt(float((of_force**2).sum() * (of_rise**2).sum()))
    if scale == 0.0:
        return 0.0
    lags = np.arange(-3 * reach, 3 * reach + 1)
    size = 2 ** (of_force.size + lags.size).bit_length()
    match = np.fft.irfft(np.fft.rfft(of_rise, size) * np.conj(np.fft.rfft(of_force, size)), size)[lags] / scale
    near = np.abs(lags) <= reach
    best = int(np.argmax(np.where(near, match, -1.0)))
    known = match[best] >= _MATCHED and float(np.abs(match[~near]).max()) <= _BLURRED
    return step * float(lags[best]) if known else 0.0
