"""``pneutouch calibrate`` as a user meets it: a simulated campaign in, estimates, files and exit codes out."""

from __future__ import annotations

import json
import tomllib
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from pneutouch.cli import calibrate, simulate
from pneutouch.cli.app import app
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.spec.toml_text import toml_text
from pneutouch.workflows.calibrate.fit import observations_of
from tests.bench.calibrate.sensors import softer
from tests.evaluation.calibrated import CONTENT

assert calibrate and simulate

DEAD = "pneumatics.dead_volume_mL=0.3"


def run(*arguments: str):
    return CliRunner().invoke(app, list(arguments))


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """One specimen of one resin, two pressures, two runs each and an injection; the design states the air behind it."""
    out = tmp_path_factory.mktemp("simulated")
    words = "--resins TangoPlus --specimens 1 --pressures 0,22 --runs 2 --kinds steps,injection --rest 10 --model atlas"
    result = run("simulate", "paper-dome", "--set", DEAD, *words.split(), "--out", str(out))
    assert result.exit_code == 0, result.stderr
    return out / "paper-dome-campaign"


@pytest.fixture
def place(tmp_path, monkeypatch, library):
    """A working folder of its own, with a design that states the dead volume."""
    content = tomllib.loads(library.paths("designs")["paper-dome"].read_text())
    content["pneumatics"]["dead_volume_mL"] = 0.3
    (tmp_path / "designs").mkdir()
    (tmp_path / "designs" / "mine.toml").write_text(toml_text(content))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def files(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


def test_the_truth_is_in_the_intervals_and_the_files_predict(campaign, place):
    words = ("calibrate", str(campaign), "--design", "mine", "--save", "dome-1", "--out", "out")
    result = run(*words, "--json")
    assert result.exit_code == 0, result.stderr
    said = json.loads(result.stdout)
    truth = json.loads((campaign / "truth.json").read_text())["specimens"]["TangoPlus-1"]
    found = {estimate["key"]: estimate for estimate in said["estimates"]}
    assert list(found) == ["shear_modulus_MPa", "wall_thickness_mm", "dead_volume_mL", "contact_offset_mm"]
    for key in ("shear_modulus_MPa", "wall_thickness_mm", "dead_volume_mL"):
        low, high = found[key]["interval_95"]
        assert low <= truth[key] <= high, key
    assert len(said["notes"]) <= 6
    assert "simulated" in said["notes"][0]
    assert said["written"][1:] == ["calibrations/dome-1.toml"] and said["calibration"] == "dome-1"
    text = run(*words).stdout
    assert f"shear_modulus_MPa  {found['shear_modulus_MPa']['value']:.4g}" in text

    sensor = evaluate("mine@dome-1", model="atlas").sensor
    assert sensor.dome.wall_thickness == pytest.approx(found["wall_thickness_mm"]["value"], rel=1e-6)
    predicted = run("predict", "mine", "--calibration", "dome-1", "--model", "atlas", "--json")
    assert predicted.exit_code == 0, predicted.stderr
    same = run("predict", "mine@dome-1", "--model", "atlas", "--json")
    assert same.stdout == predicted.stdout
    state = json.loads(predicted.stdout)["states"][0]
    measured = truth["pressures"]["0"]["sensitivity_kPa_per_N"]
    assert state["sensitivity_kPa_per_N"] == pytest.approx(measured, rel=0.03)


@pytest.mark.slow
def test_a_calibrated_comparison_leads_to_the_reader_and_another_design_gets_none(campaign, place):
    assert run("calibrate", str(campaign), "--design", "mine", "--save", "dome-1", "--out", "out").exit_code == 0
    compared = run("compare", "mine", "mine@dome-1", "--model", "atlas", "--out", "out")
    assert compared.stderr.splitlines()[-1] == "next: pneutouch export-reader mine --calibration dome-1"
    refused = run("export-reader", "soft-pad", "--calibration", "dome-1", "--out", "out")
    assert refused.exit_code == 2
    assert "--calibration dome-1: the calibration was made with a membrane of" in refused.stderr
    assert not [path for path in (place / "out").iterdir() if path.name.endswith("-reader")]


@pytest.mark.slow
def test_a_part_of_the_parameters_says_what_else_counts(campaign, place):
    words = ("calibrate", str(campaign), "--design", "mine", "--fit", "modulus,dead-volume", "--out", "out", "--json")
    counted, bare = (json.loads(run(*words, *more).stdout) for more in ((), ("--no-priors", "--save", "bare")))
    (line,) = [line for line in counted["notes"] if "the intervals include" in line]
    assert "the priors of wall thickness and contact offset" in line
    assert counted["fit"]["considered"] == ["wall", "offset"]
    assert any("without priors only the fitted parameters are uncertain" in line for line in bare["notes"])
    width = [one["estimates"][0]["interval_95"][1] - one["estimates"][0]["interval_95"][0] for one in (counted, bare)]
    assert width[0] > 1.5 * width[1]


@pytest.mark.slow
def test_the_file_is_named_by_design_and_sensor_and_kept(campaign, place):
    words = ("calibrate", str(campaign), "--design", "mine", "--out", "out", "--fit")
    result = run(*words, "modulus")
    assert result.exit_code == 0, result.stderr
    assert result.stderr.splitlines()[-1] == (
        "next: pneutouch compare mine mine@mine-TangoPlus-1 --set pneumatics.dead_volume_mL=0.3"
    )
    listed = json.loads(run("list", "calibrations", "--json").stdout)["calibrations"]
    assert listed == [{"name": "mine-TangoPlus-1", "title": "sensor TangoPlus-1, Simulated campaign of paper-dome"}]
    assert not any(
        "mine-TangoPlus-1" in entry["name"] for entry in json.loads(run("list", "--json").stdout)["materials"]
    )
    other = run(*words, "modulus,wall")
    assert other.exit_code == 2
    assert "there is a calibration of this name, of other content; give another --save, or --force" in other.stderr
    assert run(*words, "modulus,wall", "--force").exit_code == 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--sensor", "B"), "--sensor B: no such sensor in the campaign; there are TangoPlus-1"),
        (("--fit", "moduls"), "--fit moduls: no such parameter. Did you mean modulus"),
        (("--hold-out", "5"), "--hold-out 5: no run at this driving pressure; measured: 0, 22 kPa"),
        (("--save", "a b"), "--save a b: cannot be a name; use letters, digits"),
        (("--save", "../x"), "--save ../x: cannot be a name; use letters, digits"),
        (("--save", "none"), "--save none: cannot be the name of a calibration; use letters"),
    ],
)
def test_wrong_words_end_with_two_and_nothing_written(words, message, campaign, place):
    before = files(place)
    result = run("calibrate", str(campaign), "--design", "mine", "--out", "out", *words)
    assert result.exit_code == 2 and message in result.stderr.replace("\n", " "), result.stderr
    assert files(place) == before


@pytest.fixture
def unfitted(monkeypatch):
    """No fit is made: what is refused is refused before it."""

    def fail(*given, **more):
        raise AssertionError("the fit began")

    monkeypatch.setattr("pneutouch.workflows.calibrate.calibrate.calibrate", fail)


def test_a_second_campaign_of_the_sensor_is_refused_before_the_fit(campaign, place, unfitted):
    (place / "calibrations").mkdir()
    (place / "calibrations" / "mine-TangoPlus-1.toml").write_text(toml_text(CONTENT))
    before = files(place)
    result = run("calibrate", str(campaign), "--design", "mine", "--out", "out")
    assert result.exit_code == 2
    assert "there is a calibration of this name, of other content; give another --save, or --force" in result.stderr
    assert files(place) == before


@pytest.mark.parametrize("words", [(), ("--save", "dome-1")])
def test_a_folder_that_cannot_be_written_is_refused_before_the_fit(words, campaign, place, unfitted):
    (place / "calibrations").write_text("")
    result = run("calibrate", str(campaign), "--design", "mine", "--out", "out", *words)
    assert result.exit_code == 2
    assert "calibrations is not a folder" in result.stderr.replace("\n", " ")
    assert not (place / "out").exists()


@pytest.fixture
def soft(monkeypatch):
    """Curves that are too soft for any modulus of the atlas, so that the modulus ends on its bound."""

    designed = evaluate("paper-dome", {"pneumatics.dead_volume_mL": 0.3}, model="membrane").sensor

    def exchanged(*given):
        sensor, seen, notes = observations_of(*given)
        bare = [curve.run for curve in seen.curves if curve.run.driving_pressure_kPa == 0]
        made = zip(bare, softer(designed, len(bare)), strict=True)
        curves = tuple(replace(curve, run=run) for run, curve in made)
        return sensor, replace(seen, curves=curves, injections=()), notes

    monkeypatch.setattr("pneutouch.workflows.calibrate.calibrate.observations_of", exchanged)


def test_a_fit_that_is_no_calibration_is_reported(campaign, place, soft):
    words = ("calibrate", str(campaign), "--design", "mine", "--out", "out", "--no-priors", "--fit", "modulus")
    result = run(*words, "--json")
    assert result.exit_code == 1, result.stderr
    said = json.loads(result.stdout)
    reason = "no calibration was saved: shear_modulus_MPa has no interval (on its bound, or not seen)"
    assert said["calibration"] is None and said["notes"][-1].startswith(reason)
    assert said["written"] == ["out/mine-TangoPlus-1-calibration"]
    kept = json.loads((place / "out/mine-TangoPlus-1-calibration/calibration.json").read_text())
    assert (kept["notes"], kept["estimates"]) == (said["notes"], said["estimates"])
    assert kept["estimates"][0]["on_bound"]
    assert not (place / "calibrations").exists()
    plain = run(*words)
    assert plain.exit_code == 1 and reason in plain.stdout
    assert plain.stderr.splitlines()[-1] == "next: pneutouch predict mine --set pneumatics.dead_volume_mL=0.3"


@pytest.fixture
def stretched(monkeypatch):
    """Forces of the runs multiplied by a factor, as by a wrong gain of the load cell; the travel is kept."""

    def stretch(factor, power=1.0):
        def exchanged(*given):
            sensor, seen, notes = observations_of(*given)
            curves = (
                replace(curve, force=factor * curve.force.max() * (curve.force / curve.force.max()) ** power)
                for curve in seen.curves
            )
            return sensor, replace(seen, curves=tuple(curves)), notes

        monkeypatch.setattr("pneutouch.workflows.calibrate.calibrate.observations_of", exchanged)

    return stretch


@pytest.mark.slow
def test_a_usual_fit_has_no_warning_and_a_poor_one_has(campaign, place, stretched):
    words = ("calibrate", str(campaign), "--design", "mine", "--out", "out")
    usual = run(*words, "--json")
    assert json.loads(usual.stdout)["warnings"] == []
    stretched(1.5)
    poor = run(*words, "--save", "poor", "--json")
    assert poor.exit_code == 0, poor.stderr
    (said,) = json.loads(poor.stdout)["warnings"]
    assert said.startswith("the fitted model describes the runs poorly: it is off in force by 1")
    assert f"\nwarning: {said}\n" in run(*words, "--save", "poor").stdout


@pytest.mark.slow
@pytest.mark.parametrize(("factor", "power"), [(0.4, 1.0), (1.0, 0.1)])
def test_runs_that_contradict_the_fitted_model_give_no_calibration(campaign, place, stretched, factor, power):
    stretched(factor, power)
    words = ("calibrate", str(campaign), "--design", "mine", "--out", "out")
    result = run(*words, "--json")
    assert result.exit_code == 1, result.stderr
    said = json.loads(result.stdout)
    reason = "no calibration was saved: the runs contradict the fitted model: it is off in force by"
    assert said["calibration"] is None and said["notes"][-1].startswith(reason) and len(said["warnings"]) == 1
    assert not (place / "calibrations").exists()
    saved = run(*words, "--save", "dome-1")
    assert saved.exit_code == 2 and not (place / "calibrations").exists()
    assert "the runs contradict the fitted model" in saved.stderr and "check units, columns" in saved.stderr


def test_a_contradicted_fit_with_modulus_held_names_the_choice_of_parameters(campaign, place, stretched):
    """Another modulus might describe the runs: the key is the option that fits it, and the remedy says so first."""
    stretched(1.0, 0.1)
    words = ("calibrate", str(campaign), "--design", "mine", "--out", "out", "--fit", "wall,dead-volume")
    result = run(*words, "--save", "dome-1")
    assert result.exit_code == 2 and not (place / "calibrations").exists()
    said = " ".join(result.stderr.split())
    assert "--fit: the runs contradict the fitted model" in said
    assert "fit modulus and wall, or check units, columns, driving pressures" in said


def test_one_that_was_to_be_saved_is_an_error_with_its_report(campaign, place, soft):
    words = ("--no-priors", "--fit", "modulus", "--save", "dome-1")
    result = run("calibrate", str(campaign), "--design", "mine", "--out", "out", *words)
    assert result.exit_code == 2
    assert "--fit: shear_modulus_MPa has no interval" in result.stderr
    said = result.stderr.replace("\n", " ")
    assert "(the fit is in out/mine-TangoPlus-1-calibration); leave out modulus" in said
    assert (place / "out/mine-TangoPlus-1-calibration/calibration.json").is_file()
    assert not (place / "calibrations").exists()


@pytest.mark.slow
def test_a_design_that_cannot_be_fitted_is_refused_at_once_and_compared_instead(campaign, place):
    """The fit needs the atlas, whose walls have a base; the last line of characterize is a command that works."""
    content = tomllib.loads((place / "designs" / "mine.toml").read_text())
    (place / "designs" / "rough.toml").write_text(toml_text({**content, "contact": {"base": False}}))
    refused = run("calibrate", str(campaign), "--design", "rough", "--out", "out")
    assert refused.exit_code == 2
    for word in ("rough.toml: contact.base = ", "no fit covers", "`compare` sets"):
        assert word in refused.stderr
    assert not (place / "out").exists() and not (place / "calibrations").exists()
    words = ("characterize", str(campaign), "--design", "rough", "--evidence", "none", "--out", "out")
    shown = run(*words)
    assert shown.exit_code == 0, shown.stderr
    folder = "out/paper-dome-campaign-measured"
    assert shown.stderr.splitlines()[-1] == f"next: pneutouch compare rough {folder}"
