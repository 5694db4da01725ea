"""``pneutouch predict DESIGN --for FIGURE=VALUE``: the driving pressure that gives a figure."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer

from pneutouch.cli.terminal import bar, echo, put, report_next, set_words, table_text
from pneutouch.results.driving import (
    DrivingRecord,
    FigureReach,
    MissedTask,
    PressureInterval,
    ReachedTask,
    TaskGas,
    TaskRecord,
    UnknownLeak,
)
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY, plain
from pneutouch.wording import tenths_below


def report_driving(
    design: str,
    changes: dict[str, Any],
    given: Sequence[str],
    tasks: Path | None,
    leak: Path | None,
    words: tuple[list[str] | None, str | None],
    *,
    json: bool,
    **options: Any,
) -> None:
    """Solve the tasks given as texts and those of a file, print the answer, and exit with code 1 if one is not met.

    ``words`` are the ``--set`` options and the calibration, for the next command.
    """
    from pneutouch.output.files import json_bytes
    from pneutouch.spec.tasks import parse_task, read_tasks
    from pneutouch.workflows.driving import driving_record, driving_schedule, read_leak

    required = [*map(parse_task, given), *(read_tasks(tasks) if tasks is not None else [])]
    measured = None if leak is None else read_leak(leak, Path(design).stem.partition("@")[0])
    with bar("") as progress:
        schedule = driving_schedule(design, required, changes, leak=measured, progress=progress, **options)
    record = driving_record(schedule)
    if json:
        put(json_bytes(plain(record)).decode())
    else:
        echo(schedule_text(record))
    _next(design, record, words)
    if not schedule.reached:
        raise typer.Exit(1)


def _next(design: str, record: DrivingRecord, words: tuple[list[str] | None, str | None]) -> None:
    """Report the next command: predict at the pressures found, else select for the first task that is not met."""
    missed = next((task for task in record.tasks if not task.reached), None)
    if missed is None:
        answers_kPa = {round(task.solutions[0].driving_pressure_kPa, 2) for task in record.tasks}
        listed = ",".join(f"{at_kPa:g}" for at_kPa in sorted(answers_kPa))
        report_next("predict", design, *set_words(*words), "--set", f"pneumatics.driving_pressures_kPa=[{listed}]")
        return
    value = f"{missed.value:g}"
    flags = {SENSITIVITY_KEY: ["--sensitivity"], "force_range_N": ["--force-range"]}
    stiffness = ["--stiffness-least", f"{0.95 * missed.value:g}", "--stiffness-most", f"{1.05 * missed.value:g}"]
    known = flags.get(missed.requirement)
    report_next("select", *(stiffness if known is None else [*known, value]), "--base", design)


_UNITS = {SENSITIVITY_KEY: "kPa/N", STIFFNESS_KEY: "N/mm", "force_range_N": "N"}
_NAMES = {SENSITIVITY_KEY: "sensitivity", STIFFNESS_KEY: "stiffness", "force_range_N": "force range"}

_MINUTE, _HOUR = 60.0, 3600.0


def schedule_text(record: DrivingRecord) -> str:
    """The answer: the reach of the pressure, a table of the tasks, and remarks on each."""
    lines = [
        f"{record.design}: model {record.model}, rated pressure {tenths_below(record.rated_pressure_kPa):.1f} kPa, "
        f"computed to {record.highest_kPa:.1f} kPa ({record.limit})"
    ]
    lines += [_reach(name, record.reach[name]) for name in dict.fromkeys(task.requirement for task in record.tasks)]
    head = [
        "task",
        "required",
        "driving kPa",
        "band kPa (k = 2)",
        "inject mL",
        "move mL",
        "kPa/K",
        "1 % is",
        "holds it",
    ]
    lines += ["", table_text(head, [_row(task) for task in record.tasks]), ""]
    for task in record.tasks:
        lines += _unreached(task) if isinstance(task, MissedTask) else _notes(task, record)
    return "\n".join([*lines, *_legend(record)])


def _required(task: TaskRecord) -> str:
    return f"{_NAMES[task.requirement]} {task.value:g} {_UNITS[task.requirement]}"


def _titled(task: TaskRecord) -> str:
    return f"{task.task}: {_required(task)}" if task.task else _required(task)


def _reach(figure: str, reach: FigureReach | None) -> str:
    if reach is None:
        return f"{_NAMES[figure]}: not known at any driving pressure"
    within = ""
    if reach.rated_low is not None:
        within = f"; up to the rated pressure {reach.rated_low:.4g} to {reach.rated_high:.4g}"
    return (
        f"{_NAMES[figure]} by pressure: {reach.low:.4g} (at {reach.low_at_kPa:.3g} kPa) to {reach.high:.4g} "
        f"(at {reach.high_at_kPa:.3g} kPa) {_UNITS[figure]}{within}"
    )


def _row(task: ReachedTask | MissedTask) -> list[str]:
    first = [task.task or "-", _required(task)]
    if isinstance(task, MissedTask):
        return [*first, "not reached", *["-"] * 6]
    solution, gas = task.solutions[0], task.gas
    return [
        *first,
        f"{solution.driving_pressure_kPa:.2f}",
        _band(solution.band),
        f"{gas.injected_mL:.3f}",
        f"{gas.moved_mL:+.3f}",
        f"{gas.by_temperature_kPa_per_K:.3f}",
        "-" if gas.step_kPa is None else f"{gas.step_kPa:.2g} kPa",
        _time(gas),
    ]


def _band(band: PressureInterval | None) -> str:
    if band is None:
        return "not known"
    low = f"{'<= ' if band.open_low else ''}{band.low_kPa:.1f}"
    return f"{low} to {'>= ' if band.open_high else ''}{band.high_kPa:.1f}"


def _time(gas: TaskGas) -> str:
    seconds = gas.hold_s
    if seconds is None:
        return "not known" if gas.loss_kPa_per_min is None else "no loss"
    if seconds < 2 * _MINUTE:
        return f"{seconds:.0f} s"
    return f"{seconds / _MINUTE:.0f} min" if seconds < 2 * _HOUR else f"{seconds / _HOUR:.1f} h"


def _notes(task: ReachedTask, record: DrivingRecord) -> list[str]:
    """Warnings on a task that is reached, and its further solutions."""
    required = _titled(task)
    first, *others = task.solutions
    lines = []
    if first.above_rating:
        rated = f"{tenths_below(record.rated_pressure_kPa):.1f} kPa"
        lines.append(
            f"warning: {required}: {first.driving_pressure_kPa:.2f} kPa is above the rated pressure of {rated}"
        )
    if others:
        also = ", ".join(f"{one.driving_pressure_kPa:.2f}" for one in others)
        lines.append(f"{required}: also at {also} kPa; the lowest is taken")
    if first.band is not None and (first.band.open_low or first.band.open_high):
        advice = "calibrate it (pneutouch calibrate), then repeat with --calibration"
        if record.is_calibrated:
            advice = "calibrate it with more runs, at driving pressures near this one"
        elif not record.is_fitted:
            advice = "measure it (pneutouch characterize): no calibration covers such a sensor"
        lines.append(
            f"{required}: its uncertainty exceeds what pressure can correct: the sensor in hand may not reach it; "
            f"{advice}"
        )
    return lines


def _unreached(task: MissedTask) -> list[str]:
    """Lines on a task that is not reached: pressures at which it may be, and changes by which it would be."""
    lines = [f"{_titled(task)}: no driving pressure gives it"]
    if task.possible_band is not None:
        lines.append(f"  within the uncertainty the sensor in hand may have it at {_band(task.possible_band)} kPa")
    for one in task.offline:
        change = f"{one.what} {one.before:.4g} to {one.after:.4g}"
        lines.append(f"  to change offline: {change}, which gives {one.predicted:.4g} {_UNITS[task.requirement]}")
    return lines if task.offline else [*lines, "  no single dimension within a factor of 2 gives it: see select"]


def _legend(record: DrivingRecord) -> list[str]:
    """Meaning of the columns, and the basis of their numbers."""
    leak = record.leak
    lines = [
        f"inject: air at ambient pressure ({record.ambient_pressure_kPa:g} kPa) into the vented sensor, dead volume "
        f"{record.dead_volume_mL:.3f} mL; a regulator is set to the driving pressure instead",
        f"kPa/K: change of the sealed pressure with temperature at {record.temperature_C:g} C; "
        "1 %: change of the driving pressure that changes the figure by 1 %",
    ]
    if isinstance(leak, UnknownLeak):
        return [*lines, f"how long a sealed cavity holds it is not known: {leak.unknown} with --leak"]
    rate = f"{leak.rate_kPa_per_min:.3g} kPa/min at {leak.at_kPa:.3g} kPa"
    return [*lines, f"holds it: until the leak ({rate}, {leak.measured}) has changed the figure by 1 %"]
