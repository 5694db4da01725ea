"""A run's blocks to its curve: points read at the ends of holds, or the way in of a run without holds."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.contact import BEFORE, Baseline, baseline
from pneutouch.bench.doubts import doubts_of, listed, untrusted
from pneutouch.bench.indents import RunIndentations, find_indents
from pneutouch.bench.record import Blocks, MeasuredCurve, SuspectInterval
from pneutouch.errors import InputError
from pneutouch.spec.campaign import CampaignRun, Rig

WAY_POINTS = 25
"""Points on the way in of a loop or a relaxation run: our choice, about twice as many as the stairs have."""

_BEYOND_TRAVEL = 1.05


def curve_of(run: CampaignRun, blocks: Blocks, rig: Rig) -> MeasuredCurve:
    """The curve of a run with a plate; its first point is the origin.

    Steps and saturation: one point for each indentation, sorted by depth. Loop and relaxation: the way in, averaged over
    the cycles, at `WAY_POINTS` even depths. A force or rise that falls as the sensor is pressed stays negative
    (`plausible.check_plausible` tells). Noise is that of single samples without contact, from the spread within blocks and
    the one between their means about a straight line; drift the slope before the first contact.

    Raises InputError where the plate does not move or moves the wrong way, or nothing is ever touched.
    """
    if run.kind in ("leak", "injection"):
        raise InputError(f"{blocks.file}: a {run.kind} run has no plate and no curve")
    found = find_indents(blocks)
    touched = [k for k, contact in enumerate(found.contacts) if contact is not None]
    if not touched:
        raise InputError(_no_contact(blocks, found))
    doubts = [*listed(blocks.doubts), *_travel(blocks, rig), *doubts_of(run, blocks, found)]
    kept, left_out = _kept(blocks, found, touched)
    doubts += left_out
    if not kept:
        reasons = "; ".join(sorted({doubt.why for doubt in left_out}))
        raise InputError(f"{blocks.file}: none of {len(touched)} indentations can be used: {reasons}")
    ways = [_way(blocks, found, k) for k in kept] if run.kind in ("loop", "relaxation") else []
    points = _averaged(ways) if ways else _points(found, kept)
    bases = [found.bases[k] for k in kept]
    return MeasuredCurve(
        run, *points, driving=float(np.mean([base.mean[1] for base in bases])), indents=found.indents,
        loop=tuple(_cycle(blocks, found, k) for k in kept) if run.kind == "loop" else (),
        relaxation=_relaxation(blocks, found, kept[0]) if run.kind == "relaxation" else None,
        noise=(_noise(bases, 0), _noise(bases, 1)),
        drift=_drift(blocks, found),
        doubts=tuple(sorted(doubts, key=lambda doubt: (doubt.start, doubt.end, doubt.why))),
    )  # fmt: skip


def _no_contact(blocks: Blocks, found: RunIndentations) -> str:
    if not found.parts:
        return f"{blocks.file}: no contact: the plate never goes in and out; from {blocks.position.min():.4g} to {blocks.position.max():.4g} mm"
    noise = _noise(found.bases, 0)
    over = max(
        float(np.abs(blocks.force[one.clear[1] : one.hold[1]] - base.mean[0]).max())
        for one, base in zip(found.parts, found.bases, strict=True)
    )
    return (
        f"{blocks.file}: no contact: the force never leaves its noise: at most {over:.3g} N beyond what it is without, with "
        f"{noise:.3g} N of noise, in {len(found.parts)} indentations; did the plate reach the sensor, is columns.force the right column?"
    )


def _travel(blocks: Blocks, rig: Rig) -> list[SuspectInterval]:
    span = float(np.ptp(blocks.position))
    if span <= _BEYOND_TRAVEL * rig.travel_mm:
        return []
    why = f"position covers {span:.4g} mm, the rig's travel is {rig.travel_mm:g}: is its unit right?"
    return [SuspectInterval(float(blocks.time[0]), float(blocks.time[-1]), why, True)]


def _kept(blocks: Blocks, found: RunIndentations, touched: list[int]) -> tuple[list[int], list[SuspectInterval]]:
    kept, doubts = [], []
    for k in touched:
        indent = found.indents[k]
        why = untrusted(blocks, indent, BEFORE)
        if why is None:
            kept.append(k)
        else:
            told = f"indentation {k + 1}, {indent.indentation:.4g} mm, left out: {why}"
            doubts.append(SuspectInterval(*indent.read, told, False))
    return kept, doubts


def _points(found: RunIndentations, kept: Sequence[int]) -> tuple[Array, Array, Array]:
    points = np.array([
        (0.0, 0.0, 0.0),
        *((one.indentation, one.force, one.rise) for one in (found.indents[k] for k in kept)),
    ])  # fmt: skip
    depth, force, rise = points[np.argsort(points[:, 0], kind="stable")].T
    return depth, force, rise


def _way(blocks: Blocks, found: RunIndentations, k: int) -> tuple[Array, Array, Array]:
    """Indentation, force and rise of the blocks on a way in, from contact to the deepest."""
    part, base, indent = found.parts[k], found.bases[k], found.indents[k]
    start = int(np.searchsorted(blocks.time, indent.contact))
    end = _deepest(blocks, part.hold) + 1
    at = slice(min(start, end - 1), end)
    return blocks.position[at] - found.onset, blocks.force[at] - base.mean[0], blocks.pressure[at] - base.mean[1]


def _deepest(blocks: Blocks, hold: tuple[int, int]) -> int:
    """Where the way in ends: in the middle of a short stay, else at the hold's begin."""
    begin, end = hold
    return begin + int(blocks.position[begin:end].argmax()) if end - begin < WAY_POINTS else begin


def _averaged(ways: list[tuple[Array, Array, Array]]) -> tuple[Array, Array, Array]:
    """Ways in at even depths from the origin, averaged."""
    depth = np.linspace(0.0, min(float(way[0].max()) for way in ways), WAY_POINTS + 1)
    curves = np.zeros((2, len(ways), depth.size))
    for k, (place, force, rise) in enumerate(ways):
        order = np.argsort(place, kind="stable")
        for row, values in enumerate((force, rise)):
            curves[row, k, 1:] = np.interp(depth[1:], np.append(0.0, place[order]), np.append(0.0, values[order]))
    force, rise = curves.mean(axis=1)
    return depth, force, rise


def _cycle(blocks: Blocks, found: RunIndentations, k: int) -> tuple[Array, Array, Array, Array]:
    _, force, rise = _way(blocks, found, k)
    part, base, indent = found.parts[k], found.bases[k], found.indents[k]
    start = _deepest(blocks, part.hold)
    end = part.out if math.isnan(indent.release) else int(np.searchsorted(blocks.time, indent.release))
    out = slice(start, max(end, start + 1))
    return force, rise, blocks.force[out] - base.mean[0], blocks.pressure[out] - base.mean[1]


def _relaxation(blocks: Blocks, found: RunIndentations, k: int) -> tuple[Array, Array, Array]:
    at, base = slice(*found.parts[k].hold), found.bases[k]
    time = blocks.time[at]
    return time - time[0], blocks.force[at] - base.mean[0], blocks.pressure[at] - base.mean[1]


def _drift(blocks: Blocks, found: RunIndentations) -> tuple[float, float]:
    """Slopes of pressure and force over the last third of the first stretch without contact.

    There a reset is over and nothing was pressed yet: after an indentation the wall still recovers.
    """
    start, end = found.parts[0].clear
    slopes = baseline(blocks, end - max((end - start) // 3, 1), end).slope
    return slopes[1], slopes[0]


def _noise(bases: Sequence[Baseline], channel: int) -> float:
    """Of the stretches pooled: what single samples scatter about a straight line."""
    count = np.array([max(base.end - base.start - 2, 1) for base in bases], float)
    variance = np.array([base.between[channel] + base.within[channel] for base in bases])
    return float(np.sqrt(count @ variance / count.sum()))
