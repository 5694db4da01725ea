"""Rules on bodies as a whole: meshes, overlaps, contact faces, sensing faces, and the build volume."""

from itertools import combinations

import numpy as np

from pneutouch.arrays import Array, Flags, Indices
from pneutouch.body import Body
from pneutouch.printability.measure.chords import first_hits
from pneutouch.printability.rules.feature_sizes import spot
from pneutouch.printability.subject import Joint
from pneutouch.printability.view import PrintJob, PrintPart, PrintView
from pneutouch.results.printing import Excess, Finding
from pneutouch.units import UM

_SOLID = (
    "vendor, objet.com Tips and Tricks: watertight; vertices rounded to 32-bit floats and merged, as STL readers do"
)
_FINEST = "the machine's finest step: least of layer height and pixel, as its profile states; "
_CAST_STEP = "STL of 0.01 to 0.03 mm is enough, finer prints no better: vendor, objet.com Tips and Tricks"
_VENDOR = "vendor, objet.com Tips and Tricks: finer does not print better; four times finer: own, unverified"
_GUESS = 1.5
"""Factor by which a sagitta overstates the deviation of a mesh with the same area as its curve."""
_FINER = 4.0
"""Chords this many times narrower than the finest step needs make at least as many times the triangles."""


def check_mesh(view: PrintView) -> list[Finding]:
    """Findings on open meshes, on their deviation from the exact solid, and on chords finer than needed."""
    findings = []
    for part in view.parts:
        findings += _open(part) or [*_coarse(part), *_fine(part)]
    return findings


def _open(part: PrintPart) -> list[Finding]:
    if not part.item.body.is_closed():
        text = "the mesh is not closed"
    elif not part.read.is_closed():
        text = "the mesh is not closed once its points are rounded to 32-bit floats and merged"
    elif not part.sound:
        text = "the mesh bounds no solid: it is inside out or not manifold"
    else:
        return []
    fix = part.item.hints.get("mesh", "mend the mesh where it comes from; nothing else is measured on it")
    return [Finding("mesh", "error", part.name, text, fix, _SOLID, None, None)]


def _coarse(part: PrintPart) -> list[Finding]:
    step = part.item.printer.finest_step(part.item.mode)
    if part.item.solid is None:
        (deviation, edge), how = part.surface.chord_error, "by the turn of its edges"
        where = part.surface.vertices[part.surface.edges.ends[edge]].mean(axis=0)
    else:
        points = _points(part)
        distances = part.item.solid.distance(points)
        deviation, how = float(distances.max()), "from the exact solid"
        where = points[int(distances.argmax())]
    if deviation <= step * (_GUESS if part.item.solid is None else 1.02):
        return []
    text = f"the mesh is off by {deviation / UM:.0f} um ({how}); the machine's finest step is {step / UM:g} um"
    fix = part.item.hints.get("mesh", f"mesh it within {step:g} mm")
    resolution = part.item.printer.resolution
    source = f"{_FINEST}{_CAST_STEP if resolution is None else resolution.source}"
    return [Finding("mesh", "warning", part.name, text, fix, source, spot(where), Excess(deviation, step, "mm"))]


def _points(part: PrintPart) -> Array:
    """Corners, middles of edges and of triangles, (n, 3): there a mesh is farthest from a smooth surface."""
    body, ends = part.surface, part.surface.edges.ends
    return np.concatenate([body.vertices, body.vertices[ends].mean(axis=1), body.corners.mean(axis=1)])


def _fine(part: PrintPart) -> list[Finding]:
    step = part.item.printer.finest_step(part.item.mode)
    sagittas = part.surface.sagittas
    curved = sagittas[sagittas > 1e-9]
    if len(curved) < 100:
        return []
    # Nine tenths of them are no higher; numpy.percentile loads the masked arrays, a tenth of NumPy's import.
    highest = np.interp(0.9 * (len(curved) - 1), np.arange(len(curved)), np.sort(curved))
    # A sagitta goes with the square of the chord's width.
    finer = float(np.sqrt(step / highest))
    if finer <= _FINER:
        return []
    text = f"its chords are {finer:.0f} times narrower than the machine's finest step of {step / UM:g} um needs"
    fix = part.item.hints.get("mesh", f"mesh it within {step:g} mm; the file gets smaller, the print the same")
    return [Finding("mesh", "note", part.name, text, fix, _FINEST + _VENDOR, None, Excess(finer, _FINER, ""))]


_SOURCE = "vendor: one closed shell per material region, shells must not occupy the same space (multi-colour guideline)"
_FIX = "report the design: this is a fault"
_NOTHING = 1e-6
"""Volume in mm3 below which an overlap is due to rounding: a cube of 10 um."""
_SAME = 1e-6
"""Corners that differ by less (mm) are the same."""
_LEAST_SHARE = 0.999
"""Least share of a joint's exact area that the meshes must have in common."""


def check_contact_faces(view: PrintView) -> list[Finding]:
    """Findings on every two bodies that overlap, and on joints whose faces share too little area."""
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
    """Corners of the triangles as whole numbers of `_SAME`, (m, 3, 3)."""
    corners: Array = np.rint(body.corners / _SAME)
    return corners.astype(np.int64)


def _ordered(whole: Indices) -> Indices:
    """Corners of each triangle, sorted, (m, 9)."""
    order = np.lexsort((whole[:, :, 2], whole[:, :, 1], whole[:, :, 0]), axis=1)
    return np.take_along_axis(whole, order[:, :, None], axis=1).reshape(-1, 9)


_MATTE_SOURCE = "vendor: faces that support touches come out matte (DOC-37004 p. 5-34); share allowed: own, unverified"
_MOST = 0.01
"""Share of the sensing face that support may touch."""
_DOWN = {"polyjet": -0.02, "filament": -0.7, "resin": -0.7}
"""Vertical part of the normal below which a face needs support: any overhang (PolyJet), past 45 degrees (others)."""
_OFF = 1e-3
"""Distance from the face in mm at which rays upwards start."""


def check_matte(view: PrintView) -> list[Finding]:
    """Findings on sensing faces of which too much faces down or lies under a part; cast ones are left out."""
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
    text = f"support touches {share:.0%} of the sensing face; at most {_MOST:.0%} may be touched"
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


def check_envelope(view: PrintView) -> list[Finding]:
    """Findings on jobs larger than the build volume, also if turned a quarter on the tray; cast ones are left out."""
    jobs = (job for job in view.jobs if not job.printer.is_casting)
    return [finding for job in jobs if (finding := _check_bounds(job)) is not None]


def _check_bounds(job: PrintJob) -> Finding | None:
    envelope = job.printer.envelope
    x, y, z = (float(length) for length in job.bounds[1] - job.bounds[0])
    if z <= envelope.z and ((x <= envelope.x and y <= envelope.y) or (x <= envelope.y and y <= envelope.x)):
        return None
    excesses = [
        Excess(z, envelope.z, "mm"),
        Excess(max(x, y), max(envelope.x, envelope.y), "mm"),
        Excess(min(x, y), min(envelope.x, envelope.y), "mm"),
    ]
    worst = max(excesses, key=lambda excess: excess.measured / excess.limit)
    part = job.parts[0]
    limits = f"{envelope.x:g} x {envelope.y:g} x {envelope.z:g} mm"
    text = f"{x:.1f} x {y:.1f} x {z:.1f} mm as it stands; the machine builds {limits}"
    fix = part.item.hints.get("envelope", "make it smaller, lay it down, or take a larger printer")
    return Finding("envelope", "error", part.name, text, fix, envelope.source, None, worst)
