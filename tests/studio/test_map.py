"""The map of a design: the figures of ``predict`` at its cells, reasons where there are none, errors at their fields."""

from __future__ import annotations

import json
import math
import random
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from pneutouch.results.record import plain
from pneutouch.studio.design_jobs import GRID, map_design
from pneutouch.studio.job import answered
from pneutouch.studio.server import bases_of
from pneutouch.workflows.sweep.variables import MAPPED, reason_words
from tests.refusals import refused

RADIUS, WALL = "membrane.inner_radius_mm", "membrane.wall_thickness_mm"
PRESSURES = "pneumatics.driving_pressures_kPa"
ASKED = {
    **{"x.field": RADIUS, "x.low": "5.55", "x.high": "14.8"},
    **{"y.field": WALL, "y.low": "0.9", "y.high": "2.4", "map.pressure_kPa": "10"},
}


def request(values: dict[str, str], **changes: str) -> dict[str, object]:
    bases, first = bases_of(None)
    return {"question": {"base": first, "values": changes}, "values": values, "bases": bases, "files": []}


def mapped(folder: Path, values: dict[str, str], report=lambda done, total, what: None, **changes: str):
    return plain(map_design(request(values, **changes), folder, report))


@pytest.fixture(scope="module")
def over_the_membrane(tmp_path_factory):
    steps, folder = [], tmp_path_factory.mktemp("map")
    found = mapped(folder, ASKED, lambda *step: steps.append(step))
    return found, steps, list(folder.iterdir())


def predicted(command, *settings: str):
    words = [word for each in settings for word in ("--set", each)]
    return command("predict", "paper-dome", "--model", "atlas", "--json", *words)


def is_shown(shown: float, value: float) -> None:
    assert shown == pytest.approx(value, rel=5.1e-6)


@pytest.mark.slow
def test_its_values_are_those_of_predict(over_the_membrane, command):
    found, _, _ = over_the_membrane
    figures = found["figures"]
    assert figures.keys() == MAPPED.keys() == found["labels"].keys()
    known = [(i, j) for i in range(GRID) for j in range(GRID) if figures["sensitivity"][i][j] is not None]
    for i, j in random.Random(1).sample(known, 5):
        place = f"{RADIUS}={found['x']['values'][i]}", f"{WALL}={found['y']['values'][j]}", f"{PRESSURES}=[10]"
        said = json.loads(predicted(command, *place).stdout)
        (state,) = said["states"]
        interval = state["uncertainty"]["figures"]["sensitivity_kPa_per_N"]
        is_shown(figures["sensitivity"][i][j], state["sensitivity_kPa_per_N"])
        is_shown(figures["force-range"][i][j], state["force_range_N"][1])
        is_shown(figures["rated-pressure"][i][j], said["rating"]["rated_pressure_kPa"])
        is_shown(figures["interval"][i][j], 50 * math.log(interval["high"] / interval["low"]))


@pytest.mark.slow
def test_it_states_a_reason_for_every_missing_cell_and_its_progress(over_the_membrane, command):
    found, steps, left = over_the_membrane
    cells = found["figures"]["sensitivity"]
    missing = [(i, j) for i in range(GRID) for j in range(GRID) if cells[i][j] is None]
    assert missing == [(i, j) for i in range(GRID) for j in range(GRID) if found["reasons"][i][j]]
    assert len({found["reasons"][i][j] for i, j in missing}) == 2
    for i, j in random.Random(2).sample(missing, 3):
        place = f"{RADIUS}={found['x']['values'][i]}", f"{WALL}={found['y']['values'][j]}", f"{PRESSURES}=[10]"
        refusal = predicted(command, *place)
        assert refusal.returncode != 0
        assert reason_words(" ".join(refusal.stderr.split())) == found["reasons"][i][j]
    assert [done for done, _, _ in steps] == list(range(0, GRID**2, 128))
    assert {total for _, total, _ in steps} == {GRID**2}
    assert left == []


@pytest.mark.slow
def test_a_driving_pressure_is_a_field_as_well(tmp_path, command):
    values = {**ASKED, "y.field": PRESSURES, "y.low": "0", "y.high": "60"}
    found = mapped(tmp_path, values, **{"pneumatics.dead_volume_mL": "1"})
    pressure_kPa = found["y"]["values"][10]
    place = f"{RADIUS}={found['x']['values'][20]}", f"{PRESSURES}=[{pressure_kPa}]", "pneumatics.dead_volume_mL=1"
    (state,) = json.loads(predicted(command, *place).stdout)["states"]
    is_shown(found["figures"]["sensitivity"][20][10], state["sensitivity_kPa_per_N"])
    assert found["figures"]["sensitivity"][20][-1] is None
    assert found["reasons"][20][-1] == "beyond the limit point"


@pytest.mark.slow
def test_what_no_design_can_have_is_a_reason_and_no_error(tmp_path):
    found = mapped(tmp_path, {**ASKED, "y.high": "30"})
    assert found["figures"]["sensitivity"][0][-1] is None
    assert found["reasons"][0][-1] == "wall not thinner than the inner radius"


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"x.low": "0.5"}, "x.low"),
        ({"x.high": "101"}, "x.high"),
        ({"y.low": "thin"}, "y.low"),
        ({"y.high": ""}, "y.high"),
        ({"y.high": "inf"}, "y.high"),
        ({"y.low": "2.4", "y.high": "0.9"}, "y.high"),
        ({"y.low": "2.4"}, "y.high"),
        ({"y.field": RADIUS, "y.low": "5", "y.high": "9"}, "y.field"),
        ({"x.field": "membrane.material"}, "x.field"),
        ({"x.field": "membrane.none_such"}, "x.field"),
        ({"x.field": "none-such"}, "x.field"),
        ({"map.pressure_kPa": "-1"}, "map.pressure_kPa"),
    ],
)
def test_an_error_stands_at_its_field_before_any_work(change, field, tmp_path):
    steps = []
    with refused(field):
        mapped(tmp_path, ASKED | change, lambda *step: steps.append(step))
    assert steps == []
    answer = plain(
        answered({"kind": "map", "arguments": request(ASKED | change), "folder": str(tmp_path)}, lambda *_: None)
    )
    assert answer["status"] == 422
    assert [each["fields"] for each in answer["content"]["problems"]] == [[field]]


def test_an_error_of_the_design_names_its_field(tmp_path):
    with refused(WALL):
        mapped(tmp_path, ASKED, **{WALL: "-1"})


@pytest.mark.slow
def test_cancelled_it_ends_and_leaves_nothing(tmp_path):
    command, pipe = [sys.executable, "-m", "pneutouch.studio.job"], subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, start_new_session=True) as process:
        asked = {"kind": "map", "arguments": request(ASKED), "folder": str(tmp_path)}
        process.stdin.write(json.dumps(asked).encode() + b"\n")
        process.stdin.flush()
        while json.loads(process.stdout.readline())["progress"]["done"] == 0:
            assert process.poll() is None
        assert list(tmp_path.iterdir())
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) == 143
        assert process.stderr.read() == b""
    assert list(tmp_path.iterdir()) == []
