"""A pad measured: presses planned, simulated, read back and fitted to the truth; faults of a rig named; its reader."""

from __future__ import annotations

import importlib.util
import json
import re

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.mechanics.touch.forward import PadModel
from pneutouch.output.new_pad import new_pad
from pneutouch.workflows.pad import campaign, measured
from pneutouch.workflows.pad.load import load_pad
from pneutouch.workflows.pad.touch import calibrated_model, pad_model
from tests.pads import coarse_home
from tests.running import in_process

CHANGED = "pneumatics.driving_pressures_kPa"
AT = f"{CHANGED}=[0,12]"


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    """A home with a pad of three cells, tabulated by coarse presses."""
    with coarse_home(tmp_path_factory) as folder:
        new_pad("tip", folder / "designs", "row:3", 9.0)
        new_pad("other", folder / "designs", "row:3", 10.0)
        yield folder


@pytest.fixture(scope="module")
def plan(home):
    changes = {"pneumatics.driving_pressures_kPa": [0.0, 12.0]}
    return campaign.plan_pad(load_pad("tip", changes)), changes


@pytest.fixture
def folder(plan, tmp_path):
    return campaign.simulate_pad(plan[0], tmp_path, 4, plan[1])


def changed(path, change):
    """Rewrite a recording, its columns by name."""
    head, table = path.read_text().split("\n", 1)
    columns = dict(zip(head.split(","), np.loadtxt(table.splitlines(), delimiter=",").T, strict=True))
    change(columns)
    rows = np.column_stack(list(columns.values()))
    np.savetxt(path, rows, delimiter=",", header=",".join(columns), comments="")


def test_presses_are_on_every_cell_and_between_neighbours_within_the_range(plan):
    presses, places = plan[0].presses, plan[0].model.places
    away = np.hypot(*(presses[:, None, :2] - places).transpose(2, 0, 1)).min(axis=1)
    assert len(presses) == 15 and (away < 4.6).all() and (away < 1.5).sum() == 9
    assert plan[0].answer.inside.all() and (plan[0].answer.force > 0.0).all()


def test_presses_on_a_larger_dome_are_as_far_beside_its_axis(plan, monkeypatch):
    own = plan[0].model
    mixed = PadModel(3.0 * own.places, (own.table, own.table.scaled(2.6)), np.array([0, 1, 0]), own.gain)
    monkeypatch.setattr(campaign, "pad_model", lambda *given: mixed)
    made = campaign.plan_pad(plan[0].pad)
    assert made.radius >= mixed.radii[0] and made.highest == 2
    for place, table in zip(mixed.places, mixed.of_cells("radius"), strict=True):
        away = np.sort(np.hypot(*(made.presses[:, :2] - place).T))
        assert away[:3] == pytest.approx([0.5 * table] * 3, abs=0.02)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_the_fit_finds_what_was_simulated(plan, tmp_path, seed):
    made = campaign.simulate_pad(plan[0], tmp_path, seed, plan[1])
    truth = json.loads((made / "pad-truth.json").read_text())
    fit = measured.fitted(measured.read_campaign(made))
    assert abs(fit.force_factor - truth["force_factor"]) < 3.5 * fit.of_force_factor
    assert (np.abs(fit.rise_factors - truth["rise_factors"]) < 3.5 * fit.of_rise_factors).all()
    assert np.allclose(fit.shift, truth["stage_zero_mm"], atol=0.1)
    assert fit.of_force_factor < 0.07 and fit.rise_error < 0.04


def test_pads_are_compared_with_pads(home, tmp_path):
    shown = in_process(["compare", "tip", "other", "--set", AT], tmp_path)
    rows = [re.split(r" {2,}", line) for line in shown.stdout.splitlines()]
    assert shown.returncode == 0 and rows[0][1:] == ["tip", "other"]
    values = {key: [float(text.replace(",", " ").split()[0]) for text in texts] for key, *texts in rows[1:]}
    assert values["pitch, mm"] == [9.0, 10.0] and values["mass, g"][0] < values["mass, g"][1]
    places = next(value for key, value in values.items() if "place" in key)
    assert 0.0 < places[0] < places[1]
    assert in_process(["compare", "tip", "paper-dome"], tmp_path).returncode == 2


def test_presses_by_hand_alone_give_the_force(plan, folder):
    file = folder / campaign.PAD_CAMPAIGN
    text = file.read_text()
    first, _, rest = text.partition("[[runs]]")
    file.write_text(first + "[[runs]]" + rest.partition("[[runs]]")[2])
    read = measured.read_campaign(folder)
    assert read.readings.by_hand.all()
    fit, truth = measured.fitted(read), json.loads((folder / "pad-truth.json").read_text())
    ratio = fit.force_factor / np.mean(fit.rise_factors), truth["force_factor"] / np.mean(truth["rise_factors"])
    assert ratio[0] == pytest.approx(ratio[1], rel=0.1)


def test_swapped_channels_are_named(folder):
    def swap(columns):
        columns["pressure_1_kPa"], columns["pressure_3_kPa"] = columns["pressure_3_kPa"], columns["pressure_1_kPa"]

    changed(folder / "runs/stage.csv", swap)
    with pytest.raises(InputError) as caught:
        measured.fitted(measured.read_campaign(folder))
    assert caught.value.key == "pressure_1_kPa" and caught.value.problem.count("reads") == 2


def test_a_cell_that_leaks_is_named(folder):
    changed(folder / "runs/stage.csv", lambda columns: columns["pressure_2_kPa"].fill(12.0))
    changed(folder / "runs/hand.csv", lambda columns: columns["pressure_2_kPa"].fill(12.0))
    with pytest.raises(InputError) as caught:
        measured.fitted(measured.read_campaign(folder))
    assert caught.value.key == "pressure_2_kPa" and "leaks" in caught.value.problem


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda columns: columns.pop("pressure_2_kPa"), "pressure_2_kPa"),
        (lambda columns: columns.pop("depth_mm"), "depth_mm"),
        (lambda columns: columns["force_N"].fill(0.0), "contact"),
        (lambda columns: columns["force_N"].fill(1.0), "contact"),
    ],
)
def test_a_recording_that_cannot_be_used_names_file_and_column(folder, change, words):
    changed(folder / "runs/stage.csv", change)
    with pytest.raises(InputError, match=words) as caught:
        measured.read_campaign(folder)
    assert "stage.csv" in str(caught.value)


def test_from_the_plan_to_the_reader_at_the_first_try(home, tmp_path):
    for words, wanted in [
        (["plan", "tip", "--set", AT], "outputs/tip-plan"),
        (["simulate", "outputs/tip-plan", "--seed", "3"], "outputs/tip-campaign"),
        (["characterize", "outputs/tip-campaign"], "outputs/tip-figures"),
        (["calibrate", "outputs/tip-campaign", "--save", "mine", "--force"], str(home / "calibrations/pads/mine.toml")),
        (["export-reader", "tip", "--calibration", "mine", "--set", AT], "outputs/tip-reader"),
    ]:
        result = in_process(words, tmp_path)
        assert result.returncode == 0 and wanted in result.stdout, result.stderr
    truth = json.loads((tmp_path / "outputs/tip-campaign/pad-truth.json").read_text())
    changes = {"pneumatics.driving_pressures_kPa": [0.0, 12.0]}
    model, _ = calibrated_model(load_pad("tip", changes), "mine")
    bare = pad_model(load_pad("tip", changes), 12.0)
    press = np.array([[0.5, 0.5]]), np.array([6.0]), np.array([1.2])
    assert model.under_balls(*press).force[0] / bare.under_balls(*press).force[0] == pytest.approx(
        truth["force_factor"], rel=0.06
    )
    bent = model.under_balls(*press).rise / np.maximum(bare.under_balls(*press).rise, 1e-12)
    assert bent[0, 1] == pytest.approx(truth["rise_factors"][1], abs=0.08)
    assert np.allclose(model.gain / bare.gain, truth["rise_factors"], atol=0.1)
    assert not np.allclose(model.gain, bare.gain, atol=1e-3)
    spec = importlib.util.spec_from_file_location("tip_reader", tmp_path / "outputs/tip-reader/tip_reader.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    reader = module.PadForceReader(module.TABLE)
    reader.tare([[12.0] * 3] * 10)
    pressed = model.under_plates(np.array([[0.02, 0.0]]), np.array([1.0]))
    contact = reader.read((12.0 + 1e3 * pressed.rise[0]).tolist())
    assert contact.force_N == pytest.approx(pressed.force[0], abs=3.0 * contact.uncertainty_N)
    assert abs(contact.x_mm - pressed.centre[0, 0]) < 3.0 * contact.xx_mm2**0.5


def test_what_is_not_of_this_pad_is_refused(home, folder, tmp_path):
    fit = measured.read_campaign(folder)
    from pneutouch.workflows.pad.measured_files import save_calibration

    kept = measured.calibration_of(fit, measured.fitted(fit))
    assert save_calibration(kept, "first", replace=False) == save_calibration(kept, "first", replace=False)
    with pytest.raises(InputError, match="content"):
        save_calibration(kept.model_copy(update={"force_factor": 1.5}), "first", replace=False)
    with pytest.raises(InputError, match="elsewhere"):
        calibrated_model(load_pad("other"), "first")
    with pytest.raises(InputError, match="groups"):
        calibrated_model(load_pad("tip", {"pad.groups": [{"cells": [2], "driving_pressure_kPa": 5.0}]}), "first")
    for words in (
        ["plan", "tip", "--specimens", "2"],
        ["plan", "tip", "--calibration", "first"],
        ["plan", "tip", "--json"],
        ["characterize", str(folder), "--set", AT],
        ["export-reader", "tip", "--json"],
    ):
        result = in_process(words, tmp_path)
        assert result.returncode == 2 and words[2] in result.stderr


@pytest.mark.parametrize(
    ("key", "scale"), [("force_N", 9.80665), ("pressure", 6.894757), ("depth_mm", -1.0), ("pressure", 0.145)]
)
def test_another_unit_or_sign_is_refused_and_not_fitted(folder, key, scale):
    def change(columns):
        for name in columns:
            if name.startswith(key):
                columns[name] *= scale

    for run in ("stage", "hand") if key != "depth_mm" else ("stage",):
        changed(folder / f"runs/{run}.csv", change)
    with pytest.raises(InputError) as caught:
        measured.fitted(measured.read_campaign(folder))
    assert caught.value.remedy or key == "depth_mm"


def test_a_pad_given_by_its_path_is_found_again(home, tmp_path):
    place = tmp_path / "elsewhere.toml"
    place.write_text((home / "designs/pads/tip.toml").read_text())
    made = campaign.simulate_pad(campaign.plan_pad(load_pad(str(place), {CHANGED: [0.0, 12.0]})), tmp_path, 1)
    file = made / campaign.PAD_CAMPAIGN
    file.write_text(file.read_text().replace("assignments = []", f"assignments = ['{AT}']"))
    assert measured.read_campaign(made).pad.name == "elsewhere"


def test_a_name_that_no_file_can_have_is_none_of_a_pad(tmp_path):
    assert in_process(["characterize", "a" * 300], tmp_path).returncode == 2
