"""``pneutouch fit-material``: tests of a laboratory made into a material file."""

from pathlib import Path
from typing import Annotated, Any

from pneutouch.cli.app import JsonOption, OutOption, app, print_json
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.declared import given, with_options
from pneutouch.cli.terminal import bar, echo, filled_text, notify, report_next, table_text
from pneutouch.results.fit import MaterialFit
from pneutouch.spec.options import FitOptions

parameter = parameters_of(__file__)


@app.command("fit-material")
@with_options(FitOptions)
def fit_material(
    data: Annotated[list[Path], parameter("data")],
    out: OutOption = Path("outputs"),
    json: JsonOption = False,
    **options: Any,
) -> None:
    """Fit a hyperelastic law to your own tests and write it as a material of your own."""
    from pneutouch.workflows.fit_material import fit_material as fit
    from pneutouch.workflows.fit_material import fit_report, write_material

    asked = given(FitOptions, options)
    with bar("fitting laws"):
        fitted = fit(data, asked)
        report = fit_report(fitted)
        folder = write_material(fitted, report, out)
    for note in report.notes:
        notify(f"note: {note}")
    if json:
        print_json(report, folder=str(folder))
        return

    echo(fit_text(report))
    echo(f"\nwritten: {report.file}\n{folder}")
    _report_next(asked.name, report.profile)


def _report_next(name: str, profile: str | None) -> None:
    """Report the next command: predict a dome of the material, with the profile that makes it."""
    copied = "pneutouch new PROFILE --from silicone-casting, or from another of pneutouch list printers"
    first = "" if profile else f"add {name} to the resins of a profile of your own ({copied})"
    made = ("--set", f"print.profile={profile or 'PROFILE'}")
    report_next("predict", "paper-dome", "--set", f"membrane.material={name}", *made, first=first)


def fit_text(report: MaterialFit) -> str:
    """The law, the modulus, and the misfit of each law."""
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
    return filled_text("fit.txt.j2", report=report, table=table_text(head, rows))
