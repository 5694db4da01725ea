"""The process of a device that the page watches: commands on its input, frames with new samples on its output."""

import json
import math
import os
import select
import signal
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any, BinaryIO

from pneutouch.catalogue import Library
from pneutouch.errors import InputError, PneutouchError
from pneutouch.results.record import plain
from pneutouch.spec.files import inside
from pneutouch.spec.read import parse_changes
from pneutouch.studio.form import PageLibrary, Question
from pneutouch.studio.guard import PageFault, faults_of, internal_fault
from pneutouch.workflows.live.live_pad import PadRecordings, live_pad
from pneutouch.workflows.live.planned import PlanRuns
from pneutouch.workflows.live.recording import FreeCampaign
from pneutouch.workflows.live.running import LiveRun, live_run
from pneutouch.workflows.live.sensor import faster_of, live_sensor
from pneutouch.workflows.live.session import LivePoint
from pneutouch.workflows.pad.export import pad_tables
from pneutouch.workflows.pad.load import load_pad

_FRAME_S, _STATE_S = 1.0 / 60.0, 0.2
"""Time between two frames, and between two states of the device."""

_MOST = 4096
"""Greatest number of samples in a frame; a device that sends more is shown later."""


class _Watched:
    """A device that the page watches."""

    def __init__(self, running: LiveRun, request: Mapping[str, Any], out: BinaryIO) -> None:
        self._running, self._request, self._out = running, request, out
        self._pad: str | None = request.get("pad")
        self._sent, self._stated = 0, -math.inf

    def work(self) -> None:
        """Send frames and follow commands until the input ends."""
        lines = _Lines(sys.stdin.fileno())
        while (commands := lines.within(_FRAME_S)) is not None:
            for command in commands:
                try:
                    self._do(command)
                except PneutouchError as error:
                    self._write({"fault": _fault(error)})
                except OSError as error:
                    self._write({"fault": _fault(_of_system(error))})
            try:
                self._running.advance()
                self._running.check_link()
            except OSError as error:
                self._write({"fault": _fault(_of_system(error))})
            self._frame()

    def _do(self, command: Mapping[str, Any]) -> None:
        what, running = command.get("do"), self._running
        if what == "again":
            self._sent, self._stated = 0, -math.inf
        elif what == "tare":
            running.session.tare()
        elif what == "stop":
            running.stop()
        elif what == "record":
            folder = _folder(command.get("folder"), "live.folder")
            simulated = faster_of(running.port) is not None
            free = (
                self._campaign(folder, simulated) if self._pad is None else PadRecordings(folder, self._pad, simulated)
            )
            running.record_free(free)
        elif what == "plan":
            plan = PlanRuns.of(_folder(command.get("folder"), "live.plan"))
            running.record_run(plan, plan.chosen(None))

    def _campaign(self, folder: Path, simulated: bool) -> FreeCampaign:
        question = Question.of(self._request["question"])
        changed = [f"{key}={text}" for key, text in question.values.items() if text is not None]
        parse_changes(changed)
        return FreeCampaign.of(folder, self._request["bases"][question.base], changed, simulated)

    def _frame(self) -> None:
        points = self._running.session.since(self._sent)[:_MOST]
        frame: dict[str, Any] = {}
        if points:
            self._sent = points[-1].number
            frame["points"] = [_row(point) for point in points]
            frame["made"] = self._made(points[-1])
            if self._pad is not None and (newest := self._running.session.newest()) is not None:
                frame["touch"] = _known(newest.reading)
        if time.monotonic() - self._stated > _STATE_S:
            self._stated = time.monotonic()
            frame["state"] = self._running.session.state
            frame["file"] = None if self._running.file is None else str(self._running.file)
        if frame:
            self._write(frame)

    def _made(self, point: LivePoint) -> float:
        """Time of day at which a sample was made, s: that of a simulated device's clock, else of its arrival."""
        device = self._running.device
        return time.time() if device is None else device.made(point.sample.number)

    def _write(self, line: Mapping[str, Any]) -> None:
        self._out.write(json.dumps(plain(line)).encode() + b"\n")
        self._out.flush()


def _of_system(error: OSError) -> InputError:
    """An error of the system in its words."""
    return InputError(error.strerror or str(error), file=error.filename)


def _fault(error: Exception) -> PageFault:
    """The problems of an error, at the fields of the page's form."""
    known = error if isinstance(error, PneutouchError) else internal_fault(error)
    if known.key in ("port", "baud", "sensor", "plan", "folder"):
        known.key = f"live.{known.key}"
    return faults_of(known)


def _known(reading: Any) -> Mapping[str, Any]:
    """Readings of a contact with a pad by name; None for those that are not known."""
    values = {} if reading is None else reading._asdict()
    return {key: None if isinstance(one, float) and math.isnan(one) else one for key, one in values.items()}


def _row(point: LivePoint) -> list[float | None]:
    """Time, pressures, force, its standard uncertainty, and force of the force sensor; None for what is not known."""
    reading, sample = point.reading, point.sample
    read = (math.nan, math.nan) if reading is None else (reading.force_N, reading.uncertainty_N)
    values = (point.time_s, *read, sample.force_N, *sample.pressures_kPa)
    return [round(one, 5) if math.isfinite(one) else None for one in values]


def _folder(given: Any, key: str) -> Path:
    """A folder below the one in which the studio was started. Raises InputError for another."""
    if not isinstance(given, str) or not given.strip():
        raise InputError("give a folder", key=key, value=given)
    return inside(Path(), given.strip(), file="the page", key=key)


class _Lines:
    """JSON lines of a stream as they come."""

    def __init__(self, stream: int) -> None:
        self._stream, self._rest = stream, b""

    def within(self, seconds: float) -> list[Mapping[str, Any]] | None:
        """Lines that came within ``seconds``; None where the stream has ended."""
        if not select.select([self._stream], [], [], seconds)[0]:
            return []
        piece = os.read(self._stream, 1 << 16)
        if not piece:
            return None
        *lines, self._rest = (self._rest + piece).split(b"\n")
        return [json.loads(line) for line in lines]


def watch(request: Mapping[str, Any], out: BinaryIO) -> None:
    """Open the device of a request (``question`` or ``pad``, ``bases``, ``port``, ``baud``) and watch it. Raises
    InputError."""
    library = PageLibrary(Library.default().folders)
    if request.get("pad") is None:
        sensor = live_sensor(Question.of(request["question"]).source(request["bases"], library))
    else:
        pad = load_pad(request["pad"], library=library)
        sensor = live_pad(pad.name, *pad_tables(pad, None))
    with live_run(sensor, request["port"], request["baud"]) as running:
        _Watched(running, request, out).work()


def main() -> None:
    """Read the request, and watch the device; what fails is a line too."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    out = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    first = b""
    while not first.endswith(b"\n"):
        # Byte by byte: what follows is read as it comes.
        piece = os.read(sys.stdin.fileno(), 1)
        if not piece:
            return
        first += piece
    try:
        watch(json.loads(first), out)
    except BrokenPipeError:
        return
    except Exception as error:
        out.write(json.dumps(plain({"fault": _fault(error)})).encode() + b"\n")
        out.flush()


if __name__ == "__main__":
    main()
