"""``pneutouch export-reader``: the sensor's force over pressure, for microcontrollers, for Python and as data."""

from pathlib import Path

from pneutouch.cli.app import (
    CalibrationOption,
    DesignArgument,
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
from pneutouch.cli.terminal import echo, notify


@app.command("export-reader")
def export_reader(
    design: DesignArgument,
    set_: SetOption = None,
    calibration: CalibrationOption = None,
    model: ModelOption = None,
    tolerance: ToleranceOption = None,
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
) -> None:
    """Write the sensor's pressure-to-force model: a table, a C header, a Python module, an Arduino sketch."""
    with reporting():
        from pneutouch.cli.progress import bar
        from pneutouch.evaluation.evaluate import evaluate
        from pneutouch.mechanics.models import model_options
        from pneutouch.workflows.reader import make_reader, write_reader

        with bar("tabulating the sensor"):
            options = model_options(model or (None if tolerance else "auto"), tolerance)
            result = make_reader(evaluate(design, changes(set_, calibration), **options))
            folder = write_reader(result, out)
        if result.note is not None:
            notify(result.note)
        if json:
            print_json({**result.document, "folder": str(folder)})
        else:
            from pneutouch.cli.reader_text import reader_text

            echo(reader_text(result.document))
            echo(f"\n{folder}")
