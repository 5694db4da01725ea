"""``pneutouch scan``: a sensor slides over a specimen, and its spectrum is read."""

from pathlib import Path
from typing import Annotated, Any

import typer

from pneutouch.cli import app as cli
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.declared import given, with_options
from pneutouch.cli.terminal import bar, filled_text, table_text
from pneutouch.results.scan import ScanRecord, SeparationRecord, SimulatedSignal, SoughtPattern
from pneutouch.spec.options import ScanOptions, flag_of

parameter = parameters_of(__file__)

SpecimenArgument = Annotated[str, parameter("specimen")]

_NOT_SEPARATING = {
    key: f"--{flag_of(ScanOptions, key)}" for key in ("driving_pressures_kPa", "control", "seed", "data")
}


@cli.app.command()
@with_options(ScanOptions)
def scan(
    context: typer.Context,
    specimen: SpecimenArgument,
    design: Annotated[str, parameter("design")],
    separate: Annotated[str | None, parameter("separate")] = None,
    set_: cli.SetOption = None,
    calibration: cli.CalibrationOption = None,
    out: cli.OutOption = Path("outputs"),
    json: cli.JsonOption = False,
    **options: Any,
) -> None:
    """Scan a specimen with a sensor: signals, scalograms and which pattern each state shows."""
    asked = given(ScanOptions, options)
    if separate is not None:
        cli.refuse_flags(context, _NOT_SEPARATING, "--separate, which scans nothing", specimen)
        _separate(specimen, design, separate, asked, cli.changes(set_, calibration), json=json)
        return
    from pneutouch.workflows.scan import run_scan
    from pneutouch.workflows.scanned import scanned, write_scan

    with bar("scanning"):
        run = run_scan(specimen, design, asked, cli.changes(set_, calibration))
        record = scanned(run)
        folder = write_scan(run, record, out)
    cli.print_answer(record, scan_text, folder, json=json)


def _separate(
    specimen: str, design: str, text: str, options: ScanOptions, changed: dict[str, Any], *, json: bool
) -> None:
    from pneutouch.workflows.scan import separating

    with bar("ranking domes"):
        separation = separating(specimen, design, text, options, changed)
    cli.print_answer(separation, separation_text, json=json)
    if not separation.domes:
        raise typer.Exit(1)


def scan_text(record: ScanRecord) -> str:
    """Tables of the states, and of the readings of each pattern in each state."""
    simulated = [state for state in record.states if isinstance(state, SimulatedSignal)]
    states = [
        [
            state.label,
            f"{state.contact_radius_mm:.2f}",
            f"{state.stiffness_N_per_mm:.3f}",
            f"{state.pressure_slope_kPa_per_mm:.3f}",
            f"{state.pressure_kPa:.2f}",
            state.model,
        ]
        for state in simulated
    ]
    contacts = table_text(["state", "patch radius mm", "N/mm", "kPa/mm", "kPa", "model"], states)
    rows = [[state.label, pattern.name, *_readings(pattern)] for state in record.states for pattern in state.patterns]
    head = ["signal", "pattern", "true Hz", "found Hz", "model Pa", "read Pa", "over noise", "p", ""]
    readings = table_text(head, rows)
    return filled_text("scan.txt.j2", record=record, simulated=simulated, contacts=contacts, readings=readings)


def _readings(pattern: SoughtPattern) -> list[str]:
    true, model = f"{pattern.true_frequency_Hz:.4g}", _pascals(pattern.model_amplitude_kPa)
    if pattern.p_value is None:
        return [true, "-", model, "-", "-", "-", "no signal"]
    return [
        true,
        f"{pattern.detected_frequency_Hz:.4g}",
        model,
        _pascals(pattern.amplitude_kPa),
        f"{pattern.detection_figure:.1f}",
        f"{pattern.p_value:.3f}",
        "detected" if pattern.detected else "not detected",
    ]


def _pascals(pressure_kPa: float | None) -> str:
    return "-" if pressure_kPa is None else f"{1e3 * pressure_kPa:.3g}"


def separation_text(record: SeparationRecord) -> str:
    """Table of the domes that separate two patterns, best first, or a sentence that none does."""
    one, two = (f"{pattern.pitch_mm:g} mm at {pattern.depth_mm:g} mm" for pattern in record.patterns)
    if not record.domes:
        return f"none of {record.candidates} candidates shows both {one} and {two} above the noise"
    rows = [
        [
            str(dome.rank),
            dome.resin,
            f"{dome.inner_radius_mm:.2f}",
            f"{dome.wall_thickness_mm:.2f}",
            *(
                cell
                for state in dome.states
                for cell in (f"{state.driving_pressure_kPa:.1f}", "/".join(map(_pascals, state.amplitudes_kPa)))
            ),
            f"{dome.contrast:.3g}",
        ]
        for dome in record.domes
    ]
    head = ["", "resin", "R0 mm", "t0 mm", "1st: kPa", "Pa", "2nd: kPa", "Pa", "contrast"]
    first = f"1st pattern {one}, 2nd {two}; {record.candidates} candidates at {record.preload_N:g} N"
    return "\n".join([first, "", table_text(head, rows)])
