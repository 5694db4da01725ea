"""``pneutouch export-reader``: the sensor's force over pressure, for microcontrollers, for Python and as data."""

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Annotated, Any

from pneutouch.cli import app as cli
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.terminal import bar, notify, table_text
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
    box, known, rated_kPa = record.box, record.difference, record.rating.driving_pressure_kPa
    relative, calibration = record.grid.force_uncertainty_relative, record.calibration
    low, high = box.driving_pressure_kPa
    lines = [
        f"{record.design}: force from pressure, by the model {record.model}"
        + (f", calibration {calibration}" if calibration else ", not calibrated"),
        f"  driving pressure   {low:.4g} to {high:.4g} kPa; rated for {rated_kPa:.4g} kPa",
        f"  contact            {record.conditions.contact}",
        f"  contact force      0 to {box.contact_force_N[1]:.4g} N, to {box.indentation_mm[1]:.4g} mm of travel",
        f"  pressure rise      0 to {box.pressure_rise_kPa[1]:.4g} kPa",
        f"  ambient pressure   {box.ambient_pressure_kPa[0]:.5g} to {box.ambient_pressure_kPa[1]:.5g} kPa",
        f"  gas temperature    within {box.temperature_change_K:g} K of that at the tare",
        f"  table to model     {known.nominal_percent:.2f} % of full scale at most in {known.states} states; "
        f"{known.other_conditions_percent:.2f} % at other temperatures and ambient pressures",
    ]
    if relative is None:
        lines.append(f"  uncertainty        unknown: {record.grid.force_uncertainty_unknown}")
    else:
        least, most = (100 * pick(map(pick, relative)) for pick in (min, max))
        days, since = record.grid.force_uncertainty_age_days, "calibration" if calibration else "print"
        when = (
            f"up to {days:.4g} days after its {since}" if days else f"at the age of its {since}, --age 1y adds ageing"
        )
        lines += [
            f"  uncertainty        {least:.2g} to {most:.2g} % of the force (standard), {when}",
            "                     noise of the gauge not in it",
        ]
    return "\n".join(lines)


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
