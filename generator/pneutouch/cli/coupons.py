"""``pneutouch coupons``: test prints, and what a lab measured on them."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pneutouch.cli.app import JsonOption, app, print_answer, print_json
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.declared import words
from pneutouch.cli.terminal import bar, echo, report_next, table_text
from pneutouch.results.coupons import CouponReport


def coupon_names(incomplete: str) -> list[str]:
    """Completions of the last of several names of coupons with commas between."""
    from pneutouch.spec.coupon import COUPON_NAMES

    before, comma, word = incomplete.rpartition(",")
    return [f"{before}{comma}{name}" for name in COUPON_NAMES if name.startswith(word)]


if TYPE_CHECKING:
    from pneutouch.workflows.coupons.order import CouponOptions

parameter = parameters_of(__file__)


_CHOSEN = ("profile", "material", "design", "mixing", "only", "copies")


@app.command()
def coupons(
    profile: Annotated[str | None, parameter("profile")] = None,
    material: Annotated[list[str] | None, parameter("material")] = None,
    mixing: Annotated[list[str] | None, parameter("mixing")] = None,
    design: Annotated[str | None, parameter("design")] = None,
    only: Annotated[list[str] | None, parameter("only", autocompletion=coupon_names)] = None,
    copies: Annotated[list[str] | None, parameter("copies")] = None,
    results: Annotated[Path | None, parameter("results")] = None,
    out: Annotated[Path | None, parameter("out")] = None,
    json: JsonOption = False,
) -> None:
    """Make test prints to measure a printer and its resins, or enter what was measured."""
    given = {key: value for key, value in locals().items() if key in _CHOSEN and value}
    if results is not None:
        _enter(results, out, given, json)
        return
    from pneutouch.workflows.coupons.make import RESULTS, SHEET, build_coupons

    order = _options(given)
    with bar("making coupons"):
        made = build_coupons(order, out or Path("outputs"))
    if json:
        print_json(made)
    else:
        folder = Path(made.folder)
        echo(made.folder)
        by_hand = f"print and measure as {folder / SHEET} states, fill in {folder / RESULTS}"
        report_next("coupons", "--results", folder / RESULTS, first=by_hand)


def _enter(path: Path, out: Path | None, given: dict[str, Any], json: bool) -> None:
    """Write local profiles from a results file and report the changes. Raises InputError with any other option."""
    from pneutouch.errors import InputError

    if given:
        flags = ", ".join(f"--{key}" for key in given)
        raise InputError(f"--results {path}: {flags} cannot be given with it: the file holds the measurements")
    from pneutouch.workflows.coupons.results import enter_results

    report = enter_results(path, out)
    print_answer(report, results_text, json=json)


def _options(given: dict[str, Any]) -> "CouponOptions":
    """The order of coupons from the options given. Raises InputError for copies that are not a number."""
    from pneutouch.errors import InputError
    from pneutouch.workflows.coupons.order import CouponOptions

    copies = {}
    for word in words(given.get("copies", [])):
        name, equals, number = word.partition("=")
        if not equals or not number.strip().isdecimal():
            raise InputError(f"--copies {word}: write COUPON=N, such as puck=4")
        copies[name.strip()] = int(number)
    materials, only = words(given.get("material", [])), words(given.get("only", []))
    return CouponOptions(
        given.get("profile"), materials, given.get("design"), only, copies, words(given.get("mixing", []))
    )


def results_text(report: CouponReport) -> str:
    """The measured figures, the changes of each profile, the files written, and notes."""
    figures = [
        [
            f.about,
            f.name,
            f"{f.value:.4g}",
            "" if f.spread is None else f"± {f.spread:.2g}",
            "" if f.count is None else f"n = {f.count}",
        ]
        for f in report.figures
    ]
    changes = [[change.key, _shown(change.before), "->", _shown(change.after)] for change in report.changes]
    parts = [
        table_text([], figures),
        table_text([], changes),
        "\n".join(f"written: {path}" for path in report.written),
        "\n".join(f"note: {note}" for note in report.notes),
    ]
    return "\n\n".join(part for part in parts if part)


def _shown(quantity: Mapping[str, Any] | None) -> str:
    """A quantity as text: its value or its range, or the least size of a feature."""
    if quantity is None:
        return "not known"
    if "recommended" in quantity:
        return f"{quantity['least']:g}" if "least" in quantity else "not known"
    if "value" in quantity:
        return f"{quantity['value']:g}"
    return f"{quantity['low']:g} to {quantity['high']:g}"
