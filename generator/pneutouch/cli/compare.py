"""``pneutouch compare``: designs, builds and measurements side by side."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from pneutouch.cli.app import (
    ClampOption,
    ClosureOption,
    JsonOption,
    ModelOption,
    OutOption,
    SetOption,
    ToleranceOption,
    app,
    changes,
    print_json,
    reporting,
)
from pneutouch.cli.complete import names
from pneutouch.cli.terminal import echo, report_next, set_words


@app.command()
def compare(
    things: Annotated[
        list[str],
        typer.Argument(
            metavar="A B...",
            help="Designs, DESIGN@CALIBRATION, folders of build or characterize.",
            autocompletion=names("designs"),
        ),
    ],
    set_: SetOption = None,
    model: ModelOption = None,
    tolerance: ToleranceOption = None,
    closure: ClosureOption = "variational",
    clamp: ClampOption = "base",
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
) -> None:
    """Compare designs, builds and measurements: their differences, and those that exceed their uncertainty."""
    with reporting():
        from pneutouch.cli.progress import bar
        from pneutouch.mechanics.models.choice import model_options
        from pneutouch.results.record import plain
        from pneutouch.workflows.compare import compare as run
        from pneutouch.workflows.compare import write

        with bar("") as progress:
            result = run(
                things,
                changes(set_),
                closure=closure,
                clamp=clamp,
                progress=progress,
                **model_options(model, tolerance),
            )
            progress(len(things), len(things), "drawing curves and sections")
            folder = write(result, out)
        if json:
            print_json(plain(replace(result.record, folder=str(folder))))
        else:
            from pneutouch.cli.compare_text import comparison_text

            echo(comparison_text(result.record))
            echo(f"\n{folder}")
            uncalibrated, _, calibration = next((thing for thing in things if "@" in thing), "").partition("@")
            if calibration and not Path(f"{uncalibrated}@{calibration}").exists():
                report_next("export-reader", uncalibrated, *set_words(set_, calibration))
