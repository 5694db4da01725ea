"""Warnings about a run, each with its time interval and reason, and reasons why an indentation cannot be used."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from pneutouch.arrays import Index
from pneutouch.bench.excursions import NEAR, Excursion, rough_lag
from pneutouch.bench.first_contact import COARSE, Baseline, baseline, step_share
from pneutouch.bench.indents import HOLD, RELAXATION, RunIndentations, read_window
from pneutouch.bench.record import GAP, Blocks, MeasuredIndentation, SuspectInterval, SuspectKind, stretches
from pneutouch.errors import InputError
from pneutouch.spec.campaign import CampaignRun
from pneutouch.units import KPA

SHORT = 0.5
"""Share of the paper's hold below which a hold is reported as short: our choice."""

SETTLED = 0.01
"""Share of the force or the rise by which the two halves of a read window may differ: our choice."""

LEAK = 0.02
"""Share of the greatest rise that a leak may take during an indentation before it is asked about: our choice, about the
difference between three runs. The sensitivity over stairs is off by as much."""

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
    if (share := max(blocks.joined)) > _FAST and run.kind not in ("steps", "saturation"):
        why = f"between two readings of a slow gauge the press goes {share:.0%} of its way: press slower"
        warnings.append(SuspectInterval(float(blocks.time[0]), float(blocks.time[-1]), why, True, "asked"))
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
    elif min(blocks.joined) > 0.0:
        why = "first contact lies between two readings of slow gauges: press slower, for figures over travel"
    elif indentations.at_once:
        why = (
            f"the plate moves {max(indentations.free, 0.0):.2g} mm before the force rises, so first contact was not "
            "seen: was the sensor pressed already? Start the recording, and zero force and gauge, clear of the dome"
        )
    elif math.isinf(indentations.onset_error):
        why = (
            "the place of first contact is lost in noise, and figures over travel with it: press slower, or more often"
        )
    else:
        return []
    kind: SuspectKind = "other" if math.isfinite(indentations.onset_error) else "asked"
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
        back = blocks.position[indentations.parts[number - 1].out - 1] < indent.onset
        kind: SuspectKind = "asked" if back and blocks.position is not blocks.force else "other"
        warnings.append(SuspectInterval(end, float(blocks.time[-1]), lasting, True, kind))
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
    for less, more in itertools.pairwise(sorted(indents, key=lambda one: one.indentation)):
        if more.indentation - less.indentation <= SAME_DEPTH:
            later = max(less, more, key=lambda one: one.contact)
            why = f"two indentations at one depth, {less.indentation:.4g} and {more.indentation:.4g} mm"
            warnings.append(SuspectInterval(*later.hold, why, True))
    return warnings


def _leak(blocks: Blocks, indentations: RunIndentations) -> list[SuspectInterval]:
    """Question on a drift without contact that takes more than `LEAK` of the greatest rise during an indentation; only
    a note where readings of a slow gauge are joined, whose slope has another error."""
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
        "that has not settled? Seal the sensor, and let it rest before it is pressed"
    )
    kind: SuspectKind = "other" if blocks.joined[1] else "asked"
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


_RETURNED, _LEAST, _SAME, _TRIES, _TRY = 0.1, 8, 1e-9, 8, 0.2
"""Share of its way in by which a plate may end a press short of its clear end, for its lag; blocks that are averaged at
an end, and least number of refreshes; relative difference of the same reading; number of steps in which a lag is found,
and the longest, s: our choice."""


def behind(blocks: Blocks, indentations: RunIndentations, key: str) -> float:
    """Time in s by which a channel follows the travel, by the area that it encloses over it, in and out.

    The area of y(t - lag) over x is -lag times the integral of y' x', for a short lag. A wall that relaxes, a leak and
    warmed gas all make a channel lead; a drift from before to after a press is taken out."""
    time, place, lag = blocks.time, blocks.position, rough_lag(blocks, key)
    clear = [*sorted({one.clear for one in indentations.parts}), (0, time.size)]
    sign = -1 if np.interp(time + lag, time, getattr(blocks, key)) @ (place - place.mean()) < 0 else 1
    for _ in range(_TRIES):
        values = sign * np.interp(time + lag, time, getattr(blocks, key))
        area = speeds = 0.0
        for (start, _), (_, out) in itertools.pairwise(clear):
            x, t, y = place[start:out], time[start:out], values[start:out]
            steps = np.diff(t)
            gone = t.size >= 2 * _LEAST and x[-_LEAST:].mean() - x[:_LEAST].mean() <= _RETURNED * np.ptp(x)
            if not gone or steps.max() > GAP + 2 * np.median(steps):
                continue
            y = y - np.interp(t, t[[0, -1]], [y[:_LEAST].mean(), y[-_LEAST:].mean()])
            area += float((0.5 * (y[1:] + y[:-1])) @ np.diff(x))
            speeds += float((np.diff(y) / steps) @ np.diff(x))
        lag -= float(np.clip(area / max(speeds, 1e-300), -_TRY, _TRY))
    return lag


_KEPT, _GOES_ON, _GREAT, _TURNED, _FAST = 0.6, 0.75, 0.015, 0.003, 0.3
"""Share of the blocks that repeat the one before, and of another channel's way that it makes meanwhile, from which on a
channel is refreshed seldom; steps of the travel, as a share of its span, that are too great for figures over it; shares
of its span by which a channel leaves its straight line between refreshes where the plate turns, and that the other may
go between two: our choice."""


def refreshed(blocks: Blocks, channels: Sequence[str]) -> tuple[Blocks, list[SuspectInterval]]:
    """Blocks with straight lines through the readings of a force or pressure at the moments at which it is refreshed,
    and notes on that. Where the plate turns in between, the other channel shows how far it went.

    Raises InputError for a travel whose steps are great while force and pressure go on."""
    notes = []
    others = {"position": ("force", "pressure"), "force": ("pressure", "position"), "pressure": ("force", "position")}
    for key in (one for one in others if one in channels):
        # The other channel must itself be read more often.
        live = (one for one in others[key] if one in channels and _refreshes(blocks, one, key) is None)
        found = ((one, _refreshes(blocks, key, one)) for one in live)
        other, at = next((one for one in found if one[1] is not None), ("", None))
        if at is None:
            continue
        span, follows, time = np.ptp(getattr(blocks, key)), getattr(blocks, other), blocks.time
        # The block with which a reading begins may still hold some of the one before.
        values = getattr(blocks, key)[at + 1]
        step = float(np.median(np.abs(np.diff(values))))
        if key == "position":
            if step > _GREAT * span:
                problem = f"column {blocks.columns.position.name}: one reading stays while the force goes on, for steps"
                remedy = "record the travel finer or more often, or give `kind` hand, which does without it"
                raise InputError(f"{problem} of {step:.2g} mm", file=blocks.file, remedy=remedy)
            continue
        if step <= 1.5 * blocks.steps[key == "pressure"]:
            continue
        line = np.interp(time, time[at], values)
        alike = np.polyval(np.polyfit(follows[at], values, 3), follows)
        turn = alike - np.interp(time, time[at], alike[at])
        line += np.where(np.abs(turn) > _TURNED * span, turn, 0.0)
        share = float(np.abs(np.diff(follows[at])).max() / np.ptp(follows))
        joined = (share, blocks.joined[1]) if key == "force" else (blocks.joined[0], share)
        blocks = replace(blocks, joined=joined, **{key: line, f"{key}_extreme": np.abs(line)})
        every = f"refreshes only every {float(np.median(np.diff(time[at]))):.2g} s; its readings are joined by lines"
        notes.append(SuspectInterval(float(time[0]), float(time[-1]), f"the {key} {every}", True))
    return blocks, notes


def _refreshes(blocks: Blocks, key: str, other: str) -> Index | None:
    """Blocks (k,) with which a new reading of a channel begins; None if it is read as often as the other."""
    values, follows = getattr(blocks, key), getattr(blocks, other)
    again = np.abs(np.diff(values, prepend=np.nan)) <= _SAME * np.abs(values).max()
    kept = np.array(stretches(again), int).reshape(-1, 2)
    if again.mean() < _KEPT or len(kept) < _LEAST:
        return None
    start, end = kept[:, 0] - 1, kept[:, 1] - 1
    way = float(np.abs(np.diff(follows[start])).sum())
    return start if float(np.abs(follows[end] - follows[start]).sum()) > _GOES_ON * way else None
