"""The device of the page: requests that make no sense, and the frames of its process."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys

import pytest

pytest.importorskip("serial")

import itertools

from pneutouch.studio.live_process import _Lines
from tests.studio.conftest import HOME

REQUEST = {"question": {"base": "paper-dome", "values": {}}, "port": "simulated", "baud": "115200", "pad": None}


@pytest.fixture
def ask(client):
    return lambda path, content: client.post(f"/api/live/{path}", json=content, headers={"Origin": HOME})


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"port": ""}, "live.port"),
        ({"port": 3}, "live.port"),
        ({"baud": "fast"}, "live.baud"),
        ({"baud": "1"}, "live.baud"),
        ({"pad": "no-such-pad"}, "live.sensor"),
    ],
)
def test_a_device_that_cannot_be_opened_is_refused_at_its_field(ask, change, field):
    answer = ask("open", REQUEST | change)
    assert answer.status_code == 422 and answer.json()["problems"][0]["fields"] == [field]


@pytest.mark.parametrize(
    "content", [{}, {"do": "format"}, [], "tare", {"do": "tare"}, {"do": "stop"}, {"do": "again"}, {"do": None}]
)
def test_commands_without_a_device_and_unknown_ones_are_refused(ask, content):
    assert ask("do", content).status_code == 422


def test_the_ports_are_listed_with_the_simulated_one(client):
    known = client.get("/api/live/ports").json()
    assert known["ports"][-1] == "simulated" and known["open"] is False


class Watched:
    """The process of a device, and the documents that it sends."""

    def __init__(self, folder, port, home):
        self.process = subprocess.Popen(
            [sys.executable, "-m", "pneutouch.studio.live_process"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            cwd=folder,
            env={**os.environ, "PNEUTOUCH_HOME": str(home)},
        )
        self.send({**REQUEST, "baud": 115200, "port": port, "bases": {"paper-dome": "paper-dome"}})

    def send(self, document):
        self.process.stdin.write(json.dumps(document).encode() + b"\n")
        self.process.stdin.flush()

    def until(self, condition):
        """The first document that meets a condition."""
        for line in self.process.stdout:
            document = json.loads(line)
            if condition(document):
                return document
        raise AssertionError("the process ended")

    def end(self):
        self.process.stdin.close()
        rest = self.process.stdout.read()
        self.process.stdout.close()
        assert self.process.wait(60) == 0
        return rest


def stated(key, value):
    return lambda document: document.get("state", {}).get(key) == value


def test_frames_hold_every_sample_once_and_a_recording_goes_where_it_is_sent(tmp_path):
    watched = Watched(tmp_path, "simulated:20", tmp_path)
    watched.until(stated("status", "OK"))
    first = watched.until(lambda document: "points" in document)["points"]
    then = watched.until(lambda document: "points" in document)["points"]
    times = [row[0] for row in (*first, *then)]
    assert all(b > a for a, b in itertools.pairwise(times))
    assert times[-1] - times[0] == pytest.approx(0.01 * (len(times) - 1), abs=0.005)
    watched.send({"do": "record", "folder": "mine"})
    watched.until(lambda document: document.get("state", {}).get("recorded_s", 0.0) > 5.0)
    watched.send({"do": "stop"})
    done = watched.until(lambda document: document.get("file"))
    assert (tmp_path / done["file"]).is_file() and (tmp_path / "mine" / "campaign.toml").is_file()
    # The page was loaded anew: what is kept comes again.
    watched.send({"do": "again"})
    again = watched.until(lambda document: "points" in document and document["points"][0][0] < times[-1])
    assert len(again["points"]) > 100
    watched.end()


@pytest.mark.parametrize("folder", ["../mine", "/tmp/mine", "", None])
def test_recordings_stay_below_the_folder_of_the_studio(tmp_path, folder):
    (tmp_path / "here").mkdir()
    watched = Watched(tmp_path / "here", "simulated", tmp_path)
    watched.until(lambda document: "state" in document)
    watched.send({"do": "record", "folder": folder})
    fault = watched.until(lambda document: "fault" in document)["fault"]
    assert fault["problems"][0]["fields"] == ["live.folder"]
    watched.end()
    assert [path.name for path in tmp_path.iterdir()] == ["here"]


def test_a_device_that_is_not_there_is_a_fault_at_its_field(tmp_path):
    watched = Watched(tmp_path, str(tmp_path / "ttyACM0"), tmp_path)
    fault = watched.until(lambda document: "fault" in document)["fault"]
    assert fault["problems"][0]["fields"] == ["live.port"]
    watched.end()


def test_lines_of_a_stream_are_cut_where_they_end():
    read, write = os.pipe()
    with io.FileIO(write, "w") as stream:
        lines = _Lines(read)
        assert lines.within(0.0) == []
        stream.write(b'{"do": "tare"}\n{"do"')
        assert lines.within(1.0) == [{"do": "tare"}]
        stream.write(b': "stop"}\n')
        assert lines.within(1.0) == [{"do": "stop"}]
    assert lines.within(1.0) is None
    os.close(read)
