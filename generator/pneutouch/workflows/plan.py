"""Plan of a measurement: runs of a campaign, their steps and expected readings, and limits of the rig they exceed."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from pneutouch.bench.indents import CLEARANCE, REPETITIONS, RunProtocol, protocol
from pneutouch.bench.simulate.curve import PressCurves
from pneutouch.bench.simulate.rig import LEAK_SECONDS
from pneutouch.catalogue import DesignSource, Library, ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.evaluation.contact_object import contact_document
from pneutouch.evaluation.gauge import reading_of
from pneutouch.evaluation.resins import SimulatedResin, pressed, resins_of, tested_kPa
from pneutouch.evaluation.result import rating_record
from pneutouch.formats import versioned
from pneutouch.output.files import check_writable, json_bytes, with_manifest, write_folder
from pneutouch.parts import assemble
from pneutouch.report.plan_sheet import plan_sheet
from pneutouch.results.plan import (
    ExpectedPoint,
    PlannedCampaign,
    PlannedResin,
    PlannedRun,
    PlannedSpecimen,
    PlannedState,
    PlannedStep,
    PlannedTest,
    PlanViolation,
)
from pneutouch.results.record import plain
from pneutouch.spec.campaign import Campaign, CampaignRun, Rig, RunKind
from pneutouch.spec.options import PlanOptions
from pneutouch.spec.read import Changes, read_toml, validate
from pneutouch.spec.toml_text import assignments
from pneutouch.units import KPA, ML
from pneutouch.workflows.plan_expected import (
    curve_warnings,
    injection,
    leak_limit,
    points,
    refuse_above_limits,
    travel_warnings,
)
from pneutouch.workflows.simulate import campaign_toml
from pneutouch.workflows.simulate_inputs import named_design

FILL, PUSH, SETTLE = 30.0, 2.0, 20.0
"""Seconds to fill before a leak run, to push one volume, and to let that settle and cool: our choice."""

_REST = (("wait", 0.2), ("vent", 0.2), ("set_pressure", 0.2), ("wait", 0.4))
"""Actions of a rest with reset and their shares of it: our choice; the last share lets the pressure settle."""


def steps_of(test: RunProtocol, pressure_kPa: float, rig: Rig) -> list[PlannedStep]:
    """Steps of one run with a plate; travels count from first contact, below zero the plate is clear."""
    steps = [PlannedStep("record", rig.rate_Hz, "Hz", 0.0)]
    for k, depth in enumerate(test.depths):
        if test.reset:
            values = {"wait": (None, ""), "vent": (0.0, "kPa"), "set_pressure": (pressure_kPa, "kPa")}
            steps += [PlannedStep(action, *values[action], share * test.rest) for action, share in _REST]
        elif k == 0:
            steps.append(PlannedStep("set_pressure", pressure_kPa, "kPa", test.rest))
        else:
            steps.append(PlannedStep("wait", None, "", test.rest))
        seconds = (depth + CLEARANCE) / test.speed
        steps.append(PlannedStep("move", depth, "mm", seconds))
        if test.hold > 0:
            steps.append(PlannedStep("hold", depth, "mm", test.hold))
        steps.append(PlannedStep("move", -CLEARANCE, "mm", seconds))
    return steps


def leak_steps(pressure_kPa: float, rig: Rig) -> list[PlannedStep]:
    """Steps of a leak run: the line is filled to the driving pressure, closed and left alone."""
    return [
        PlannedStep("set_pressure", pressure_kPa, "kPa", FILL),
        PlannedStep("record", rig.rate_Hz, "Hz", 0.0),
        PlannedStep("wait", None, "", LEAK_SECONDS),
    ]


def injection_steps(volume_mL: float) -> list[PlannedStep]:
    """Steps of an injection run: ``volume_mL`` in five equal parts, each read after it has settled."""
    steps = [PlannedStep("vent", 0.0, "kPa", SETTLE)]
    for share in (0.2, 0.4, 0.6, 0.8, 1.0):
        steps += [
            PlannedStep("inject", round(share * volume_mL, 9), "mL", PUSH),
            PlannedStep("wait", None, "", SETTLE),
            PlannedStep("record", None, "", 0.0),
        ]
    return steps


PAPER = Rig()

SATURATION = (0.0, 12.0)
"""Driving pressures of the saturation test, kPa (paper, section 3-C)."""


@dataclass(frozen=True)
class CampaignPlan:
    """A plan, the campaign file to fill in, and the files that this one needs, by name."""

    record: PlannedCampaign
    campaign: Campaign
    copied: dict[str, bytes]

    @property
    def name(self) -> str:
        """Name of the output folder."""
        return self.record.name

    @property
    def sheet(self) -> str:
        """The plan as Markdown for the laboratory."""
        return plan_sheet(self.record)


def rig_of(file: Path | None) -> Rig:
    """Rig from the [rig] table of a TOML file; the paper's without a file. Raises InputError without the table."""
    if file is None:
        return Rig()
    content = read_toml(file)
    if not isinstance(content.get("rig"), dict):
        raise InputError(
            "rig: missing", file=file, remedy="give a [rig] table, such as [rig] and below it force_range_N = 50.0"
        )
    return validate(Rig, content["rig"], f"{file}: rig")


def paper_rig(scene: ResolvedDesign) -> Rig:
    """Rig of the paper, with range and rate of the gauge that the design names, if it names one."""
    if scene.gauge is None:
        return PAPER
    reading = reading_of(scene)
    return Rig(
        name=f"the paper's rig with the gauge {reading.title}"[:120],
        pressure_range_kPa=reading.limit / KPA,
        rate_Hz=min(PAPER.rate_Hz, reading.rate_Hz or PAPER.rate_Hz),
    )


def make_plan(
    design: str | DesignSource,
    changes: Changes | None = None,
    options: PlanOptions = PlanOptions(),  # noqa: B008 - immutable
    *,
    rig: Rig = PAPER,
    rig_name: str = "",
    library: Library | None = None,
    out: Path | None = None,
) -> CampaignPlan:
    """Plan the paper's tests for a design in each resin. Raises InputError, also if ``out`` cannot take the plan."""
    library = library or Library.default()
    subjects = resins_of(design, changes, options.resins, library=library)
    named, copied = named_design(design, library)
    scene = subjects[0].scene
    if out is not None:
        check_writable(out / f"{scene.name}-plan")
    if rig == PAPER and not rig_name:
        rig = paper_rig(scene)
    for subject in subjects:
        refuse_above_limits(subject.name, subject.rating, scene)
    tests = plated_tests(subjects[0], min(s.rating.pressure_kPa for s in subjects))
    curves = {s.name: _pressed(s, tests) for s in subjects}
    listed: list[PlannedRun] = []
    for subject in subjects:
        for k in range(options.specimens):
            listed += _runs(subject, f"{subject.name}-{k + 1}", tests, curves[subject.name], rig, len(listed))
    warnings = [w for s in subjects for w in _warnings(s, curves[s.name], tests, rig)]
    depths = tuple(depth for test, _ in tests.values() for depth in test.depths)
    pneumatics, membrane = scene.design.pneumatics, scene.design.membrane
    record = PlannedCampaign(
        name=f"{scene.name}-plan",
        design=scene.name,
        title=scene.design.document.title,
        inner_radius_mm=membrane.inner_radius_mm,
        wall_thickness_mm=membrane.wall_thickness_mm,
        ambient_pressure_kPa=pneumatics.ambient_pressure_kPa,
        driving_pressures_kPa=tuple(tested_kPa(scene)),
        dead_volume_mL=subjects[0].sensor.gas.dead_volume / ML,
        dead_volume_note=assemble(scene).dead_volume_note or None,
        contact=contact_document(scene).get("contact"),
        clearance_mm=CLEARANCE,
        plate_diameter_mm=scene.design.indentation.plate_diameter_mm,
        rig={**rig.model_dump(mode="json"), "file": rig_name or None},
        sensors=tuple(PlannedSpecimen(f"{s.name}-{k + 1}", s.name) for s in subjects for k in range(options.specimens)),
        resins=tuple(_expected(s, curves[s.name], tests, rig) for s in subjects),
        tests={kind: _test(kind, *test) for kind, test in tests.items()},
        runs=tuple(listed),
        total_s=sum(run.duration_s for run in listed),
        warnings=(*travel_warnings(depths, rig), *warnings),
    )
    campaign = Campaign(
        title=f"Campaign of {scene.design.document.title}"[:120],
        design=named,
        assignments=assignments(changes or {}),
        ambient_pressure_kPa=pneumatics.ambient_pressure_kPa,
        rig=rig,
        runs=[_campaign_run(run) for run in listed],
    )
    return CampaignPlan(record, campaign, copied)


def _campaign_run(run: PlannedRun) -> CampaignRun:
    """Entry of a planned run in the campaign file."""
    return CampaignRun(
        file=run.file,
        kind=run.kind,
        sensor=run.sensor,
        resin=run.resin,
        driving_pressure_kPa=run.driving_pressure_kPa,
        run=run.run,
        volumes_mL=[step.value for step in run.steps if step.action == "inject" and step.value is not None] or None,
    )


def _test(kind: str, test: RunProtocol, driving_pressures_kPa: tuple[float, ...]) -> PlannedTest:
    times = test.hold, test.rest, test.reset, test.speed, test.duration
    return PlannedTest(test.depths, *times, driving_pressures_kPa, _times(kind))


def write_plan(plan: CampaignPlan, out: Path) -> Path:
    """Write ``out/<design>-plan/``: plan.json, plan.md, campaign.toml, manifest; the same input, the same bytes."""
    folder = out / plan.name
    note = "# Fill in lab, and date and age_days of every run; measured files go to the path in `file`."
    document = plain(plan.record)
    files = {
        "plan.json": json_bytes(versioned("plan", document)),
        "plan.md": plan.sheet.encode(),
        "campaign.toml": campaign_toml(plan.campaign, note),
        **plan.copied,
    }
    inputs = {key: document[key] for key in ("design", "rig", "sensors", "tests")}
    return write_folder(folder, with_manifest(files, plan.name, inputs))


Tests = Mapping[RunKind, tuple[RunProtocol, tuple[float, ...]]]


def plated_tests(subject: SimulatedResin, rated_kPa: float) -> Tests:
    """Protocol and driving pressures (kPa) of each kind of run with a plate, in the order in which they are run.

    The design's own pressures are kept; the one that the plan chooses for saturation is at most ``rated_kPa``.
    """
    driving_kPa = tuple(tested_kPa(subject.scene))
    top_kPa = min(SATURATION[-1], driving_kPa[-1], rated_kPa)
    pressures_kPa: dict[RunKind, tuple[float, ...]] = {
        "steps": driving_kPa,
        "loop": driving_kPa,
        "saturation": tuple(sorted({SATURATION[0], top_kPa})),
        "relaxation": tuple(sorted({0.0, driving_kPa[-1]})),
    }
    return {kind: (protocol(kind, subject.sensor.dome.shape.height), at) for kind, at in pressures_kPa.items()}


def _times(kind: str) -> int:
    return REPETITIONS if kind in ("steps", "saturation") else 1


def _pressed(subject: SimulatedResin, tests: Tests) -> PressCurves:
    pressures_kPa = sorted({p for _, at in tests.values() for p in at})
    depth = max(depth for test, _ in tests.values() for depth in test.depths)
    return pressed(subject.name, subject.sensor, [p * KPA for p in pressures_kPa], depth, "auto")


def _warnings(subject: SimulatedResin, pressed_curves: PressCurves, tests: Tests, rig: Rig) -> Iterator[PlanViolation]:
    for curve in pressed_curves.curves:
        here: dict[str, RunProtocol] = {
            k: t for k, (t, at) in tests.items() if any(abs(p * KPA - curve.driving) < 1e-12 for p in at)
        }
        yield from curve_warnings(subject.name, subject.rating, curve, here, rig)


def _expected(subject: SimulatedResin, pressed_curves: PressCurves, tests: Tests, rig: Rig) -> PlannedResin:
    """Expected readings of one resin: at every depth of every kind of run, after injected air, and the leak allowed."""
    depths = tuple(sorted({depth for test, _ in tests.values() for depth in test.depths}))
    states = tuple(
        PlannedState(
            curve.driving / KPA, points(curve, depths), curve.reach, None if curve.ends is None else curve.ends[0]
        )
        for curve in pressed_curves.curves
    )
    steps = tests["steps"][0]
    rises_kPa = [points(curve, steps.depths[:1])[0].pressure_rise_kPa for curve in pressed_curves.curves]
    least_kPa = min((rise_kPa for rise_kPa in rises_kPa if rise_kPa is not None), default=None)
    return PlannedResin(
        resin=subject.name,
        model=pressed_curves.model,
        states=states,
        injection=injection(pressed_curves, subject.rating, rig),
        limit_kPa=pressed_curves.limits.lowest / KPA,
        limit_by=pressed_curves.limits.binding,
        rating=rating_record(subject.rating, [curve.driving for curve in pressed_curves.curves]),
        leak_limit_kPa_per_min=None if least_kPa is None else leak_limit(least_kPa, steps),
    )


def _runs(
    subject: SimulatedResin, sensor: str, tests: Tests, pressed_curves: PressCurves, rig: Rig, before: int
) -> list[PlannedRun]:
    """Runs of one specimen in order: leak and injection first, relaxation, which strains the wall longest, last."""
    top_kPa = tested_kPa(subject.scene)[-1]
    volume_mL = injection(pressed_curves, subject.rating, rig).sensor_volume_mL
    planned: list[tuple[RunKind, float, int, list[PlannedStep], tuple[ExpectedPoint, ...]]] = [
        ("leak", top_kPa, 1, leak_steps(top_kPa, rig), ())
    ]
    if volume_mL is not None:
        planned.append(("injection", 0.0, 1, injection_steps(volume_mL), ()))
    curves = {round(curve.driving / KPA, 9): curve for curve in pressed_curves.curves}
    for kind, (test, pressures_kPa) in tests.items():
        for pressure_kPa in pressures_kPa:
            expected = points(curves[round(pressure_kPa, 9)], tuple(dict.fromkeys(test.depths)))
            planned += [
                (kind, pressure_kPa, n + 1, steps_of(test, pressure_kPa, rig), expected) for n in range(_times(kind))
            ]
    return [
        PlannedRun(
            number=before + place,
            kind=kind,
            sensor=sensor,
            resin=subject.name,
            driving_pressure_kPa=pressure_kPa,
            run=n,
            file=f"runs/{sensor}-{pressure_kPa:g}kPa-{kind}-{n}.csv",
            steps=tuple(steps),
            expected=expected,
            duration_s=sum(step.seconds for step in steps),
        )
        for place, (kind, pressure_kPa, n, steps, expected) in enumerate(planned, start=1)
    ]
