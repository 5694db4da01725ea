"""``pneutouch predict --for`` as a user meets it."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

import pneutouch as pt
from pneutouch.cli.driving import schedule_text
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.spec.tasks import parse_task
from pneutouch.workflows.driving import driving_record, driving_schedule

ZERO = ("--model", "atlas")


def test_for_answers_with_pressure_band_and_next_step(command):
    done = command("predict", "paper-dome", "--for", "sensitivity=2.1", *ZERO)
    assert done.returncode == 0, done.stderr
    (row,) = (line for line in done.stdout.splitlines() if line.startswith("-  "))
    assert "sensitivity 2.1 kPa/N" in row and " 13.25 " in row
    last = done.stderr.splitlines()[-1]
    assert last == "next: pneutouch predict paper-dome --set 'pneumatics.driving_pressures_kPa=[13.25]'"
    again = command("predict", "paper-dome", "--set", "pneumatics.driving_pressures_kPa=[13.25]", *ZERO, "--json")
    assert json.loads(again.stdout)["states"][0]["sensitivity_kPa_per_N"] == pytest.approx(2.1, rel=1e-3)


def test_only_a_sensor_that_a_fit_covers_is_to_be_calibrated(library):
    task = parse_task("sensitivity=2.1")
    record = driving_record(driving_schedule("paper-dome", [task], library=library, model="atlas"))
    assert record.is_fitted and "calibrate it (pneutouch calibrate)" in schedule_text(record)
    other = schedule_text(replace(record, is_fitted=False))
    assert "no calibration covers such a sensor" in other and "pneutouch calibrate" not in other


SOFT = {"membrane.material": "DragonSkin10", "membrane.inner_radius_mm": 7.0}


@pytest.mark.parametrize(
    ("design", "changes", "model", "what"),
    [("paper-dome", {}, "atlas", "sensitivity=3.5"), ("cast-dome", SOFT, "solid", "force_range=30")],
)
def test_a_design_changed_as_said_has_the_figure_that_is_said(design, changes, model, what, library):
    schedule = driving_schedule(design, [parse_task(what)], changes, library=library, model=model)
    (task,) = driving_record(schedule).tasks
    for one in task.offline:
        changed = changes | {one.what: one.after}
        states = evaluate(design, changed, model=model, library=library).prediction.states
        figures = [state.figures for state in states if state.figures]
        found = [f.sensitivity if what.startswith("sens") else f.force_range[1] for f in figures]
        assert min(abs(value / one.predicted - 1) for value in found) < 0.02, one.what


def test_a_calibrated_sensor_is_not_to_be_calibrated_nor_built_anew(library):
    record = driving_record(
        driving_schedule("paper-dome", [parse_task("sensitivity=2.1")], library=library, model="atlas")
    )
    assert "(pneutouch" not in schedule_text(replace(record, is_calibrated=True))


def test_a_figure_out_of_reach_ends_with_code_1_and_its_range(command):
    done = command("predict", "paper-dome", "--for", "sensitivity=2.5", *ZERO)
    assert done.returncode == 1, done.stderr
    assert "sensitivity by pressure: 1.445 (at 38.8 kPa) to 2.323 (at 0 kPa) kPa/N" in done.stdout
    assert "no driving pressure gives it" in done.stdout
    assert "to change offline: membrane.wall_thickness_mm 1.5 to" in done.stdout
    assert done.stderr.splitlines()[-1] == "next: pneutouch select --sensitivity 2.5 --base paper-dome"


def test_tasks_of_a_file_and_a_leak_give_a_schedule(command, tmp_path):
    (tmp_path / "tasks.csv").write_text("name,stiffness_N_per_mm\nhold,4.2\nfeel,4.6\n")
    (tmp_path / "results.toml").write_text(
        'lab = "Bench"\ndate = 2026-11-21\n[leak-cap.paper-dome]\nstart_kPa = [20.0, 20.1]\nend_kPa = [19.5, 19.6]\n'
    )
    words = ("--tasks", "tasks.csv", "--leak", "results.toml", *ZERO, "--json")
    done = command("predict", "paper-dome", *words)
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert [task["task"] for task in document["tasks"]] == ["hold", "feel"]
    assert document["leak"]["rate_kPa_per_min"] == pytest.approx(0.05)
    assert all(task["gas"]["hold_s"] > 0 for task in document["tasks"])
    assert document["tasks"][1]["gas"]["moved_mL"] < 0
    schedule = pt.load("paper-dome").driving_schedule(
        tmp_path / "tasks.csv", leak=tmp_path / "results.toml", model="atlas"
    )
    assert {**schedule.to_dict(), "leak": None} == {**document, "leak": None}


def test_from_python_one_figure_gives_one_pressure():
    result = pt.load("paper-dome").driving_pressure(stiffness_N_per_mm=4.3, model="atlas")
    low, high = result.band_kPa
    assert result.reached and low <= result.driving_pressure_kPa <= high
    assert "stiffness_N_per_mm=4.3" in repr(result)
    with pytest.raises(pt.InputError, match="no figure is given"):
        pt.load("paper-dome").driving_pressure()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--for", "stif=2"), "error: --for stif=2: unknown figure. Did you mean stiffness?"),
        (("--for", "stiffness=2", "--monte-carlo", "9"), "error: --monte-carlo 9: cannot be given with --for or"),
        (("--leak", "x.toml"), "error: --leak x.toml: needs --for or --tasks"),
        (("--tasks", "none.csv"), "error: none.csv: no such file"),
        (("--for", "stiffness=2", "--leak", "none.toml"), "error: none.toml: no such file"),
        (("--for", "stiffness=2", "--leak", "other.toml"), "error: other.toml: leak-cap.paper-dome: no leak of this"),
        (("--for", "stiffness=2", "--leak", "bad.json"), "error: bad.json: not as characterize writes it"),
    ],
)
def test_wrong_words_are_one_clear_error(command, tmp_path, words, message):
    (tmp_path / "other.toml").write_text(
        'lab = "B"\ndate = 2026-11-21\n[leak-cap.long-tube]\nstart_kPa = [2, 2]\nend_kPa = [1, 1]\n'
    )
    (tmp_path / "bad.json").write_text("[]")
    done = command("predict", "paper-dome", *words, *ZERO)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.splitlines()[-1].startswith(message)
