"""``pneutouch sweep``: many designs to one dataset."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pneutouch.cli.app import CalibrationOption, JsonOption, SetOption, app, changes, print_json
from pneutouch.cli.complete import assignment, parameters_of
from pneutouch.cli.terminal import bar, echo, notify, report_next, table_text
from pneutouch.errors import InputError
from pneutouch.results.record import SENSITIVITY_KEY, STIFFNESS_KEY
from pneutouch.wording import tenths_below

if TYPE_CHECKING:
    from pneutouch.workflows.sweep import SweepPlan, SweepResult

parameter = parameters_of(__file__)


@app.command()
def sweep(
    file: Annotated[Path | None, parameter("file")] = None,
    design: Annotated[str | None, parameter("design")] = None,
    over: Annotated[list[str] | None, parameter("over", autocompletion=assignment)] = None,
    set_: SetOption = None,
    calibration: CalibrationOption = None,
    model: Annotated[str | None, parameter("model")] = None,
    closure: Annotated[str | None, parameter("closure")] = None,
    clamp: Annotated[str | None, parameter("clamp")] = None,
    out: Annotated[Path | None, parameter("out")] = None,
    workers: Annotated[int | None, parameter("workers")] = None,
    scheduler: Annotated[str | None, parameter("scheduler")] = None,
    fresh: Annotated[bool, parameter("fresh")] = False,
    yes: Annotated[bool, parameter("yes")] = False,
    charts: Annotated[Path | None, parameter("charts")] = None,
    json: JsonOption = False,
) -> None:
    """Predict a grid or a list of designs into one dataset (netCDF)."""
    from pneutouch.workflows.sweep import sweep as run
    from pneutouch.workflows.sweep.dataset import stored_dataset, write_companions, write_maps
    from pneutouch.workflows.sweep.execute import ComputeResources
    from pneutouch.workflows.sweep.grid import is_dense

    plan = _plan(
        file, design, over or [], changes(set_, calibration), {"model": model, "closure": closure, "clamp": clamp}
    )
    target = _free_place(plan, out, charts)
    with bar("computing points") as progress:
        machines = ComputeResources(workers, scheduler)
        done = run(plan, target, machines, fresh=fresh, yes=yes, progress=progress)
    with bar("drawing the sensitivity"):
        filled = _FILLED & {key.replace(".", "_") for key in plan.varied}
        a_point = sum(done.states.values()) // done.points if filled else 1
        rows, written = write_companions(done.path, _MOST * a_point)
        maps = [] if charts is None else write_maps(stored_dataset(done.path), charts)
    _report(done, rows, written, maps, json=json)
    if charts is None and not json and sum(is_dense(axis.values) for axis in plan.axes) > 1:
        words = [word for word in sys.argv[1:] if word != "--fresh"]
        report_next(*words, "--charts", done.path.with_name(f"{done.path.stem}-maps"))


def _plan(
    file: Path | None, design: str | None, over: list[str], changed: dict[str, Any], options: dict[str, str | None]
) -> "SweepPlan":
    from pneutouch.workflows.sweep import plan_of_file, plan_of_flags

    if file is not None and over and design is None and file.suffix != ".toml":
        file, design = None, str(file)
    if file is not None and (design is not None or over):
        problem = f"a sweep file and {'--over' if over else '--design'}: give one or the other"
        remedy = f"a design to vary is given by --design {file}" if design is None else None
        raise InputError(problem, file=file, remedy=remedy)
    if file is not None:
        return plan_of_file(file, changed, **options)
    if design is None or not over:
        raise InputError("give a sweep file, or --design NAME with --over TABLE.KEY=VALUES")
    return plan_of_flags(design, over, changed, **options)


def _free_place(plan: "SweepPlan", out: Path | None, charts: Path | None) -> Path:
    """The file of the dataset. Raises InputError if anything required cannot be drawn or written."""
    from pneutouch.output.files import check_writable
    from pneutouch.workflows.sweep.dataset import check_companions
    from pneutouch.workflows.sweep.grid import check_dense

    target = Path("outputs") / f"{plan.name}.nc" if out is None else out
    check_companions(target, plan)
    if charts is not None:
        check_dense({axis.key: axis.values for axis in plan.axes})
        check_writable(charts / "chart", key="charts")
    return target


def _report(
    done: "SweepResult", rows: list[dict[str, Any]], written: list[Path], maps: list[Path], *, json: bool
) -> None:
    """Print the table, and last the dataset's path, on stdout; the states by outcome and other files on stderr."""
    if json:
        print_json(
            {
                "dataset": str(done.path),
                "points": done.points,
                "computed": done.computed,
                "states": done.states,
                "input_hash": done.input_hash,
                "table": str(written[0]),
                "pictures": [str(path) for path in written[1:]],
                "maps": [str(path) for path in maps],
            }
        )
        return
    counts = ", ".join(f"{count} {status}" for status, count in done.states.items())
    there = "; was there already, --fresh computes it again" if done.computed == 0 else ""

    echo(sweep_text(rows, sum(done.states.values()), written[0]))
    notify(f"{done.points} points, states: {counts}{there}")
    for path in [*written, *maps]:
        notify(f"written: {path}")
    echo(f"\n{done.path}")


_MOST = 24
"""Number of rows that are printed: as many as a screen shows."""

_FIGURES = {
    SENSITIVITY_KEY: ("S kPa/N", 3),
    STIFFNESS_KEY: ("N/mm", 3),
    "force_range_high_N": ("N at the end", 2),
    "range_end_mm": ("range mm", 2),
    "limit_point_kPa": ("limit kPa", 1),
    "rated_pressure_kPa": ("rated kPa", 1),
}
"""Columns with their decimals, as `predict` shows the same figures."""

_FILLED = {"pneumatics_injected_volumes_mL", "pneumatics_apex_heights_mm"}
_OF_FILLED = [name for name in _FIGURES if name != "force_range_high_N"]
"""Swept fields that give states by filling, and the figures known of these states."""


def sweep_text(rows: list[dict[str, Any]], count: int, table: Path) -> str:
    """Swept fields, figures and status of the first rows of ``count``; of more also the file that holds them all."""
    if not rows:
        return "no state"
    names = list(rows[0])
    swept = names[: names.index("driving_pressure_kPa")]
    if _FILLED & {*swept}:
        head = [*swept, "kPa", *(_FIGURES[name][0] for name in _OF_FILLED), "status"]
        # Every driving pressure of a point repeats its state by filling.
        text = table_text(head, list(dict.fromkeys(_filled_cells(row, swept) for row in rows)))
    else:
        others = (name for name, _ in list(_FIGURES.values())[1:])
        head = [*swept, "kPa", "S kPa/N", "interval (k = 2)", *others, "status"]
        text = table_text(head, [_cells(row, swept) for row in rows])
    left = count - len(rows)
    return f"{text}\n... and {left} more: {table}" if left else text


def _cells(row: dict[str, Any], swept: list[str]) -> list[str]:
    low, high = row["sensitivity_low_kPa_per_N"], row["sensitivity_high_kPa_per_N"]
    sensitivity, *others = (_figure(name, row[name]) for name in _FIGURES)
    interval = "-" if low is None else f"{low:.2f} to {high:.2f}"
    fields = [_field(row[name]) for name in (*swept, "driving_pressure_kPa")]
    return [*fields, sensitivity, interval, *others, row["status"]]


def _filled_cells(row: dict[str, Any], swept: list[str]) -> tuple[str, ...]:
    """Cells of the state by injected gas or apex height."""
    figures = (_figure(name, row.get(f"filled_{name}", row[name])) for name in _OF_FILLED)
    pressure_kPa = row["filled_driving_pressure_kPa"]
    pressure = "-" if pressure_kPa is None else f"{pressure_kPa:.3f}"
    return (*(_field(row[name]) for name in swept), pressure, *figures, row["status"])


def _figure(name: str, value: float | None) -> str:
    """A figure with its decimals; a rated pressure is rounded down, so that the shown one is never above it."""
    if value is None:
        return "-"
    return f"{tenths_below(value) if name == 'rated_pressure_kPa' else value:.{_FIGURES[name][1]}f}"


def _field(value: Any) -> str:
    return "-" if value is None else f"{value:g}" if isinstance(value, float) else str(value)
