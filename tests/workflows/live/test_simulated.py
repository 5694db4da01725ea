"""A simulated device at a pseudo-terminal: its force is read within its interval, and its runs are those of a rig."""

from __future__ import annotations

import itertools
import json

import numpy as np
import pytest

pytest.importorskip("serial")

from pneutouch.errors import InputError
from pneutouch.spec.campaign import campaign_of
from pneutouch.workflows.live.planned import PlanRuns, RunSteps
from pneutouch.workflows.live.recording import FreeCampaign
from pneutouch.workflows.live.running import live_run
from pneutouch.workflows.live.sensor import live_sensor
from tests.conftest import ROOT
from tests.running import in_process
from tests.workflows.live.devices import wait_for
from tests.workflows.live.test_session import read_rows

FAST = "simulated:100"

AT = "pneumatics.driving_pressures_kPa=[0,12]"


@pytest.fixture(scope="module")
def sensor():
    return live_sensor("paper-dome")


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    """A plan of the paper's sensor at two driving pressures."""
    out = tmp_path_factory.mktemp("plan")
    words = ["plan", "paper-dome", "--specimens", "1", "--set", AT]
    assert in_process([*words, "--out", str(out)], out).returncode == 0
    return out / "paper-dome-plan"


def test_the_force_is_read_within_its_interval_as_the_force_sensor_beside_it_has_it(sensor):
    with live_run(sensor, FAST, pressure_kPa=5.0) as running:
        wait_for(lambda: running.session.samples > 6000)
        points = running.session.since(0)
        state = running.session.state
    assert state.device == "paper-dome" and state.lost == state.damaged == 0
    assert state.driving_pressures_kPa[0] == pytest.approx(5.0, abs=0.1)
    read = [(one.reading, one.sample.force_N) for one in points if one.reading and one.sample.force_N > 0.5]
    assert len(read) > 200
    inside = [abs(reading.force_N - force) < 2 * reading.uncertainty_N + 0.1 for reading, force in read]
    assert np.mean(inside) > 0.99


def test_a_leak_and_touches_are_in_what_it_sends(sensor):
    with live_run(sensor, FAST, pressure_kPa=22.0) as running:
        wait_for(lambda: running.session.samples > 20_000)
        points = running.session.since(0)
    free = [one.sample.pressures_kPa[0] for one in points if one.sample.position_mm < 0.0]
    touched = [one.sample.pressures_kPa[0] for one in points if one.sample.force_N > 1.0]
    # 20,000 samples at 100 Hz leak for 200 s.
    assert np.mean(free) < 22.0 - 1e-3 and touched and min(touched) > np.mean(free)
    assert np.std(free) > 1e-3


def test_the_runs_of_a_plan_are_recorded_into_its_files_and_read_as_they_are(sensor, plan, tmp_path):
    runs = PlanRuns.of(plan)
    with live_run(sensor, FAST) as running:
        # The whole plan takes hours of the device: what a calibration needs.
        wanted = [one for one in runs.recordable if one.kind in ("steps", "loop") and one.run == 1]
        for one in wanted:
            running.record_run(runs, one)
            wait_for(running.advance)
            recorded = read_rows(plan / one.file)
            assert float(recorded[-1]["time_s"]) == pytest.approx(one.duration_s, abs=0.02)
            assert len(recorded) == pytest.approx(100 * one.duration_s, abs=3)
    assert campaign_of(plan)[0].simulated
    assert {one.number for one in wanted}.isdisjoint({one.number for one in runs.open})
    measured = in_process(["characterize", str(plan), "--out", str(tmp_path), "--json"], tmp_path)
    # Files that are still to be recorded are told, and the figures are there.
    assert measured.returncode == 3
    figures = {one["driving_pressure_kPa"]: one for one in json.loads(measured.stdout)["groups"]}
    predicted = json.loads(in_process(["predict", "paper-dome", "--json", "--set", AT], tmp_path).stdout)
    for state in predicted["states"]:
        figure = figures[state["driving_pressure_kPa"]]["figures"]["sensitivity_kPa_per_N"]
        assert figure["value"] == pytest.approx(state["sensitivity_kPa_per_N"], rel=0.06)
    with pytest.raises(InputError):
        running.record_run(runs, wanted[0])


def test_simulated_and_measured_runs_are_never_in_one_campaign(sensor, plan):
    runs = PlanRuns.of(plan)
    runs.check_source(simulated=True)
    with pytest.raises(InputError) as error:
        runs.check_source(simulated=False)
    assert error.value.key == "simulated"
    with pytest.raises(InputError) as error:
        runs.check_design("agilus-dome")
    assert error.value.key == "plan"


def test_a_run_that_is_cut_short_stays_open(sensor, tmp_path):
    words = ["plan", "paper-dome", "--specimens", "1", "--set", AT, "--out", str(tmp_path)]
    assert in_process(words, tmp_path).returncode == 0
    runs = PlanRuns.of(tmp_path / "paper-dome-plan")
    # As long as nothing was recorded it may be one or the other.
    runs.check_source(simulated=True)
    runs.check_source(simulated=False)
    one = next(run for run in runs.open if run.kind == "steps")
    with live_run(sensor, FAST) as running:
        for number in (1, 2):
            running.record_run(runs, one)
            wait_for(lambda: running.session.recorded() > 40.0)
            kept = running.stop()
            assert kept.name.endswith(f".cut-{number}.csv") and len(read_rows(kept)) > 4000
    assert one in runs.open and campaign_of(runs.folder)[0].simulated
    (runs.folder / runs.runs[-1].file).write_text("mine")
    with pytest.raises(InputError):
        runs.check_source(simulated=False)


def test_a_recording_without_a_zero_states_no_driving_pressure(sensor, tmp_path):
    free = FreeCampaign(tmp_path, "paper-dome", (), simulated=True)
    with live_run(sensor, "simulated", pressure_kPa=12.0) as running:
        running.record_free(free)
        wait_for(lambda: running.session.recorded() > 0.5)
        running.stop()
        wait_for(lambda: running.session.tared)
        running.record_free(free)
        wait_for(lambda: running.session.recorded() > 0.5)
    first, second = campaign_of(tmp_path)[0].runs
    assert "driving_pressure_kPa" not in first.model_fields_set
    assert second.driving_pressure_kPa == pytest.approx(12.0, abs=0.1)


def test_steps_follow_the_plan_and_the_zero_is_taken_before_each_press(plan):
    for planned in PlanRuns.of(plan).recordable:
        steps = RunSteps(planned)
        assert steps.before_s + steps.seconds == pytest.approx(planned.duration_s)
        times = np.arange(0.0, steps.seconds, 0.05)
        words = [steps.at(float(time))[0] for time in times]
        zero = [steps.zero(float(time)) for time in times]
        begun = [len(list(group)) for on, group in itertools.groupby(zero) if on]
        presses = [key for key, _ in itertools.groupby(words) if key.startswith("press to")]
        rests = sum(1 for step in planned.steps if step.action in ("wait", "set_pressure"))
        assert begun and len(begun) <= rests
        if planned.kind == "leak":
            assert steps.before and begun == [40]
        else:
            assert len(begun) == len(presses) and min(begun) >= 19
        assert not any(on for on, said in zip(zero, words, strict=True) if said.startswith(("press", "hold")))
        assert steps.at(steps.seconds + 1.0) == ("done", 0.0)


def test_recordings_without_a_plan_are_runs_of_a_campaign(sensor, tmp_path):
    folder = tmp_path / "mine"
    free = FreeCampaign(folder, "paper-dome", (), simulated=True)
    with live_run(sensor, FAST) as running:
        for _ in range(2):
            running.record_free(free)
            wait_for(lambda: running.session.recorded() > 30.0)
            running.stop()
    (folder / "campaign.toml").write_text((folder / "campaign.toml").read_text() + "# mine\n")
    campaign, _ = campaign_of(folder)
    assert [one.file for one in campaign.runs] == ["runs/live-1.csv", "runs/live-2.csv"] and campaign.simulated
    assert [one.run for one in campaign.runs] == [1, 2]
    measured = in_process(["characterize", str(folder), "--out", str(tmp_path), "--json"], tmp_path)
    assert measured.returncode == 0, measured.stderr
    with pytest.raises(InputError) as error:
        FreeCampaign(folder, "agilus-dome", (), simulated=True).check()
    assert error.value.file == str(folder / "campaign.toml")
    with pytest.raises(InputError):
        FreeCampaign(folder, "paper-dome", (), simulated=False).check()


def test_a_run_whose_range_ends_early_goes_on_untouched_to_its_planned_end(tmp_path):
    """Without that the touches of a device that is left alone would be presses of the run."""
    words = ["plan", "fingertip-dome", "--specimens", "1", "--set", AT, "--out", str(tmp_path)]
    assert in_process(words, tmp_path).returncode == 0
    runs = PlanRuns.of(tmp_path / "fingertip-dome-plan")
    one = next(run for run in runs.recordable if run.kind == "saturation" and run.driving_pressure_kPa == 12.0)
    planned = sum(step.action == "move" and step.value > 0.0 for step in one.steps)
    rows = np.array(list(live_sensor("fingertip-dome").rig(12.0).run(one)))
    presses = int((np.diff(np.r_[False, rows[:, 0] > 0.0].astype(int)) == 1).sum())
    assert 3 < presses < planned
    assert len(rows) >= 100 * RunSteps(one).seconds
    assert np.isfinite(rows).all() and abs(rows[-1, 2] - 12.0) < 0.5


def test_a_design_given_by_its_path_is_copied_beside_its_recordings(tmp_path):
    (tmp_path / "mine.toml").write_text((ROOT / "designs/paper-dome.toml").read_text())
    words = ["live", "./mine.toml", "--port", "simulated:20", "--record", "rec", "--seconds", "40"]
    assert in_process(words, tmp_path).returncode == 0
    measured = in_process(["characterize", "rec", "--json"], tmp_path)
    assert measured.returncode == 0, measured.stderr
    assert in_process(words, tmp_path).returncode == 0
    assert len(campaign_of(tmp_path / "rec")[0].runs) == 2


@pytest.mark.slow
def test_a_recorded_campaign_is_calibrated(sensor, plan, tmp_path, monkeypatch):
    runs = PlanRuns.of(plan)
    monkeypatch.setenv("PNEUTOUCH_HOME", str(tmp_path))
    with live_run(sensor, FAST) as running:
        for one in runs.open:
            if one.kind in ("steps", "loop"):
                running.record_run(runs, one)
                wait_for(running.advance)
    done = in_process(["calibrate", str(plan), "--save", "live", "--json"], tmp_path)
    # The plan has runs that are still to be recorded.
    assert done.returncode == 3, done.stderr
    fitted = json.loads(done.stdout)
    assert fitted["calibration"] is not None
    live_sensor("paper-dome@live", {"pneumatics.driving_pressures_kPa": [0, 12]})
