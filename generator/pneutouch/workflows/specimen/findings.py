"""The print rules on a specimen. Bodies that fill one another leave no open space, so two subjects are checked."""

from dataclasses import replace

import numpy as np

from pneutouch.arrays import Array, Indices
from pneutouch.body import Body
from pneutouch.parts.specimen import Box
from pneutouch.printability import Finding, check
from pneutouch.printability.subject import Joint, PrintItem, PrintSubject
from pneutouch.workflows.specimen.draw import SpecimenBodies

OPEN = frozenset({"holes", "channels", "gaps", "hollows", "cleaning", "emboss", "matte"})
"""Rules on open space: a space that one body leaves open another one fills, so they look at the block as a whole."""

BONDED = frozenset({"walls", "pins"})
"""Rules on free-standing features: here they are bonded to the other resin, which the limits do not include."""

_MOST_CHECKED = 40_000
"""Indices of a body up to which it is measured by rays; beyond it a minute and more."""

_JOB = "specimen"


def findings(drawn: SpecimenBodies) -> list[Finding]:
    """The findings on the bodies, and on the block with its frame as one."""
    alone = [
        _bonded(finding)
        for finding in check(bodies_of(drawn))
        if finding.rule not in OPEN and not _rounding(drawn, finding)
    ]
    whole = [finding for finding in check(block_of(drawn)) if finding.rule in OPEN]
    return sorted([*alone, *whole, *_unmeasured(drawn)], key=lambda finding: finding.rank)


def bodies_of(drawn: SpecimenBodies) -> PrintSubject:
    """The bodies as one job, with the faces that they must share; those too large to be measured left out."""
    measured = [body for body in drawn.bodies if len(body.triangles) <= _MOST_CHECKED]
    names = {body.name for body in measured}
    joints = (_joint(drawn),) if {"matrix", "inclusion"} <= names else ()
    return PrintSubject(tuple(_item(drawn, body) for body in measured), joints, drawn.scene.name)


def block_of(drawn: SpecimenBodies) -> PrintSubject:
    """The block as one body, and the frame."""
    rest = [body for body in drawn.bodies if body.name == "frame"]
    block = _box(drawn.scene.block)
    whole = replace(drawn.bodies[0], name="block", role="block", vertices=block[0], triangles=block[1])
    return PrintSubject(tuple(_item(drawn, body) for body in (whole, *rest)), (), drawn.scene.name)


def _item(drawn: SpecimenBodies, body: Body) -> PrintItem:
    hints = {
        "walls": "raise width_mm, height_mm or depth_mm of the layer, or the pitch",
        "pins": "raise width_mm or strut_radius_mm of the layer",
        "envelope": "take a smaller block, or another print.profile",
        "resins": "take another material, or another print.profile",
    }
    return PrintItem(body, drawn.scene.printer, drawn.scene.mode, job=_JOB, hints=hints)


def _joint(drawn: SpecimenBodies) -> Joint:
    """All of the inclusion but its footprints on the sides of the block meets the matrix."""
    inclusion = drawn.bodies[1]
    corners, block = inclusion.corners, drawn.scene.block
    ends = np.array([block.low, block.high])
    outside = (corners[:, :, None, :] == ends[None, None]).all(axis=1).any(axis=(1, 2))
    a, b, c = np.moveaxis(corners[~outside], 1, 0)
    area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    x, y, z = (float(value) for value in a[0])
    return Joint("matrix", "inclusion", area, (x, y, z))


def _rounding(drawn: SpecimenBodies, finding: Finding) -> bool:
    """True if an overlap is the kernel's rounding on coincident facets: the faces are the same by construction."""
    excess = finding.excess
    if finding.rule != "contact faces" or excess is None or excess.unit != "mm3":
        return False
    return excess.measured < 1e-6 * drawn.scene.block.volume


def _bonded(finding: Finding) -> Finding:
    """A thin place of a body that is bonded is a warning: the limit is of one that stands free."""
    if finding.rule not in BONDED or finding.body == "frame":
        return finding
    severity = "warning" if finding.severity == "error" else finding.severity
    other = "inclusion" if finding.body == "matrix" else "matrix"
    text = f"{finding.message} (a limit of free-standing features; here it is bonded to the {other})"
    return replace(finding, severity=severity, message=text)


def _unmeasured(drawn: SpecimenBodies) -> list[Finding]:
    return [
        Finding(
            "mesh",
            "note",
            body.name,
            f"{len(body.triangles)} triangles: closed, but thin places were not measured",
            "see the struts and sheets in the layer table, which were checked before drawing",
            "own: rays take a minute and more",
        )
        for body in drawn.bodies
        if len(body.triangles) > _MOST_CHECKED
    ]


def _box(box: Box) -> tuple[Array, Indices]:
    from manifold3d import Manifold

    size = np.array(box.high) - np.array(box.low)
    mesh = Manifold.cube(size.tolist()).translate(box.low).to_mesh64()
    return np.array(mesh.vert_properties[:, :3], order="C"), mesh.tri_verts.astype(np.int64)
