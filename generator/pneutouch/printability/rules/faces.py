"""Bodies must not overlap, and must meet where they are bonded. Measured on the meshes.

Support on the face that senses, which it would leave matte and rough.
"""

from itertools import combinations

import numpy as np

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.body import Body
from pneutouch.printability.measure.chords import first_hits
from pneutouch.printability.rules.feature_sizes import spot
from pneutouch.printability.subject import Joint
from pneutouch.printability.view import PrintJob, PrintPart, PrintView
from pneutouch.results.printing import Excess, Finding

_SOURCE = "vendor: one closed shell per material region, shells must not occupy the same space (multi-colour guideline)"
_FIX = "report the design: this is a fault"
_NOTHING = 1e-6
"""Volume in mm3 below which an overlap is rounding: a cube of 10 um."""
_SAME = 1e-6
"""Corners that differ by less (mm) are the same."""
_LEAST_SHARE = 0.999
"""Share of a joint's exact area that the meshes must share."""


def check_contact_faces(view: PrintView) -> list[Finding]:
    """Measure the overlap of every two bodies and the area of the faces that they are to share."""
    overlaps = {
        frozenset((one.name, other.name)): finding
        for one, other in combinations(view.sound, 2)
        if (finding := _overlap(one, other)) is not None
    }
    joints = [joint for joint in view.subject.joints if frozenset((joint.one, joint.other)) not in overlaps]
    return [*overlaps.values(), *(finding for joint in joints for finding in _parted(view, joint))]


def _overlap(one: PrintPart, other: PrintPart) -> Finding | None:
    boxes = one.item.body.bounds, other.item.body.bounds
    if (boxes[0][0] >= boxes[1][1]).any() or (boxes[1][0] >= boxes[0][1]).any():
        return None
    common = one.manifold ^ other.manifold
    volume = float(common.volume())
    if volume <= _NOTHING:
        return None
    where = spot(np.array(common.bounding_box()).reshape(2, 3).mean(axis=0))
    text = f"overlaps with the {other.name} by {volume:.3g} mm3"
    fix = one.item.hints.get("contact faces", _FIX)
    return Finding("contact faces", "error", one.name, text, fix, _SOURCE, where, Excess(volume, 0.0, "mm3"))


def _parted(view: PrintView, joint: Joint) -> list[Finding]:
    one, other = view.part(joint.one), view.part(joint.other)
    if one is None or other is None:
        return []
    shared = shared_area(one.item.body, other.item.body)
    if shared >= _LEAST_SHARE * joint.area:
        return []
    text = f"shares {shared:.1f} mm2 with the {other.name}; the joint has {joint.area:.1f} mm2"
    fix = one.item.hints.get("contact faces", _FIX)
    excess = Excess(shared, joint.area, "mm2")
    return [Finding("contact faces", "error", joint.one, text, fix, _SOURCE, joint.where, excess)]


def overlap_volume(one: Body, other: Body) -> float:
    """Volume in mm3 that both bodies occupy."""
    return float((one.manifold() ^ other.manifold()).volume())


def shared_area(one: Body, other: Body) -> float:
    """Area in mm2 of the triangles that both bodies have, facing in opposite directions."""
    first, second = _whole(one), _whole(other)
    # What both have lies where their boxes meet.
    low = np.maximum(first.min(axis=(0, 1)), second.min(axis=(0, 1)))
    high = np.minimum(first.max(axis=(0, 1)), second.max(axis=(0, 1)))
    near = [np.flatnonzero(((corners >= low) & (corners <= high)).all(axis=(1, 2))) for corners in (first, second)]
    rows = np.concatenate([_ordered(first[near[0]]), _ordered(second[near[1]])])
    _, number = np.unique(rows, axis=0, return_inverse=True)
    number = number.reshape(-1)
    common = near[1][np.isin(number[len(near[0]) :], number[: len(near[0])])]
    a, b, c = np.moveaxis(other.corners[common], 1, 0)
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def _whole(body: Body) -> Indices:
    """Corners of the triangles in whole numbers, (m, 3, 3)."""
    corners: Array = np.rint(body.corners / _SAME)
    return corners.astype(np.int64)


def _ordered(whole: Indices) -> Indices:
    """Each triangle's corners in order of size, (m, 9)."""
    order = np.lexsort((whole[:, :, 2], whole[:, :, 1], whole[:, :, 0]), axis=1)
    return np.take_along_axis(whole, order[:, :, None], axis=1).reshape(-1, 9)


_MATTE_SOURCE = "vendor: faces that support touches come out matte (DOC-37004 p. 5-34); share allowed: own, unverified"
_MOST = 0.01
"""Share of the sensing face that support may touch."""
_DOWN = {"polyjet": -0.02, "filament": -0.7, "resin": -0.7}
"""Vertical part of the normal below which a face needs support: any overhang (PolyJet), past 45 degrees (others)."""
_OFF = 1e-3
"""Distance from the face in mm at which the look upwards starts."""


def check_matte(view: PrintView) -> list[Finding]:
    """Measure the share of each sensing face that looks down or lies under something of the same job; none is cast."""
    return [
        finding
        for job in view.jobs
        for part in job.parts
        if part.item.sensing is not None
        and job.sound
        and not job.printer.is_casting
        and (finding := _check(job, part)) is not None
    ]


def _check(job: PrintJob, part: PrintPart) -> Finding | None:
    samples, sensing = part.samples, part.item.sensing
    rows = np.flatnonzero(
        (samples.areas > 0) & (np.zeros(len(samples.areas), bool) if sensing is None else sensing(samples.points))
    )
    if not len(rows):
        return None
    areas, points = samples.areas[rows], samples.points[rows]
    touched = _touched(job, part, points, part.surface.normals[samples.faces[rows]])
    share = float(areas[touched].sum() / areas.sum())
    if share <= _MOST:
        return None
    text = f"support touches {share:.0%} of the sensing face; at most {_MOST:.0%} may be matte"
    fix = part.item.hints.get("matte", "turn the part so that its sensing face looks up")
    where = spot(points[touched][0])
    return Finding("matte", "warning", part.name, text, fix, _MATTE_SOURCE, where, Excess(share, _MOST, ""))


def _touched(job: PrintJob, part: PrintPart, points: Array, normals: Array) -> Flags:
    touched: Flags = normals @ job.up < _DOWN[part.process]
    height = float(job.bounds[1][2] - job.bounds[0][2]) + 1.0
    upwards = np.broadcast_to(job.up, points.shape)
    for other in job.parts:
        left = np.flatnonzero(~touched)
        hits = first_hits(other.manifold, points[left] + _OFF * normals[left], upwards[left], height)
        touched[left] |= np.isfinite(hits.distances[:, 1])
    return touched
