"""Soft objects in a design: its keys, what is refused, and what a prediction says of them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.result import predicted
from tests.running import in_process

ROOT = Path(__file__).resolve().parents[2]
SOFT = {"contact.object_modulus_MPa": 0.1, "pneumatics.driving_pressures_kPa": [0.0, 12.0]}
NODULE = {"contact.nodule_depth_mm": 6.0, "contact.nodule_radius_mm": 3.0, "contact.nodule_modulus_MPa": 2.0}
FEW = {"indentation.steps": 8}


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"contact.object_thickness_mm": 3.0}, "object_thickness_mm"),
        ({"contact.object_poisson_ratio": 0.3}, "object_poisson_ratio"),
        ({**SOFT, "contact.friction": 0.5}, "object_modulus_MPa"),
        ({**SOFT, "contact.offset_mm": 1.0}, "object_modulus_MPa"),
        ({**SOFT, "contact.anywhere": True}, "object_modulus_MPa"),
        ({**SOFT, "contact.plate_rim_mm": 1.0}, "object"),
        (
            {**SOFT, "contact.object": "cone", "contact.cone_half_angle_deg": 60.0, "contact.cone_tip_radius_mm": 2.0},
            "object",
        ),
        (
            {**SOFT, "contact.object": "ball", "contact.ball_radius_mm": 8.0, "contact.object_thickness_mm": 3.0},
            "object",
        ),
        ({"contact.object_modulus_MPa": 1e-4}, "object_modulus_MPa"),
        ({"contact.nodule_depth_mm": 5.0}, "nodule_depth_mm"),
        ({**SOFT, "contact.nodule_depth_mm": 5.0}, "nodule_radius_mm"),
        ({**SOFT, **NODULE, "contact.object_thickness_mm": 20.0}, "object_thickness_mm"),
        ({**SOFT, **NODULE, "contact.nodule_depth_mm": 4.0}, "nodule_depth_mm"),
        ({**SOFT, **NODULE, "contact.nodule_modulus_MPa": 0.05}, "nodule_modulus_MPa"),
    ],
)
def test_what_no_soft_object_has_is_refused_with_its_key(change, key):
    with pytest.raises(InputError) as error:
        evaluate("paper-dome", change, model="solid")
    assert key in f"{error.value.key} {error.value}"


def test_the_record_says_what_the_object_is_made_of():
    evaluation = evaluate("paper-dome", SOFT | FEW, model="solid")
    record = predicted(evaluation)
    assert record.contact["object_modulus_MPa"] == 0.1 and record.contact["object_poisson_ratio"] == 0.49
    assert record.contact["label"] == "soft block (0.1 MPa)"
    assert not any(text.startswith("rigid") for text in evaluation.prediction.assumptions)
    assert any("elastic" in text for text in evaluation.prediction.assumptions)
    state = evaluation.prediction.states[0]
    # The surface follows the wall, and is flat far away.
    section = state.shapes[-1].body
    assert np.ptp(section[-5:, 1]) < 0.3 and section[0, 1] > section[-1, 1] + 0.2
    assert state.face is None


def test_a_nodule_presses_back():
    plain, hard = (
        evaluate("paper-dome", SOFT | FEW | more, model="solid").prediction.states[0] for more in ({}, NODULE)
    )
    for travel in (1.0, 2.0, 3.0):
        less, more = (np.interp(travel, one.indentation, one.force) for one in (plain, hard))
        assert 1.005 * less < more < 1.2 * less


def test_other_models_and_fits_say_why_not():
    for model in ("membrane", "atlas", "local", "harmonic"):
        with pytest.raises(InputError, match="soft"):
            evaluate("paper-dome", SOFT | FEW, model=model)
    with pytest.raises(InputError) as error:
        evaluate("paper-dome", SOFT | FEW, model="auto", tolerance=0.01)
    assert error.value.key == "tolerance"
    chosen = evaluate("paper-dome", SOFT | FEW, model="auto").prediction
    assert chosen.model == "solid" and re.search(r"meets 3\.0% \(", chosen.error_estimate.model_choice)


def test_travel_tells_a_soft_object_and_the_pressure_says_little():
    """At one force the rise under a block of 0.1 MPa is within a tenth of that under a plate, at twice the travel."""
    soft, rigid = (
        evaluate("paper-dome", change | FEW, model="solid").prediction.states[0]
        for change in (SOFT, {"pneumatics.driving_pressures_kPa": [0.0, 12.0]})
    )
    at = 0.3
    rises = [np.interp(at, one.force, one.pressure_rise) for one in (soft, rigid)]
    travels = [np.interp(at, one.force, one.indentation) for one in (soft, rigid)]
    assert rises[0] == pytest.approx(rises[1], rel=0.15) and travels[0] > 1.2 * travels[1]


def test_the_command_prints_a_soft_object_s_range_and_no_relaxation(tmp_path):
    asked = ["predict", "agilus-dome", "--set", "contact.object_modulus_MPa=0.02", "--set", "indentation.steps=8"]
    done = in_process(asked, tmp_path)
    assert done.returncode == 0, done.stderr
    assert re.search("object strained, [0-9.]+ mm", done.stdout)
    assert re.search("hysteresis not known: the object is a soft", done.stdout)


def test_a_nodule_adds_the_force_that_calculix_finds():
    stored = json.loads((ROOT / "docs/background/soft-objects.json").read_text(encoding="utf-8"))
    page = (ROOT / "docs/background/contact.md").read_text(encoding="utf-8")
    bound = float(re.search(r"the force that the nodule adds is within (\d+) % from 0.5 mm", page)[1]) / 100.0
    plain, hard = stored["nodules"]
    seen = np.array(plain["travel_mm"]) >= 0.5
    ours, there = (np.array(hard[key])[seen] - np.array(plain[key])[seen] for key in ("force_N", "calculix_force_N"))
    assert (there > 0.0).all() and np.abs(ours / there - 1.0).max() <= bound


def test_the_page_states_what_calculix_found():
    """The page's bounds hold for every point within the range of the stored comparison."""
    stored = json.loads((ROOT / "docs/background/soft-objects.json").read_text(encoding="utf-8"))
    page = (ROOT / "docs/background/contact.md").read_text(encoding="utf-8")
    found = re.search(r"force within ([\d.]+) %, rise within ([\d.]+) % of the scene's greatest", page)
    force, rise = (float(one) / 100.0 for one in found.groups())
    assert len(stored["scenes"]) == 8
    for scene in stored["scenes"]:
        inside = (np.array(scene["strain"]) <= 1.0) & np.isfinite(np.array(scene["calculix_force_N"], dtype=float))
        assert inside.sum() >= 5, scene
        ours, there = (np.array(scene[key], dtype=float)[inside] for key in ("force_N", "calculix_force_N"))
        assert np.abs(ours / there - 1.0).max() <= force, scene
        ours, there = (np.array(scene[key], dtype=float)[inside] for key in ("rise_kPa", "calculix_rise_kPa"))
        assert np.abs(ours - there).max() <= rise * ours[-1], scene
