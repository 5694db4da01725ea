"""``pneutouch live``: a sensor read over a serial port, shown and recorded."""

import math
import select
import sys
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from pneutouch.cli.app import CalibrationOption, DesignArgument, JsonOption, SetOption, app, changes, print_answer
from pneutouch.cli.complete import parameters_of
from pneutouch.cli.pad_commands import is_pad, live_of_pad
from pneutouch.cli.terminal import bar, echo, filled_text, notify, report_next, set_words
from pneutouch.errors import ComputationError, InputError
from pneutouch.spec.toml_text import assignments

if TYPE_CHECKING:
    from pneutouch.workflows.live.planned import PlanRuns
    from pneutouch.workflows.live.readers import LiveReading
    from pneutouch.workflows.live.running import LiveRun

parameter = parameters_of(__file__)

_PAINT_S, _LINE_S = 0.1, 0.5
_GONE_S = 60.0
"""Seconds after which a device that was unplugged is given up."""

_SAID = 64
"""Number of last events that are not repeated."""


@app.command()
def live(
    design: DesignArgument,
    port: Annotated[str | None, parameter("port")] = None,
    baud: Annotated[int, parameter("baud")] = 115_200,
    plan: Annotated[Path | None, parameter("plan")] = None,
    run: Annotated[int | None, parameter("run")] = None,
    all_: Annotated[bool, parameter("all")] = False,
    record: Annotated[Path | None, parameter("record")] = None,
    seconds: Annotated[float | None, parameter("seconds")] = None,
    pressure_kPa: Annotated[float | None, parameter("pressure_kPa")] = None,
    set_: SetOption = None,
    calibration: CalibrationOption = None,
    json: JsonOption = False,
) -> None:
    """Read a sensor over a serial port: its force as it comes, recorded for `characterize`. Ctrl-C ends it."""
    from pneutouch.workflows.live.live_pad import PadRecordings
    from pneutouch.workflows.live.planned import PlanRuns
    from pneutouch.workflows.live.port import ports
    from pneutouch.workflows.live.recording import FreeCampaign, Recordings
    from pneutouch.workflows.live.running import live_run
    from pneutouch.workflows.live.sensor import faster_of, live_sensor

    if port is None:
        raise InputError("missing", key="port", remedy=f"give one of {', '.join([*ports(), 'simulated'])}")
    if record is not None and plan is not None:
        raise InputError("cannot be given with `plan`", key="record", value=str(record))
    for key, value in {"run": run, "all": all_ or None}.items():
        if value is not None and plan is None:
            raise InputError("needs `plan`", key=key, value=value)
    is_simulated = faster_of(port) is not None
    planned = None if plan is None else PlanRuns.of(plan)
    chosen = None if planned is None else planned.chosen(run)
    fields = changes(set_, calibration)
    free: Recordings | None = None
    if record is not None and is_pad(design):
        free = PadRecordings(record, design, is_simulated)
    elif record is not None:
        free = FreeCampaign.of(record, design, assignments(fields), is_simulated)
    if free is not None:
        free.check()
    with bar("tabulating the sensor"):
        sensor = live_of_pad(design, set_, calibration) if is_pad(design) else live_sensor(design, fields)
    with live_run(sensor, port, baud, pressure_kPa=pressure_kPa) as running, _view(json=json) as show:
        try:
            while planned is not None and chosen is not None:
                notify(f"run {chosen.number}: {chosen.kind} of {chosen.sensor} at {chosen.driving_pressure_kPa:g} kPa")
                running.record_run(planned, chosen)
                complete = _watch(running, show, seconds)
                chosen = planned.open[0] if all_ and complete and planned.open else None
            if free is not None:
                running.record_free(free)
            if planned is None:
                _watch(running, show, seconds)
        finally:
            if running.stop() is not None:
                notify(f"note: {running.session.state.said[-1]}")
        known = running.record()
    print_answer(known, lambda one: filled_text("live.txt.j2", record=one), json=json)
    _report_next(planned, record, [design, "--port", port, *set_words(set_, calibration)], json=json)


def _watch(running: "LiveRun", show: Callable[["LiveRun"], None], seconds: float | None) -> bool:
    """Show what is read until the time is over, or the run of a plan is complete: True then.

    Raises InputError and ComputationError for a device that does not speak, or is gone."""
    lost_since: float | None = None
    while seconds is None or running.session.seconds < seconds:
        if running.advance():
            return True
        running.check_link()
        if running.session.link == "reading":
            lost_since = None
        elif running.session.samples:
            lost_since = lost_since or time.monotonic()
            if time.monotonic() - lost_since > _GONE_S:
                raise ComputationError(f"the device at {running.port} did not come back in {_GONE_S:g} s")
        show(running)
        if sys.stdin.isatty() and select.select([sys.stdin], [], [], 0.0)[0] and sys.stdin.readline().strip() == "t":
            running.session.tare()
        time.sleep(_PAINT_S)
    return False


@contextmanager
def _view(*, json: bool) -> Iterator[Callable[["LiveRun"], None]]:
    """Function that shows what is read: a panel on a terminal, else a line now and then; events on stderr."""
    said: deque[str] = deque(maxlen=_SAID)

    def events(running: "LiveRun") -> None:
        for words in running.session.state.said:
            if words not in said:
                said.append(words)
                notify(f"note: {words}")

    if not sys.stdout.isatty() or json:
        last = [0.0]

        def line(running: "LiveRun") -> None:
            events(running)
            if not json and time.monotonic() - last[0] >= _LINE_S:
                last[0] = time.monotonic()
                echo(" | ".join(lines_of(running)))

        yield line
        return
    from rich.console import Console
    from rich.live import Live
    from rich.text import Text

    with Live(console=Console(), refresh_per_second=1.0 / _PAINT_S, transient=True) as panel:

        def paint(running: "LiveRun") -> None:
            panel.update(Text("\n".join([*lines_of(running), *running.session.state.said[-3:], "t and Enter: tare"])))

        yield paint


def lines_of(running: "LiveRun") -> list[str]:
    """The reading, the pressures, the step of the plan and the recording, in a line each."""
    point, state = running.session.newest(), running.session.state
    lines = [f"{running.session.seconds:7.1f} s  {state.link}, {state.status}"]
    if point is not None and point.reading is not None:
        force_N, sigma_N = point.reading.force_N, point.reading.uncertainty_N
        if force_N == force_N:
            bounds = f" ({max(force_N - 2 * sigma_N, 0.0):.3f} to {force_N + 2 * sigma_N:.3f})"
            known = bounds if sigma_N == sigma_N else ""
            lines.append(f"force {force_N:.3f} N{known}{_place(point.reading)}")
    if point is not None:
        read = ", ".join(f"{one_kPa:.3f}" for one_kPa in point.sample.pressures_kPa)
        zeros = ", ".join("-" if one_kPa is None else f"{one_kPa:.3f}" for one_kPa in state.driving_pressures_kPa)
        lines.append(f"pressure {read} kPa, without contact {zeros} kPa")
    if state.step:
        lines.append(f"{state.step}: {state.step_left_s:.1f} s")
    if state.recording is not None:
        lines.append(f"recording {state.recording}: {state.recorded_s:.1f} s")
    return lines


def _place(reading: "LiveReading") -> str:
    """Place of the force on a pad, in words; empty for a dome."""
    x_mm, y_mm = getattr(reading, "x_mm", math.nan), getattr(reading, "y_mm", math.nan)
    return f" at {x_mm:.1f}, {y_mm:.1f} mm" if math.isfinite(x_mm + y_mm) else ""


def _report_next(planned: "PlanRuns | None", record: Path | None, words: Sequence[str], *, json: bool) -> None:
    """Name the next command: the next run of the plan, or the evaluation."""
    if json:
        return
    by_hand = () if planned is None else planned.by_hand
    if by_hand:
        files = ", ".join(str(file) for file in by_hand)
        notify(f"note: to be read by hand, with the columns volume_mL and pressure_kPa: {files}")
    if planned is not None and planned.open:
        report_next("live", *words, "--plan", planned.folder)
    elif planned is not None or record is not None:
        report_next("characterize", record if planned is None else planned.folder)
