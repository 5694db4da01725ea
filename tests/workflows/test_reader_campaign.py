"""A calibrated sensor's header, compiled, on the runs that the calibration did not use: of a resin, of a silicone."""

from __future__ import annotations

import shutil
import subprocess
import tomllib

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.spec.options import CalibrationOptions, SimulationOptions
from pneutouch.spec.toml_text import assignments, toml_text
from pneutouch.workflows.calibrate.calibrate import run_calibration
from pneutouch.workflows.export_reader import make_reader
from pneutouch.workflows.simulate import simulate

UNSEEN_KPA, REST = 9.0, 25
DEAD = {"pneumatics.dead_volume_mL": 0.3}
CAST = {"pneumatics.driving_pressures_kPa": [0.0, 6.0, 12.0]}
FITTED = ["modulus", "wall", "dead-volume", "offset"]

MAIN = """
#include <stdio.h>
#include "held_dome_reader.h"
int main(void)
{
    float rest[25], gauge;
    int k, count;
    while (scanf("%d", &count) == 1) {
        held_dome_reader reader;
        held_dome_begin(&reader);
        for (k = 0; k < 25; k++) {
            if (scanf("%f", &rest[k]) != 1) return 1;
            held_dome_add(&reader, rest[k]);
        }
        held_dome_tare(&reader, 20.0f, HELD_DOME_AMBIENT_KPA);
        for (k = 0; k < count; k++) {
            held_dome_reading reading;
            int status;
            if (scanf("%f", &gauge) != 1) return 1;
            status = (int)held_dome_read(&reader, gauge, 20.0f, HELD_DOME_AMBIENT_KPA, &reading);
            printf("%d %.9g %.9g\\n", status, (double)reading.force_N, (double)reading.uncertainty_N);
        }
    }
    return 0;
}
"""


def presses(path):
    """Gauge pressures at rest before each press, and gauge pressure, force and its noise from contact to the top."""
    _, position, force, pressure = np.genfromtxt(path, delimiter=",", skip_header=2).T
    away = position < -0.2
    for start in np.flatnonzero(away[:-1] & ~away[1:]) + 1:
        rest = slice(start - REST, start)
        # Between presses the rig opens its valve; a press begins at the driving pressure.
        if start < REST or np.ptp(pressure[rest]) > 0.5 or abs(pressure[rest].mean() - UNSEEN_KPA) > 1.0:
            continue
        left = np.flatnonzero(away[start:])
        end = start + (int(left[0]) if left.size else force.size - start)
        top = start + int(np.argmax(force[start:end]))
        noise = float(force[rest].std(ddof=1)) * np.sqrt(1 + 1 / REST)
        yield pressure[rest], pressure[start:top], force[start:top] - force[rest].mean(), noise


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler (gcc) on this machine")
@pytest.mark.parametrize(
    ("design", "changes", "model"), [("paper-dome", DEAD, "atlas"), ("cast-dome", CAST, "solid")], ids=["resin", "cast"]
)
def test_the_compiled_reader_holds_its_uncertainty_on_the_held_out_runs(design, changes, model, tmp_path, monkeypatch):
    """At least 95 % of the samples lie within k = 2. The rig's own zeros drift: both are tared before every press."""
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    options = SimulationOptions(
        specimens=1,
        driving_pressures_kPa=[0.0, 6.0, UNSEEN_KPA, 12.0],
        runs=2,
        kinds=["steps"],
        rate_Hz=20.0,
        seed=1,
        model=model,
    )
    place = simulate(design, tmp_path / "campaign", changes, options)
    content = tomllib.loads((place / "campaign.toml").read_text())
    unseen = [run["file"] for run in content["runs"] if run.get("driving_pressure_kPa", 0.0) == UNSEEN_KPA]
    content["assignments"] = assignments(changes)
    content["runs"] = [run for run in content["runs"] if run["file"] not in unseen]
    (place / "campaign.toml").write_text(toml_text(content))
    run_calibration(place, None, CalibrationOptions(fit=FITTED, save="held"), tmp_path / "fit")
    result = make_reader(evaluate(f"{design}@held", changes, model="auto"))
    assert result.record.grid.force_uncertainty_age_days == 0.0
    header = next(content for name, content in result.files.items() if name.endswith("_reader.h")).decode()
    word = f"{design}-held".replace("-", "_")
    renamed = header.replace(word, "held_dome").replace(word.upper(), "HELD_DOME")
    (tmp_path / "held_dome_reader.h").write_text(renamed)
    (tmp_path / "main.c").write_text(MAIN)
    subprocess.run(["gcc", "-O2", "main.c", "-o", "main"], cwd=tmp_path, check=True)
    every = [press for file in unseen for press in presses(place / file)]
    assert len(every) >= 20
    text = "\n".join(f"{gauge.size} " + " ".join(f"{p:.9g}" for p in (*rest, *gauge)) for rest, gauge, _, _ in every)
    done = subprocess.run([tmp_path / "main"], input=text, capture_output=True, text=True, check=True)
    status, force, standard = np.array([line.split() for line in done.stdout.splitlines()], float).T
    measured = np.concatenate([force for _, _, force, _ in every])
    noise = np.concatenate([np.full(gauge.size, noise) for _, gauge, _, noise in every])
    read = status <= 1
    assert read.mean() > 0.97
    within = np.abs(force - measured) <= 2.0 * np.hypot(standard, noise)
    assert within[read].mean() >= 0.95


@pytest.mark.slow
@pytest.mark.parametrize("design", ["cast-dome", "graded-dome"])
def test_runs_with_their_columns_exchanged_are_not_fitted(design, tmp_path, monkeypatch):
    """Also where the atlas has no prediction to hold them against."""
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    options = SimulationOptions(specimens=1, driving_pressures_kPa=[6.0], runs=2, kinds=["steps"], seed=1)
    place = simulate(design, tmp_path / "campaign", {}, options)
    for path in (place / "runs").glob("*.csv"):
        path.write_text(path.read_text().replace("force_N,pressure_kPa", "pressure_kPa,force_N"))
    with pytest.raises(InputError, match="swapped"):
        run_calibration(place, None, CalibrationOptions(fit=["modulus"]), tmp_path / "fit")
