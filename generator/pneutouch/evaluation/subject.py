"""A sensor as the print rules look at it: its bodies on their machines, and where they must meet.

Findings of the print rules on a sensor and, where its membrane is cast, on its mould.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.catalogue import KINDS, ResolvedDesign
from pneutouch.catalogue.library import PACKAGE
from pneutouch.errors import InputError
from pneutouch.parts import Assembly, assemble
from pneutouch.parts.cast_ring import RING
from pneutouch.parts.glue import glue_of, glue_surfaces
from pneutouch.parts.layout import Layout
from pneutouch.printability import Finding, SensorContext, check
from pneutouch.printability.measure.mould import LEAVES
from pneutouch.printability.rulebook import check_mould, mould_subject
from pneutouch.printability.rules.feature_sizes import CHECKS
from pneutouch.printability.subject import Joint, PrintItem, PrintSubject
from pneutouch.printability.view import GluedSeat, PrintView, WettedSurface
from pneutouch.spec.read import read_toml

_HINTS = {
    "membrane": {
        "walls": "raise membrane.wall_thickness_mm",
        "envelope": "take a smaller membrane.inner_radius_mm or another print.profile",
        "resins": "take another membrane.material or print.profile",
    },
    "connector": {
        "walls": "take another connector.port, or another connector.seat or print.connector_profile",
        "pins": "take another connector.port, or another print.connector_profile",
        "holes": "drill after printing, or take another connector.port, or another print.connector_profile",
        "channels": "push a drill or wire through after printing, or take another connector.port",
        "envelope": "take a smaller membrane.inner_radius_mm, another connector.mount or print.connector_profile",
        "resins": "take another connector.material or print.connector_profile",
    },
}
"""Remedies in the design by body and rule; a ring and a plug take those of the connector."""

_RING_HINTS = {
    **_HINTS["connector"],
    "walls": "raise cast_ring.width_mm or cast_ring.thickness_mm, or lower cast_ring.hole_count",
    "holes": "drill after printing, or raise cast_ring.hole_diameter_mm",
}
"""Remedies in the design by rule for the ring that a flange is cast around."""


def subject_of(assembly: Assembly) -> PrintSubject:
    """The bodies of a sensor with their machines, as they stand in them, and the faces that membrane, connector
    and a ring share."""
    scene, layout = assembly.scene, assembly.layout
    items = []
    for body, solid in zip(assembly.bodies, assembly.solids, strict=True):
        printer, mode = assembly.machine(body.name)
        items.append(
            PrintItem(
                body,
                printer,
                mode,
                solid,
                up=(0.0, 0.0, 1.0 if assembly.stands_up(body.name) else -1.0),
                job=assembly.job(body.name),
                sensing=_outer_wall(assembly) if body.name == "membrane" else None,
                hints=_hints(body.name, layout),
                insert=assembly.solid(RING) if body.name == "membrane" and layout.ring is not None else None,
            )
        )
    where = (layout.flange_radius, 0.0, layout.plate_high)
    area = assembly.seat_area
    joints = [Joint("membrane", "connector", area, where)] if area > 0 else []
    if layout.ring is not None:
        joints.append(Joint(RING, "connector", layout.ring.foot_area, where))
    return PrintSubject(tuple(items), tuple(joints), scene.name)


def _hints(body: str, layout: Layout) -> dict[str, str]:
    if body == RING and layout.ring is not None:
        return _RING_HINTS
    return _HINTS.get(body, _HINTS["connector"])


def glued_seat(scene: ResolvedDesign) -> GluedSeat | None:
    """Glue of the flange with the surfaces that it joins; None without glue, or if the choice is open."""
    name, surfaces = glue_of(scene), glue_surfaces(scene)
    return None if name is None or surfaces is None else GluedSeat(name, *surfaces)


def made_of(assembly: Assembly) -> PrintSubject:
    """The bodies of a sensor and, where its membrane is cast, the parts of the mould, one of each."""
    subject, mould = subject_of(assembly), assembly.mould
    if mould is None:
        return subject
    printed = mould_subject(mould).items
    return replace(subject, items=(*subject.items, *printed))


def wetted(assembly: Assembly) -> tuple[WettedSurface, ...]:
    """The surfaces that a cast membrane cures against: parts of the mould, and the ring; empty for a printed one."""
    mould = assembly.mould
    if mould is None:
        return ()
    label, process = mould.material.label, mould.printer.process
    surfaces = [WettedSurface(solid.name, label, process) for solid in mould.solids if solid.name in LEAVES]
    if mould.insert is not None:
        process = assembly.scene.connector_printer.process
        surfaces.append(WettedSurface(mould.insert.name, mould.insert.material.label, process))
    return tuple(surfaces)


def _outer_wall(assembly: Assembly) -> Callable[[Array], Flags]:
    """Test of surface points (n, 3): True on the dome's outer wall, which touches the world and must not be matte."""
    face, slack = assembly.layout.shape.outer, 2 * assembly.scene.mesh_tolerance

    def on_wall(points: Array) -> Flags:
        plane = np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])
        on_face: Flags = np.min([piece.distance(plane) for piece in face], axis=0) <= slack
        return on_face & (points[:, 2] > slack)

    return on_wall


def sensor_findings(assembly: Assembly, context: SensorContext) -> list[Finding]:
    """All findings, errors first; warnings that the design accepts are notes. A calibrated membrane is cast already, so
    its mould is left aside.

    Raises InputError if a detail of the mould has no space.
    """
    context = replace(context, glued=glued_seat(assembly.scene))
    if assembly.mould is None or context.calibrated:
        findings = check(subject_of(assembly), context)
    else:
        findings = check(subject_of(assembly), replace(context, wetted=wetted(assembly)))
        findings += check_mould(assembly.mould)
    reasons = assembly.scene.design.accepted.reasons
    return sorted((_accepted(finding, reasons) for finding in findings), key=lambda finding: finding.rank)


_PORT, _NAMED = "another connector.port", 2
"""Words of a remedy that proposes another port, and number of ports that are named in their place."""

_OF_PORTS = ("walls", "pins", "holes", "channels")
"""Rules whose findings on the connector another port may resolve."""


def with_ports(findings: list[Finding], scene: ResolvedDesign) -> list[Finding]:
    """Findings whose remedies name ports, where some resolve them: each was drawn and checked. Ports that take the
    design's tube come first; where the design names a tube, only these are named."""
    broken = {one.rule for one in findings if _names_port(one)}
    if not broken:
        return findings
    ending: dict[str, list[str]] = {rule: [] for rule in broken}
    tubes, stated = dict(_shipped("tubes")), scene.design.pneumatics.tube
    own = [name for name, tube in tubes.items() if tube.title == scene.tube.title]
    for name, port in sorted(_shipped("ports"), key=lambda entry: not set(own) & set(entry[1].tubes)):
        if name == scene.design.connector.port or stated not in (None, *port.tubes):
            continue
        if all(len(names) == _NAMED for names in ending.values()):
            break
        connector = scene.design.connector.model_copy(update={"port": name})
        design = scene.design.model_copy(update={"connector": connector})
        with suppress(InputError):
            subject = subject_of(
                assemble(replace(scene, design=design, port=port, tube=tubes[stated or port.tubes[0]]))
            )
            items = tuple(item for item in subject.items if item.body.name == "connector")
            view = PrintView(replace(subject, items=items, joints=()), None)
            for rule, names in ending.items():
                names += [] if len(names) == _NAMED or CHECKS[rule](view) else [name]
    return [_with_port(one, ending[one.rule]) if _names_port(one) else one for one in findings]


def _shipped(kind: str) -> Iterator[tuple[str, Any]]:
    """Name and content of every shipped part of a kind; without a user's parts, which must not change a build."""
    for path in sorted((PACKAGE / KINDS[kind].folder).glob("*.toml")):
        yield path.stem, KINDS[kind].validate(read_toml(path), str(path))


def _with_port(finding: Finding, names: list[str]) -> Finding:
    fix = finding.fix.replace(_PORT, f"connector.port = {' or '.join(names)}") if names else finding.fix
    return replace(finding, fix=fix)


def _names_port(finding: Finding) -> bool:
    return finding.body == "connector" and finding.rule in _OF_PORTS and _PORT in finding.fix


def _accepted(finding: Finding, reasons: Mapping[str, str]) -> Finding:
    """A warning on a rule that has a reason, turned into a note with that reason; any other finding unchanged."""
    reason = reasons.get(finding.rule)
    if reason is None or finding.severity != "warning":
        return finding
    return replace(finding, severity="note", message=f"{finding.message}; accepted: {reason}")
