"""``pneutouch scan``: a sensor slides over a specimen, and its spectrum is read."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pneutouch.cli.app import (
    CalibrationOption,
    JsonOption,
    OutOption,
    SetOption,
    app,
    changes,
    print_json,
    refuse_flags,
    reporting,
)
from pneutouch.cli.complete import names
from pneutouch.cli.progress import bar
from pneutouch.cli.terminal import echo

if TYPE_CHECKING:
    from pneutouch.workflows.scan.run import ScanOptions


SpecimenArgument = Annotated[
    str,
    typer.Argument(
        metavar="SPECIMEN", help="Name of a specimen, or path of its TOML file.", autocompletion=names("specimens")
    ),
]

_NOT_SEPARATING = {key: f"--{key}" for key in ("pressures", "control", "seed", "data")}


@app.command()
def scan(
    context: typer.Context,
    specimen: SpecimenArgument,
    design: Annotated[
        str,
        typer.Option("--design", help="Sensor that scans: name of a design, or path.", autocompletion=names("designs")),
    ],
    pressures: Annotated[
        str, typer.Option(metavar="KPA,KPA", help="Driving pressures, kPa; empty: measured data alone.")
    ] = "0,22",
    preload: Annotated[float, typer.Option(help="Normal force at which the height is set, N.")] = 0.5,
    speed: Annotated[float | None, typer.Option(help="Speed along the path, mm/s; left out: the specimen's.")] = None,
    control: Annotated[str, typer.Option(help="Quantity held constant along the path: height or force.")] = "height",
    noise: Annotated[
        float | None, typer.Option(help="White noise of a sample, kPa rms; left out: one step of the recorder.")
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the noise.")] = 0,
    data: Annotated[
        list[Path] | None,
        typer.Option(
            "--data", metavar="FILE", help="Measured signal, CSV with time_s and pressure_kPa; may be repeated."
        ),
    ] = None,
    separate: Annotated[
        str | None,
        typer.Option(
            "--separate",
            metavar="PITCH@DEPTH,PITCH@DEPTH",
            help="Instead: rank domes by how well they separate two patterns, mm.",
        ),
    ] = None,
    set_: SetOption = None,
    calibration: CalibrationOption = None,
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
) -> None:
    """Scan a specimen with a sensor: signals, scalograms and which pattern each state shows."""
    with reporting():
        options = _options(pressures, preload, speed, control, noise, seed, data or [])
        if separate is not None:
            refuse_flags(context, _NOT_SEPARATING, "--separate, which scans nothing", specimen)
            _separate(specimen, design, separate, options, changes(set_, calibration), json=json)
            return
        from pneutouch.workflows.scan.document import document
        from pneutouch.workflows.scan.run import run_scan
        from pneutouch.workflows.scan.write import write_scan

        with bar("scanning"):
            run = run_scan(specimen, design, options, changes(set_, calibration))
            folder = write_scan(run, out)
        if json:
            print_json({**document(run), "folder": str(folder)})
        else:
            from pneutouch.cli.scan_text import scan_text

            echo(scan_text(document(run)))
            echo(f"\n{folder}")


def _options(
    pressures: str, preload: float, speed: float | None, control: str, noise: float | None, seed: int, data: list[Path]
) -> ScanOptions:
    from pneutouch.errors import InputError
    from pneutouch.spec.number import plain_number
    from pneutouch.texture.scan import NOISE
    from pneutouch.units import KPA
    from pneutouch.workflows.scan.run import ScanOptions

    try:
        listed = tuple(plain_number(part) * KPA for part in pressures.split(",") if part.strip())
    except ValueError:
        raise InputError(f"--pressures {pressures}: must be numbers in kPa with commas between, such as 0,22") from None
    return ScanOptions(listed, preload, speed, control, NOISE if noise is None else noise * KPA, seed, tuple(data))


def _separate(
    specimen: str, design: str, text: str, options: ScanOptions, changed: dict[str, Any], *, json: bool
) -> None:
    from pneutouch.workflows.scan.separate import separating

    with bar("ranking domes"):
        separation = separating(specimen, design, text, options, changed)
    if json:
        print_json(separation)
    else:
        from pneutouch.cli.scan_text import separation_text

        echo(separation_text(separation))
    if not separation["domes"]:
        raise typer.Exit(1)
