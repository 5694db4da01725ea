"""``pneutouch select``: the inverse."""

from pathlib import Path
from typing import Annotated, Any

import typer

from pneutouch.cli.app import DesignFolderOption, JsonOption, app, design_folder, print_json, reporting
from pneutouch.cli.declared import FieldOption, field_tables, with_fields
from pneutouch.errors import InputError
from pneutouch.spec.target import Target


def _percent(text: str) -> float:
    from pneutouch.mechanics.models import parse_tolerance

    return 100 * parse_tolerance(text)


def _pressures(text: str) -> list[float]:
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise InputError("write two driving pressures in kPa, such as 0,22", key="same_at", value=text) from None


_FIELDS = {
    "sensitivity": FieldOption("target", "sensitivity_kPa_per_N"),
    "tolerance": FieldOption("target", "tolerance_percent", _percent, "SHARE"),
    "at": FieldOption("target", "driving_pressure_kPa"),
    "force_range": FieldOption("target", "force_range_N"),
    "stiffness_least": FieldOption("target", "stiffness_least_N_per_mm"),
    "stiffness_most": FieldOption("target", "stiffness_most_N_per_mm"),
    "max_diameter": FieldOption("target", "max_diameter_mm"),
    "inner_radius": FieldOption("given", "inner_radius_mm"),
    "wall": FieldOption("given", "wall_thickness_mm"),
    "material": FieldOption("given", "materials"),
    "mix": FieldOption("given", "mix", metavar="SOFT+STIFF"),
    "graded": FieldOption("given", "graded"),
    "same_at": FieldOption("target", "same_sensitivity_at_kPa", _pressures, "KPA,KPA"),
    "same_within": FieldOption("target", "same_within_percent", _percent, "SHARE"),
    "widest_range": FieldOption("target", "widest_range"),
    "base": FieldOption("setting", "base"),
    "profile": FieldOption("setting", "profile"),
    "tube_length": FieldOption("setting", "tube_length_mm"),
    "dead_volume": FieldOption("setting", "dead_volume_mL"),
    "robustness": FieldOption("weights", "robustness"),
    "tunability": FieldOption("weights", "tunability"),
}


@app.command()
@with_fields(Target, _FIELDS)
def select(
    target: Annotated[
        Path | None, typer.Argument(metavar="TARGET", help="Target file (TOML); options override it.")
    ] = None,
    write: Annotated[
        str | None, typer.Option(metavar="NAME", help="Save the design picked as designs/NAME.toml.")
    ] = None,
    pick: Annotated[int, typer.Option(help="Rank of the design to save.")] = 1,
    charts: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Folder for the trade-off and tuning charts, SVG.")
    ] = None,
    out: DesignFolderOption = None,
    json: JsonOption = False,
    **fields: Any,
) -> None:
    """Find designs for a target; exit 1 where there is none."""
    with reporting():
        from pneutouch.output.new import check_name
        from pneutouch.workflows.select import document as shown
        from pneutouch.workflows.select.run import select as run

        folder = design_folder(out)
        if write is not None:
            check_name(write, folder)
        request, where = _target(target, fields), str(target or "select")
        if request.given.graded:
            _graded(request, where, write, folder, charts=charts is not None, pick=pick != 1, json=json)
            return
        selection = run(request, where)
        designs, choice, path = selection.answer.designs, None, None
        if designs:
            choice = shown.pick(selection, pick)
            path = shown.write_choice(selection, choice, write, folder) if write is not None else None
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


def _target(path: Path | None, fields: dict[str, Any]) -> Target:
    """The target of a file, options in place of its fields; or of options alone."""
    from pneutouch.spec.read import read_toml, validate

    content = {} if path is None else read_toml(path)
    for table, values in field_tables(_FIELDS, fields).items():
        section = content.setdefault(table, {})
        if not isinstance(section, dict):
            raise InputError("must be a table", file=path, key=table, value=section)
        section.update(values)
    if "target" not in content:
        raise InputError("no target", remedy="give a target file, or `sensitivity`, `force_range` or a stiffness")
    return validate(Target, content, "select" if path is None else str(path))
