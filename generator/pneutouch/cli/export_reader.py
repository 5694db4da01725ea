"""``pneutouch export-reader``: the sensor's force over pressure, for microcontrollers, for Python and as data."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from pneutouch.cli.app import (
    AnswerModelOption,
    CalibrationOption,
    DesignArgument,
    JsonOption,
    OutOption,
    SetOption,
    ToleranceOption,
    app,
    changes,
    print_json,
    reporting,
)
from pneutouch.cli.complete import simulators
from pneutouch.cli.terminal import echo, notify


@app.command("export-reader")
def export_reader(
    design: DesignArgument,
    set_: SetOption = None,
    calibration: CalibrationOption = None,
    model: AnswerModelOption = None,
    tolerance: ToleranceOption = None,
    simulator: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help="Write a model for a simulator instead: mujoco or urdf.", autocompletion=simulators
        ),
    ] = None,
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
) -> None:
    """Write the sensor's pressure-to-force model: a table, a C header, a Python module, an Arduino sketch."""
    with reporting():
        from pneutouch.cli.progress import bar
        from pneutouch.evaluation.evaluate import evaluate
        from pneutouch.mechanics.models import model_options
        from pneutouch.workflows.reader import make_reader, write_reader

        options = model_options(model or (None if tolerance else "auto"), tolerance)
        if simulator is not None:
            _export_simulator(design, changes(set_, calibration), simulator, out, options, json=json)
            return
        with bar("tabulating the sensor"):
            result = make_reader(evaluate(design, changes(set_, calibration), **options))
            folder = write_reader(result, out)
        if result.note is not None:
            notify(result.note)
        off_percent = result.document["difference"]["nominal_percent"]
        if off_percent > 0.5:
            notify(f"warning: the table is up to {off_percent:.2f} % of full scale off the model, more than 0.5 %")
        if json:
            print_json({**result.document, "folder": str(folder)})
        else:
            from pneutouch.cli.reader_text import reader_text

            echo(reader_text(result.document))
            echo(f"\n{folder}")
            files = " and ".join(sorted(path.name for path in folder.glob("*_reader.*")))
            notify(f"how to use it: the examples at the head of {files}")


def _export_simulator(
    design: str, changed: dict[str, Any], simulator: str, out: Path, options: Mapping[str, Any], *, json: bool
) -> None:
    """Write the model for a simulator and list its content."""
    from pneutouch.cli.progress import bar
    from pneutouch.evaluation.evaluate import evaluate
    from pneutouch.workflows.simulator import make_simulator, write_simulator

    with bar("tabulating the press"):
        result = make_simulator(evaluate(design, changed, **options), simulator)
        folder = write_simulator(result, out)
    if json:
        print_json({**result.document, "folder": str(folder)})
    else:
        from pneutouch.cli.simulator_text import simulator_text

        echo(simulator_text(result.document))
        echo(f"\n{folder}")
