"""Curve of a run from its blocks: one point for each hold, or the loading of a run without holds."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.excursions import Excursion, check_exchanged, smoothed
from pneutouch.bench.first_contact import BEFORE, Baseline, baseline, step_share
from pneutouch.bench.indents import RunIndentations, find_indents
from pneutouch.bench.record import BLOCK_ARRAYS, Blocks, MeasuredCurve, MeasuredIndentation, SuspectInterval
from pneutouch.bench.run_warnings import (
    SURELY,
    behind,
    cut_short,
    goes_on,
    listed,
    pressed_before,
    run_warnings,
    slope_variance,
    untrusted,
)
from pneutouch.bench.source import otherwise
from pneutouch.errors import InputError
from pneutouch.mechanics.response import figures
from pneutouch.spec.campaign import CampaignRun, Rig, RunKind

Points = tuple[Array, Array, Array]
Loadings = Sequence[Points]
Warnings = list[SuspectInterval]

ALIKE_DEEP = 0.95
"""Share of the deepest loading that others must reach to be averaged with it: our choice."""

LOADING_POINTS = 25
"""Points of the curve of a loop or a relaxation run: our choice, about twice as many as steps have."""

_BEYOND_TRAVEL = 1.05

_LAG_COUNTS, _EARLY, _GOES_ON, _AT_END, _STEEP = 0.01, 0.2, 0.004, 0.1, 10
"""Change of a channel at its steepest over a lag, as a share of its span, or of a figure, from which on a lag is asked
about; least lead in s of a pressure that is asked about whatever its figures, as a leak leads too; shares of its span
by which a force grows in a stay of a coarse travel, and of a stage at its end; most blocks over which a channel's
steepest way is taken: our choice."""


def curve_of(run: CampaignRun, blocks: Blocks, rig: Rig) -> MeasuredCurve:
    """Curve of a run with a plate; its first point is the origin.

    A run without a stated kind has the kind that its record shows. Steps and saturation: one point for each stay,
    sorted by depth. Loop, relaxation and a press by hand: the loading, averaged over the cycles, at `LOADING_POINTS`
    even depths, or forces by hand, where the indentation is NaN. A force or rise that falls as the sensor is pressed
    stays negative (see `run_checks.check_plausible`). Noise is that of single samples without contact, from the spread
    within blocks and between their means about a line; drift is the pressure's slope before contact.

    Raises InputError for a leak or injection, a plate that stands or moves backwards, no contact or no usable press."""
    if run.kind in ("leak", "injection"):
        raise InputError(f"a {run.kind} run has no plate and no curve", file=blocks.file)
    travels = _travel(blocks, rig)
    blocks = _without_spikes(blocks)
    if run.kind == "hand":
        blocks = _by_force(blocks)
    else:
        check_exchanged(blocks)
    indentations = find_indents(blocks, by_hand=run.kind == "hand")
    shows: RunKind = "hand" if run.kind == "hand" else indentations.kind(blocks)
    told = "kind" not in run.model_fields_set
    run = run.model_copy(update={"kind": shows} if told else {})
    steps = told and run.kind == "steps"
    points, kept, left_out = _read(run, blocks, indentations, steps=steps)
    warnings: Warnings = [*listed(blocks.warnings), *travels, *run_warnings(run, blocks, indentations), *left_out]
    warnings += _lagging(run, blocks, indentations, points, steps=steps)
    turns, indents = run.kind in ("loop", "hand"), indentations.indents
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
        noise=(_noise(bases, 0, blocks.steps[0]), _noise(bases, 1, blocks.steps[1])),
        step_error=step_share(blocks, bases) * float(np.abs(points[1]).max()) / math.sqrt(12),
        drift=_drift(blocks, indentations),
        onset_error=indentations.onset_error,
        at_once=indentations.at_once,
        shows=shows,
        told=told,
        warnings=tuple(sorted(warnings, key=lambda warning: (warning.start, warning.end, warning.why))),
    )


def _read(
    run: CampaignRun, blocks: Blocks, indentations: RunIndentations, *, steps: bool
) -> tuple[Points, list[int], Warnings]:
    """Depths, forces and rises of a curve, (n,) each, the indices of its indentations, and warnings on the others."""
    touched = [k for k, contact in enumerate(indentations.contacts) if contact is not None]
    if not touched:
        raise InputError(_no_contact(blocks, indentations))
    kept, left_out = _kept(blocks, indentations, touched, steps=steps)
    if not kept:
        reasons = "; ".join(sorted({warning.why for warning in left_out}))
        raise InputError(f"none of {len(touched)} indentations can be used: {reasons}", file=blocks.file)
    if run.kind in ("steps", "saturation"):
        points = _points(indentations, kept)
        beyond = [k for k in touched if k not in kept and indentations.indents[k].indentation > points[0][-1]]
        if beyond and (clipped := [one for one in blocks.warnings if one.kind == "clipped"]):
            why = f"{clipped[0].why}; {len(beyond)} indentations are left out, and the figures end before, at "
            why += f"{points[0][-1]:.3g} mm: press less deep, or use an instrument of greater range"
            left_out.append(SuspectInterval(clipped[0].start, clipped[-1].end, why, False, "asked"))
        return points, kept, left_out
    loadings = [_loading(blocks, indentations, k) for k in kept]
    deep, shallow = _deep(loadings, kept, indentations.indents)
    points = _averaged([loading for k, loading in zip(kept, loadings, strict=True) if k in deep])
    return points, deep, [*left_out, *shallow]


def _lagging(
    run: CampaignRun, blocks: Blocks, indentations: RunIndentations, points: Points, *, steps: bool
) -> Warnings:
    """Question on the time between force, pressure and travel: by the way that a channel makes in it where it alone is
    late, else by the figures that it changes, as a leak, warmed gas or a wall that relaxes may be behind it."""
    force, pressure = (behind(blocks, indentations, key) for key in ("force", "pressure"))
    early = min(force, 0.0) - pressure
    lag, key, first, alone, late = max(
        (pressure - max(force, 0.0), "pressure", "force", True, (0, 1)),
        (force - max(pressure, 0.0), "force", "travel", True, (1, 0)),
        (min(force, pressure), "force and pressure", "travel", False, (1, 1)),
        (-max(force, pressure), "travel", "force and pressure", False, (-1, -1)),
        (early, "force", "pressure", early > _EARLY, (0, -1)),
    )
    step = float(np.median(np.diff(blocks.time)))
    if lag < step:
        return []
    values, count = getattr(blocks, "pressure" if key == "pressure" else "force"), round(lag / step)
    # Over a short time, as in a long one a press may be over.
    over = min(count, _STEEP)
    way = float(np.ptp([values[over:], values[:-over]], axis=0).max(initial=0.0)) / max(float(np.ptp(values)), 1e-300)
    way *= count / max(over, 1)
    if not alone or run.kind == "hand" or count < 2 or way < _LAG_COUNTS:
        in_time = {
            of: np.interp(blocks.time + by * lag, blocks.time, getattr(blocks, of))
            for of, by in zip(("force", "pressure"), late, strict=True)
        }
        changed = _changed(run, replace(blocks, **in_time), points, steps=steps)
        if changed < _LAG_COUNTS:
            return []
        way = max(way, changed)
    comes = "come" if key == "force and pressure" else "comes"
    why = (
        f"the {key} {comes} {lag:.2g} s after the {first}: does a filter, a slow gauge or another clock delay it? "
        f"Shift the column by that, or press {math.ceil(1.5 * way / _LAG_COUNTS)} times slower"
    )
    return [SuspectInterval(float(blocks.time[0]), float(blocks.time[-1]), why, True, "late")]


def _changed(run: CampaignRun, blocks: Blocks, points: Points, *, steps: bool) -> float:
    """Greatest relative difference of sensitivity, stiffness and force between blocks and points; 0 if not known."""
    try:
        others = _read(run, blocks, find_indents(blocks, by_hand=run.kind == "hand"), steps=steps)[0]
    except InputError:
        return 0.0
    if (was := figures(*points)) is None or (would := figures(*others)) is None:
        return 0.0
    pairs = [(getattr(was, key), getattr(would, key)) for key in ("sensitivity", "stiffness", "force_high")]
    return float(max(abs(there - here) / max(abs(here), 1e-300) for here, there in pairs))


def _without_spikes(blocks: Blocks) -> Blocks:
    """Blocks without those in which a channel reads a spike; all blocks if every one has a spike."""
    clean = np.ones(blocks.time.size, bool)
    for spike in (one for one in blocks.warnings if one.kind == "spike" and not one.used):
        clean &= (blocks.time < spike.start) | (blocks.time > spike.end)
    if clean.all() or not clean.any():
        return blocks
    return replace(blocks, **{name: getattr(blocks, name)[clean] for name in BLOCK_ARRAYS})


def _by_force(blocks: Blocks) -> Blocks:
    """Blocks of a press by hand with force as position. Raises InputError if the force never changes or falls."""
    if np.ptp(blocks.force) <= SURELY * float(np.median(blocks.force_spread)):
        raise InputError(
            f"the force never changes: from {blocks.force.min():.3g} to {blocks.force.max():.3g} N",
            file=blocks.file,
            remedy='a leak? give `kind` "leak"',
        )
    rest = float(np.median(blocks.force[: max(blocks.force.size // 50, 3)]))
    fall = rest - float(blocks.force.min())
    if fall > float(blocks.force.max()) - rest:
        raise InputError(
            f"column {blocks.columns.force.name}: falls by {fall:.3g} N as the sensor is pressed",
            file=blocks.file,
            remedy=f"it must rise: {otherwise(blocks.columns, 'force')}",
        )
    return replace(blocks, position=blocks.force)


def _no_contact(blocks: Blocks, indentations: RunIndentations) -> str:
    if not indentations.parts:
        span = f"from {blocks.position.min():.4g} to {blocks.position.max():.4g} mm"
        return f"{blocks.file}: no contact: the plate never goes in and out; {span}"
    noise = _noise(indentations.bases, 0, blocks.steps[0])
    over = max(
        float(np.abs(blocks.force[one.clear[1] : one.hold[1]] - base.mean[0]).max())
        for one, base in zip(indentations.parts, indentations.bases, strict=True)
    )
    return (
        f"{blocks.file}: no contact: the force never leaves its noise: at most {over:.3g} N beyond what it is "
        f"without, with {noise:.3g} N of noise, in {len(indentations.parts)} indentations; did the plate reach the "
        f"sensor, is {blocks.columns.force.name} the right column of the force?"
    )


def _travel(blocks: Blocks, rig: Rig) -> list[SuspectInterval]:
    span = float(np.ptp(blocks.position))
    if span <= _BEYOND_TRAVEL * rig.travel_mm:
        return []
    why = f"position covers {span:.4g} mm, the rig's travel is {rig.travel_mm:g}: is its unit right?"
    return [SuspectInterval(float(blocks.time[0]), float(blocks.time[-1]), why, True)]


def _kept(
    blocks: Blocks, indentations: RunIndentations, touched: list[int], *, steps: bool
) -> tuple[list[int], Warnings]:
    """Indices of the usable indentations, and warnings about the others; ``steps``: a stay is required."""
    kept, warnings = [], []
    for k in touched:
        indent, part = indentations.indents[k], indentations.parts[k]
        why = untrusted(blocks, indent, BEFORE)
        if not part.held and (steps or (k - 1 in touched and goes_on(indentations, k - 1))):
            why = why or "the plate does not stay there, as it does at the steps"
        why = why or cut_short(blocks, indent, part.held) or pressed_before(blocks, part, indent)
        if why is None:
            kept.append(k)
        else:
            # By hand the travel is not known, and the force stands in its place.
            reach = f"{indent.force:.4g} N" if blocks.position is blocks.force else f"{indent.indentation:.4g} mm"
            message = f"indentation {k + 1}, {reach}, left out: {why}"
            warnings.append(SuspectInterval(*indent.read, message, False))
    return kept, warnings


def _points(indentations: RunIndentations, kept: Sequence[int]) -> Points:
    points = np.array(
        [(0.0, 0.0, 0.0), *((one.indentation, one.force, one.rise) for one in (indentations.indents[k] for k in kept))]
    )
    depth, force, rise = points[np.argsort(points[:, 0], kind="stable")].T
    return depth, force, rise


def _loading(blocks: Blocks, indentations: RunIndentations, k: int) -> Points:
    """Indentation (mm), force (N) and rise (MPa) of loading k, from contact to the deepest point, (n,) each."""
    part, base, indent = indentations.parts[k], indentations.bases[k], indentations.indents[k]
    start = int(np.searchsorted(blocks.time, indent.contact))
    end = _deepest(blocks, part) + 1
    at = slice(min(start, end - 1), end)
    return blocks.position[at] - indentations.onset, blocks.force[at] - base.mean[0], blocks.pressure[at] - base.mean[1]


def _deepest(blocks: Blocks, part: Excursion) -> int:
    """Index of the block at which a loading ends: the first at the depth of its stay, else the deepest, the middle one
    where a coarse travel reads several alike, also if the force shows that the plate goes on in such a stay."""
    begin, end = part.hold
    place = blocks.position[begin:end]
    # A quick turn has one deepest block; a slow one many, of which noise must not choose.
    place = smoothed(place) if place.size >= LOADING_POINTS else place
    deepest = begin + np.flatnonzero(place >= (np.median(place) if part.held else place.max()))
    middle, sixth = deepest.size // 2, deepest.size // 6 + 1
    first, later = blocks.force[deepest[:sixth]], blocks.force[deepest[middle - sixth : middle + sixth]]
    grows = (later.mean() - first.mean()) / float(np.ptp(blocks.force)) if later.size else 0.0
    return int(deepest[middle if not part.held or _GOES_ON < grows < _AT_END else 0])


def _deep(loadings: Loadings, kept: list[int], indents: Sequence[MeasuredIndentation]) -> tuple[list[int], Warnings]:
    """Indices in ``kept`` of loadings that reach `ALIKE_DEEP` of the deepest, and warnings about the others."""
    ends = [float(loading[0].max()) for loading in loadings]
    deep = [k for k, end in zip(kept, ends, strict=True) if end >= ALIKE_DEEP * max(ends)]
    why = f"left out of the average: it ends before {ALIKE_DEEP:.0%} of the deepest"
    shallow = [k for k in kept if k not in deep]
    return deep, [SuspectInterval(*indents[k].read, f"indentation {k + 1} {why}", False) for k in shallow]


def _averaged(loadings: Loadings) -> Points:
    """Mean loading: depths, forces and rises at even depths from the origin, (n,) each."""
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
    start = _deepest(blocks, part)
    end = part.out if math.isnan(indent.release) else int(np.searchsorted(blocks.time, indent.release))
    out = slice(start, max(end, start + 1))
    return force, rise, blocks.force[out] - base.mean[0], blocks.pressure[out] - base.mean[1]


def _relaxation(blocks: Blocks, indentations: RunIndentations, k: int) -> Points:
    at, base = slice(*indentations.parts[k].hold), indentations.bases[k]
    time = blocks.time[at]
    return time - time[0], blocks.force[at] - base.mean[0], blocks.pressure[at] - base.mean[1]


def _drift(blocks: Blocks, indentations: RunIndentations) -> tuple[float, float]:
    """Slope of the pressure (MPa/s) over the last third of the first stretch without contact, and its standard error.

    There a reset is over and nothing pressed yet: after a press the wall recovers. Too few blocks: infinite error."""
    start, end = indentations.parts[0].clear
    base = baseline(blocks, end - max((end - start) // 3, 1), end)
    return base.slope[1], math.sqrt(slope_variance(blocks, base)) if base.end - base.start > 3 else math.inf


def _noise(bases: Sequence[Baseline], channel: int, step: float) -> float:
    """Noise of a channel (0 force, 1 pressure): scatter of samples about a straight line, pooled over stretches; at
    least that of rounding to its ``step``."""
    count = np.array([max(base.end - base.start - 2, 1) for base in bases], float)
    variance = np.array([base.between[channel] + base.within[channel] for base in bases])
    return max(float(np.sqrt(count @ variance / count.sum())), step / math.sqrt(12))
