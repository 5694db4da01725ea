"""``pneutouch simulate``: a campaign of simulated runs, to try the measuring chain on."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pneutouch.cli.app import CalibrationOption, JsonOption, OutOption, SetOption, app, changes, print_json, reporting
from pneutouch.cli.complete import names
from pneutouch.cli.progress import bar
from pneutouch.cli.terminal import echo, notify, report_next
from pneutouch.wording import counted

if TYPE_CHECKING:
    from pneutouch.workflows.simulate_inputs import SimulationOptions

ResinsOption = Annotated[
    str,
    typer.Option(
        "--resins",
        metavar="NAME,NAME",
        help="Resins of the dome, or all of the paper's; left out: the design's.",
        autocompletion=names("materials", listed=True),
    ),
]
SpecimensOption = Annotated[int, typer.Option("--specimens", help="Specimens of each resin.")]
SPECIMENS = 3

_ModelOption = Annotated[
    str | None,
    typer.Option(
        "--model",
        help="What presses the specimens: solid, harmonic, atlas or auto.",
        show_default="solid; harmonic for contact off the axis",
    ),
]


@app.command()
def simulate(
    design: Annotated[
        str,
        typer.Argument(
            metavar="DESIGN",
            help="Name of a design, path of a TOML file, or the folder of a plan: then every run of the plan.",
            autocompletion=names("designs"),
        ),
    ],
    resins: ResinsOption = "",
    specimens: SpecimensOption = SPECIMENS,
    pressures: Annotated[
        str | None, typer.Option(metavar="KPA,KPA", help="Driving pressures, kPa; left out: the design's.")
    ] = None,
    runs: Annotated[int, typer.Option(help="Runs of each steps and saturation test; other kinds have one.")] = 3,
    kinds: Annotated[
        str, typer.Option(metavar="KIND,KIND", help="Of steps, saturation, loop, relaxation, leak, injection.")
    ] = "steps,loop,relaxation",
    rate: Annotated[float, typer.Option(help="Samples a second, Hz.")] = 100.0,
    rest: Annotated[
        float | None, typer.Option(metavar="S", help="Longest rest, s; left out: the paper's 30 s and 2 s.")
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of scatter and noise.")] = 0,
    ages: Annotated[
        str, typer.Option(metavar="DAYS,DAYS", help="Ages at which every specimen is measured, days.")
    ] = "0",
    model: _ModelOption = None,
    parquet: Annotated[bool, typer.Option("--parquet", help="Parquet files instead of CSV.")] = False,
    set_: SetOption = None,
    calibration: CalibrationOption = None,
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
) -> None:
    """Simulate a measurement campaign: records with known truth, always labelled as simulated."""
    with reporting():
        from pneutouch.bench.simulate import SimulationTruth
        from pneutouch.mechanics.models.choice import USUAL
        from pneutouch.workflows.simulate import simulate
        from pneutouch.workflows.simulate_inputs import SimulationOptions

        options = SimulationOptions(
            resins=words(resins),
            specimens=specimens,
            runs=runs,
            kinds=words(kinds),
            rate=rate,
            seed=seed,
            model=model or USUAL,
            driving_pressures_kPa=None if pressures is None else numbers("--pressures", pressures),
            ages_days=numbers("--ages", ages),
            parquet=parquet,
            truth=SimulationTruth(rest=rest),
        )
        with bar("simulating specimens") as progress:
            folder = simulate(design, out, changes(set_, calibration), options, progress=progress)
        _report(folder, options, json=json)


def words(text: str) -> tuple[str, ...]:
    """Names with commas between."""
    return tuple(part.strip() for part in text.split(",") if part.strip())


def numbers(flag: str, text: str) -> tuple[float, ...]:
    """Numbers with commas between. Raises InputError."""
    from pneutouch.errors import InputError
    from pneutouch.spec.values import plain_number

    try:
        return tuple(map(plain_number, words(text)))
    except ValueError:
        raise InputError(f"{flag} {text}: must be numbers with commas between, such as 0,22") from None


def _report(folder: Path, options: SimulationOptions, *, json: bool) -> None:
    """The folder on stdout; on stderr where runs stop short of their depth."""
    from json import loads

    from pneutouch.workflows.simulate_inputs import KINDS

    truth = loads((folder / "truth.json").read_text(encoding="utf-8"))
    files = [name for name in loads((folder / "manifest.json").read_text(encoding="utf-8"))["files"] if "/" in name]
    for note in truth["notes"]:
        notify(f"note: {note}")
    if json:
        content = {"folder": str(folder), "simulated": True, "runs": len(files), "specimens": len(truth["specimens"])}
        print_json(content | {"seed": options.seed, "populations": truth["populations"], "notes": truth["notes"]})
        return
    of_kind = {run.rpartition("-")[0].rpartition("-")[2] for run in files}
    kinds = ", ".join(kind for kind in KINDS if kind in of_kind)
    runs, specimens = counted(len(files), "simulated run"), counted(len(truth["specimens"]), "specimen")
    notify(f"{runs} of {specimens} ({kinds})")
    echo(str(folder))
    report_next("characterize", folder)
