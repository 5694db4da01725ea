"""The files of a reader as their users have them: the header compiled, the module imported, the sketch on a stub."""

from __future__ import annotations

import importlib.util
import random
import shutil
import subprocess
from itertools import pairwise
from pathlib import Path

import pytest

from pneutouch.catalogue import Library
from pneutouch.export.reader.reading import Status
from pneutouch.export.reader.render import MOST_TABLES, arduino_gauge, c_name, reader_files, sketch_note, table_bytes
from pneutouch.spec.gauge import Gauge
from pneutouch.workflows.live.protocol import DeviceName, LineReader
from tests.export.reader.records import record, single

HERE = Path(__file__).parent
STRICT = ["-Wall", "-Wextra", "-Werror", "-std=c99", "-pedantic"]
c_compiler = pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler (gcc) on this machine")
cpp_compiler = pytest.mark.skipif(shutil.which("g++") is None, reason="no C++ compiler (g++) on this machine")

MAIN = """
#include <stdio.h>
#include "dome_reader.h"
int main(void)
{
    float driving, gauge, temperature, ambient;
    while (scanf("%f %f %f %f", &driving, &gauge, &temperature, &ambient) == 4) {
        dome_reader reader;
        dome_reading reading;
        dome_status status;
        dome_begin(&reader);
        dome_add(&reader, driving);
        dome_tare(&reader, 20.0f, ambient);
        status = dome_read(&reader, gauge, temperature, ambient, &reading);
        printf("%d %.9g %.9g\\n", (int)status, (double)reading.force_N, (double)reading.uncertainty_N);
    }
    return 0;
}
"""

TRACK = """
#include <stdio.h>
#include "dome_reader.h"
int main(void)
{
    dome_reader reader;
    float gauge;
    int k;
    dome_begin(&reader);
    for (k = 0; k < 200 && scanf("%f", &gauge) == 1; k++) {
        dome_add(&reader, gauge);
    }
    dome_tare(&reader, 20.0f, DOME_AMBIENT_KPA);
    while (scanf("%f", &gauge) == 1) {
        printf("%d %.9g\\n", dome_track(&reader, gauge, 20.0f, DOME_AMBIENT_KPA, 0.2f), (double)reader.drift_kPa);
    }
    return 0;
}
"""


def gauge(name) -> Gauge:
    return Library.default().load("gauges", name)


def compiled(folder, program, known):
    for name, content in reader_files(known, "dome").items():
        (folder / name).write_bytes(content)
    (folder / "main.c").write_text(program)
    subprocess.run(["gcc", "-O2", *STRICT, "main.c", "-o", "main"], cwd=folder, check=True)
    return lambda text: subprocess.run([folder / "main"], input=text, capture_output=True, text=True, check=True).stdout


def module(folder):
    spec = importlib.util.spec_from_file_location("dome_reader", folder / "dome_reader.py")
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded.ForceReader(loaded.TABLE)


def states(count, *, nominal):
    draw = random.Random(3)
    for _ in range(count):
        driving = single(draw.uniform(-0.3, 24.5))
        around = (20.0, record()["conditions"]["ambient_pressure_kPa"])
        if not nominal:
            around = single(draw.uniform(14.0, 26.0)), single(draw.uniform(98.0, 104.6))
        yield driving, single(driving + draw.uniform(-0.5, 14.0)), *around


@c_compiler
@pytest.mark.parametrize(
    "known",
    [
        record(),
        pytest.param(record(factor=1.25), marks=pytest.mark.slow),
        pytest.param(record(relative=False), marks=pytest.mark.slow),
    ],
    ids=["plain", "factor", "bare"],
)
def test_c_and_python_have_the_same_answers(tmp_path, known):
    answers, reader, seen = compiled(tmp_path, MAIN, known), module(tmp_path), set()
    for nominal in (True, False):
        every = list(states(1500, nominal=nominal))
        lines = answers("\n".join(" ".join(f"{x:.9g}" for x in row) for row in every)).splitlines()
        for (driving, pressure, temperature, ambient), line in zip(every, lines, strict=True):
            status, force, uncertainty = line.split()
            reader.tare([driving], 20.0, ambient)
            reading = reader.read(pressure, temperature, ambient)
            assert int(status) == reading.status
            seen.add(reading.status)
            # At other conditions a pressure is solved for, with the rounding of float32 at 120 kPa: some 2e-5 kPa.
            bound = {"rel": 1e-6} if nominal else {"abs": 3e-5 * 4.4 / 12.4}
            assert float(force) == pytest.approx(reading.force_N, nan_ok=True, **bound)
            assert float(uncertainty) == pytest.approx(reading.uncertainty_N, rel=1e-3, abs=1e-6, nan_ok=True)
    assert {Status.OK, Status.ABOVE_RATING, Status.BEYOND_RANGE, Status.BELOW_ZERO, Status.NOT_TARED} <= seen
    assert Status.CONDITIONS in seen


@c_compiler
def test_c_and_python_follow_a_drift_alike(tmp_path):
    draw = random.Random(2)
    signal = [single(10.0 + draw.gauss(0.0, 0.004)) for _ in range(200)]
    signal += [
        single(10.0 + 1e-4 * k * 0.2 + (1.0 if 2000 < k < 2500 else 0.0) + draw.gauss(0.0, 0.004)) for k in range(5000)
    ]
    lines = compiled(tmp_path, TRACK, record())("\n".join(f"{x:.9g}" for x in signal)).splitlines()
    reader = module(tmp_path)
    reader.tare(signal[:200])
    for pressure, line in zip(signal[200:], lines, strict=True):
        touched, drift = line.split()
        assert bool(int(touched)) == reader.track(pressure, 0.2)
        assert float(drift) == pytest.approx(reader.drift_kPa, abs=2e-4)
    assert reader.drift_kPa == pytest.approx(0.1, abs=0.02)


@c_compiler
def test_the_header_needs_no_library_and_its_tables_are_small(tmp_path):
    compiled(tmp_path, '#include "dome_reader.h"\nint main(void) { return 0; }\n', record())
    text = (tmp_path / "dome_reader.h").read_text()
    assert [line for line in text.splitlines() if line.startswith("#include")] == [
        "#include <stdint.h>",
        "#include <avr/pgmspace.h>",
    ]
    assert "malloc" not in text
    assert table_bytes(record()) <= MOST_TABLES


def test_every_file_states_its_difference_from_the_full_model():
    files = reader_files(record(), "dome", gauge("nxp-mpx5100gp"))
    assert set(files) == {
        "reader.schema.json",
        "dome_reader.h",
        "dome_reader.py",
        "arduino/dome_sketch/dome_sketch.ino",
        "arduino/dome_sketch/dome_reader.h",
    }
    for name, content in files.items():
        assert name == "reader.schema.json" or b"0.02 %" in content, name


@cpp_compiler
@pytest.mark.parametrize("name", ["honeywell-abp2-5psi", "nxp-mpx5100gp"])
def test_the_sketch_sends_the_pressures_and_newtons_of_the_python_reader(tmp_path, name):
    known = {**record(), "gauge": {"name": name, "range_kPa": [-2.0, 34.0]}}
    for path, content in reader_files(known, "dome", gauge(name)).items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_bytes(content)
    places = [f"-I{HERE / 'stub'}", f"-I{tmp_path / 'arduino/dome_sketch'}", '-DSKETCH="dome_sketch.ino"']
    subprocess.run(
        ["g++", "-Wall", "-Wextra", "-Werror", *places, HERE / "run_sketch.cpp", "-o", "run"], cwd=tmp_path, check=True
    )
    sent = subprocess.run([tmp_path / "run"], capture_output=True, check=True).stdout
    heard = LineReader()
    name, *samples = heard.feed(sent)
    assert heard.damaged == 0 and sent.startswith(b"# tare: status 0")
    assert name == DeviceName(known["design"], 1)
    assert [one.number for one in samples] == list(range(len(samples))) and len(samples) == 600
    assert {b.time_ms - a.time_ms for a, b in pairwise(samples)} <= {10.0, 16.0, 17.0}
    lines = [{one[0]: one[1:] for one in line.split(b"*")[0].decode().split(",")[3:]} for line in sent.splitlines()[2:]]
    reader = module(tmp_path)
    at, pressed, beyond = samples[0].pressures_kPa[0], 390, -1
    reader.tare([at])
    assert at == pytest.approx(12.0, abs=0.1) and lines[0]["r"] == "0.0000" and lines[0]["s"] == "0"
    assert float(lines[pressed]["r"]) == pytest.approx(
        reader.read(samples[pressed].pressures_kPa[0]).force_N, abs=0.002
    )
    assert lines[pressed]["s"] == "0" and lines[pressed]["c"] == "1"
    assert lines[beyond]["r"] == "nan" and lines[beyond]["s"] in "34"


def test_a_gauge_that_no_sketch_can_read_is_left_out_with_the_reason():
    assert "absolute" in sketch_note(gauge("st-lps33hw"))
    assert "names no gauge" in sketch_note(None)
    assert sketch_note(gauge("nxp-mpx5100gp")) is None
    other = gauge("honeywell-abp2-5psi").model_copy(update={"order_code": "XYZ"})
    assert "is not covered" in arduino_gauge(other)
    assert not any(name.endswith(".ino") for name in reader_files(record(), "dome", other))


def test_names_become_identifiers_of_c():
    assert [c_name(name) for name in ("paper-dome", "6mm dome", "ä_b")] == [
        "paper_dome",
        "sensor_6mm_dome",
        "sensor___b",
    ]
