"""``pneutouch calibrate``: fit the model to the sensor in hand."""

from pathlib import Path
from typing import Annotated, Any

import typer

from pneutouch.cli.app import JsonOption, OutOption, app, print_json, reporting
from pneutouch.cli.complete import names
from pneutouch.cli.declared import with_fields
from pneutouch.cli.next_step import report_next, set_words
from pneutouch.cli.reading import READING_FIELDS, ColumnsOption, reading_of, reading_text
from pneutouch.cli.simulate import numbers
from pneutouch.cli.terminal import echo, notify
from pneutouch.spec.campaign import Campaign


@app.command()
@with_fields(Campaign, READING_FIELDS)
def calibrate(
    data: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="Folder of a campaign, or its campaign file.")],
    design: Annotated[
        str | None,
        typer.Option(
            metavar="DESIGN",
            help="Design that the sensor was made to.",
            show_default="the campaign's",
            autocompletion=names("designs"),
        ),
    ] = None,
    sensor: Annotated[
        str | None, typer.Option(metavar="NAME", help="Sensor of the campaign.", show_default="its only one")
    ] = None,
    fit: Annotated[
        str, typer.Option(metavar="NAMES", help="What to fit: modulus, wall, dead-volume, offset, friction.")
    ] = "modulus,dead-volume,wall,offset",
    hold_out: Annotated[
        list[str] | None, typer.Option(metavar="KPA,KPA", help="Driving pressures to predict by the others.")
    ] = None,
    no_priors: Annotated[bool, typer.Option("--no-priors", help="Fit to the measurements alone.")] = False,
    save: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help="Name of the calibration in the user's folder.", show_default="design and sensor"
        ),
    ] = None,
    replace: Annotated[bool, typer.Option("--force", help="Replace a calibration of that name.")] = False,
    columns: ColumnsOption = None,
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
    **fields: Any,
) -> None:
    """Fit modulus, wall, dead volume and contact offset to a sensor's runs."""
    with reporting():
        from pneutouch.cli.progress import bar
        from pneutouch.workflows.calibrate.run import CalibrationOptions, run_calibration

        held = numbers("--hold-out", ",".join(hold_out or ()))
        options = CalibrationOptions(
            data, design, sensor, tuple(fit.split(",")), held, not no_priors, save, replace, out
        )
        with bar("reading runs", unit="MB") as progress:
            outcome = run_calibration(options, progress=progress, reading=reading_of(columns, fields))
        document = outcome.document
        if document["read_as"]:
            notify(reading_text(document["read_as"]))
        if json:
            print_json(document)
        else:
            from pneutouch.cli.calibrate_text import calibration_text

            echo(calibration_text(document))
            plain, name = outcome.design_given, document["calibration"]
            words = ("compare", plain, f"{plain}@{name}") if name else ("predict", plain)
            report_next(*words, *set_words(outcome.assignments))
        if document["failures"]:
            raise typer.Exit(3)
        if document["calibration"] is None:
            raise typer.Exit(1)
