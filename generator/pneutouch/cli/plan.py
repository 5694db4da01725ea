"""``pneutouch plan``: a test plan for the laboratory."""

from pathlib import Path
from typing import Annotated

import typer

from pneutouch.cli.app import (
    CalibrationOption,
    DesignArgument,
    JsonOption,
    OutOption,
    SetOption,
    app,
    changes,
    print_json,
    reporting,
)
from pneutouch.cli.next_step import report_next
from pneutouch.cli.progress import bar
from pneutouch.cli.simulate import SPECIMENS, ResinsOption, SpecimensOption, words
from pneutouch.cli.terminal import echo, notify


@app.command()
def plan(
    design: DesignArgument,
    resins: ResinsOption = "",
    specimens: SpecimensOption = SPECIMENS,
    rig: Annotated[
        Path | None,
        typer.Option("--rig", metavar="RIG.toml", help="File with a [rig] table; left out: the paper's rig."),
    ] = None,
    set_: SetOption = None,
    calibration: CalibrationOption = None,
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
) -> None:
    """Plan a measurement campaign: every run and step, what it must read, and where the rig cannot follow."""
    with reporting():
        from pneutouch.workflows.plan.run import make_plan, rig_of, write_plan

        with bar("planning the runs"):
            result = make_plan(
                design,
                changes(set_, calibration),
                resins=words(resins),
                specimens=specimens,
                rig=rig_of(rig),
                rig_name="" if rig is None else rig.name,
            )
            folder = write_plan(result, out)
        for warning in result.document["warnings"]:
            notify(f"warning: {warning['rule']}: {warning['message']}")
        if json:
            print_json({**result.document, "folder": str(folder)})
        else:
            from pneutouch.cli.plan_text import plan_text

            echo(plan_text(result.document))
            echo(f"\n{folder}")
            report_next("simulate", folder)
