"""A calibration as a document and as files that every other command takes."""

from __future__ import annotations

import json
import re
import tomllib
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.bench.calibrate import Observations
from pneutouch.bench.record import MeasuredCurve
from pneutouch.catalogue import Library, load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate, sensor_of
from pneutouch.output.files import json_bytes
from pneutouch.parts import assemble
from pneutouch.spec.campaign import Campaign, CampaignRun
from pneutouch.units import KPA
from pneutouch.workflows.calibrate.files import HEAD, prepare, save, write_calibration
from pneutouch.workflows.calibrate.fit import calibrate, observations_of
from tests.bench.calibrate.sensors import curves, injections

TRUTH = {"shear_modulus": 0.21, "dead_volume": 400.0}


@pytest.fixture(scope="module")
def scene(library):
    return load_scene("paper-dome", {"pneumatics.dead_volume_mL": 0.3}, library)


@pytest.fixture(scope="module")
def observations(scene):
    truth = sensor_of(assemble(scene)).replace(break_stretch=None, **TRUTH)
    rng = np.random.default_rng(21)
    pushed = injections(truth, np.linspace(100, 1500, 10), 1, rng)
    return Observations(curves(truth, (0.0, 12.0, 22.0), 3, rng, 0.004), pushed)


@pytest.fixture(scope="module")
def found(observations, scene):
    names = ("modulus", "wall", "dead-volume", "offset")
    return calibrate(observations, scene, names, hold_out_kPa=(22.0,), sensor="A1", title="Spring campaign")


def test_the_document_holds_the_truth_and_is_json(found):
    document = json.loads(json_bytes(found.document))
    estimates = {e["key"]: e for e in document["estimates"]}
    for key, value in (
        ("shear_modulus_MPa", 0.21),
        ("wall_thickness_mm", 1.5),
        ("dead_volume_mL", 0.4),
        ("contact_offset_mm", 0.0),
    ):
        low, high = estimates[key]["interval_95"]
        assert low < value < high, key
        assert low < estimates[key]["value"] < high
        assert len(estimates[key]["prior"]["source"]) > 8
    matrix = np.array(document["correlation"]["matrix"])
    assert np.allclose(np.diag(matrix), 1)
    assert np.allclose(matrix, matrix.T)
    assert (np.abs(matrix) <= 1 + 1e-9).all()
    (held,) = document["held_out"]
    assert abs(held["sensitivity_error"]) < 0.02
    assert len(document["residuals"]) == 10
    assert all(isinstance(line, str) for line in document["notes"])


def test_the_same_data_give_the_same_bytes(found, observations, scene):
    again = calibrate(
        observations,
        scene,
        ("modulus", "wall", "dead-volume", "offset"),
        hold_out_kPa=(22.0,),
        sensor="A1",
        title="Spring campaign",
    )
    assert json_bytes(again.document) == json_bytes(found.document)


def test_no_interval_reaches_below_no_dead_volume(observations, scene):
    """Few runs of a sensor that has next to none: the interval ends at zero."""
    truth = sensor_of(assemble(scene)).replace(break_stretch=None, shear_modulus=0.2, dead_volume=5.0)
    seen = Observations(curves(truth, (0.0, 12.0), 2, np.random.default_rng(5), 0.02))
    (_, dead) = calibrate(seen, scene, ("modulus", "dead-volume"), priors=False).estimates
    assert dead["on_bound"] or dead["interval_95"][0] == 0.0


def test_saved_files_predict_what_was_measured(found, observations, library, tmp_path):
    library = Library((tmp_path, *library.folders))
    saved = prepare(found, "dome-A1", tmp_path, library)
    save(saved)
    assert [path.removeprefix(str(tmp_path)) for path in saved.paths] == [
        "/printprofiles/materials/dome-A1.toml",
        "/designs/dome-A1.toml",
    ]
    resin = tomllib.loads((tmp_path / "printprofiles/materials/dome-A1.toml").read_text())
    low, high = found.estimates[0]["interval_95"]
    assert 2 * 1.96 * resin["shear_modulus_MPa"]["spread"] == pytest.approx(high - low, rel=1e-3)
    assert "calibrated on sensor A1, Spring campaign, 9 curves, 1 injections" in resin["shear_modulus_MPa"]["source"]
    assert "measured" not in resin
    assert resin["shore_a"]["value"] == 27.6
    states = evaluate("dome-A1", model="atlas", library=library).prediction.states
    before = evaluate(
        "paper-dome", {"pneumatics.dead_volume_mL": 0.3}, model="atlas", library=library
    ).prediction.states
    for pressure, state, old in ((12.0, states[2], before[2]), (22.0, states[3], before[3])):
        curve = next(c for c in observations.curves if c.run.driving_pressure_kPa == pressure)
        ours, theirs = (np.interp(curve.indentation, s.indentation, s.force) - curve.force for s in (state, old))
        assert state.driving_pressure == pytest.approx(pressure * KPA)
        assert np.abs(ours).max() < 0.5 * np.abs(theirs).max()


def test_files_of_others_are_left_alone(found, library, tmp_path):
    library = Library((tmp_path, *library.folders))
    mine = tmp_path / "designs" / "mine.toml"
    mine.parent.mkdir()
    mine.write_text("[membrane]\n")
    with pytest.raises(InputError, match="was not written by pneutouch calibrate"):
        prepare(found, "mine", tmp_path, library)
    assert mine.read_text() == "[membrane]\n"
    with pytest.raises(InputError, match="which the new file would hide"):
        prepare(found, "TangoPlus", tmp_path, library)
    assert len(prepare(found, "TangoPlus", tmp_path, library, shadow=True).files) == 2
    with pytest.raises(InputError, match="letters, digits"):
        prepare(found, "../up", tmp_path, library)


def test_its_own_files_are_written_anew(found, library, tmp_path):
    library = Library((tmp_path, *library.folders))
    save(prepare(found, "A1", tmp_path, library))
    first = (tmp_path / "designs/A1.toml").read_bytes()
    save(prepare(found, "A1", tmp_path, library))
    assert (tmp_path / "designs/A1.toml").read_bytes() == first
    assert first.decode().startswith(HEAD)


def test_an_estimate_without_interval_is_no_resin(scene, library, tmp_path):
    """Forces as of air alone: the modulus ends on its bound, and nothing is saved."""
    truth = sensor_of(assemble(scene)).replace(break_stretch=None)
    soft = tuple(
        MeasuredCurve(c.run, c.indentation, 0.3 * c.force, 0.3 * c.rise, c.driving)
        for c in curves(truth, (0.0,), 3, np.random.default_rng(1), 0.002)
    )
    found = calibrate(Observations(soft), scene, ("modulus",), priors=False)
    assert found.estimates[0]["on_bound"]
    assert found.estimates[0]["interval_95"] is None
    with pytest.raises(InputError, match="has no interval"):
        prepare(found, "soft", tmp_path, library)


def test_the_folder_holds_document_and_chart(found, tmp_path):
    folder = write_calibration(found, tmp_path)
    assert sorted(path.name for path in folder.iterdir()) == ["calibration.json", "manifest.json", "residuals.svg"]
    chart = (folder / "residuals.svg").read_text()
    root = ET.fromstring(chart)
    points = [use for use in root.iter("{http://www.w3.org/2000/svg}use") if use.get("y")]
    # Three markers in three rows of panels: nine curves twice, and the injection.
    assert len(points) >= 2 * 9 * 14 + 10
    colours = set(re.findall(r"stroke: (#[0-9a-f]{6})", chart))
    assert {"#16212b", "#0b5c8a", "#6c7a86"} <= colours


def test_runs_of_other_sensors_and_kinds_are_not_taken(observations, scene):
    def campaign(*runs):
        return Campaign(runs=list(runs), ambient_pressure_kPa=95.0)

    curve = observations.curves[0]
    other = CampaignRun(file="b.csv", sensor="B", resin="FLX9950")
    loop = replace(curve, run=curve.run.model_copy(update={"kind": "loop", "file": "loop.csv"}))
    both = campaign(curve.run, other)
    name, taken, notes = observations_of(both, [curve, loop], [], scene, "A")
    assert (name, len(taken.curves), taken.ambient) == ("A", 1, pytest.approx(0.095))
    assert notes == []
    with pytest.raises(InputError, match="sensor: the campaign holds A, B; name one"):
        observations_of(both, [curve], [], scene)
    with pytest.raises(InputError, match='sensor = "C": no such sensor'):
        observations_of(both, [curve], [], scene, "C")
    with pytest.raises(InputError, match='sensor = "B": no readable run'):
        observations_of(both, [curve], [], scene, "B")
    held = CampaignRun(file="i.csv", sensor="A", resin="TangoPlus", kind="injection", driving_pressure_kPa=5.0)
    with pytest.raises(InputError, match=r"i\.csv: driving_pressure_kPa = 5: an injection must begin at ambient"):
        observations_of(campaign(held), [], [(held, np.ones(3), np.ones(3))], scene)
    _, _, remarks = observations_of(campaign(curve.run.model_copy(update={"resin": "FLX9950"})), [curve], [], scene)
    assert "states A to be of FLX9950, the design states TangoPlus" in remarks[0]
