"""Pads in the commands of one sensor: plan, simulate, characterize, calibrate and export-reader."""

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from pneutouch.cli.app import changes, print_answer
from pneutouch.cli.terminal import bar, echo, filled_text, notify, report_next, set_words, table_text
from pneutouch.errors import InputError
from pneutouch.spec.values import plain_number

if TYPE_CHECKING:
    from pneutouch.workflows.live.sensor import LiveSensor
    from pneutouch.workflows.pad.select_pads import PadTarget, PadTrial
    from pneutouch.workflows.pad.touch import Tabulate

_WANTED = {"force_error": 10.0, "place_error": 1.0, "gauges": 12, "ball": 8.0}
"""Errors, gauges and ball of a pad that is selected, where they are not given: our choice."""
_SIZES = ("inner_radius", "wall_thickness")


def is_pad(design: str) -> bool:
    """True if a pad has this name or path."""
    from pneutouch.catalogue import Library

    return Library.default().pad_file(design) is not None


def is_planned(folder: str) -> bool:
    """True for the folder of a pad's plan or campaign."""
    from pneutouch.workflows.pad.measured import is_pad_campaign

    return is_pad_campaign(Path(folder))


def plan_a_pad(context: typer.Context, name: str, set_: list[str] | None, out: Path) -> None:
    """Plan presses of a ball over a pad."""
    from pneutouch.workflows.pad.campaign import plan_pad, write_pad_plan
    from pneutouch.workflows.pad.load import load_pad

    _refuse_others(context, name, "design", "set_", "out")
    pad = load_pad(name, changes(set_))
    with _tabulating() as made_by:
        folder = write_pad_plan(plan_pad(pad, made_by), out, changes(set_))
    echo(str(folder))
    report_next("simulate", folder)


def simulate_a_pad(context: typer.Context, name: str, set_: list[str] | None, out: Path, seed: int) -> None:
    """Simulate recordings of a pad, given by its name or by the folder of its plan."""
    from pneutouch.spec.pad import PAD_CAMPAIGN, PadCampaign
    from pneutouch.spec.read import parse_changes, read_toml, validate
    from pneutouch.workflows.pad.campaign import plan_pad, simulate_pad
    from pneutouch.workflows.pad.load import load_pad

    _refuse_others(context, name, "design", "set_", "out", "seed")
    given = changes(set_)
    if is_planned(name):
        campaign: PadCampaign = validate(PadCampaign, read_toml(Path(name) / PAD_CAMPAIGN), f"{name}/{PAD_CAMPAIGN}")
        name, given = campaign.pad, parse_changes(campaign.assignments) | given
    pad = load_pad(name, given)
    with _tabulating("simulating presses") as made_by:
        folder = simulate_pad(plan_pad(pad, made_by), out, seed, given)
    echo(str(folder))
    report_next("characterize", folder)


def characterize_a_pad(context: typer.Context, data: Path, out: Path, *, json: bool) -> None:
    """Set the readings of a pad beside its prediction."""
    from pneutouch.workflows.pad.measured import fitted, read_campaign
    from pneutouch.workflows.pad.measured_files import write_figures

    _refuse_others(context, str(data), "data", "out", "json")
    with _tabulating("fitting the readings") as made_by:
        measured = read_campaign(data, made_by)
        record, folder = write_figures(measured, fitted(measured), out)
    print_answer(record, lambda one: filled_text("pad.txt.j2", record=one), folder, json=json)
    if not json:
        report_next("calibrate", data)


def calibrate_a_pad(context: typer.Context, data: Path, out: Path, save: str | None, *, replace: bool) -> None:
    """Fit a pad's prediction to its readings and save that among the user's calibrations of pads."""
    from pneutouch.workflows.pad.measured import calibration_of, fitted, read_campaign
    from pneutouch.workflows.pad.measured_files import save_calibration, write_figures

    _refuse_others(context, str(data), "data", "out", "save", "replace")
    with _tabulating("fitting the readings") as made_by:
        measured = read_campaign(data, made_by)
        fit = fitted(measured)
        record, folder = write_figures(measured, fit, out)
        path = save_calibration(calibration_of(measured, fit), save or measured.pad.name, replace=replace)
    echo(f"{filled_text('pad.txt.j2', record=record)}\n\n{folder}\n{path}")
    given = set_words(measured.campaign.assignments)
    report_next("export-reader", measured.campaign.pad, "--calibration", path.stem, *given)


def export_a_pad(
    context: typer.Context, name: str, set_: list[str] | None, calibration: str | None, simulator: str | None, out: Path
) -> None:
    """Write the reader of a pad, or its model for a simulator."""
    from pneutouch.workflows.pad.export import write_pad_reader, write_pad_simulator
    from pneutouch.workflows.pad.load import load_pad

    _refuse_others(context, name, "design", "set_", "calibration", "simulator", "out")
    pad = load_pad(name, changes(set_))
    with _tabulating() as made_by:
        if simulator is None:
            folder = write_pad_reader(pad, calibration, out, made_by)
        else:
            folder = write_pad_simulator(pad, calibration, simulator, out, made_by)
    echo(str(folder))
    files = " and ".join(sorted(path.name for path in folder.glob("*_reader.*")))
    notify(f"how to use it: {f'the examples at the head of {files}' if files else folder / 'README.md'}")


def live_of_pad(name: str, set_: list[str] | None, calibration: str | None) -> "LiveSensor":
    """A pad to be read live."""
    from pneutouch.workflows.live.live_pad import live_pad
    from pneutouch.workflows.pad.export import pad_tables
    from pneutouch.workflows.pad.load import load_pad

    pad = load_pad(name, changes(set_))
    with _tabulating() as made_by:
        return live_pad(pad.name, *pad_tables(pad, calibration, made_by))


def select_a_pad(
    context: typer.Context,
    area: str,
    wanted: Mapping[str, float | None],
    gauge: str | None,
    height: float | None,
    charts: Path | None,
) -> None:
    """Find the pad with the fewest cells that reads force and place as well as wanted; exit 1 if there is none."""
    from pneutouch.workflows.pad.select_pads import PadTarget, select_pads, write_pad_chart

    _refuse_others(context, f"--pad {area}", *_WANTED, "pad", "gauge", "max_height", "charts")
    try:
        width, depth = (plain_number(text) for text in area.lower().split("x"))
    except ValueError:
        raise InputError("write width and depth in mm", key="pad", value=area, remedy="such as 30x20") from None
    values = {key: _WANTED[key] if value is None else value for key, value in wanted.items()}
    most = math.inf if height is None else height
    for key, value in {**values, "pad": min(width, depth), "max_height": most}.items():
        if not value > 0.0:
            raise InputError("must be more than 0", key=key, value=value)
    force, place, ball = values["force_error"] / 100.0, values["place_error"], values["ball"]
    target = PadTarget((width, depth), force, place, ball, int(values["gauges"]), gauge, most)
    with bar("reading balls on pads"):
        trials = select_pads(target)
    rows = [_row(one, target) for one in trials]
    head = ["layout", "pitch mm", "R0 mm", "force +- %", "place +- mm", "read %", "meets"]
    echo(f"median errors under balls of {ball:g} mm radius anywhere on {width:g} x {depth:g} mm, TangoPlus, 12 kPa")
    echo(table_text(head, rows))
    if charts is not None:
        write_pad_chart(trials, target, charts)
        echo(str(charts / "pad-trade-off.svg"))
    best = next((one for one in trials if one.meets(target)), None)
    if best is None:
        raise typer.Exit(1)
    radius, wall = (f"membrane.{key}_mm={size:.2f}" for key, size in zip(_SIZES, best.sizes, strict=True))
    sets = set_words([radius, wall, "pneumatics.driving_pressures_kPa=[0,12]"])
    report_next("new", "NAME", "--pad", best.layout, "--pitch", f"{best.pitch:.3g}", *sets)


def _row(one: "PadTrial", target: "PadTarget") -> list[str]:
    numbers = one.pitch, one.sizes[0], 100.0 * one.force_error, one.place_error, 100.0 * one.read
    forms = ("%.3g", "%.2f", "%.1f", "%.2f", "%.0f")
    texts = [form % number for form, number in zip(forms, numbers, strict=True)]
    return [one.layout, *texts, "yes" if one.meets(target) else ""]


def compare_pads(context: typer.Context, names: list[str], set_: list[str] | None) -> None:
    """Print sizes, figures and resolution of pads side by side."""
    from pneutouch.workflows.pad.load import load_pad
    from pneutouch.workflows.pad.select_pads import compared

    _refuse_others(context, names[0], "things", "set_")
    for name in names:
        if not is_pad(name):
            raise InputError("is no pad", key="things", value=name, remedy="compare pads with pads")
    pads = [load_pad(name, changes(set_)) for name in names]
    with _tabulating("comparing") as made_by:
        columns = [compared(pad, made_by) for pad in pads]
    keys = dict.fromkeys(key for column in columns for key in column)
    echo(table_text(["", *names], [[key, *(column.get(key, "") for column in columns)] for key in keys]))


@contextmanager
def _tabulating(what: str = "reading the table of a cell") -> "Iterator[Tabulate]":
    """Bar of a stage; yields what tabulates a cell, by presses that it counts, where there is no table yet."""
    from pneutouch.mechanics.touch.cell import cell_table

    with bar(what) as progress:
        yield partial(cell_table, progress=lambda done, total: progress(done, total, "tabulating a cell"))


def _refuse_others(context: typer.Context, name: str, *ours: str) -> None:
    """Raise InputError for an option that was given and is none of ``ours``, those that hold for pads."""
    for one in context.command.params:
        source = context.get_parameter_source(one.name or "")
        if one.name not in ours and source is not None and source.name == "COMMANDLINE":
            raise InputError(f"{max(one.opts, key=len)} holds for one sensor, not for a pad", file=name)
