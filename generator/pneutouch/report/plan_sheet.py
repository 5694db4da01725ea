"""The test plan as a sheet to print: order, instruments, steps, what must be read, and what to do when it is not."""

from collections.abc import Iterable
from itertools import groupby

from pneutouch.results.plan import ExpectedPoint, PlannedCampaign, PlannedInjection
from pneutouch.rounding import tenths_below
from pneutouch.wording import counted

_WORDS = {
    "leak": "Leak",
    "injection": "Dead volume",
    "steps": "Sensitivity",
    "loop": "Hysteresis",
    "saturation": "Saturation",
    "relaxation": "Relaxation",
}

_AMISS = (
    (
        "Pressure falls in the leak run by more than the limit",
        "wet the joints with soap water; press the tube on, renew the glue; then the leak run again. Do not go on with "
        "a leak: it looks like relaxation",
    ),
    (
        "Injected air reads less than expected, by the same share at each volume",
        "dead volume is larger than stated: shorten the tube, or measure it with the line alone (above) and give it as "
        "pneumatics.dead_volume_mL",
    ),
    (
        "Injected air reads more than expected",
        "a blocked bore, an unopened valve, or a smaller cavity: look for resin or support left inside",
    ),
    (
        "Force and pressure rise both off by one factor at every depth",
        "the resin: note its lot, age and storage; print age and temperature move a modulus by tens of percent. "
        "Nothing is wrong with the rig",
    ),
    ("Force right, pressure rise too small", "dead volume or leak"),
    (
        "First contact earlier or later from run to run by more than 0.1 mm",
        "the sensor moves in its seat, or the driving pressure was not the same: check both",
    ),
    (
        "Force before contact not near zero, or other after the run",
        "zero the force sensor without contact; keep the tube from pulling",
    ),
    ("Curve jumps down in force", "the wall buckled inward: the range has ended, stop there; note the depth"),
    ("Readings stand still at one value", "an instrument is at the end of its range: lift off"),
)
"""Sign, and what to do."""


def plan_sheet(plan: PlannedCampaign) -> str:
    """Markdown of a plan."""
    sections = {
        "Warnings": _warnings(plan),
        "Instruments": _instruments(plan),
        "Order": _order(plan),
        "Before the first run of a specimen": _before(plan),
        "Leak and dead volume": _air(plan),
        "Steps": _steps(plan),
        "Expected values": _expected(plan),
        "When a value is off": ["| sign | what to do |", "|---|---|", *(f"| {sign} | {do} |" for sign, do in _AMISS)],
        "Record": _record(plan),
    }
    parts = (f"## {name}\n\n" + "\n".join(lines) for name, lines in sections.items())
    return "\n\n".join([f"# Test plan: {_escaped(plan.title)}", *_head(plan), *parts]) + "\n"


def _head(plan: PlannedCampaign) -> list[str]:
    names = [one.sensor for one in plan.sensors]
    pressures = _list(plan.driving_pressures_kPa)
    idealised = f" ({plan.dead_volume_note})" if plan.dead_volume_note else ""
    return [
        f"Design {_escaped(plan.design)}: R0 {plan.inner_radius_mm:g} mm, wall {plan.wall_thickness_mm:g} mm, "
        f"dead volume {plan.dead_volume_mL:.3g} mL{idealised}, "
        f"driving pressures {pressures} kPa, {_object(plan)}.",
        f"{counted(len(plan.runs), 'run')} on {counted(len(names), 'specimen')} "
        f"({', '.join(map(_escaped, names))}): **{_time(plan.total_s)}** on the rig, mounting and looking aside.",
        "Laboratory: ______________________  Operator: ______________________  Date: ______________",
        "Room: ______ °C  Air pressure: ________ hPa  Resin lots: ________________________________",
    ]


def _object(plan: PlannedCampaign) -> str:
    """Object that presses the sensor, in words."""
    return f"{plan.contact['label']}" if plan.contact is not None else f"plate {plan.plate_diameter_mm:g} mm"


def _warnings(plan: PlannedCampaign) -> list[str]:
    if not plan.warnings:
        return ["None: all that is expected stays within the instruments and the sensor."]
    return [f"- ☐ **{one.rule}**: {_escaped(one.message)}" for one in plan.warnings]


def _instruments(plan: PlannedCampaign) -> list[str]:
    rig = plan.rig
    states = (state for resin in plan.resins for state in resin.states)
    points = [point for state in states for point in state.points]
    force = max((p.force_N for p in points if p.force_N is not None), default=0.0)
    pressure_kPa = max((p.cavity_pressure_kPa for p in points if p.cavity_pressure_kPa is not None), default=0.0)
    travel = max(depth for test in plan.tests.values() for depth in test.depths_mm) + plan.clearance_mm
    return [
        _escaped(rig["name"]),
        "",
        "| instrument | range | resolution | greatest expected | instrument used, number |",
        "|---|---|---|---|---|",
        f"| force sensor | {rig['force_range_N']:g} N | {rig['force_resolution_N']:g} N | {force:.1f} N | |",
        f"| pressure gauge | {rig['pressure_range_kPa']:g} kPa | | {pressure_kPa:.1f} kPa | |",
        f"| stage | {rig['travel_mm']:g} mm | | {travel:.2f} mm | |",
        f"| recorder | {rig['rate_Hz']:g} Hz | | time, position, force, pressure | |",
    ]


def _order(plan: PlannedCampaign) -> list[str]:
    """The runs of the first specimen by kind; the others have the same."""
    first = plan.sensors[0].sensor
    all_runs = [run for run in plan.runs if run.sensor == first]
    lines = [
        "Each specimen in this order; let it rest 5 minutes between kinds of test.",
        "",
        "| | test | kind | driving pressure, kPa | runs at each | one run | together |",
        "|---|---|---|---|---|---|---|",
    ]
    for place, (kind, group) in enumerate(groupby(all_runs, key=lambda run: run.kind), start=1):
        runs = list(group)
        at = sorted({run.driving_pressure_kPa for run in runs})
        lines.append(
            f"| {place} | {_WORDS[kind]} | `{kind}` | {_list(at)} | {len(runs) // len(at)} | "
            f"{_time(runs[0].duration_s)} | {_time(sum(run.duration_s for run in runs))} |"
        )
    each = _time(sum(run.duration_s for run in all_runs))
    return [*lines, f"| | one specimen | | | {len(all_runs)} runs | | **{each}** |"]


def _before(plan: PlannedCampaign) -> list[str]:
    return [
        "1. ☐ Measure the wall where the dome is open, and the dome's height: note both.",
        f"2. ☐ Clean and dry plate and dome; {_dust(plan)}.",
        "3. ☐ Plate square to the base within half a degree; dome on the plate's axis within 0.5 mm.",
        f"4. ☐ Zero the force sensor with the plate {plan.clearance_mm:g} mm clear, the gauge with the cavity vented.",
        "5. ☐ Find first contact: lower slowly until the force has left zero by three resolutions; that position is "
        "depth 0. Find it again at each driving pressure: the dome grows.",
        f"6. ☐ Try the program once with the plate {plan.clearance_mm + 20:g} mm clear.",
    ]


def _dust(plan: PlannedCampaign) -> str:
    friction = (plan.contact or {}).get("friction", 0.0)
    if not friction:
        return "dust them with talc (the prediction has no friction)"
    return "no talc: the prediction has a surface that grips" if friction == "inf" else f"the friction is {friction:g}"


def _air(plan: PlannedCampaign) -> list[str]:
    lines = [
        "Leak: fill to the pressure, close the valve, record 10 minutes, plate clear.",
        "",
        "Dead volume: vent and close. Draw room air into a syringe and push the volumes below in turn, 20 s after each "
        "read the "
        "pressure. With a round volume pushed into the line alone (sensor off, end capped) the dead volume is "
        f"ambient pressure ({plan.ambient_pressure_kPa:g} kPa) x pushed volume / gauge pressure.",
        "",
    ]
    for resin in plan.resins:
        air, leak_kPa_per_min = resin.injection, resin.leak_limit_kPa_per_min
        lines += [f"### {_escaped(resin.resin)}", ""]
        if leak_kPa_per_min is not None:
            within = (
                f"- Leak at most {leak_kPa_per_min:.2g} kPa/min: then it takes less than 1 % of the first step's rise."
            )
            lines.append(f"{within} Read: ________ kPa/min")
        if air.line_volume_mL is not None:
            lines.append(
                f"- {air.line_volume_mL:g} mL into the capped line ({air.dead_volume_mL:.3g} mL): "
                f"{air.line_pressure_kPa:.1f} kPa. Read: ________ kPa"
            )
        else:
            lines.append(
                "- The design gives no dead volume, so the line's reading cannot be predicted: push the smallest "
                "volume of the syringe into the capped line. Pushed: ________ mL  Read: ________ kPa"
            )
        lines += ["", *_pushes(air), ""]
    return lines[:-1]


def _pushes(air: PlannedInjection) -> list[str]:
    if not air.sensor:
        return ["No round volume is small enough for this sensor; leave the injection out."]
    bare = air.dead_volume_mL == 0
    head = ["pushed into the sensor, mL", f"with {air.dead_volume_mL:.3g} mL dead volume, kPa"]
    keys = ["pressure_kPa", *([] if bare else ["without_dead_volume_kPa"]), "with_more_dead_volume_kPa"]
    head += [*([] if bare else ["without any, kPa"]), f"with {air.more_dead_volume_mL:g} mL more, kPa", "read, kPa"]
    rows = [
        f"| {row.volume_mL:.4g} | {' | '.join(f'{getattr(row, key):.2f}' for key in keys)} | |" for row in air.sensor
    ]
    return [f"| {' | '.join(head)} |", "|---" * len(head) + "|", *rows]


def _steps(plan: PlannedCampaign) -> list[str]:
    lines = ["Depth counts from first contact at the driving pressure of the run.", ""]
    for kind, test in plan.tests.items():
        depths, hold = test.depths_mm, test.hold_s
        reset = "vent, then set the driving pressure again, and let it settle"
        even = f"{depths[1] - depths[0]:g} mm steps to " if len(set(depths)) > 1 else ""
        lines += [
            f"**{_WORDS[kind]}** (`{kind}`, at {_list(test.driving_pressures_kPa)} kPa, "
            f"{counted(test.runs, 'run')} each, {_time(test.duration_s)} a run)",
            "",
            "1. Start recording.",
            f"2. Plate {plan.clearance_mm:g} mm clear, rest {test.rest_s:g} s: "
            f"{reset if test.reset else 'leave the pressure as it is'}.",
            f"3. To depth at {test.speed_mm_per_s:g} mm/s: {even}{depths[-1]:.2f} mm; "
            f"{f'hold {hold:g} s' if hold else 'no hold'}; back to {plan.clearance_mm:g} mm clear.",
            f"4. Again from 2, {len(depths)} times in all." if len(depths) > 1 else "4. Once.",
            "5. Stop and save under the name in the record.",
            "",
        ]
    return lines[:-1]


def _expected(plan: PlannedCampaign) -> list[str]:
    lines = [
        "Predictions, to be compared with the readings at the end of each hold; force and pressure rise count from "
        "before contact. "
        "Their uncertainty: `pneutouch predict`. A dash: beyond the predicted range. An exclamation mark: beyond an "
        "instrument's range, do not go there.",
        "",
    ]
    for resin in plan.resins:
        states = resin.states
        head = " | ".join(f"{s.driving_pressure_kPa:g} kPa: force, N | rise, kPa" for s in states)
        lines += [
            f"### {_escaped(resin.resin)} (model {resin.model}; may be driven to "
            f"{tenths_below(resin.rating.rated_pressure_kPa):.1f} kPa)",
            "",
            f"{resin.rating.basis}.",
            "",
            f"| depth, mm | {head} |",
            "|---" * (1 + 2 * len(states)) + "|",
        ]
        for row in zip(*(state.points for state in states), strict=True):
            values = [
                f"{_number(getattr(p, key))}{_mark(p, plan)}" for p in row for key in ("force_N", "pressure_rise_kPa")
            ]
            lines.append(f"| {row[0].depth_mm:.4g} | {' | '.join(values)} |")
        lines.append("")
    return lines[:-1]


def _record(plan: PlannedCampaign) -> list[str]:
    lines = [
        "Depth: the deepest that prediction and instruments allow; there, force and rise expected before the stroke, "
        "read after it.",
        "",
    ]
    for sensor, group in groupby(plan.runs, key=lambda run: run.sensor):
        lines += [
            f"### {_escaped(sensor)}",
            "",
            "Printed on: ______________  Lot: ______________  Wall: ________ mm  Height: ________ mm",
            "",
            "| no. | file | ☐ | date, time | °C | first contact, mm | depth, mm | force, N | rise, kPa | remarks |",
            "|---" * 10 + "|",
        ]
        for run in group:
            usable = [p for p in run.expected if p.force_N is not None and not _mark(p, plan)]
            cells = ["", "", ""]
            if usable:
                last = usable[-1]
                cells = [f"{last.depth_mm:.4g}", f"{last.force_N:.2f} /", f"{last.pressure_rise_kPa:.2f} /"]
            file = run.file.removeprefix("runs/")
            lines.append(f"| {run.number} | `{file}` | ☐ | | | | {' | '.join(cells)} | |")
        lines.append("")
    return lines[:-1]


def _mark(point: ExpectedPoint, plan: PlannedCampaign) -> str:
    """An exclamation mark where an instrument's range would be passed."""
    if point.force_N is None or point.cavity_pressure_kPa is None:
        return ""
    rig = plan.rig
    over = point.force_N > rig["force_range_N"] or point.cavity_pressure_kPa > rig["pressure_range_kPa"]
    return " !" if over else ""


def _number(value: float | None) -> str:
    return "–" if value is None else f"{value:.2f}"


def _list(values: Iterable[float]) -> str:
    return ", ".join(f"{value:g}" for value in values)


def _time(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.1f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace("|", "\\|").replace("<", "&lt;")
