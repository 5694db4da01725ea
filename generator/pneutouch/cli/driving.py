"""``pneutouch predict DESIGN --for FIGURE=VALUE``: the driving pressure that gives a figure."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer

from pneutouch.cli.terminal import bar, echo, filled_text, put, report_next, set_words, table_text
from pneutouch.results.driving import DrivingRecord, MissedTask, PressureInterval, ReachedTask, TaskGas, TaskRecord
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
    return filled_text(
        "schedule.txt.j2",
        record=record,
        figures=list(dict.fromkeys(task.requirement for task in record.tasks)),
        table=table_text(head, [_row(task) for task in record.tasks]),
        titled=_titled,
        band=_band,
        names=_NAMES,
        units=_UNITS,
        below=tenths_below,
    )


def _required(task: TaskRecord) -> str:
    return f"{_NAMES[task.requirement]} {task.value:g} {_UNITS[task.requirement]}"


def _titled(task: TaskRecord) -> str:
    return f"{task.task}: {_required(task)}" if task.task else _required(task)


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
