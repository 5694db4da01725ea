"""``pneutouch predict DESIGN --for FIGURE=VALUE``: the driving pressure that gives a figure.

Driving pressures as text.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer

from pneutouch.cli.progress import bar
from pneutouch.cli.terminal import echo, put, report_next, set_words, table_text
from pneutouch.rounding import tenths_below


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
    """Solve the tasks given as texts and those of a file, print the answer, and end with code 1 where one is not met.

    ``words`` are the ``--set`` options and the calibration, for the next command.
    """
    from pneutouch.output.files import json_bytes
    from pneutouch.spec.tasks import parse_task, read_tasks
    from pneutouch.workflows.driving import driving_schedule, read_leak, schedule_document

    required = [*map(parse_task, given), *(read_tasks(tasks) if tasks is not None else [])]
    measured = None if leak is None else read_leak(leak, Path(design).stem.partition("@")[0])
    with bar("") as progress:
        schedule = driving_schedule(design, required, changes, leak=measured, progress=progress, **options)
    document = schedule_document(schedule)
    if json:
        put(json_bytes(document).decode())
    else:
        echo(schedule_text(document))
    _next(design, document, words)
    if not schedule.reached:
        raise typer.Exit(1)


def _next(design: str, document: dict[str, Any], words: tuple[list[str] | None, str | None]) -> None:
    """Predict at the pressures where all tasks are met; else look for another design for the first that is not."""
    missed = next((task for task in document["tasks"] if not task["reached"]), None)
    if missed is None:
        answers = [task["solutions"][0] for task in document["tasks"]]
        listed = ",".join(
            f"{at_kPa:g}" for at_kPa in sorted({round(one["driving_pressure_kPa"], 2) for one in answers})
        )
        report_next("predict", design, *set_words(*words), "--set", f"pneumatics.driving_pressures_kPa=[{listed}]")
        return
    value = f"{missed['value']:g}"
    flags = {"sensitivity_kPa_per_N": ["--sensitivity"], "force_range_N": ["--force-range"]}
    stiffness = ["--stiffness-least", f"{0.95 * missed['value']:g}", "--stiffness-most", f"{1.05 * missed['value']:g}"]
    known = flags.get(missed["requirement"])
    report_next("select", *(stiffness if known is None else [*known, value]), "--base", design)


_UNITS = {"sensitivity_kPa_per_N": "kPa/N", "stiffness_N_per_mm": "N/mm", "force_range_N": "N"}
_NAMES = {"sensitivity_kPa_per_N": "sensitivity", "stiffness_N_per_mm": "stiffness", "force_range_N": "force range"}

_MINUTE, _HOUR = 60.0, 3600.0


def schedule_text(document: dict[str, Any]) -> str:
    """The answer: the reach of the pressure, a table of the tasks, and remarks on each."""
    rated, top = document["rated_pressure_kPa"], document["highest_kPa"]
    lines = [
        f"{document['design']}: model {document['model']}, rated pressure {tenths_below(rated):.1f} kPa, "
        f"computed to {top:.1f} kPa ({document['limit']})"
    ]
    for figure in dict.fromkeys(task["requirement"] for task in document["tasks"]):
        lines.append(_reach(figure, document["reach"][figure]))
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
    lines += ["", table_text(head, [_row(task) for task in document["tasks"]]), ""]
    for task in document["tasks"]:
        lines += _notes(task, document)
    return "\n".join([*lines, *_legend(document)])


def _required(task: dict[str, Any]) -> str:
    return f"{_NAMES[task['requirement']]} {task['value']:g} {_UNITS[task['requirement']]}"


def _reach(figure: str, reach: dict[str, Any] | None) -> str:
    if reach is None:
        return f"{_NAMES[figure]}: not known at any driving pressure"
    ends = " to ".join(f"{reach[end]:.4g} (at {reach[f'{end}_at_kPa']:.3g} kPa)" for end in ("low", "high"))
    within = ""
    if "rated_low" in reach:
        within = f"; up to the rated pressure {reach['rated_low']:.4g} to {reach['rated_high']:.4g}"
    return f"{_NAMES[figure]} by pressure: {ends} {_UNITS[figure]}{within}"


def _row(task: dict[str, Any]) -> list[str]:
    first = [task["task"] or "-", _required(task)]
    if not task["reached"]:
        return [*first, "not reached", *["-"] * 6]
    solution, gas = task["solutions"][0], task["gas"]
    step = "-" if gas["step_kPa"] is None else f"{gas['step_kPa']:.2g} kPa"
    return [
        *first,
        f"{solution['driving_pressure_kPa']:.2f}",
        _band(solution["band"]),
        f"{gas['injected_mL']:.3f}",
        f"{gas['moved_mL']:+.3f}",
        f"{gas['by_temperature_kPa_per_K']:.3f}",
        step,
        _time(gas),
    ]


def _band(band: dict[str, Any] | None) -> str:
    if band is None:
        return "not known"
    low = f"{'<= ' if band['open_low'] else ''}{band['low_kPa']:.1f}"
    return f"{low} to {'>= ' if band['open_high'] else ''}{band['high_kPa']:.1f}"


def _time(gas: dict[str, Any]) -> str:
    if gas["hold_s"] is None:
        return "not known" if gas["loss_kPa_per_min"] is None else "no loss"
    seconds = gas["hold_s"]
    if seconds < 2 * _MINUTE:
        return f"{seconds:.0f} s"
    return f"{seconds / _MINUTE:.0f} min" if seconds < 2 * _HOUR else f"{seconds / _HOUR:.1f} h"


def _notes(task: dict[str, Any], document: dict[str, Any]) -> list[str]:
    """Warnings and more solutions of a task, or what to change where it is not reached."""
    name = f"{task['task']}: " if task["task"] else ""
    required = f"{name}{_required(task)}"
    if not task["reached"]:
        return _unreached(required, task)
    first, *others = task["solutions"]
    lines = []
    if first["above_rating"]:
        at, rated = first["driving_pressure_kPa"], document["rated_pressure_kPa"]
        lines.append(f"warning: {required}: {at:.2f} kPa is above the rated pressure of {tenths_below(rated):.1f} kPa")
    if others:
        at = ", ".join(f"{one['driving_pressure_kPa']:.2f}" for one in others)
        lines.append(f"{required}: also at {at} kPa; the lowest is taken")
    band = first["band"]
    if band is not None and (band["open_low"] or band["open_high"]):
        advice = "calibrate it (pneutouch calibrate), then repeat with --calibration"
        if not document["is_fitted"]:
            advice = "measure it (pneutouch characterize): no calibration covers such a sensor"
        lines.append(
            f"{required}: its uncertainty exceeds what pressure can correct: the sensor in hand may not reach it; "
            f"{advice}"
        )
    return lines


def _unreached(required: str, task: dict[str, Any]) -> list[str]:
    lines = [f"{required}: no driving pressure gives it"]
    if task["possible_band"] is not None:
        lines.append(f"  within the uncertainty the sensor in hand may have it at {_band(task['possible_band'])} kPa")
    unit = _UNITS[task["requirement"]]
    for one in task["offline"]:
        change = f"{one['what']} {one['before']:.4g} to {one['after']:.4g}"
        lines.append(f"  to change offline: {change}, which gives {one['predicted']:.4g} {unit}")
    return lines if task["offline"] else [*lines, "  no single dimension within a factor of 2 gives it: see select"]


def _legend(document: dict[str, Any]) -> list[str]:
    """Meaning of the columns, and the basis of their numbers."""
    gas = f"dead volume {document['dead_volume_mL']:.3f} mL"
    leak = document["leak"]
    lines = [
        f"inject: air at ambient pressure ({document['ambient_pressure_kPa']:g} kPa) into the vented sensor, {gas}; "
        "a regulator is set to the driving pressure instead",
        f"kPa/K: change of the sealed pressure with temperature at {document['temperature_C']:g} C; "
        "1 %: change of the driving pressure that changes the figure by 1 %",
    ]
    if "unknown" in leak:
        return [*lines, f"how long a sealed cavity holds it is not known: {leak['unknown']} with --leak"]
    rate = f"{leak['rate_kPa_per_min']:.3g} kPa/min at {leak['at_kPa']:.3g} kPa"
    return [*lines, f"holds it: until the leak ({rate}, {leak['measured']}) has changed the figure by 1 %"]
