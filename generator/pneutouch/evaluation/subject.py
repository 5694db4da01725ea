"""A sensor as the print rules look at it: its bodies on their machines, and where they must meet.

Findings of the print rules on a sensor and, where its membrane is cast, on its mould.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

from pneutouch.arrays import Array, Flags
from pneutouch.catalogue import ResolvedDesign
from pneutouch.catalogue.library import Library, shipped_root
from pneutouch.catalogue.scene import check_scene
from pneutouch.errors import BeyondLimitError, ComputationError, InputError
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.predict import predict
from pneutouch.mechanics.prediction import CurveOutcome, SensorPrediction
from pneutouch.mechanics.rating import Rating, ratings
from pneutouch.mechanics.sensor import ResponseCorrection, Sensor
from pneutouch.parts import Assembly, assemble
from pneutouch.parts.cast_ring import RING
from pneutouch.parts.connector import seat_area
from pneutouch.parts.glue import glue_of, glue_surfaces
from pneutouch.printability import Finding, SensorContext, check
from pneutouch.printability.measure.mould import LEAVES
from pneutouch.printability.rulebook import check_mould, mould_subject
from pneutouch.printability.rules.feature_sizes import ALIKE, CHECKS
from pneutouch.printability.subject import Joint, PrintItem, PrintSubject
from pneutouch.printability.view import GluedSeat, PrintView, WettedSurface
from pneutouch.results.prediction import ByMixingCurve, MixState
from pneutouch.spec.material import Material, MixByCurve
from pneutouch.spec.part import ORingStub
from pneutouch.spec.printer import Printer
from pneutouch.units import KPA
from pneutouch.wording import data_of, rounded

_HINTS: dict[str, dict[str, str]] = data_of(__file__)
"""Remedies in the design by body and rule; a ring and a plug take those of the connector."""


def subject_of(assembly: Assembly) -> PrintSubject:
    """The bodies of a sensor as they stand in their machines, and the faces that membrane, connector and ring share."""
    scene, layout = assembly.scene, assembly.layout
    hints = {**_HINTS, RING: {**_HINTS["connector"], **_HINTS["ring"]}}
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
                hints=hints.get(body.name, _HINTS["connector"]),
                insert=assembly.solid(RING) if body.name == "membrane" and layout.ring is not None else None,
            )
        )
    where = (layout.flange_radius, 0.0, layout.plate_high)
    area = seat_area(scene.seat, assembly.solid("connector"))
    joints = [Joint("membrane", "connector", area, where)] if area > 0 else []
    if layout.ring is not None:
        joints.append(Joint(RING, "connector", layout.ring.foot_area, where))
    return PrintSubject(tuple(items), tuple(joints), scene.name)


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
    context = replace(context, glued=glued_seat(assembly.scene), scene=assembly.scene)
    if assembly.mould is None or context.calibrated:
        findings = check(subject_of(assembly), context)
    else:
        findings = check(subject_of(assembly), replace(context, wetted=wetted(assembly)))
        findings += check_mould(assembly.mould)
    reasons = assembly.scene.design.accepted.reasons
    return sorted((accepted(finding, reasons) for finding in findings), key=lambda finding: finding.rank)


_NAMED = 2
"""Number of parts that a remedy names."""

_FIELDS = {"ports": "port", "mounts": "mount", "printers": "connector_printer"}
_OTHERS = {"connector.port": "ports", "connector.mount": "mounts", "print.connector_profile": "printers"}
"""Settings that may end a finding on the connector's sizes, in the order in which they are tried, with their kinds."""


def with_parts(findings: list[Finding], scene: ResolvedDesign) -> list[Finding]:
    """Findings on sizes of the connector, with remedies that name parts which end them: each was drawn and checked.

    Mounts are tried for what no port ends, and printers for the rest. Ports that take the design's tube come first;
    where the design names a tube, only these are named."""
    thin = [one for one in findings if one.body in ("connector", "plug") and one.rule in CHECKS and one.excess]
    fixes: dict[Finding, str] = {}
    for key in _OTHERS:
        fixes |= _ending(key, [one for one in thin if one not in fixes], thin, scene)
    return [replace(one, fix=fixes.get(one, one.fix)) for one in findings]


def _ending(key: str, left: list[Finding], thin: list[Finding], scene: ResolvedDesign) -> dict[Finding, str]:
    """Remedies of those findings ``left`` that another part for ``key`` ends: it leaves only others of ``thin``."""
    ending: dict[Finding, list[str]] = {one: [] for one in left}
    for name, other in _others(scene, key):
        open_ones = [one for one, names in ending.items() if len(names) < _NAMED]
        if not open_ones:
            break
        with suppress(InputError):
            check_scene(other)
            items = tuple(item for item in subject_of(assemble(other)).items if item.body.name == left[0].body)
            view = PrintView(PrintSubject(items))
            found = {rule: check(view) for rule, check in CHECKS.items()}
            if any(new.severity == "error" for each in found.values() for new in each):
                continue
            for one in open_ones:
                rest = [
                    each.excess.measured for each in thin if each is not one and each.rule == one.rule and each.excess
                ]
                sizes = [new.excess.measured for new in found[one.rule] if new.excess]
                if all(any(abs(size - other) < ALIKE for other in rest) for size in sizes):
                    ending[one].append(name)
    by_hand = {rule: f"{fix}, or " for rule, fix in _HINTS["connector"].items()}
    return {
        one: f"{by_hand.get(one.rule, '')}take {key} = {' or '.join(names)}" for one, names in ending.items() if names
    }


def _others(scene: ResolvedDesign, key: str) -> Iterator[tuple[str, ResolvedDesign]]:
    """The design with each other shipped part in place of that of ``key``; a port comes with a tube that it takes.

    A user's parts are left out: they must not change a build. So are stubs with an O-ring, which need a bore to go
    into, and mounts with inserts, which need a connector that melts."""
    (table, field), kind = key.split("."), _OTHERS[key]
    chosen, stated, shipped = getattr(scene.design, table), scene.design.pneumatics.tube, Library((shipped_root(),))
    parts = {name: shipped.load(kind, name) for name in sorted(shipped.paths(kind))}
    tubes = {name: shipped.load("tubes", name) for name in shipped.paths("tubes")} if kind == "ports" else {}
    own = {name for name, tube in tubes.items() if tube.title == scene.tube.title}
    plain = [
        name for name, part in parts.items() if not isinstance(part, ORingStub) and not getattr(part, "insert", None)
    ]
    for name in sorted(plain, key=lambda name: not own & set(getattr(parts[name], "tubes", ()))):
        if name == getattr(chosen, field) or (kind == "ports" and stated not in (None, *parts[name].tubes)):
            continue
        design = scene.design.model_copy(update={table: chosen.model_copy(update={field: name})})
        more = {"tube": tubes[stated or parts[name].tubes[0]]} if kind == "ports" else {}
        yield name, replace(scene, design=design, **{_FIELDS[kind]: parts[name]}, **more)


def accepted(finding: Finding, reasons: Mapping[str, str]) -> Finding:
    """A warning on a rule that has a reason, turned into a note with that reason; any other finding unchanged."""
    reason = reasons.get(finding.rule)
    if reason is None or finding.severity != "warning":
        return finding
    return replace(finding, severity="note", message=f"{finding.message}; accepted: {reason}")


def curve_outcomes(
    sensor: Sensor, material: Material, printer: Printer, prediction: SensorPrediction, rated: Rating
) -> tuple[CurveOutcome, ...]:
    """Outcomes of the sensor for every mixing curve of its mix, the softest first.

    ``prediction`` and ``rated`` are those by the curve in use. For the other curves the same model predicts, without
    the search for waves, which changes no figure. Empty without several curves, and for (costly) contact off the axis.
    """
    if sensor.protocol.off_axis is not None:
        return ()
    outcomes = []
    for by_curve in material.curves:
        if by_curve.place == "in use":
            outcomes.append(CurveOutcome(by_curve, prediction.states, rated.pressure))
        else:
            outcomes.append(_outcome(by_curve, sensor, material.by_curve(by_curve), printer, prediction))
    return tuple(outcomes)


def _outcome(
    by_curve: MixByCurve, sensor: Sensor, material: Material, printer: Printer, prediction: SensorPrediction
) -> CurveOutcome:
    there = sensor.replace(wall=material_sensor(material).wall, correction=ResponseCorrection(), waves=0)
    pressures = [state.driving_pressure for state in prediction.states]
    answer = _predicted(there, pressures, prediction)
    if answer is None:
        return CurveOutcome(by_curve, (), None)
    error = abs(answer.error_estimate.limit_pressure_relative)
    return CurveOutcome(
        by_curve, answer.states, ratings([answer.limits], [there], material, printer, numerical=error)[0].pressure
    )


def _predicted(sensor: Sensor, pressures: list[float], like: SensorPrediction) -> SensorPrediction | None:
    """Prediction by the model of ``like`` at the pressures (MPa) up to the highest that can be solved; None if none."""
    for count in range(len(pressures), 0, -1):
        try:
            return predict("", sensor, pressures[:count], model=like.model, closure=like.closure or "variational")
        except (BeyondLimitError, ComputationError):
            continue
    return None


def by_mixing_curve(outcomes: Sequence[CurveOutcome]) -> tuple[ByMixingCurve, ...]:
    """The sensor by every mixing curve of its mix, the softest first."""
    records = tuple(
        ByMixingCurve(
            curve=one.by_curve.curve,
            place=one.by_curve.place,
            shear_modulus_MPa=one.by_curve.shear_modulus_MPa.nominal,
            beyond_last_point=one.by_curve.beyond,
            rated_pressure_kPa=None if one.rated is None else one.rated / KPA,
            states=tuple(
                MixState(state.driving_pressure / KPA, found and found.sensitivity, found and found.force_range[1])
                for state in one.states
                for found in (state.figures,)
            ),
        )
        for one in outcomes
    )
    return rounded(records, 6)
