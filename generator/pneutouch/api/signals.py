"""Simulated signals of a step or a sine."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from pneutouch.api.design import Design, source_of
from pneutouch.api.fields import named_by_keyword, number_of
from pneutouch.api.results import Result
from pneutouch.errors import InputError


def respond(
    design: Design | str | Path,
    *,
    step_N: float | None = None,
    step_mm: float | None = None,
    sine_Hz: float | None = None,
    peak_N: float | None = None,
    peak_mm: float | None = None,
    duration_s: float | None = None,
    seed: int = 0,
    model: str | None = None,
) -> Result:
    """Simulate a step of force or travel, or a sine from no load to a peak, through wall, gas, line and gauge.

    Without a size it is half of the range, without ``sine_Hz`` a step. ``duration_s`` None: 1 s, or ten cycles;
    ``seed`` is that of the gauge's noise. `Result.save` writes the signals. Raises InputError for
    a load beyond the range.
    """
    from pneutouch.evaluation.evaluate import evaluate
    from pneutouch.mechanics.models import model_options
    from pneutouch.workflows.respond.document import document, write_respond
    from pneutouch.workflows.respond.load import Load
    from pneutouch.workflows.respond.run import run_respond

    sizes = {"step_N": step_N, "step_mm": step_mm, "peak_N": peak_N, "peak_mm": peak_mm}
    given = {key: value for key, size in sizes.items() if (value := number_of(size, key)) is not None}
    frequency_Hz, length_s = number_of(sine_Hz, "sine_Hz"), number_of(duration_s, "duration_s")
    wrong = [key for key in given if key.startswith("step") == (sine_Hz is not None)]
    if wrong or len(given) > 1:
        remedy = "give one of `peak_N` and `peak_mm` with `sine_Hz`, or one of `step_N` and `step_mm` without"
        raise InputError("these sizes do not go together", key=(wrong or list(given))[0], remedy=remedy)
    key, size = next(iter(given.items()), ("", None))
    with named_by_keyword():
        evaluation = evaluate(source_of(design), **model_options(model, None))
        run = run_respond(evaluation, Load(size, key.endswith("mm"), frequency_Hz, length_s), seed)
    return Result(f"Response of {evaluation.scene.name}", document(run), partial(write_respond, run))
