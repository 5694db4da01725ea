"""``pneutouch select``: the inverse."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pneutouch.cli.app import (
    DesignFolderOption,
    ForceOption,
    JsonOption,
    SetOption,
    app,
    design_folder,
    print_json,
    reporting,
)
from pneutouch.cli.declared import field_tables, named_by_flag, with_fields
from pneutouch.cli.next_step import DesignPlace, report_next, report_written
from pneutouch.cli.progress import bar
from pneutouch.cli.select_fields import SELECT_FIELDS
from pneutouch.cli.select_processes import select_over
from pneutouch.cli.terminal import echo
from pneutouch.errors import InputError
from pneutouch.spec.target import Target

if TYPE_CHECKING:
    from pneutouch.workflows.select.run import SelectionRun

_FLAGS_ALONE = "select"
"""Stands for the target's file if none is given."""


@app.command()
@with_fields(Target, SELECT_FIELDS)
def select(
    target: Annotated[
        Path | None, typer.Argument(metavar="TARGET", help="Target file (TOML); options override it.")
    ] = None,
    set_: SetOption = None,
    write: Annotated[
        str | None, typer.Option(metavar="NAME", help="Save the design picked as designs/NAME.toml.")
    ] = None,
    pick: Annotated[int, typer.Option(help="Rank of the design to save; its row with --process.")] = 1,
    overwrite: ForceOption = False,
    charts: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Folder for the trade-off and tuning charts, SVG.")
    ] = None,
    out: DesignFolderOption = None,
    json: JsonOption = False,
    **fields: Any,
) -> None:
    """Find designs for a target; exit 1 if there is none."""
    where = str(target or _FLAGS_ALONE)
    stated = {name: SELECT_FIELDS[name] for name, value in fields.items() if value is not None}
    given = {f"{option.table}.{option.key}": name for name, option in stated.items()}
    with reporting(), named_by_flag(given, where, alone=target is None):
        from pneutouch.output.files import check_writable
        from pneutouch.output.new import check_free

        folder = design_folder(out)
        if write is not None:
            check_free(write, folder, overwrite=overwrite)
        request = _target(target, fields, set_ or [])
        place = None if write is None else DesignPlace(write, folder, overwrite)
        if request.setting.processes is not None:
            select_over(request, where, place, pick, json=json, charts=charts is not None)
            return
        if request.given.graded:
            _graded(request, where, place, charts=charts is not None, pick=pick != 1, json=json)
            return
        if charts is not None:
            check_writable(charts / "chart", key="charts")
        selection = _run(request, where, None if write is None else pick)
        _report(selection, pick, place, charts, json=json)


def _run(request: Target, where: str, written: int | None) -> SelectionRun:
    """The selection, with a bar over its steps on a terminal."""
    from pneutouch.workflows.select.gauged import select as run
    from pneutouch.workflows.select.run import STEPS

    with bar("") as report:
        return run(request, where, written=written, progress=lambda step: report(STEPS.index(step), len(STEPS), step))


def _report(selection: SelectionRun, pick: int, place: DesignPlace | None, charts: Path | None, *, json: bool) -> None:
    """Save the chosen design and show the designs. Exits 1 if there are none."""
    from pneutouch.workflows.select import document as shown

    designs, choice, path = selection.answer.designs, None, None
    if designs:
        choice = shown.pick(selection, pick)
        path = None if place is None else shown.write_choice(selection, choice, *place[:2], overwrite=place.overwrite)
    if charts is not None:
        from pneutouch.workflows.select.charts import write_charts

        write_charts(selection, charts, choice)
    if json:
        print_json({**shown.document(selection), "written": None if path is None else str(path)})
    else:
        from pneutouch.cli.select_text import selection_text

        echo(selection_text(selection))
        if path is not None:
            report_written(path)
        elif designs:
            from pneutouch.output.new import free_name

            report_next(*sys.argv[1:], "--write", free_name())
    if not designs:
        raise typer.Exit(1)


def _graded(target: Target, where: str, place: DesignPlace | None, *, json: bool, **others: bool) -> None:
    """The search for a grade; ``others`` are flags that do not go with it and whether they were given."""
    from pneutouch.cli.graded import select_graded

    select_graded(target, where, place, json=json, refused=[flag for flag, given in others.items() if given])


def _target(path: Path | None, fields: dict[str, Any], set_: list[str]) -> Target:
    """The target of a file, options in place of its fields; or of options alone."""
    from pneutouch.catalogue.examples import read_given
    from pneutouch.spec.files import design_inside
    from pneutouch.spec.read import validate

    content = {} if path is None else read_given(path, "give the path of a target file; a design is given as `base`")
    setting = content.get("setting")
    if path is not None and isinstance(setting, dict) and isinstance(setting.get("base"), str):
        setting["base"] = design_inside(path.parent, setting["base"], file=path, key="setting.base")
    tables = field_tables(SELECT_FIELDS, fields)
    for table, values in tables.items():
        section = content.setdefault(table, {})
        if not isinstance(section, dict):
            raise InputError("must be a table", file=path, key=table, value=section)
        section.update(values)
    if "target" not in content and content.keys() <= Target.model_fields.keys():
        what = "a target file" if path is None else "the file a table [target]"
        raise InputError("no target", file=path, remedy=f"give {what}, or `sensitivity`, `force_range` or a stiffness")
    target = validate(Target, content, _FLAGS_ALONE if path is None else str(path))
    if not set_:
        return target
    # What is set last holds: the options come after the file's own changes.
    changed = target.setting.model_copy(update={"assignments": [*target.setting.assignments, *set_]})
    return target.model_copy(update={"setting": changed})
