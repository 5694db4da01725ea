"""``pneutouch calibrate``: fit the model to the sensor in hand; ``pneutouch table``: its local table."""

from pathlib import Path
from typing import Annotated, Any

import typer

from pneutouch.cli.app import DesignArgument, JsonOption, OutOption, SetOption, app, changes, print_json
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.declared import READING_FIELDS, ColumnsOption, given, reading_of, with_fields, with_options
from pneutouch.cli.pad_commands import calibrate_a_pad, is_planned
from pneutouch.cli.terminal import bar, echo, filled_text, notify, report_next, set_words, table_text
from pneutouch.results.calibration import EstimateRecord, FittedResponse, OutcomeRecord
from pneutouch.spec.campaign import Campaign
from pneutouch.spec.options import CalibrationOptions
from pneutouch.wording import counted

parameter = parameters_of(__file__)


@app.command()
@with_options(CalibrationOptions)
@with_fields(Campaign, READING_FIELDS)
def calibrate(
    context: typer.Context,
    data: Annotated[Path, parameter("data")],
    design: Annotated[str | None, parameter("design")] = None,
    columns: ColumnsOption = None,
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
    **fields: Any,
) -> None:
    """Fit modulus, wall, dead volume and contact offset to a sensor's runs."""
    from pneutouch.workflows.calibrate.calibrate import run_calibration
    from pneutouch.workflows.characterize.load import reading_text

    asked = given(CalibrationOptions, fields)
    if is_planned(str(data)):
        calibrate_a_pad(context, data, out, asked.save, replace=asked.replace)
        return
    with bar("reading runs", unit="MB") as progress:
        outcome = run_calibration(data, design, asked, out, progress=progress, reading=reading_of(columns, fields))
    record = outcome.record
    if record.read_as:
        notify(reading_text(record.read_as))
    if json:
        print_json(record)
    else:
        echo(calibration_text(record))
        uncalibrated, name = outcome.design_given, record.calibration
        words = ("compare", uncalibrated, f"{uncalibrated}@{name}") if name else ("predict", uncalibrated)
        report_next(*words, *set_words(outcome.assignments))
    if record.failures:
        raise typer.Exit(3)
    if record.calibration is None:
        raise typer.Exit(1)


@app.command()
def table(design: DesignArgument, set_: SetOption = None, check: Annotated[bool, parameter("check")] = False) -> None:
    """Build the table of a design's neighbourhood, with which other shapes are answered in milliseconds."""
    from time import process_time

    from pneutouch.catalogue import load_scene
    from pneutouch.evaluation.evaluate import sensor_of
    from pneutouch.mechanics.models.accuracy import TABULATION
    from pneutouch.mechanics.models.local import MODEL, find, make
    from pneutouch.parts import assemble
    from pneutouch.units import KPA

    scene = load_scene(design, changes(set_))
    sensor = sensor_of(assemble(scene))
    found, damaged = find(sensor)
    for path in damaged:
        notify(f"note: {path} is damaged{'' if check else ': built again if it is of this design'}")
    if check:
        echo(MODEL.covers(sensor) or f"{design}: answered from a stored table")
    else:
        begun = process_time()
        with bar("solving the designs around it") as progress:
            found = make(sensor, max(0.0, *scene.design.pneumatics.driving_pressures_kPa, 0.0) * KPA, progress)
        echo(f"built in {process_time() - begun:.0f} s of processor time")
    if found is None:
        raise typer.Exit(1)
    error = f"sensitivity within {found.error:.2%} of the solid in {found.errors.size} presses, bound {TABULATION:.2%}"
    echo(f"{found.path}: {found.path.stat().st_size / 1e6:.2f} MB; {error}")
    report_next("predict", design, "--model", "auto", *set_words(set_))


def calibration_text(record: "OutcomeRecord") -> str:
    """The estimates and the design's values, the goodness of the fit, warnings, notes, and the files written."""
    from pneutouch.workflows.characterize.load import same_failures

    rows = [[e.key, f"{e.value:.4g}", _interval(e), f"designed {e.designed:.4g}"] for e in record.estimates]
    remarks = (
        [f"warning: {warning}" for warning in record.warnings],
        [f"note: {note}" for note in record.notes],
        [f"not used: {files}: {why}" for files, why in same_failures(record.failures)],
        [f"written: {path}" for path in record.written],
    )
    estimates, response = table_text([], rows), _response(record.response)
    return filled_text(
        "calibration.txt.j2", record=record, estimates=estimates, response=response, remarks=remarks, counted=counted
    )


def _response(response: "tuple[FittedResponse, ...]") -> str:
    if not response:
        return "no curves: the model's error in sensitivity stays that of the resin"
    head = ["kPa", "force times", "pressure rise times", "sensitivity", "error left in it"]
    rows = [
        [
            f"{row.driving_pressure_kPa:g}",
            f"{row.force_factor:.4f}",
            f"{row.pressure_factor:.4f}",
            f"{row.pressure_factor / row.force_factor - 1:+.1%}",
            f"{row.sensitivity_error_relative:.1%}",
        ]
        for row in response
    ]
    return f"correction of the fitted model (errors are standard uncertainties):\n{table_text(head, rows)}"


def _interval(estimate: "EstimateRecord") -> str:
    interval = estimate.interval_95
    if interval is None:
        return "on its bound, no interval" if estimate.on_bound else "no interval"
    return f"95 %: {interval[0]:.4g} to {interval[1]:.4g}"
