"""``pneutouch characterize``: measured runs turned into figures, compared with the predicted ones."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_args

import typer

from pneutouch.cli.app import CalibrationOption, JsonOption, OutOption, SetOption, app, changes, print_answer
from pneutouch.cli.commands import option
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.declared import READING_FIELDS, ColumnsOption, reading_of, reading_words, with_fields
from pneutouch.cli.pad_commands import characterize_a_pad, is_planned
from pneutouch.cli.terminal import bar, filled_text, notify, report_next, set_words
from pneutouch.errors import InputError, PneutouchError
from pneutouch.spec.campaign import Campaign, RunKind
from pneutouch.wording import SIMULATED, counted, listed

if TYPE_CHECKING:
    from pneutouch.results.measured import MeasuredCampaign
    from pneutouch.workflows.characterize.campaign import CharacterizationResult

parameter = parameters_of(__file__)


DesignOption = Annotated[str | None, parameter("design")]


KindOption = Annotated[str | None, parameter("kind", help=f"Kind of a single run: {', '.join(get_args(RunKind))}.")]


@app.command()
@with_fields(Campaign, READING_FIELDS)
def characterize(
    context: typer.Context,
    data: Annotated[Path, parameter("data")],
    design: DesignOption = None,
    target: Annotated[Path | None, parameter("target")] = None,
    model: Annotated[str | None, parameter("model")] = None,
    evidence: Annotated[str, parameter("evidence")] = "doubtful",
    columns: ColumnsOption = None,
    kind: KindOption = None,
    set_: SetOption = None,
    calibration: CalibrationOption = None,
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
    **fields: Any,
) -> None:
    """Turn measured runs into figures and compare them with the prediction; exit 3 where files are not used."""
    from pneutouch.mechanics.models.choice import USUAL
    from pneutouch.workflows.characterize.campaign import characterize as run
    from pneutouch.workflows.characterize.campaign import write
    from pneutouch.workflows.characterize.load import reading_text, same_failures

    if is_planned(str(data)):
        characterize_a_pad(context, data, out, json=json)
        return
    _check(evidence, kind)
    with bar("reading runs", unit="MB") as progress:
        given, reading = changes(set_, calibration), reading_of(columns, fields)
        how: Any = {"target": target, "model": model or USUAL, "reading": reading, "kind": kind}
        outcome = run(data, design, given, progress=progress, **how)
    folder = write(outcome, out, evidence)
    named = partial(option, context.command)
    print_answer(outcome.figures, partial(measured_text, named=named), folder, json=json)
    if outcome.read_as:
        notify(reading_text(outcome.read_as))
    for files, message in same_failures(outcome.measured.failures):
        words = InputError(message).message(named)
        notify(f"error: {files}: not used: {words}")
    if outcome.failed:
        raise typer.Exit(3)
    if outcome.missed:
        raise typer.Exit(1)
    if not json and (data.is_dir() or data.suffix == ".toml"):
        _report_next(outcome, data, folder, design, set_, reading_words(columns, fields))


def _check(evidence: str, kind: str | None) -> None:
    """Raise InputError, which suggests the nearest name, if ``evidence`` or ``kind`` is no known one."""
    from pneutouch.errors import nearest
    from pneutouch.workflows.characterize.campaign import EVIDENCE

    if evidence not in EVIDENCE:
        raise InputError(f"unknown.{nearest(evidence, EVIDENCE)}", key="evidence", value=evidence)
    if kind is not None and kind not in get_args(RunKind):
        raise InputError(f"unknown.{nearest(kind, get_args(RunKind))}", key="kind", value=kind)


def _report_next(
    outcome: "CharacterizationResult",
    data: Path,
    folder: Path,
    design: str | None,
    set_: list[str] | None,
    read: list[str],
) -> None:
    """Report the next command: `calibrate` if the fit covers the design, else `compare`; none without runs to fit."""
    campaign = outcome.measured.campaign
    fitted = sorted({run.sensor for run in campaign.runs if run.kind in ("steps", "injection")})
    if not fitted:
        return
    if outcome.fitted:
        named = ["--sensor", fitted[0]] if len({run.sensor for run in campaign.runs}) > 1 else []
        report_next("calibrate", data, *named, *(["--design", design] if design else []), *read)
    else:
        # The campaign's own assignments belong to the design that it names.
        given = [] if design else campaign.assignments
        report_next("compare", outcome.design_given, folder, *set_words([*given, *(set_ or ())]))


_NAMED = 12
"""Greatest number of runs whose kind is listed one by one."""

_SHALLOWER = 0.01
"""Relative difference from the depth of `predict` up to which a measured depth is not mentioned."""


def measured_text(measured: "MeasuredCampaign", named: Callable[[str], str | None] = lambda parameter: None) -> str:
    """A table for each group, measured figures with intervals and the prediction; then target, ageing and warnings.

    ``named`` gives the option for a parameter of the library."""
    from pneutouch.bench.figures import BY_KEY

    told = [f"{run.file} as {run.kind}" for run in measured.runs if run.kind_by_record]
    return filled_text(
        "measured.txt.j2",
        measured=measured,
        mark=SIMULATED,
        shallower=_SHALLOWER,
        figures=BY_KEY,
        told=listed(told, _NAMED),
        doubtful=[warning for run in measured.runs for warning in run.warnings if warning.kind != "note"],
        questions=[
            (entry.file, PneutouchError(entry.question).message(named).removesuffix("."))
            for entry in measured.questions
        ],
        counted=counted,
    )
