"""``pneutouch compare``: designs, builds and measurements side by side."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pneutouch.cli import app as cli
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.pad_commands import compare_pads, is_pad
from pneutouch.cli.terminal import bar, report_next, set_words, table_text

if TYPE_CHECKING:
    from pneutouch.results.comparison import ComparisonRecord, RowRecord

parameter = parameters_of(__file__)


@cli.app.command()
def compare(
    context: typer.Context,
    things: Annotated[list[str], parameter("things")],
    set_: cli.SetOption = None,
    model: cli.ModelOption = None,
    tolerance: cli.ToleranceOption = None,
    closure: cli.ClosureOption = "variational",
    clamp: cli.ClampOption = "base",
    out: cli.OutOption = Path("outputs"),
    json: cli.JsonOption = False,
) -> None:
    """Compare designs, builds and measurements: their differences, and those that exceed their uncertainty."""
    if any(is_pad(thing) for thing in things):
        compare_pads(context, things, set_)
        return
    from pneutouch.mechanics.models.choice import model_options
    from pneutouch.workflows.compare import compare as run
    from pneutouch.workflows.compare import write

    with bar("") as progress:
        result = run(
            things,
            cli.changes(set_),
            closure=closure,
            clamp=clamp,
            progress=progress,
            **model_options(model, tolerance),
        )
        progress(len(things), len(things), "drawing curves and sections")
        folder = write(result, out)
    cli.print_answer(result.record, comparison_text, folder, json=json)
    if not json:
        uncalibrated, _, calibration = next((thing for thing in things if "@" in thing), "").partition("@")
        if calibration and not Path(f"{uncalibrated}@{calibration}").exists():
            report_next("export-reader", uncalibrated, *set_words(set_, calibration))


def comparison_text(comparison: "ComparisonRecord") -> str:
    """Inputs that differ, figures with intervals, differences that exceed their uncertainty, and assumptions."""
    # Names are completed without numpy, which the records load.
    from pneutouch.report import comparison_words

    labels = comparison_words.labels(comparison)
    sources = (f", {one.source}" if one.source not in ("", one.label) else "" for one in comparison.compared)
    lines = [f"{one.label}: {one.kind}{source}" for one, source in zip(comparison.compared, sources, strict=True)]
    lines += comparison_words.marks(comparison)
    inputs = comparison_words.input_rows(comparison)
    if inputs:
        lines += ["", table_text(["inputs that differ", *labels], inputs)]
    differences = ["difference"] if len(labels) == 2 else [f"{label}, difference" for label in labels[1:]]
    for pressure_kPa in comparison_words.pressures(comparison):
        rows = [_row(row) for row in comparison.figures if row.driving_pressure_kPa == pressure_kPa]
        head = [comparison_words.heading(pressure_kPa), *labels, *differences]
        lines += ["", table_text(head, rows)]
    lines += ["", *comparison_words.summary(comparison), ""]
    return "\n".join([*lines, comparison.criterion, *comparison.notes])


def _row(row: "RowRecord") -> list[str]:
    from pneutouch.report import comparison_words

    values = [f"{value} ({interval})" if interval else value for value, interval in comparison_words.figure_cells(row)]
    differences = [
        f"{percent} ({interval}): {word}" if interval else f"{percent}: {word}" if percent != word else word
        for percent, interval, word in comparison_words.difference_cells(row)
    ]
    return [comparison_words.figure_name(row), *values, *differences]
