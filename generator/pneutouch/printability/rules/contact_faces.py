"""Bodies must not overlap, and must meet where they are bonded. Measured on the meshes."""

from itertools import combinations

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.body import Body
from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.sizes import spot
from pneutouch.printability.subject import Joint
from pneutouch.printability.view import PrintPart, PrintView

_SOURCE = "vendor: one closed shell per material region, shells must not occupy the same space (multi-colour guideline)"
_FIX = "report the design: this is a fault"
_NOTHING = 1e-6
"""Volume in mm3 below which an overlap is rounding: a cube of 10 um."""
_SAME = 1e-6
"""Corners that differ by less (mm) are the same."""
_LEAST_SHARE = 0.999
"""Share of a joint's exact area that the meshes must share."""


def check(view: PrintView) -> list[Finding]:
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
