"""``pneutouch plan``: a test plan for the laboratory."""

from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from pneutouch.cli import app as cli
from pneutouch.cli.commands import option
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.declared import given, with_options
from pneutouch.cli.pad_commands import is_pad, plan_a_pad
from pneutouch.cli.terminal import bar, notify, report_next, table_text
from pneutouch.errors import PneutouchError
from pneutouch.results.plan import PlannedCampaign
from pneutouch.spec.options import PlanOptions
from pneutouch.wording import counted

parameter = parameters_of(__file__)


@cli.app.command()
@with_options(PlanOptions)
def plan(
    context: typer.Context,
    design: cli.DesignArgument,
    rig: Annotated[Path | None, parameter("rig")] = None,
    set_: cli.SetOption = None,
    calibration: cli.CalibrationOption = None,
    out: cli.OutOption = Path("outputs"),
    json: cli.JsonOption = False,
    **options: Any,
) -> None:
    """Plan a measurement campaign: every run and step, what it must read, and where the rig cannot follow."""
    from pneutouch.workflows.plan import make_plan, rig_of, write_plan

    if is_pad(design):
        plan_a_pad(context, design, set_, out)
        return

    with bar("planning the runs"):
        result = make_plan(
            design,
            cli.changes(set_, calibration),
            given(PlanOptions, options),
            rig=rig_of(rig),
            rig_name="" if rig is None else rig.name,
            out=out,
        )
        folder = write_plan(result, out)
    for warning in result.record.warnings:
        words = PneutouchError(warning.message).message(partial(option, context.command))
        notify(f"warning: {warning.rule}: {words}")
    cli.print_answer(result.record, plan_text, folder, json=json)
    if not json:
        report_next("simulate", folder)


def plan_text(plan: "PlannedCampaign") -> str:
    """The tests with their times, and for each resin and driving pressure the last point that is predicted."""
    rows = []
    for resin in plan.resins:
        for state in resin.states:
            known = [point for point in state.points if point.force_N is not None]
            keys = ("depth_mm", "force_N", "pressure_rise_kPa")
            cells = [f"{getattr(known[-1], key):.2f}" for key in keys] if known else ["-"] * 3
            rows.append([resin.resin, f"{state.driving_pressure_kPa:g}", *cells, resin.model])
    runs, sensors = counted(len(plan.runs), "run"), counted(len(plan.sensors), "specimen")
    head = f"{plan.design}: {runs} on {sensors}, {plan.total_s / 3600:.1f} h on {plan.rig['name']}"
    tests = table_text(["test", "at kPa", "runs at each", "specimens", "runs", "depth mm", "min a run"], _tests(plan))
    return "\n\n".join([head, tests, table_text(["resin", "kPa", "to mm", "N", "rise kPa", "model"], rows)])


def _tests(plan: "PlannedCampaign") -> list[list[str]]:
    """A row for each kind of run, with its number of runs on all specimens, and a row with their sum."""
    rows = []
    for kind in dict.fromkeys(run.kind for run in plan.runs):
        runs = [run for run in plan.runs if run.kind == kind]
        pressures_kPa = sorted({run.driving_pressure_kPa for run in runs})
        sensors = len({run.sensor for run in runs})
        test = plan.tests.get(kind)
        rows.append(
            [
                kind,
                ", ".join(f"{p:g}" for p in pressures_kPa),
                str(len(runs) // (len(pressures_kPa) * sensors)),
                str(sensors),
                str(len(runs)),
                "-" if test is None else f"{max(test.depths_mm):.2f}",
                f"{runs[0].duration_s / 60:.1f}",
            ]
        )
    return [*rows, ["all", "", "", "", str(len(plan.runs)), "", ""]]
