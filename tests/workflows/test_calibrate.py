"""A calibration as a document and as files that every other command takes."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

from pneutouch.bench.calibrate.observations import Observations
from pneutouch.catalogue import Library, load_scene
from pneutouch.errors import InputError
from pneutouch.evaluation.evaluate import evaluate, sensor_of
from pneutouch.output.files import digest, json_bytes
from pneutouch.parts import assemble
from pneutouch.results.record import plain
from pneutouch.spec.campaign import Campaign, CampaignRun
from pneutouch.spec.options import CalibrationOptions
from pneutouch.units import KPA
from pneutouch.workflows.calibrate.calibrate import run_calibration, with_further_tests
from pneutouch.workflows.calibrate.calibration_files import (
    CampaignSource,
    calibration_content,
    check_place,
    check_unlike,
    prepare,
    save,
    write_calibration,
)
from pneutouch.workflows.calibrate.fit import calibrate, observations_of
from pneutouch.workflows.compare import compare
from tests.bench.calibrate.sensors import curves, injections, softer
from tests.bench.recordings import READ
from tests.refusals import refused

SOURCE = CampaignSource("ab" * 32)
DEAD = {"pneumatics.dead_volume_mL": 0.3}
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
    fitted = calibrate(observations, scene, names, hold_out_kPa=(22.0,), sensor="A1", title="Spring campaign")
    return with_further_tests(fitted, SOURCE)


def test_the_document_holds_the_truth_and_is_json(found):
    document = json.loads(json_bytes(plain(found.record)))
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
    names = ("modulus", "wall", "dead-volume", "offset")
    fitted = calibrate(observations, scene, names, hold_out_kPa=(22.0,), sensor="A1", title="Spring campaign")
    again = with_further_tests(fitted, SOURCE)
    assert plain(again.record) == plain(found.record)


def test_no_interval_reaches_below_no_dead_volume(observations, scene):
    """Few runs of a sensor that has next to none: the interval ends at zero."""
    truth = sensor_of(assemble(scene)).replace(break_stretch=None, shear_modulus=0.2, dead_volume=5.0)
    seen = Observations(curves(truth, (0.0, 12.0), 2, np.random.default_rng(5), 0.02))
    (_, dead) = calibrate(seen, scene, ("modulus", "dead-volume"), priors=False).record.estimates
    assert dead.on_bound or dead.interval_95[0] == 0.0


@pytest.fixture
def place(found, library, tmp_path):
    """A user's folder with the calibration in it, and its library."""
    saved = prepare(found, "dome-A1", tmp_path, SOURCE)
    save(saved)
    assert saved.path == tmp_path / "calibrations" / "dome-A1.toml"
    return Library((tmp_path, *library.folders))


def test_the_file_holds_the_fit_and_what_it_was_made_for(found, place):
    kept = place.load("calibrations", "dome-A1")
    assert (kept.source.digest, kept.source.curves, kept.source.injections) == ("ab" * 32, 9, 1)
    assert (kept.design.name, kept.design.material, kept.design.wall_thickness_mm) == ("paper-dome", "TangoPlus", 1.5)
    assert kept.covered == tuple(estimate.key for estimate in found.record.estimates)
    for k, estimate in enumerate(found.record.estimates):
        assert kept.value(estimate.key) == pytest.approx(estimate.value, rel=1e-6)
        low, high = np.array(estimate.interval_95)
        spread = np.sqrt(kept.covariance[k][k])
        if estimate.prior.relative:
            assert np.log(high / low) == pytest.approx(2 * 1.96 * spread, rel=1e-6)
        elif low > 0:
            assert high - low == pytest.approx(2 * 1.96 * spread, rel=1e-6)
    scale = np.sqrt(np.diag(kept.covariance))
    assert np.allclose(kept.covariance / np.outer(scale, scale), found.record.correlation.matrix, atol=1e-6)
    text = (place.folders[0] / "calibrations/dome-A1.toml").read_text()
    assert not re.search(r"\b20\d\d-", text)


def test_what_is_not_fitted_stays_correlated_with_what_is(observations, scene):
    """The wall keeps its prior; a thicker wall is a softer resin to the same data."""
    found = calibrate(observations, scene, ("modulus", "dead-volume"))
    content = calibration_content(found, SOURCE)
    keys = [entry["key"] for entry in content["parameters"] if entry["covered"]]
    covariance, prior = np.array(content["covariance"]), found.fit.parameters.prior_spread
    wall, modulus = keys.index("wall_thickness_mm"), keys.index("shear_modulus_MPa")
    assert covariance[wall, wall] == pytest.approx(prior[1] ** 2, rel=1e-6)
    assert covariance[wall, modulus] / np.sqrt(covariance[wall, wall] * covariance[modulus, modulus]) < -0.5
    bare = calibration_content(calibrate(observations, scene, ("modulus",), priors=False), SOURCE)
    assert [entry["key"] for entry in bare["parameters"] if entry["covered"]] == ["shear_modulus_MPa"]


def test_no_further_test_is_above_the_rated_pressure_of_the_calibrated_sensor(found, place):
    rating = evaluate("paper-dome@dome-A1", DEAD, model="atlas", library=place).rating
    words = [test.what for test in found.further]
    named_kPa = [float(what.split(" kPa")[0].split()[-1]) for what in words if "kPa" in what]
    assert max(named_kPa) == rating.pressure_kPa < rating.nominal.nominal / KPA


def test_a_calibrated_design_predicts_what_was_measured(observations, place):
    states = evaluate("paper-dome@dome-A1", DEAD, model="atlas", library=place).prediction.states
    before = evaluate("paper-dome", DEAD, model="atlas", library=place).prediction.states
    for pressure, state, old in ((12.0, states[2], before[2]), (22.0, states[3], before[3])):
        curve = next(c for c in observations.curves if c.run.driving_pressure_kPa == pressure)
        ours, theirs = (np.interp(curve.indentation, s.indentation, s.force) - curve.force for s in (state, old))
        assert state.driving_pressure == pytest.approx(pressure * KPA)
        assert np.abs(ours).max() < 0.5 * np.abs(theirs).max()


def test_a_file_of_the_name_is_left_alone(found, place):
    root = place.folders[0]
    path = root / "calibrations" / "dome-A1.toml"
    first = path.read_bytes()
    save(prepare(found, "dome-A1", root, SOURCE))
    assert path.read_bytes() == first
    other = replace(SOURCE, digest="cd" * 32)
    with pytest.raises(InputError, match="there is a calibration of this name"):
        prepare(found, "dome-A1", root, other)
    save(prepare(found, "dome-A1", root, other, replace=True))
    assert place.load("calibrations", "dome-A1").source.digest == "cd" * 32
    for bad in ("../up", "none", "a b", "x" * 101, "mine.toml", "-a"):
        with refused("save"):
            prepare(found, bad, root, SOURCE)


def test_an_estimate_without_interval_is_no_calibration(scene, tmp_path):
    """A wall softer than any of the atlas: the modulus ends on its bound, and nothing is saved."""
    soft = softer(sensor_of(assemble(scene)), 3, 0.002)
    found = calibrate(Observations(soft), scene, ("modulus",), priors=False)
    assert found.record.estimates[0].on_bound
    assert found.record.estimates[0].interval_95 is None
    with pytest.raises(InputError, match="has no interval") as refused:
        prepare(found, "soft", tmp_path, SOURCE)
    assert (refused.value.key, refused.value.remedy) == ("fit", "leave out modulus")


def test_the_folder_holds_document_and_chart(found, tmp_path):
    folder = write_calibration(found, tmp_path, SOURCE)
    assert sorted(path.name for path in folder.iterdir()) == ["calibration.json", "manifest.json", "residuals.svg"]
    chart = (folder / "residuals.svg").read_text()
    root = ET.fromstring(chart)
    points = [use for use in root.iter("{http://www.w3.org/2000/svg}use") if use.get("y")]
    # Three markers in three rows of panels: nine curves twice, and the injection.
    assert len(points) >= 2 * 9 * 14 + 10
    colours = set(re.findall(r"stroke: (#[0-9a-f]{6})", chart))
    assert {"#16212b", "#0b5c8a", "#6c7a86"} <= colours


def test_the_folder_is_known_as_one_of_pneutouchs_own(found, tmp_path):
    folder = write_calibration(found, tmp_path, SOURCE)
    manifest = json.loads((folder / "manifest.json").read_text())
    assert set(manifest["files"]) == {"calibration.json", "residuals.svg"}
    for name, entry in manifest["files"].items():
        assert entry == {"sha256": digest((folder / name).read_bytes()), "bytes": (folder / name).stat().st_size}
    assert manifest["inputs"]["campaign"]["digest"] == SOURCE.digest
    with pytest.raises(InputError, match="neither a build nor a characterization"):
        compare([str(folder), "paper-dome"])


def test_it_knows_how_deep_and_with_which_plate_it_was_measured(found, observations, place):
    kept = place.load("calibrations", "dome-A1").source
    ends = {}
    for curve in observations.curves:
        ends.setdefault(curve.run.driving_pressure_kPa, []).append(curve.indentation.max())
    assert kept.depth_mm == pytest.approx(max(min(group) for group in ends.values()), rel=1e-6)
    assert kept.plate_diameter_mm == found.scene.design.indentation.plate_diameter_mm


@pytest.mark.parametrize("spoil", ["link", "folder", "kind"])
def test_a_place_that_cannot_be_written_is_refused_before_the_fit(spoil, tmp_path):
    if spoil == "kind":
        (tmp_path / "calibrations").write_text("")
    else:
        (tmp_path / "calibrations").mkdir()
        path = tmp_path / "calibrations" / "mine.toml"
        path.mkdir() if spoil == "folder" else path.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError, match="is not a folder" if spoil == "kind" else "is no file of its own"):
        check_place("mine", tmp_path)


def test_a_file_that_the_fit_cannot_equal_is_known_before_it(found, place):
    path, names = place.folders[0] / "calibrations" / "dome-A1.toml", ("modulus", "wall", "dead-volume", "offset")
    check_unlike(path, SOURCE.digest, names, (22.0,))
    check_unlike(path.with_name("free.toml"), "cd" * 32, names, ())
    for other in (("cd" * 32, names, (22.0,)), (SOURCE.digest, names[:1], (22.0,)), (SOURCE.digest, names, ())):
        with pytest.raises(InputError, match="there is a calibration of this name"):
            check_unlike(path, *other)
    path.write_text("of somebody else")
    with pytest.raises(InputError, match="there is a calibration of this name"):
        check_unlike(path, SOURCE.digest, names, (22.0,))


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
    with refused("sensor"):
        observations_of(both, [curve], [], scene)
    with pytest.raises(InputError, match='sensor = "C": no such sensor'):
        observations_of(both, [curve], [], scene, "C")
    with pytest.raises(InputError, match='sensor = "B": no run of kind steps'):
        observations_of(both, [curve], [], scene, "B")
    held = CampaignRun(file="i.csv", sensor="A", resin="TangoPlus", kind="injection", driving_pressure_kPa=5.0)
    with pytest.raises(InputError, match=r"i\.csv: driving_pressure_kPa = 5: an injection must begin at ambient"):
        observations_of(campaign(held), [], [(held, np.ones(3), np.ones(3))], scene)
    _, _, remarks = observations_of(campaign(curve.run.model_copy(update={"resin": "FLX9950"})), [curve], [], scene)
    assert "states A to be of FLX9950, the design states TangoPlus" in remarks[0]


def test_absolute_pressures_are_those_over_the_ambient_one_of_the_campaigns_design(tmp_path):
    recording = replace(READ["steps"], ambient=90.0)
    (tmp_path / "run.csv").write_text(recording.text())
    (tmp_path / "campaign.toml").write_text(
        'design = "paper-dome"\nassignments = ["pneumatics.ambient_pressure_kPa=90"]\n'
        '[columns]\npressure = { name = "pressure_kPa", unit = "kPa_abs" }\n'
        '[[runs]]\nfile = "run.csv"\nsensor = "A1"\nkind = "steps"\n'
    )
    outcome = run_calibration(tmp_path, None, CalibrationOptions(), tmp_path / "out", root=tmp_path)
    assert not any("driving_pressure_kPa" in note for note in outcome.record.notes)
