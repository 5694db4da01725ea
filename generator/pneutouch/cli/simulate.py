"""``pneutouch simulate``: a campaign of simulated runs, to try the measuring chain on."""

from pathlib import Path
from typing import Annotated, Any

import typer

from pneutouch.cli.app import CalibrationOption, JsonOption, OutOption, SetOption, app, changes, print_json
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.declared import given, with_options
from pneutouch.cli.pad_commands import is_pad, is_planned, simulate_a_pad
from pneutouch.cli.terminal import bar, echo, notify, report_next
from pneutouch.spec.options import SimulationOptions
from pneutouch.wording import counted

parameter = parameters_of(__file__)


@app.command()
@with_options(SimulationOptions)
def simulate(
    context: typer.Context,
    design: Annotated[str, parameter("design")],
    set_: SetOption = None,
    calibration: CalibrationOption = None,
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
    **options: Any,
) -> None:
    """Simulate a measurement campaign: records with known truth, always labelled as simulated."""
    from pneutouch.workflows.simulate import simulate

    asked = given(SimulationOptions, options)
    if is_pad(design) or is_planned(design):
        simulate_a_pad(context, design, set_, out, asked.seed)
        return
    with bar("simulating specimens") as progress:
        folder = simulate(design, out, changes(set_, calibration), asked, progress=progress)
    _report(folder, asked, json=json)


def _report(folder: Path, options: SimulationOptions, *, json: bool) -> None:
    """Print the folder on stdout; on stderr the notes on runs, such as that some stop short of their depth."""
    from json import loads

    from pneutouch.workflows.simulate_inputs import KINDS

    truth = loads((folder / "truth.json").read_text(encoding="utf-8"))
    files = [name for name in loads((folder / "manifest.json").read_text(encoding="utf-8"))["files"] if "/" in name]
    for note in truth["notes"]:
        notify(f"note: {note}")
    if json:
        content = {"folder": str(folder), "simulated": True, "runs": len(files), "specimens": len(truth["specimens"])}
        print_json(content | {"seed": options.seed, "populations": truth["populations"], "notes": truth["notes"]})
        return
    of_kind = {run.rpartition("-")[0].rpartition("-")[2] for run in files}
    kinds = ", ".join(kind for kind in KINDS if kind in of_kind)
    runs, specimens = counted(len(files), "simulated run"), counted(len(truth["specimens"]), "specimen")
    notify(f"{runs} of {specimens} ({kinds})")
    echo(str(folder))
    report_next("characterize", folder)
