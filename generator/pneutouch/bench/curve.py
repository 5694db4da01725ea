"""A run's blocks to its curve: points read at the ends of holds, or the loading of a run without holds."""

import math
from collections.abc import Sequence

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.contact import BEFORE, Baseline, baseline
from pneutouch.bench.indents import RunIndentations, find_indents
from pneutouch.bench.record import Blocks, MeasuredCurve, SuspectInterval
from pneutouch.bench.suspect import listed, run_warnings, untrusted
from pneutouch.errors import InputError
from pneutouch.spec.campaign import CampaignRun, Rig

LOADING_POINTS = 25
"""Points of the loading of a loop or a relaxation run: our choice, about twice as many as the stairs have."""

_BEYOND_TRAVEL = 1.05


def curve_of(run: CampaignRun, blocks: Blocks, rig: Rig) -> MeasuredCurve:
    """The curve of a run with a plate; its first point is the origin.

    Steps and saturation: one point for each indentation, sorted by depth. Loop and relaxation: the loading, averaged
    over the cycles, at `LOADING_POINTS` even depths. A force or rise that falls as the sensor is pressed stays negative
    (see `plausible.check_plausible`). Noise is that of single samples without contact, from the spread within blocks
    and that between their means about a straight line; drift is the slope before the first contact.

    Raises InputError if the plate does not move or moves backwards, or there is no contact.
    """
    if run.kind in ("leak", "injection"):
        raise InputError(f"a {run.kind} run has no plate and no curve", file=blocks.file)
    indentations = find_indents(blocks)
    touched = [k for k, contact in enumerate(indentations.contacts) if contact is not None]
    if not touched:
        raise InputError(_no_contact(blocks, indentations))
    warnings = [*listed(blocks.warnings), *_travel(blocks, rig), *run_warnings(run, blocks, indentations)]
    kept, left_out = _kept(blocks, indentations, touched)
    warnings += left_out
    if not kept:
        reasons = "; ".join(sorted({warning.why for warning in left_out}))
        raise InputError(f"none of {len(touched)} indentations can be used: {reasons}", file=blocks.file)
    loadings = [_loading(blocks, indentations, k) for k in kept] if run.kind in ("loop", "relaxation") else []
    points = _averaged(loadings) if loadings else _points(indentations, kept)
    bases = [indentations.bases[k] for k in kept]
    return MeasuredCurve(
        run,
        *points,
        driving=float(np.mean([base.mean[1] for base in bases])),
        indents=indentations.indents,
        loop=tuple(_cycle(blocks, indentations, k) for k in kept) if run.kind == "loop" else (),
        relaxation=_relaxation(blocks, indentations, kept[0]) if run.kind == "relaxation" else None,
        noise=(_noise(bases, 0), _noise(bases, 1)),
        drift=_drift(blocks, indentations),
        warnings=tuple(sorted(warnings, key=lambda warning: (warning.start, warning.end, warning.why))),
    )


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
        indent = indentations.indents[k]
        why = untrusted(blocks, indent, BEFORE)
        if why is None:
            kept.append(k)
        else:
            message = f"indentation {k + 1}, {indent.indentation:.4g} mm, left out: {why}"
            warnings.append(SuspectInterval(*indent.read, message, False))
    return kept, warnings


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
    """Block at which the loading ends: the deepest of a short stay, else the hold's begin."""
    begin, end = hold
    return begin + int(blocks.position[begin:end].argmax()) if end - begin < LOADING_POINTS else begin


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
    """Slopes of pressure and force over the last third of the first stretch without contact.

    There a reset is over and nothing was pressed yet: after an indentation the wall still recovers.
    """
    start, end = indentations.parts[0].clear
    slopes = baseline(blocks, end - max((end - start) // 3, 1), end).slope
    return slopes[1], slopes[0]


def _noise(bases: Sequence[Baseline], channel: int) -> float:
    """Noise of a channel: scatter of single samples about a straight line, pooled over the stretches."""
    count = np.array([max(base.end - base.start - 2, 1) for base in bases], float)
    variance = np.array([base.between[channel] + base.within[channel] for base in bases])
    return float(np.sqrt(count @ variance / count.sum()))
