"""``pneutouch select``: the inverse problem, from a target to designs."""

import shlex
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pneutouch.cli.app import DesignFolderOption, ForceOption, JsonOption, SetOption, app, design_folder, print_json
from pneutouch.cli.complete import parameters_of, percent_of
from pneutouch.cli.declared import FieldOption, field_tables, named_by_flag, with_fields, words
from pneutouch.cli.pad_commands import select_a_pad
from pneutouch.cli.terminal import bar, echo, notify, report_next, report_written
from pneutouch.errors import InputError, RuleBrokenError
from pneutouch.results.selection import GradedRecord
from pneutouch.spec.target import Target
from pneutouch.spec.values import plain_numbers
from pneutouch.wording import data_of

if TYPE_CHECKING:
    from pneutouch.workflows.select.search import TargetAnswer

parameter = parameters_of(__file__)


def _pressures(text: str) -> list[float]:
    try:
        return plain_numbers(text)
    except ValueError:
        raise InputError("write two driving pressures in kPa, such as 0,22", key="same_at", value=text) from None


_PERCENT = "PERCENT"
"""Metavar of an option in per cent."""

_PARSERS: dict[str, Callable[[str], Any]] = {
    "tolerance": partial(percent_of, parameter="tolerance"),
    "same_at": _pressures,
    "same_within": partial(percent_of, parameter="same_within"),
    "process": lambda text: words([text]),
    "shape": lambda text: words([text]),
}

SELECT_FIELDS = {
    name: FieldOption(**field, parse=_PARSERS.get(name)) for name, field in data_of(__file__)["fields"].items()
}
"""The field of a target file that each option sets, by the option's parameter."""


def target_words(target: Target) -> list[str]:
    """The options that state the target, in the order of `SELECT_FIELDS`, then ``--set``."""
    words = []
    for name, option in SELECT_FIELDS.items():
        table = getattr(target, option.table)
        value = getattr(table, option.key)
        if option.key not in table.model_fields_set or value is None or value is False:
            continue
        flag = f"--{name.replace('_', '-')}"
        words += [flag] if value is True else [flag, _text(value, "%" if option.metavar == _PERCENT else "")]
    return [*words, *(word for text in target.setting.assignments for word in ("--set", text))]


def typed(field: str, value: Any) -> str:
    """The option, as it is typed, that gives the target's ``field``, ``table.key``, a value."""
    if field == "setting.assignments":
        return f"--set {shlex.quote(value)}"
    table, _, key = field.partition(".")
    name, option = next((n, one) for n, one in SELECT_FIELDS.items() if (one.table, one.key) == (table, key))
    return f"--{name.replace('_', '-')} {shlex.quote(_text(value, '%' if option.metavar == _PERCENT else ''))}"


def saving_command(target: Target, rank: int, name: str) -> str:
    """The command that saves the design of a rank under a name, as it is typed in a shell."""
    picked = [] if rank == 1 else ["--pick", str(rank)]
    return shlex.join(["pneutouch", "select", *target_words(target), *picked, "--write", name])


def _text(value: Any, unit: str) -> str:
    if isinstance(value, list):
        return ",".join(_text(each, unit) for each in value)
    return value if isinstance(value, str) else f"{value:.12g}{unit}"


_FLAGS_ALONE = "select"
"""Name that errors show in place of the target's file if none is given."""


@app.command()
@with_fields(Target, SELECT_FIELDS)
def select(
    context: typer.Context,
    target: Annotated[Path | None, parameter("target")] = None,
    have: Annotated[Path | None, parameter("have")] = None,
    pad: Annotated[str | None, parameter("pad")] = None,
    force_error: Annotated[float | None, parameter("force_error")] = None,
    place_error: Annotated[float | None, parameter("place_error")] = None,
    gauges: Annotated[int | None, parameter("gauges")] = None,
    ball: Annotated[float | None, parameter("ball")] = None,
    set_: SetOption = None,
    write: Annotated[str | None, parameter("write")] = None,
    pick: Annotated[int, parameter("pick")] = 1,
    overwrite: ForceOption = False,
    charts: Annotated[Path | None, parameter("charts")] = None,
    out: DesignFolderOption = None,
    json: JsonOption = False,
    **fields: Any,
) -> None:
    """Find designs for a target; exit 1 if there is none."""
    wanted = {"force_error": force_error, "place_error": place_error, "gauges": gauges, "ball": ball}
    if pad is not None:
        select_a_pad(context, pad, wanted, fields["gauge"], fields["max_height"], charts)
        return
    for key, value in wanted.items():
        if value is not None:
            raise InputError("is of a pad", key=key, value=value, remedy="give `pad` too, such as 30x20")
    where = str(target or _FLAGS_ALONE)
    stated = {name: SELECT_FIELDS[name] for name, value in fields.items() if value is not None}
    given = {f"{option.table}.{option.key}": name for name, option in stated.items()}
    with named_by_flag(given, where, alone=target is None):
        from pneutouch.output.files import check_writable
        from pneutouch.output.new import check_free
        from pneutouch.workflows.select.graded import GradedSelectionRun
        from pneutouch.workflows.select.search import search
        from pneutouch.workflows.select.select import SelectionRun

        folder = design_folder(out)
        if write is not None:
            check_free(write, folder, overwrite=overwrite)
        request = _target(target, fields, set_ or [], have)
        _refuse(request, charts=charts is not None, pick=pick != 1)
        if charts is not None:
            from pneutouch.workflows.select.charts import check_charts, write_charts

            check_writable(charts / "chart", key="charts")
            check_charts(charts)
        begun = time.perf_counter()
        with bar("") as report:
            answer = search(request, where, written=None if write is None else pick, progress=report)
        if isinstance(answer.run, GradedSelectionRun):
            notify(f"{answer.run.solves} solid solves in {time.perf_counter() - begun:.0f} s")
        choice = answer.pick(pick) if answer.choices else None
        path = None if choice is None or write is None else choice.write(write, folder, overwrite=overwrite)
        if charts is not None and isinstance(answer.run, SelectionRun):
            write_charts(answer.run, charts, answer.run.answer.designs[pick - 1] if choice else None)
        _report(answer, path, json=json)


def _refuse(target: Target, **given: bool) -> None:
    """Raise InputError for a flag that does not go with the kind of the target."""
    if target.setting.processes is not None and given["charts"]:
        raise InputError("--charts cannot be given with --process", remedy="draw them for one `profile`")
    refused = [f"--{flag}" for flag, is_given in given.items() if is_given]
    if target.setting.processes is None and target.given.graded and refused:
        raise InputError(f"{', '.join(refused)} cannot be given with --graded")


def _report(answer: "TargetAnswer", path: Path | None, *, json: bool) -> None:
    """Show the answer, and where the design picked was saved. Exits 1 if no design meets the target."""
    if json:
        print_json(answer.record, written=None if path is None else str(path))
    else:
        from pneutouch.cli.select_text import answer_text

        echo(answer_text(answer, typed))
        if path is not None:
            report_written(path)
        elif answer.choices and not isinstance(answer.record, GradedRecord):
            from pneutouch.output.new import free_name

            report_next(*sys.argv[1:], "--write", free_name())
    if answer.rejected is not None:
        raise RuleBrokenError(f"the grade meets the target and is rejected by `check`: {answer.rejected}")
    if not answer.choices:
        raise typer.Exit(1)


def _target(path: Path | None, fields: dict[str, Any], set_: list[str], have: Path | None) -> Target:
    """The target of a file, with options in place of its fields; or of options only. Raises InputError."""
    from pneutouch.catalogue.library import read_given
    from pneutouch.spec.files import design_inside
    from pneutouch.spec.read import validate
    from pneutouch.workflows.select.base import read_shelf

    content = {} if path is None else read_given(path, "give the path of a target file; a design is given as `base`")
    setting = content.get("setting")
    if path is not None and isinstance(setting, dict) and isinstance(setting.get("base"), str):
        setting["base"] = design_inside(path.parent, setting["base"], file=path, key="setting.base")
    for table, values in field_tables(SELECT_FIELDS, fields).items():
        section = content.setdefault(table, {})
        if not isinstance(section, dict):
            raise InputError("must be a table", file=path, key=table, value=section)
        section.update(values)
    if have is not None:
        content["have"] = read_shelf(have)
    if "target" not in content and content.keys() <= Target.model_fields.keys():
        what = "a target file" if path is None else "the file a table [target]"
        raise InputError("no target", file=path, remedy=f"give {what}, or `sensitivity`, `force_range` or a stiffness")
    target = validate(Target, content, _FLAGS_ALONE if path is None else str(path))
    if not set_:
        return target
    # What is set last holds: the options come after the file's own changes.
    changed = target.setting.model_copy(update={"assignments": [*target.setting.assignments, *set_]})
    return target.model_copy(update={"setting": changed})
