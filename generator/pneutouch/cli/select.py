"""``pneutouch select``: the inverse."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pneutouch.cli.app import JsonOption, app, print_json, reporting

if TYPE_CHECKING:
    from pneutouch.spec.target import Target

_FLAGS = {
    "sensitivity": ("target", "sensitivity_kPa_per_N"), "tolerance": ("target", "tolerance_percent"),
    "at": ("target", "driving_pressure_kPa"), "force_range": ("target", "force_range_N"),
    "stiffness_least": ("target", "stiffness_least_N_per_mm"), "stiffness_most": ("target", "stiffness_most_N_per_mm"),
    "max_diameter": ("target", "max_diameter_mm"), "inner_radius": ("given", "inner_radius_mm"),
    "wall": ("given", "wall_thickness_mm"), "material": ("given", "materials"), "mix": ("given", "mix"),
    "graded": ("given", "graded"), "same_at": ("target", "same_sensitivity_at_kPa"),
    "same_within": ("target", "same_within_percent"), "widest_range": ("target", "widest_range"), "base": ("setting", "base"),
    "profile": ("setting", "profile"), "tube_length": ("setting", "tube_length_mm"),
    "dead_volume": ("setting", "dead_volume_mL"), "robustness": ("weights", "robustness"),
    "tunability": ("weights", "tunability"),
}  # fmt: skip


@app.command()
def select(
    target: Annotated[Path | None, typer.Argument(metavar="TARGET", help="Target file (TOML); flags override it.")] = None,
    sensitivity: Annotated[float | None, typer.Option(help="Wanted sensitivity, kPa/N.")] = None,
    tolerance: Annotated[str | None, typer.Option(help="How far the sensitivity may be off, such as 5%.")] = None,
    at: Annotated[float | None, typer.Option(help="Driving pressure at which it holds, kPa; left out: free.")] = None,
    force_range: Annotated[float | None, typer.Option(help="Contact force that the range must reach, N.")] = None,
    stiffness_least: Annotated[float | None, typer.Option(help="Least mean stiffness, N/mm.")] = None,
    stiffness_most: Annotated[float | None, typer.Option(help="Greatest mean stiffness, N/mm.")] = None,
    max_diameter: Annotated[float | None, typer.Option(help="Greatest outer diameter of the dome, mm.")] = None,
    inner_radius: Annotated[float | None, typer.Option(help="Inner radius, mm, where it is settled.")] = None,
    wall: Annotated[float | None, typer.Option(help="Wall thickness, mm, where it is settled.")] = None,
    material: Annotated[list[str] | None, typer.Option(help="Resin to choose from; may be repeated.")] = None,
    mix: Annotated[str | None, typer.Option(metavar="SOFT+STIFF", help="Two base resins to mix: any fraction may be chosen.")] = None,
    graded: Annotated[bool | None, typer.Option("--graded", help="Let the mix differ between pole and rim; the solid searches.")] = None,
    same_at: Annotated[str | None, typer.Option(metavar="KPA,KPA", help="Two driving pressures with the same sensitivity; with --graded.")] = None,
    same_within: Annotated[str | None, typer.Option(help="How far the two may differ, such as 2%.")] = None,
    widest_range: Annotated[bool | None, typer.Option("--widest-range", help="As wide a force range as a grade gives.")] = None,
    base: Annotated[str | None, typer.Option(help="Design that gives everything else; left out: the defaults.")] = None,
    profile: Annotated[str | None, typer.Option(help="Printer of the membrane.")] = None,
    tube_length: Annotated[float | None, typer.Option(help="Tube to the pressure sensor, mm.")] = None,
    dead_volume: Annotated[float | None, typer.Option(help="Gas volume behind the cavity, mL; left out: computed.")] = None,
    robustness: Annotated[float | None, typer.Option(help="Weight on a small uncertainty.")] = None,
    tunability: Annotated[float | None, typer.Option(help="Weight on a sensitivity that moves with the pressure.")] = None,
    write: Annotated[str | None, typer.Option(metavar="NAME", help="Save the design picked as designs/NAME.toml.")] = None,
    pick: Annotated[int, typer.Option(help="Rank of the design to save.")] = 1,
    charts: Annotated[Path | None, typer.Option(metavar="DIR", help="Folder for the trade-off and tuning charts, SVG.")] = None,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the design file.")] = Path("designs"),
    json: JsonOption = False,
) -> None:  # fmt: skip
    """Find designs for a target; exit 1 where there is none."""
    values = {key: value for key, value in locals().items() if key in _FLAGS and value is not None}
    with reporting():
        from pneutouch.output.new import check_name
        from pneutouch.workflows.select import document as shown
        from pneutouch.workflows.select.run import select as run

        if write is not None:
            check_name(write, out)
        wanted, where = _target(target, values), str(target or "select")
        if wanted.given.graded:
            _graded(wanted, where, write, out, charts=charts is not None, pick=pick != 1, json=json)
            return
        selection = run(wanted, where)
        designs, choice, path = selection.answer.designs, None, None
        if designs:
            choice = shown.pick(selection, pick)
            path = shown.write_choice(selection, choice, write, out) if write is not None else None
        if charts is not None:
            from pneutouch.workflows.select.charts import write_charts

            write_charts(selection, charts, choice)
        if json:
            print_json({**shown.document(selection), "written": None if path is None else str(path)})
        else:
            from pneutouch.cli.select_text import selection_text

            typer.echo(selection_text(selection))
            if path is not None:
                typer.echo(f"\nwritten: {path}")
        if not designs:
            raise typer.Exit(1)


def _graded(target: Target, where: str, write: str | None, out: Path, *, json: bool, **others: bool) -> None:
    """The search for a grade; ``others`` are flags that do not go with it and whether they were given."""
    from pneutouch.cli.graded import select_graded

    select_graded(target, where, write, out, json=json, refused=[flag for flag, given in others.items() if given])


def _target(path: Path | None, values: dict[str, Any]) -> Target:
    """The target of a file, flags laid over it; or of flags alone."""
    from pneutouch.errors import InputError
    from pneutouch.mechanics.models import parse_tolerance
    from pneutouch.spec.read import read_toml, validate
    from pneutouch.spec.target import Target

    content = {} if path is None else read_toml(path)
    if "tolerance" in values:
        values["tolerance"] = 100 * parse_tolerance(values["tolerance"])
    if "same_within" in values:
        values["same_within"] = 100 * parse_tolerance(values["same_within"])
    if "same_at" in values:
        values["same_at"] = _pressures(values["same_at"])
    for flag, value in values.items():
        table, key = _FLAGS[flag]
        section = content.setdefault(table, {})
        if not isinstance(section, dict):
            raise InputError(f"{path}: {table} = {section!r}: must be a table")
        section[key] = value
    if "target" not in content:
        raise InputError("say what the sensor shall do: a target file, or --sensitivity, --force-range or a stiffness")
    return validate(Target, content, "select" if path is None else str(path))


def _pressures(text: str) -> list[float]:
    """Two driving pressures, kPa. Raises InputError."""
    from pneutouch.errors import InputError

    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise InputError(f"--same-at {text}: write two driving pressures in kPa, such as 0,22") from None
