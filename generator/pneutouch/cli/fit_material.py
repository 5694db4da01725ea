"""``pneutouch fit-material``: a laboratory's tensile or puck test to a material file.

A fitted material as text for people.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pneutouch.cli.app import JsonOption, OutOption, app, print_json, reporting
from pneutouch.cli.complete import names
from pneutouch.cli.progress import bar
from pneutouch.cli.terminal import echo, notify, report_next, table_text
from pneutouch.results.fit import MaterialFit
from pneutouch.results.record import plain

if TYPE_CHECKING:
    from pneutouch.bench.tensile.puck import PuckSize


_LengthOption = Annotated[
    float | None, typer.Option(metavar="MM", help="Of the tensile specimen.", show_default="as the file states")
]


@app.command("fit-material")
def fit_material(
    data: Annotated[
        list[Path],
        typer.Argument(
            metavar="DATA...", help="CSV of a tensile test, one file a specimen; with --puck of a puck test."
        ),
    ],
    name: Annotated[str, typer.Option("--name", metavar="NAME", help="Name of the material, as designs name it.")],
    like: Annotated[
        str | None,
        typer.Option(
            autocompletion=names("materials"), help="Known material whose density, hardness and casting are kept."
        ),
    ] = None,
    density: Annotated[float | None, typer.Option(metavar="G/CM3", help="Density of a material that is new.")] = None,
    shore_a: Annotated[str | None, typer.Option(metavar="N,N,...", help="Readings of the hardness, Shore A.")] = None,
    gauge_length: _LengthOption = None,
    width: _LengthOption = None,
    thickness: _LengthOption = None,
    puck: Annotated[
        str | None,
        typer.Option(metavar="DxT", help="A puck pressed between plates: diameter and thickness in mm, such as 20x6."),
    ] = None,
    bonded: Annotated[bool, typer.Option("--bonded", help="The puck's faces cannot slide on the plates.")] = False,
    stretch_to: Annotated[
        float | None, typer.Option(metavar="STRETCH", help="Fit up to there.", show_default="what a sensor reaches")
    ] = None,
    slack: Annotated[
        float | None, typer.Option(metavar="STRAIN", help="Strain before the specimen pulls.", show_default="found")
    ] = None,
    lab: Annotated[str | None, typer.Option(help="Who measured, for the sources.")] = None,
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
) -> None:
    """Fit a hyperelastic law to a tensile or puck test and write it as a material of your own."""
    with reporting():
        from pneutouch.bench.tensile.read import SpecimenSize
        from pneutouch.workflows.fit_material import fit_material as fit
        from pneutouch.workflows.fit_material import fit_report, write_material
        from pneutouch.workflows.fitted_material import FitOptions, MaterialFacts

        facts = MaterialFacts(like, density, _readings(shore_a), lab)
        size = SpecimenSize(gauge_length, width, thickness)
        options = FitOptions(tuple(data), name, size, _puck(puck, bonded), stretch_to, slack, facts)
        with bar("fitting laws"):
            fitted = fit(options)
            report = fit_report(fitted)
            folder = write_material(fitted, report, out)
        for note in report.notes:
            notify(f"note: {note}")
        if json:
            print_json(plain(replace(report, folder=str(folder))))
            return

        echo(fit_text(report))
        echo(f"\nwritten: {report.file}\n{folder}")
        _report_next(name, report.profile)


def _report_next(name: str, profile: str | None) -> None:
    """The prediction of a dome in the material, with the profile that makes it."""
    copied = "pneutouch new PROFILE --from silicone-casting, or from another of pneutouch list printers"
    first = "" if profile else f"add {name} to the resins of a profile of your own ({copied})"
    made = ("--set", f"print.profile={profile or 'PROFILE'}")
    report_next("predict", "paper-dome", "--set", f"membrane.material={name}", *made, first=first)


def _puck(text: str | None, bonded: bool) -> PuckSize | None:
    """The size of a puck. Raises InputError for a text that is no size."""
    from pneutouch.bench.tensile.puck import PuckSize
    from pneutouch.errors import InputError
    from pneutouch.spec.values import plain_number

    if text is None:
        if bonded:
            raise InputError("is of a puck", key="bonded", remedy="give `puck` too")
        return None
    parts = text.lower().replace("mm", "").split("x")
    try:
        diameter, thick = (plain_number(part) for part in parts)
    except ValueError:
        raise InputError("diameter and thickness in mm, such as 20x6", key="puck", value=text) from None
    return PuckSize(diameter, thick, bonded)


def _readings(text: str | None) -> tuple[float, ...]:
    """Readings of hardness. Raises InputError for a text that is no list of readings."""
    from pneutouch.errors import InputError
    from pneutouch.spec.values import plain_number

    try:
        readings = tuple(plain_number(part) for part in (text or "").split(",") if part.strip())
    except ValueError:
        readings = (-1.0,)
    if any(not 0 < reading < 100 for reading in readings):
        raise InputError("numbers from 0 to 100, separated by commas, such as 19,20,21", key="shore_a", value=text)
    return readings


def fit_text(report: MaterialFit) -> str:
    """The law, the modulus, and how far each law is off."""
    law = report.law
    rows = [
        [
            "->" if fit.label == law.label else "",
            fit.label,
            f"{fit.misfit_percent:.1f} %",
            ", ".join(
                f"{value:.4g} ± {error:.1g}" for value, error in zip(fit.constants, fit.uncertainties, strict=True)
            ),
            fit.refused or "",
        ]
        for fit in report.fits
    ]
    head = ["", "law", "misfit", "constants (MPa; Ogden: mu, alpha), k = 2", ""]
    specimens = [
        f"{one.data}: {one.points} points, slack {one.slack_percent:.2g} %, shear modulus "
        f"{one.shear_modulus_MPa:.4g} MPa"
        for one in report.specimens
    ]
    lines = [
        f"{report.material}: {law.label}, within {law.misfit_percent:.2g} % up to a stretch of "
        f"{report.largest_stretch:.3g}; shear modulus at small strain "
        f"{report.shear_modulus_small_strain_MPa:.4g} MPa",
        f"neo-Hookean over the same stretches: {report.shear_modulus_MPa:.4g} MPa",
        *specimens,
    ]
    return "\n\n".join(["\n".join(lines), table_text(head, rows)])
