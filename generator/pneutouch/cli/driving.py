"""``pneutouch predict DESIGN --for FIGURE=VALUE``: the driving pressure that gives a figure."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer

from pneutouch.cli.next_step import report_next, set_words
from pneutouch.cli.progress import bar
from pneutouch.cli.terminal import echo, put


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
        from pneutouch.cli.driving_text import schedule_text

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
