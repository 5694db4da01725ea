"""Estimates of a print for planning: resin, support, layers and time, each with its assumption.

They use the same cubes as the rules; a slicer is more exact.
"""

import math

import numpy as np

from pneutouch.printability.measure.cavities import overhangs, supported
from pneutouch.printability.measure.joined import grown
from pneutouch.printability.subject import PrintSubject
from pneutouch.printability.view import PrintJob, PrintPart, PrintView
from pneutouch.results.printing import ItemEstimate, JobEstimate
from pneutouch.units import ML, UM, grams
from pneutouch.wording import counted

_SPARSE, _LOOP, _DENSE = 0.149, 0.25, 0.4
"""Filament support: share of space that lines of 0.35 mm, 2 mm apart, fill (PrusaSlicer's preset *common*); width in mm
of a loop around it and thickness in mm of the dense layers under a ceiling, as PrusaSlicer 2.5.0 lays them."""

_OUTLINES = 1.35
"""Thickness in mm of three outlines, 0.45 mm each, behind which a part may have infill."""

_PURGE = "waste of purging, wiping and the first layers is left out"


def estimate(subject: PrintSubject) -> list[JobEstimate]:
    """Estimate of each job, in order of the subject's items; jobs with a mesh that is no solid are left out."""
    return [_estimate(job) for job in PrintView(subject).jobs if job.sound]


def _estimate(job: PrintJob) -> JobEstimate:
    first = job.parts[0].item
    x, y, z = (float(length) for length in job.bounds[1] - job.bounds[0])
    if first.printer.is_casting:
        return _cast(job)
    layers = math.ceil(z / (UM * first.mode.layer_um) - 1e-9)
    support, how = _support(job)
    swath = job.printer.swath_mm if job.printer.process == "polyjet" else None
    swaths = None if swath is None else math.ceil(min(x, y) / swath.nominal)
    seconds, reasons = _seconds(job, layers, swaths, support)
    notes = [how, _PURGE, *reasons]
    if any(part.item.body.material.is_digital for part in job.parts):
        notes.append("resins of a digital material without a measured mix are added up: vendors publish no ratios")
    return _job(job, tuple(map(_item, job.parts)), support, layers, swaths, seconds, notes)


def _cast(job: PrintJob) -> JobEstimate:
    """Estimate of a casting: the body alone, and the time of its cure; mould, overflow and loss come on top."""
    items, seconds = tuple(_item(part) for part in job.parts), None
    notes = ["silicone: the body alone; what stays in sprue, vents and cup comes on top"]
    casting = job.parts[0].item.body.material.casting
    if casting is not None:
        seconds = 3600 * casting.cure_h.nominal
        notes.append(f"time: cure at room temperature ({casting.cure_h.source}); printing the mould comes on top")
    return _job(job, items, 0.0, None, None, seconds, notes)


def _job(
    job: PrintJob,
    items: tuple[ItemEstimate, ...],
    support: float | None,
    layers: int | None,
    swaths: int | None,
    seconds: float | None,
    notes: list[str],
) -> JobEstimate:
    """The record of a job's estimates; ``support`` is in mm3."""
    x, y, z = (float(length) for length in job.bounds[1] - job.bounds[0])
    resins = sorted(set[str]().union(*(item.resins_mL for item in items)))
    return JobEstimate(
        job=job.name,
        printer=job.printer.title,
        mode=job.parts[0].item.mode.name,
        items=items,
        size_mm=(x, y, z),
        resins_mL={name: sum(item.resins_mL.get(name, 0.0) for item in items) for name in resins},
        support_mL=None if support is None else support / ML,
        layers=layers,
        swaths=swaths,
        time_min=None if seconds is None else seconds / 60,
        assumptions=tuple(notes),
    )


def _item(part: PrintPart) -> ItemEstimate:
    body, solid, material = part.item.body, part.item.solid, part.item.body.material
    volume = body.volume if solid is None else float(solid.volume)
    shell = min(volume, _OUTLINES * float(part.surface.areas.sum()))
    flow = 1.0 if material.making is None else float(material.making.slicer.get("extrusion_multiplier", 1.0))
    laid = flow * (shell + part.item.infill * (volume - shell))
    # Without a measured mix only the sum of a digital material's resins is known.
    shares = {" + ".join(material.base_resins): 1.0} if material.mix is None else material.mix.fractions
    resins_mL = {name: share * laid / ML for name, share in sorted(shares.items())}
    return ItemEstimate(part.name, volume / ML, grams(laid, material.density_g_per_cm3.nominal), resins_mL)


def _support(job: PrintJob) -> tuple[float | None, str]:
    """Volume of support in mm3, and the way in which it was found, in words."""
    voxels = job.voxels
    cubes = f"cubes of {voxels.pitch:.2f} mm"
    if job.printer.process == "polyjet":
        volume = float(supported(voxels).sum()) * voxels.cube
        return volume, f"support: everything below the part and inside it, solid, in {cubes}; no carpet below the part"
    if job.printer.process == "resin":
        return None, "support: not known, the printer's program lays it"
    full, bare = voxels.label > 0, overhangs(voxels)
    # A flat slope is a flight of steps here, of which the edges alone hang free.
    bare[:, :, 1:] |= (grown(bare) & full)[:, :, 1:] & ~full[:, :, :-1]
    # A cube is support if the next full one above it hangs free and no full one is beside it; without gaps and slivers.
    height = np.where(full, np.arange(full.shape[2]), full.shape[2] - 1)
    above = np.minimum.accumulate(height[:, :, ::-1], axis=2)[:, :, ::-1]
    under = ~grown(full, (0, 1)) & np.take_along_axis(bare, above, axis=2)
    closed = ~grown(~grown(under, (0, 1)), (0, 1))
    under = grown(~grown(~closed, (0, 1)), (0, 1)) & ~full
    sides = np.pi / 4 * sum(np.count_nonzero(np.diff(np.pad(under, 1), axis=axis)) for axis in (0, 1))
    area = voxels.pitch**2 * np.array([np.count_nonzero(under.any(axis=2)), sides])
    volume = _SPARSE * float(under.sum()) * voxels.cube + float(area @ (_DENSE, _LOOP))
    return volume, f"support: under bridges and overhangs beyond 45 degrees, {_SPARSE:.0%} filled, in {cubes}"


def _seconds(job: PrintJob, layers: int, swaths: int | None, support: float | None) -> tuple[float | None, list[str]]:
    """Time in s, and its basis in words; None if the printer's profile does not give enough."""
    item = job.parts[0].item
    layer = item.mode.layer_seconds
    if item.printer.process == "polyjet":
        if layer is None or swaths is None:
            return None, ["time: the printer's profile gives no layer_seconds or no swath_mm"]
        passes = f"{layers} layers x {counted(swaths, 'swath')}"
        text = f"time: {passes} x {layer.nominal:g} s ({layer.source}); warming up left out"
        return layers * swaths * layer.nominal, [text, "swaths: the shorter side across the travel of the heads"]
    if item.printer.process == "resin" and layer is not None:
        return layers * layer.nominal, [f"time: {layers} layers x {layer.nominal:g} s ({layer.source})"]
    rate = item.printer.deposition_mm3_per_s
    if layer is None or rate is None:
        return None, ["time: the printer's profile gives no layer_seconds or no deposition_mm3_per_s"]
    volume = (support or 0.0) + ML * sum(sum(_item(part).resins_mL.values()) for part in job.parts)
    text = (
        f"time: {volume:.0f} mm3 at {rate.nominal:g} mm3/s ({rate.source}) and {layers} layers x {layer.nominal:g} s "
        f"({layer.source}); {'solid' if item.infill == 1 else f'{item.infill:.0%} infill'}"
    )
    return volume / rate.nominal + layers * layer.nominal, [text]
