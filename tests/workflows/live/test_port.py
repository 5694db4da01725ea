"""The port of a live device: unplugged and back, busy, silent, or at something else."""

from __future__ import annotations

import os
import select
import time

import pytest

pytest.importorskip("serial")

import itertools

from pneutouch.errors import InputError
from pneutouch.workflows.live import running as module
from pneutouch.workflows.live.port import PortThread, open_port
from pneutouch.workflows.live.protocol import DeviceName, name_line
from pneutouch.workflows.live.recording import Recording
from pneutouch.workflows.live.running import LiveRun, live_run
from pneutouch.workflows.live.sensor import LiveSensor, faster_of
from tests.workflows.live.devices import closed_form, line, plugged, rest, wait_for
from tests.workflows.live.test_session import read_rows


def test_a_device_that_is_pulled_and_plugged_in_again_goes_on_with_its_recording(tmp_path):
    session = closed_form()
    with plugged(tmp_path) as cable:
        thread = PortThread(session, str(cable.port))
        try:
            cable.send(rest())
            wait_for(lambda: session.samples == 202)
            recording = Recording(tmp_path / "one.csv")
            session.record(recording)
            cable.send(b"".join(line(202 + k) for k in range(50)) + line(252)[:9])
            wait_for(lambda: session.samples == 252)
            cable.pull()
            wait_for(lambda: session.link == "unplugged")
            # What came until then is on the disk.
            assert len(read_rows(recording.cut_off)) == 50
            cable.plug_in()
            wait_for(lambda: session.link != "unplugged")
            # The board began anew.
            cable.send(b"".join(line(k) for k in range(20)))
            wait_for(lambda: session.samples == 272)
        finally:
            thread.close()
    session.stop_recording().close()
    times = [float(row["time_s"]) for row in read_rows(recording.path)]
    assert len(times) == 70 and all(b > a for a, b in itertools.pairwise(times))
    assert session.state.damaged == 0 and session.state.lost == 0


def test_a_port_is_opened_by_one_program_alone(tmp_path):
    with plugged(tmp_path) as cable:
        first = open_port(str(cable.port))
        try:
            with pytest.raises(InputError) as error:
                open_port(str(cable.port))
        finally:
            first.close()
    assert (error.value.key, error.value.value) == ("port", str(cable.port))


def test_a_port_that_is_not_there_is_named(tmp_path):
    with pytest.raises(InputError) as error:
        open_port(str(tmp_path / "ttyACM9"))
    assert error.value.key == "port" and error.value.value.endswith("ttyACM9")


@pytest.fixture
def sensor():
    return LiveSensor("closed-form", closed_form()._reader, True, None)


@pytest.mark.parametrize("content", [b"", b"\x00\xfe\x91" * 200 + b"\n" + b"force 1.2 N\n" * 20])
def test_a_silent_device_and_one_that_sends_something_else_are_told_apart(tmp_path, sensor, content, monkeypatch):
    monkeypatch.setattr(module, "FIRST_S", 1.5)
    with plugged(tmp_path) as cable, live_run(sensor, str(cable.port)) as running:
        running.check_link()
        cable.send(content)
        wait_for(lambda: running.session._lines.received >= len(content))
        end = time.monotonic() + 30.0
        with pytest.raises(InputError) as error:
            while time.monotonic() < end:
                running.check_link()
                time.sleep(0.05)
        assert error.value.key == "port" and running.session.link == ("foreign" if content else "silent")


def test_a_board_that_speaks_is_asked_for_its_name(tmp_path, sensor):
    with plugged(tmp_path) as cable, live_run(sensor, str(cable.port)) as running:
        # The first question may be lost while the board begins anew: it is asked again.
        for _ in range(2):
            wait_for(lambda: select.select([cable.master], [], [], 0.0)[0])
            assert os.read(cable.master, 10) == b"?"
        cable.send(b"#P1,paper-dome,1*")
        cable.send(name_line(DeviceName("paper-dome", 1))[17:])
        wait_for(lambda: running.session.state.device == "paper-dome")
        running.check_link()


@pytest.mark.parametrize(
    ("port", "faster"), [("simulated", 1.0), ("simulated:20", 20.0), ("/dev/ttyACM0", None), ("COM3", None)]
)
def test_ports_and_speeds_of_simulated_devices(port, faster):
    assert faster_of(port) == faster


@pytest.mark.parametrize("port", ["simulated:", "simulated:0", "simulated:101", "simulated:x", "simulated:nan"])
def test_wrong_speeds_are_refused(port):
    with pytest.raises(InputError) as error:
        faster_of(port)
    assert error.value.key == "port"


def test_a_pressure_is_of_a_simulated_device_alone(tmp_path, sensor):
    with pytest.raises(InputError) as error, live_run(sensor, str(tmp_path), pressure_kPa=3.0):
        pass
    assert error.value.key == "pressure_kPa"


def test_a_run_that_is_stopped_early_keeps_its_file(tmp_path, sensor):
    session = closed_form()
    running = LiveRun(sensor, "port", session, None)
    session.take(rest())
    session.record(Recording(tmp_path / "one.csv"))
    session.take(b"".join(line(202 + k) for k in range(10)))
    assert running.stop() == tmp_path / "one.csv" == running.file and running.stop() is None
    assert len(read_rows(running.file)) == 10
