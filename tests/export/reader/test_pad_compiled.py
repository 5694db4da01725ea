"""A pad's exported reader: the header compiled against the module, and both against the table they were made from."""

from __future__ import annotations

import shutil
import subprocess

import numpy as np
import pytest

from pneutouch.evaluation import evaluate
from pneutouch.export.reader.pad_reading import PadForceReader
from pneutouch.export.reader.pad_render import PadReaderSource, pad_reader_files
from pneutouch.mechanics.touch.forward import PadModel
from pneutouch.mechanics.touch.objects import KINDS, answer_of, random_objects
from pneutouch.mechanics.touch.reader_table import STRAIGHT, reader_table
from pneutouch.spec.pad import PadTable
from pneutouch.units import KPA
from tests.mechanics.touch.test_touch import CELL, PRESSURE
from tests.pads import coarse_table

STRICT = ["-Wall", "-Wextra", "-Werror", "-std=c99", "-pedantic"]
NOISE_KPA = 0.002
MAIN = """
#include <stdio.h>
#include "tip_reader.h"
int main(void)
{
    double zero[tip_CELLS] = { 0.0 }, rise[tip_CELLS];
    tip_reader reader;
    tip_contact c;
    int k, lost;
    tip_begin(&reader);
    tip_add(&reader, zero);
    while (scanf("%d", &lost) == 1) {
        for (k = 0; k < tip_CELLS; k++) {
            if (scanf("%lf", &rise[k]) != 1) {
                return 1;
            }
            reader.used[k] = k + 1 != lost;
        }
        k = (int)tip_read(&reader, rise, &c);
        printf("%d %.15g %.15g %.15g %.15g %.15g %.15g %.15g %.15g %.15g ", k, c.force_N, c.uncertainty_N, c.x_mm,
               c.y_mm, c.xx_mm2, c.xy_mm2, c.yy_mm2, c.curvature_per_mm, c.curvature_uncertainty_per_mm);
        printf("%.15g %.15g %.15g %.15g %.15g %.15g\\n", c.slope_x, c.slope_y, c.slope_x_uncertainty,
               c.slope_y_uncertainty, c.turn_rad, c.turn_uncertainty_rad);
    }
    return 0;
}
"""


@pytest.fixture(scope="module", params=["alike", "of two kinds"])
def pad(request, tmp_path_factory):
    table = coarse_table(evaluate("paper-dome", CELL).sensor, PRESSURE, tmp_path_factory)
    places, gain = np.array(PadTable(cell="c", layout="ring:7", pitch_mm=9.0).places), np.linspace(0.95, 1.05, 7)
    if request.param == "alike":
        return PadModel.alike(places, table, gain)
    return PadModel(places, (table, table.scaled(1.15, 1.4)), np.array([0, 1, 0, 0, 1, 1, 0]), gain)


@pytest.fixture(scope="module")
def table(pad):
    return reader_table(pad, NOISE_KPA)


@pytest.fixture(scope="module")
def header(table, tmp_path_factory):
    """The compiled header: answers to rows of the lost cell's number and rises, kPa."""
    if shutil.which("gcc") is None:
        pytest.skip("no C compiler (gcc) on this machine")
    folder = tmp_path_factory.mktemp("header")
    for name, content in pad_reader_files(table, PadReaderSource("tip", 12.0, None, "0", "0" * 64)).items():
        (folder / name).write_bytes(content)
    (folder / "main.c").write_text(MAIN)
    subprocess.run(["gcc", "-O2", *STRICT, "main.c", "-o", "main", "-lm"], cwd=folder, check=True)

    def answers(rows):
        text = "\n".join(f"{lost} " + " ".join(f"{x:.17g}" for x in row) for lost, row in rows)
        done = subprocess.run([folder / "main"], input=text, capture_output=True, text=True, check=True)
        return [line.split() for line in done.stdout.splitlines()]

    return answers


def rows_of(pad, count):
    """Readings of balls and plates, of noise, of nothing that an object explains, and with a cell left out."""
    random = np.random.default_rng(5)
    for kind in KINDS:
        for rise in answer_of(pad, kind, random_objects(pad, kind, count, random)).rise / KPA:
            yield int(random.integers(0, 8)), rise + NOISE_KPA * random.standard_normal(7)
    for _ in range(count // 4):
        yield 0, random.uniform(0.0, 0.6, 7)
        yield 0, NOISE_KPA * random.standard_normal(7)
    yield 0, np.full(7, np.nan)


def test_c_and_python_have_the_same_answers(pad, table, header):
    kinds, seen = ["none", *KINDS, "either", "outside"], set()
    rows = list(rows_of(pad, 200))
    reader = PadForceReader(table)
    reader.tare([[0.0] * 7])
    for (lost, rise), line in zip(rows, header(rows), strict=True):
        reader.used = [k + 1 != lost for k in range(7)]
        found = reader.read(rise.tolist())
        assert kinds.index(found.kind) == int(line[0])
        seen.add(found.kind)
        told = np.array([float(text) for text in line[1:]])
        assert np.allclose(told, found[1:], rtol=1e-5, atol=1e-8, equal_nan=True)
    assert seen == set(kinds)


def test_it_goes_as_the_table_it_was_made_of(pad, table):
    reader, random = PadForceReader(table), np.random.default_rng(6)
    for number, kind in enumerate(KINDS):
        objects = random_objects(pad, kind, 300, random)
        known, off, away, within = answer_of(pad, kind, objects), [], [], []
        for k, at in enumerate(objects.tolist()):
            rises, force, x, y, inside = reader.answer(number, at)
            if known.rise[k].max() > 20.0 * NOISE_KPA * KPA:
                off.append(np.abs(np.array(rises) * KPA - known.rise[k]).max() / known.rise[k].max())
            if known.force[k] > 0.1:
                assert force == pytest.approx(known.force[k], rel=0.05)
                within.append(inside)
                away.append(np.hypot(x - known.centre[k, 0], y - known.centre[k, 1]))
        assert np.sqrt(np.mean(np.square(off))) < 2.0 * STRAIGHT
        # Greatest of small forces at the edge of the pad.
        assert np.median(away) < 0.03 and max(away) < 0.3
        assert np.mean(within) > 0.97


def test_the_zero_follows_readings_without_contact_and_no_others(table):
    reader = PadForceReader(table)
    reader.tare([[0.0] * 7])
    for _ in range(500):
        assert reader.read([0.004] * 7).kind == "none"
    assert reader.zero_kPa == pytest.approx([0.004] * 7, rel=0.02)
    before = list(reader.zero_kPa)
    assert reader.read([0.5, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1]).kind != "none"
    assert reader.zero_kPa == before
