"""Readings of a pad of seven cells against the truth, and of one dome of the same area: ``python -m benchmarks.pads``.

10,000 random contacts that read at least 20 times the noise of the gauges. The dome reads the same balls by the
calibration of its central plate; their places are those that the table of contact anywhere covers.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from benchmarks.store import store, timed
from pneutouch.arrays import Array
from pneutouch.evaluation import evaluate
from pneutouch.export.reader.pad_render import PadReaderSource, pad_reader_files
from pneutouch.mechanics.anywhere.reading import FARTHEST, ball_places, force_logs, state_conditions
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.touch.cell import cell_table
from pneutouch.mechanics.touch.forward import ObjectKind, PadAnswer, PadModel
from pneutouch.mechanics.touch.objects import KINDS, answer_of, random_objects
from pneutouch.mechanics.touch.reader_table import reader_table
from pneutouch.spec.pad import PadTable
from pneutouch.units import KPA
from pneutouch.workflows.pad.fault import pad_reader
from pneutouch.workflows.pad.select_pads import SIMILAR

PITCH, RADIUS, WALL, PRESSURE_KPA, NOISE_KPA, COUNT = 9.0, 2.78, 1.0, 12.0, 0.002, 10_000
CELL = {
    "membrane.inner_radius_mm": RADIUS,
    "membrane.wall_thickness_mm": WALL,
    "connector.seat": "glued-flange-narrow",
    "connector.port": "barb-3x2",
    "connector.mount": "plain",
    "pneumatics.dead_volume_mL": 1.5,
}


def cell_sensor() -> Sensor:
    """The cell of the pad on its flange."""
    return evaluate("paper-dome", CELL, clamp="flange").sensor


def main() -> None:
    table, seconds = timed(lambda: cell_table(cell_sensor(), PRESSURE_KPA * KPA))
    np.savez_compressed(SIMILAR, **{name: values.astype(np.float32) for name, values in table.arrays().items()})
    places = np.array(PadTable(cell="cell", layout="ring:7", pitch_mm=PITCH).places)
    pad = PadModel.alike(places, table, np.ones(len(places)))
    rows = {kind: _row(pad, kind) for kind in KINDS}
    outer = PITCH + RADIUS + WALL
    store("pads", {"contacts": rows, "table_s": seconds, "one_dome": _one_dome(outer), "outer_mm": outer})


def _row(pad: PadModel, kind: ObjectKind) -> dict[str, Any]:
    random, count, noise = np.random.default_rng(1), COUNT // len(KINDS), NOISE_KPA * KPA
    answer = answer_of(pad, kind, random_objects(pad, kind, 2 * count, random))
    loud = np.flatnonzero(answer.rise.max(axis=1) > 20.0 * noise)[:count]
    answer = PadAnswer(*(part[loud] for part in answer))
    rise = answer.rise + noise * random.standard_normal(answer.rise.shape)
    table = reader_table(pad, NOISE_KPA, 1e-4)
    reader = pad_reader(table)
    told, seconds = timed(lambda: [reader.read(row) for row in (rise / KPA).tolist()])
    kinds, force, of_force, x, y, xx, xy, yy, *_ = map(np.array, zip(*told, strict=True))
    known = np.isfinite(force)
    away = (np.column_stack([x, y]) - answer.centre)[known]
    spread = np.linalg.inv(np.stack([xx, xy, xy, yy], axis=-1)[known].reshape(-1, 2, 2) + 1e-12 * np.eye(2))
    error = np.abs(force - answer.force)[known]
    square = np.einsum("mi,mij,mj->m", away, spread, away)
    touched = (answer.forces > 0.01 * answer.force[:, None]).sum(axis=1)
    return {
        "count": len(loud),
        "force_covered": float((error <= 1.96 * of_force[known]).mean()),
        "centre_covered": float((square <= 5.99).mean()),
        "force_error": float(np.median(error / answer.force[known])),
        "centre_error_mm": float(np.median(np.hypot(*away.T))),
        "one_cell": float((touched == 1).mean()),
        "named": float((kinds == kind).mean()),
        "wrong": float(np.isin(kinds, [one for one in KINDS if one != kind]).mean()),
        "outside": float((kinds == "outside").mean()),
        "reading_ms": 1e3 * seconds / len(loud),
        "header_us": _header_us(table, rise / KPA),
    }


def _header_us(table: Mapping[str, Any], rises_kPa: Array) -> float:
    """Microseconds of processor time a reading by the compiled header."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        for file, content in pad_reader_files(table, PadReaderSource("tip", PRESSURE_KPA, None, "", "")).items():
            (folder / file).write_bytes(content)
        rows = ",".join("{" + ",".join(map(repr, row)) + "}" for row in rises_kPa.tolist())
        (folder / "main.c").write_text(_MAIN % rows)
        subprocess.run(["gcc", "-O2", "-std=c99", "main.c", "-o", "main", "-lm"], cwd=folder, check=True)
        return float(subprocess.run([folder / "main"], capture_output=True, text=True, check=True).stdout)


_MAIN = """
#include <stdio.h>
#include <time.h>
#include "tip_reader.h"
static const double rows[][tip_CELLS] = {%s};
int main(void)
{
    const size_t count = sizeof rows / sizeof rows[0];
    tip_reader reader;
    tip_contact contact;
    clock_t begun = clock();
    tip_begin(&reader);
    for (size_t k = 0; k < count; k++) {
        tip_read(&reader, rows[k], &contact);
    }
    printf("%%.3f", 1e6 * (double)(clock() - begun) / CLOCKS_PER_SEC / (double)count);
    return 0;
}
"""


def _one_dome(outer: float) -> dict[str, float]:
    """Error of the force that one dome of the pad's outer radius reads under balls of the same radii."""
    wall = WALL / (RADIUS + WALL) * outer
    changes = {"membrane.inner_radius_mm": outer - wall, "membrane.wall_thickness_mm": wall}
    found = evaluate("paper-dome", {**changes, "pneumatics.driving_pressures_kPa": [PRESSURE_KPA]})
    (state,), point = found.prediction.states, found.prediction.limits.limit_point
    assert point is not None
    domes, size, random = state_conditions(found.sensor, [state], point), outer - wall, np.random.default_rng(1)
    bend = random.uniform(1.0 / (20.0 * RADIUS), 1.0 / RADIUS, COUNT)
    offset: Array = FARTHEST * np.sqrt(random.uniform(0.0, 1.0, COUNT))
    level = np.array([[0.3 * state.range_end / size]])
    logs = force_logs(domes, ball_places(domes.wall_ratio, 1.0 / (bend * size), offset), level)[0, :, 0]
    return {"inner_radius_mm": size, "force_error": float(np.nanmedian(np.abs(np.expm1(-logs))))}


if __name__ == "__main__":
    sys.exit(main())
