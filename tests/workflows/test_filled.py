"""States by injected gas along the whole path: prediction, Python, datasheet, sweep, and the commands that need pressure."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
import xarray

import pneutouch as pt
from pneutouch.evaluation.charts import tuning
from pneutouch.units import KPA
from tests.running import in_process

FILLED = "pneumatics.injected_volumes_mL"


@pytest.fixture(scope="module")
def prediction():
    return pt.load("paper-dome").replace(injected_volumes_mL=[1.0, 5.0, 7.0]).predict([0, 12])


def test_python_json_and_command_have_the_same_states(prediction, tmp_path):
    done = in_process(["predict", "paper-dome", "--set", f"{FILLED}=[1, 5, 7]", "--json"], tmp_path)
    said = json.loads(done.stdout)
    mine = prediction.to_dict()["filled"]
    assert [s["held"]["injected_volume_mL"] for s in said["filled"]] == pytest.approx([1, 5, 7], rel=1e-9)
    for ours, theirs, state in zip(mine, said["filled"], prediction.filled, strict=True):
        assert ours["sensitivity_kPa_per_N"] == theirs["sensitivity_kPa_per_N"] == state.sensitivity_kPa_per_N
    assert [s["held"]["stable_regulated"] for s in mine] == [True, True, False]
    # The states at driving pressures are those without any filling.
    plain = pt.load("paper-dome").predict([0, 12]).to_dict()["states"]
    assert prediction.to_dict()["states"] == plain


def test_the_chart_of_tuning_goes_on_beyond_the_limit_point(prediction):
    chart = tuning(prediction.evaluation, 0.02)
    pressures, values = np.array(chart.filled_kPa_per_N).T
    limit = prediction.evaluation.prediction.limits.limit_point / KPA
    assert pressures[1] > pressures[2] and max(pressures) < limit
    assert (np.diff(values) < 0.0).all()


def test_a_sweep_over_injected_gas_has_the_states_that_predict_has(prediction, tmp_path):
    done = in_process(["sweep", "paper-dome", "--over", f"{FILLED}=1,5,7", "--out", "gas.nc"], tmp_path)
    assert done.returncode == 0, done.stderr
    with xarray.open_dataset(tmp_path / "gas.nc") as data:
        swept = data.filled_sensitivity_kPa_per_N.values
        stable = data.filled_stable_regulated.values
    assert swept == pytest.approx([s.sensitivity_kPa_per_N for s in prediction.filled], rel=1e-8)
    assert stable.tolist() == [1.0, 1.0, 0.0]


def test_a_sweep_of_several_states_a_point_is_refused_with_what_works(tmp_path):
    over = ["sweep", "paper-dome", "--over", "membrane.wall_thickness_mm=1.5", "--out", "a.nc"]
    done = in_process([*over, "--set", f"{FILLED}=[1, 5]"], tmp_path)
    assert done.returncode == 2 or done.returncode == 1
    named = done.stderr.split("--over ")[-1].split()[0]
    again = in_process([*over, "--over", named], tmp_path)
    assert again.returncode == 0, again.stderr


def test_a_sweep_over_a_filling_prints_the_states_of_that_filling(prediction, tmp_path):
    done = in_process(["sweep", "paper-dome", "--over", f"{FILLED}=1,5,7", "--out", "gas.nc"], tmp_path)
    head, *rows = (re.split(" {2,}", line) for line in done.stdout.splitlines()[:4])
    shown = [dict(zip(head, row, strict=True)) for row in rows]
    for row, state in zip(shown, prediction.filled, strict=True):
        assert float(row["S kPa/N"]) == pytest.approx(float(state.sensitivity_kPa_per_N), abs=6e-4)
        assert float(row["kPa"]) == pytest.approx(float(state.driving_pressure_kPa), abs=6e-4)


def test_a_sweep_over_two_fillings_is_refused(tmp_path):
    over = ["--over", f"{FILLED}=1,2", "--over", "pneumatics.apex_heights_mm=11,12"]
    done = in_process(["sweep", "paper-dome", *over, "--out", "two.nc"], tmp_path)
    assert done.returncode == 2 and not (tmp_path / "two.nc").exists()


def test_a_sweep_may_vary_the_filling_of_a_design_that_states_several(tmp_path):
    pt.load("paper-dome").replace(injected_volumes_mL=[0.5, 1.0]).save(tmp_path / "two.toml")
    done = in_process(["sweep", "--design", "two.toml", "--over", f"{FILLED}=1,2", "--out", "a.nc"], tmp_path)
    assert done.returncode == 0, done.stderr


def test_a_sweep_into_a_vacuum_keeps_the_pressures_that_hold(tmp_path):
    words = ["sweep", "paper-dome", "--over", "membrane.wall_thickness_mm=1.5", "--out", "vacuum.nc"]
    assert in_process([*words, "--set", "pneumatics.driving_pressures_kPa=[-40, -5, 12, 80]"], tmp_path).returncode == 0
    with xarray.open_dataset(tmp_path / "vacuum.nc") as data:
        assert data.status.values.ravel().tolist() == ["refused", "ok", "ok", "refused"]


@pytest.mark.parametrize("command", ["plan", "simulate", "export-reader"])
def test_commands_of_a_rig_refuse_a_vacuum_and_leave_nothing(command, tmp_path):
    words = [command, "paper-dome", "--set", "pneumatics.driving_pressures_kPa=[-5, 0]", "--out", "made"]
    done = in_process(words, tmp_path)
    assert done.returncode != 0 and "pneumatics.driving_pressures_kPa[0]" in done.stderr
    assert not (tmp_path / "made").exists()


def test_a_vacuum_that_the_dome_does_not_bear_names_the_one_it_does(tmp_path):
    words = ["predict", "paper-dome", "--set"]
    done = in_process([*words, "pneumatics.driving_pressures_kPa=[-30]"], tmp_path)
    least = float(done.stderr.split()[-2])
    assert in_process([*words, f"pneumatics.driving_pressures_kPa=[{least}]"], tmp_path).returncode == 0
    assert in_process([*words, f"pneumatics.driving_pressures_kPa=[{least - 0.05}]"], tmp_path).returncode != 0
