"""``pneutouch export-reader``: the sensor's force over pressure, for microcontrollers, for Python and as data."""

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Annotated, Any

import typer

from pneutouch.cli import app as cli
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.pad_commands import export_a_pad, is_pad
from pneutouch.cli.terminal import bar, filled_text, notify, table_text
from pneutouch.errors import InputError
from pneutouch.results.reader import ReaderRecord, SimulatorRecord
from pneutouch.spec.values import plain_number

parameter = parameters_of(__file__)


def simulators(incomplete: str) -> list[str]:
    """Completions of the name of a simulator."""
    return [name for name in ("mujoco", "urdf") if name.startswith(incomplete)]


_DAYS = {"d": 1.0, "w": 7.0, "m": 365.0 / 12.0, "y": 365.0}


def years_of(text: str, parameter: str) -> float:
    """Years, from 0 to 1, of a time such as 90d, 8w, 6m or 1y. Raises InputError."""
    number, unit = text.strip()[:-1], text.strip()[-1:]
    try:
        value = plain_number(number) * _DAYS[unit] / _DAYS["y"]
    except (ValueError, KeyError):
        value = float("nan")
    if not 0.0 <= value <= 1.0:
        problem = "it must be a time of at most a year with its unit, such as 90d, 8w, 6m or 1y"
        raise InputError(problem, key=parameter, value=text)
    return value


@cli.app.command("export-reader")
def export_reader(
    context: typer.Context,
    design: cli.DesignArgument,
    set_: cli.SetOption = None,
    calibration: cli.CalibrationOption = None,
    model: cli.AnswerModelOption = None,
    tolerance: cli.ToleranceOption = None,
    simulator: Annotated[str | None, parameter("simulator", autocompletion=simulators)] = None,
    age: Annotated[str | None, parameter("age")] = None,
    out: cli.OutOption = Path("outputs"),
    json: cli.JsonOption = False,
) -> None:
    """Write the sensor's pressure-to-force model: a table, a C header, a Python module, an Arduino sketch."""
    from pneutouch.evaluation.evaluate import evaluate
    from pneutouch.mechanics.models.choice import model_options
    from pneutouch.workflows.export_reader import make_reader, write_reader

    if is_pad(design):
        export_a_pad(context, design, set_, calibration, simulator, out)
        return
    options = model_options(model or (None if tolerance else "auto"), tolerance)
    aged = None if age is None else years_of(age, "age")
    if simulator is not None and age is not None:
        raise InputError("a simulator's model states no uncertainty", key="age", value=age, remedy="leave it out")
    if simulator is not None:
        _export_simulator(design, cli.changes(set_, calibration), simulator, out, options, json=json)
        return
    with bar("tabulating the sensor"):
        result = make_reader(evaluate(design, cli.changes(set_, calibration), **options), aged)
        folder = write_reader(result, out)
    if result.note is not None:
        notify(result.note)
    off_percent = result.record.difference.nominal_percent
    if off_percent > 0.5:
        less = f"--set indentation.depth_mm=VALUE below {result.record.box.indentation_mm[1]:.3g} lessens that"
        notify(f"warning: the table is up to {off_percent:.2f} % of full scale off the model, above 0.5 %; {less}")
    cli.print_answer(result.document, lambda document: reader_text(result.record), folder, json=json)
    if not json:
        files = " and ".join(sorted(path.name for path in folder.glob("*_reader.*")))
        notify(f"how to use it: the examples at the head of {files}")


def _export_simulator(
    design: str, changed: dict[str, Any], simulator: str, out: Path, options: Mapping[str, Any], *, json: bool
) -> None:
    """Write the model for a simulator and list its content."""

    from pneutouch.evaluation.evaluate import evaluate
    from pneutouch.workflows.export_reader import make_simulator, write_simulator

    with bar("tabulating the press"):
        result = make_simulator(evaluate(design, changed, **options), simulator)
        folder = write_simulator(result, out)
    cli.print_answer(result.record, simulator_text, folder, json=json)


def reader_text(record: ReaderRecord) -> str:
    """The box of values in which a reader is valid, and its difference from the full model."""
    return filled_text("reader.txt.j2", record=record)


def simulator_text(record: SimulatorRecord) -> str:
    """Mass and inertia, and the values at the end of the press at every driving pressure."""
    diagonal = ", ".join(f"{record.inertia_about_centre_g_mm2[k][k]:.4g}" for k in range(3))
    head = ["driving kPa", "apex mm", "range mm", "force N", "pressure kPa", "stiffest N/mm"]
    rows = [[f"{getattr(state, field.name):.4g}" for field in fields(state)] for state in record.states]
    lines = [
        f"{record.design} for {record.simulator}, by the model {record.model}",
        f"mass {record.mass_g:.4g} g; inertia about its centre {diagonal} g mm2",
        "",
        table_text(head, rows),
    ]
    return "\n".join(lines)
