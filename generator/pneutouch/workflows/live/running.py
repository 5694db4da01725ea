"""A device that is read, and what is recorded from it: runs of a plan, or runs of its own."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pneutouch.bench.simulate.rig import MARK
from pneutouch.errors import InputError, shown
from pneutouch.results.live import LiveRecord
from pneutouch.results.plan import PlannedRun
from pneutouch.workflows.live.planned import PlanRuns, RunSteps
from pneutouch.workflows.live.port import BAUD, PortThread
from pneutouch.workflows.live.recording import Recording, Recordings
from pneutouch.workflows.live.sensor import LiveSensor, faster_of
from pneutouch.workflows.live.session import LiveSession
from pneutouch.workflows.live.simulated import SimulatedDevice

FIRST_S = 10.0
"""Time in which the first sample must come: a board that begins anew as the port is opened tares after two seconds."""


class LiveRun:
    """A session with a device, simulated or not, and its recordings. Call `advance` some times a second."""

    def __init__(self, sensor: LiveSensor, port: str, session: LiveSession, device: SimulatedDevice | None) -> None:
        self.sensor, self.port, self.session, self.device = sensor, port, session, device
        # Simulated files are marked.
        self._mark = "" if device is None else MARK
        self._campaign: Recordings | None = None
        self._pending: tuple[Recording, RunSteps, float] | None = None
        self._steps: RunSteps | None = None
        self._at_kPa: float | None = None
        self.file: Path | None = None
        self._begun = time.monotonic()

    def check_link(self) -> None:
        """Raise InputError if no sample came in `FIRST_S`, with what the device sends instead."""
        if self.session.samples or time.monotonic() - self._begun < FIRST_S:
            return
        if self.session.link == "foreign":
            heard = "".join(chr(one) if 32 <= one < 127 else "." for one in self.session.heard)
            problem = f"the device sends {shown(heard)}, which is no line of a pneutouch sketch"
            remedy = "give the `baud` of its sketch, or put the sketch of export-reader onto it"
            raise InputError(problem, key="port", value=self.port, remedy=remedy)
        remedy = "reset the board, and see whether the sketch of export-reader runs on it"
        raise InputError(f"nothing came in {FIRST_S:g} s", key="port", value=self.port, remedy=remedy)

    def record_run(self, plan: PlanRuns, run: PlannedRun) -> None:
        """Record a run of a plan into its file. Raises InputError if it is there."""
        steps = RunSteps(run)
        recording = Recording(plan.folder / run.file, self._mark, steps.seconds)
        plan.check_design(self.sensor.name)
        recording.check()
        rig = None if self.device is None else self.sensor.rig(run.driving_pressure_kPa)
        plan.check_source(rig is not None)
        self.stop()
        self._campaign, self._steps = None, steps
        if self.device is not None and rig is not None:
            self._record(recording, self.device.play(rig.run(run), rig.idle))
        elif steps.before:
            self._pending = recording, steps, self.session.seconds
            self.session.walk(lambda _: steps.ahead(self.session.seconds - self._since))
        else:
            self._record(recording, None)

    @property
    def _since(self) -> float:
        return 0.0 if self._pending is None else self._pending[2]

    def _record(self, recording: Recording, first: int | None) -> None:
        self._pending = None
        self.session.record(recording, first)
        if self._steps is None:
            self.session.walk(None)
        else:
            self.session.walk(self._steps.at, self._steps.zero)

    def record_free(self, campaign: Recordings) -> None:
        """Record a run of a campaign of its own. Raises InputError as its `check`."""
        campaign.check()
        self.stop()
        self._campaign, self._steps, self._at_kPa = campaign, None, self._zero_kPa()
        self._record(Recording(campaign.next_file(), self._mark), None)

    def advance(self) -> bool:
        """Begin what is to be recorded when its time has come; True when the run of a plan is complete, which ends it.

        Raises OSError if the recording could not be written."""
        if self.session.failure is not None:
            failure, self.session.failure = self.session.failure, None
            raise failure
        if self._pending is not None:
            recording, steps, since = self._pending
            if self.session.seconds - since >= steps.before_s:
                self._record(recording, None)
        if self.session.is_full():
            self.stop()
            return True
        return False

    def stop(self) -> Path | None:
        """End what is recorded; returns its file, None if there is none."""
        recording, self._pending = self.session.stop_recording(), None
        steps, self._steps = self._steps, None
        self.session.walk(None)
        if recording is None:
            return None
        cut = steps is not None and not recording.full
        path = recording.close(cut=cut)
        if path is not None:
            if self._campaign is not None:
                self._campaign.enter(path, self._at_kPa if self._at_kPa is not None else self._zero_kPa())
            self.session.say(f"{path.name} has {recording.seconds:.1f} s{'; the run was cut short' if cut else ''}")
            self.file = path
        return path

    def _zero_kPa(self) -> float | None:
        """Driving pressure by the zero; None before a tare."""
        return self.session.state.driving_pressures_kPa[0]

    def record(self) -> LiveRecord:
        """The record of what was read, now."""
        greatest_N = self.session.greatest_force_N
        return LiveRecord(
            design=self.sensor.name,
            port=self.port,
            seconds=self.session.seconds,
            state=self.session.state,
            greatest_force_N=greatest_N if greatest_N == greatest_N else None,
            file=None if self.file is None else str(self.file),
        )


@contextmanager
def live_run(
    sensor: LiveSensor, port: str, baud: int = BAUD, *, pressure_kPa: float | None = None
) -> Iterator[LiveRun]:
    """A device at a port, read until the block ends, which ends its recording too.

    Raises InputError as `faster_of`, `LiveSensor.rig` and `open_port`."""
    faster, device = faster_of(port), None
    if faster is not None:
        device = sensor.device(pressure_kPa, faster)
    elif pressure_kPa is not None:
        raise InputError(
            "is of a simulated device alone", key="pressure_kPa", value=pressure_kPa, remedy="leave it out"
        )
    try:
        session = LiveSession(sensor.reader, each=sensor.each)
        thread = PortThread(session, port if device is None else device.port, baud)
        running = LiveRun(sensor, port, session, device)
        try:
            yield running
        finally:
            thread.close()
            running.stop()
    finally:
        if device is not None:
            device.close()
