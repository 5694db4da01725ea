"""The test plan as a sheet to print: order, instruments, steps, what must be read, and what to do when it is not."""

from itertools import groupby

from pneutouch.report.pages import filled
from pneutouch.results.plan import ExpectedPoint, PlannedCampaign, PlannedRun
from pneutouch.wording import counted, data_of, tenths_below

_WORDS: dict[str, str] = data_of(__file__)


def plan_sheet(plan: PlannedCampaign) -> str:
    """Markdown of a test plan."""
    states = [state for resin in plan.resins for state in resin.states]
    points = [point for state in states for point in state.points]
    # The others have the same.
    first = [run for run in plan.runs if run.sensor == plan.sensors[0].sensor]
    return filled(
        "plan.md.j2",
        plan=plan,
        words=_WORDS,
        first=first,
        kinds=_kinds(first),
        dust=_dust(plan),
        force_N=max((p.force_N for p in points if p.force_N is not None), default=0.0),
        pressure_kPa=max((p.cavity_pressure_kPa for p in points if p.cavity_pressure_kPa is not None), default=0.0),
        travel_mm=max(depth for test in plan.tests.values() for depth in test.depths_mm) + plan.clearance_mm,
        groups=[list(group) for _, group in groupby(plan.runs, key=lambda run: run.sensor)],
        counted=counted,
        tenths=lambda pressure_kPa: f"{tenths_below(pressure_kPa):.1f}",
        rows=lambda resin: list(zip(*(state.points for state in resin.states), strict=True)),
        mark=lambda point: " !" if _beyond(point, plan) else "",
        deepest=lambda run: _deepest(run, plan),
    )


def _kinds(runs: list[PlannedRun]) -> list[tuple[str, list[float], int, float, float]]:
    """Runs of one kind in a row: kind, driving pressures (kPa), runs at each, time of one and of all of them, s."""
    kinds = []
    for kind, group in groupby(runs, key=lambda run: run.kind):
        members = list(group)
        at = sorted({run.driving_pressure_kPa for run in members})
        whole = sum(run.duration_s for run in members)
        kinds.append((kind, at, len(members) // len(at), members[0].duration_s, whole))
    return kinds


def _dust(plan: PlannedCampaign) -> str:
    friction = (plan.contact or {}).get("friction", 0.0)
    if not friction:
        return "dust them with talc (the prediction has no friction)"
    return "no talc: the prediction has a surface that grips" if friction == "inf" else f"the friction is {friction:g}"


def _deepest(run: PlannedRun, plan: PlannedCampaign) -> ExpectedPoint | None:
    """The deepest point that is predicted and within the ranges of the instruments; None if there is none."""
    usable = [point for point in run.expected if point.force_N is not None and not _beyond(point, plan)]
    return usable[-1] if usable else None


def _beyond(point: ExpectedPoint, plan: PlannedCampaign) -> bool:
    """True if the expected force or pressure exceeds an instrument's range; False if they are not known."""
    if point.force_N is None or point.cavity_pressure_kPa is None:
        return False
    rig = plan.rig
    return bool(point.force_N > rig["force_range_N"] or point.cavity_pressure_kPa > rig["pressure_range_kPa"])
