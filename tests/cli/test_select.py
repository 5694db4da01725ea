"""``pneutouch select`` as a user meets it."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from pneutouch.cli.app import app
from pneutouch.spec.target import Target, TargetFigures
from pneutouch.workflows.select.base import base_scene
from pneutouch.workflows.select.document import mount_note

ASKED = ["select", "--sensitivity", "1.9", "--at", "12", "--force-range", "15", "--max-diameter", "25"]


def run(*arguments: str):
    return CliRunner().invoke(app, list(arguments))


@pytest.mark.parametrize(("finger", "note"), [("20", True), ("16", False), ("7.5", True)])
def test_the_sleeve_is_named_by_its_finger_where_the_mount_s_name_has_another(finger, note, library):
    target = Target(target=TargetFigures(sensitivity_kPa_per_N=3.0, driving_pressure_kPa=10.0, fits=f"finger:{finger}"))
    base = base_scene(target, "target", library)
    sentence = (
        f"mount: Sleeve over a {finger} mm finger, two M3 set screws: finger-16 with connector.finger_diameter_mm = "
        f"{finger}"
    )
    assert mount_note(target, base) == ([sentence] if note else [])
    assert base.mount.finger_diameter == float(finger)
    assert base.mount.code == f"F{finger}"


@pytest.mark.slow
def test_json_lists_ranked_designs_with_uncertainty_and_margins():
    result = run(*ASKED, "--json")
    assert result.exit_code == 0
    said = json.loads(result.stdout)
    assert said["met"] is True
    assert [d["rank"] for d in said["designs"]] == list(range(1, len(said["designs"]) + 1))
    for design in said["designs"]:
        assert design["expanded_uncertainty_kPa_per_N"] > 0
        assert design["binding"] in design["margins"]
        assert min(room for room in design["margins"].values() if room is not None) >= 0
    assert all(d["solid"]["within_expanded_uncertainty"] for d in said["designs"][:3])
    assert "Agilus30" in said["left_out"]
    assert set(said["left_out"].values()) == {"the Stratasys Objet260 Connex cannot run it"}


def test_a_written_design_can_be_predicted(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run(*ASKED, "--write", "mine", "--json")
    assert result.exit_code == 0
    written = json.loads(result.stdout)
    assert written["written"] == "designs/mine.toml"
    said = json.loads(run("predict", "mine", "--json").stdout)
    state = next(s for s in said["states"] if s["driving_pressure_kPa"] == 12.0)
    first = written["designs"][0]
    assert state["sensitivity_kPa_per_N"] == pytest.approx(first["sensitivity_kPa_per_N"], rel=0.012)
    assert run(*ASKED, "--write", "mine").exit_code == 2


@pytest.mark.slow
def test_text_names_resins_and_what_binds():
    said = run(*ASKED).stdout
    assert "TangoPlus" in said
    assert "binds" in said
    assert "left out: Agilus30" in said


@pytest.mark.slow
def test_an_impossible_target_exits_1_and_says_what_to_give_up():
    result = run(*ASKED[:-3], "150", "--max-diameter", "25")
    assert result.exit_code == 1
    assert "no design meets the target" in result.stdout
    assert "without the requirement on force range alone a design fits" in result.stdout


@pytest.mark.slow
def test_a_target_file_with_flags_over_it(tmp_path):
    path = tmp_path / "target.toml"
    path.write_text(
        '[target]\nsensitivity_kPa_per_N = 1.0\ndriving_pressure_kPa = 12\n[given]\nmaterials = ["FLX9940"]\n'
    )
    said = json.loads(run("select", str(path), "--sensitivity", "1.9", "--json").stdout)
    assert said["target"]["target"]["sensitivity_kPa_per_N"] == 1.9
    assert {d["material"] for d in said["designs"]} == {"FLX9940"}


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("[target]\n", "give at least one of sensitivity_kPa_per_N"),
        ("[target]\nsensitivity_kPa_per_N = -1\n", "target.sensitivity_kPa_per_N = -1"),
        ("[target]\nsensitvity_kPa_per_N = 1\n", "Did you mean sensitivity_kPa_per_N"),
        (
            "[target]\nsensitivity_kPa_per_N = 1\nstiffness_least_N_per_mm = 3\nstiffness_most_N_per_mm = 2\n",
            "contradict each other",
        ),
        (
            "[target]\nsensitivity_kPa_per_N = 1\nmax_diameter_mm = 15\n[given]\ninner_radius_mm = 9\n",
            "contradict each other",
        ),
        ("[target]\nsensitivity_kPa_per_N = 1\n[given]\nmaterials = []\n", "given.materials"),
        ("target = 3\n", "target"),
    ],
)
def test_a_bad_target_file_is_named_with_its_key(tmp_path, content, said):
    path = tmp_path / "bad.toml"
    path.write_text(content)
    result = run("select", str(path))
    assert result.exit_code == 2
    assert said in result.stderr
    assert "bad.toml" in result.stderr
    assert "Traceback" not in result.output


@pytest.mark.parametrize(
    ("extra", "said"),
    [
        (["--tolerance", "0"], "--tolerance 0"),
        (["--tolerance", "much"], "--tolerance much"),
        (["--material", "Tango"], "--material Tango: no such name"),
        pytest.param(["--pick", "99"], "--pick 99", marks=pytest.mark.slow),  # known after the search
        (["--write", "bad name"], "--write bad name"),
    ],
)
def test_bad_flags_exit_2(extra, said):
    result = run(*ASKED, *extra)
    assert result.exit_code == 2
    assert said in result.stderr


@pytest.mark.parametrize("options", [(), ("--base", "paper-dome")])
def test_a_misspelt_table_is_named_before_the_target_that_is_not_there(tmp_path, options):
    path = tmp_path / "misspelt.toml"
    path.write_text("[targets]\nsensitivity_kPa_per_N = 1.9\n")
    result = run("select", str(path), *options)
    assert result.exit_code == 2
    assert result.stderr.startswith(f"error: {path}: targets: unknown table. Did you mean target?")


def test_a_file_without_a_target_is_named(tmp_path):
    path = tmp_path / "given.toml"
    path.write_text("[given]\nwall_thickness_mm = 1.2\n")
    result = run("select", str(path))
    assert result.exit_code == 2
    assert result.stderr.startswith(f"error: {path}: no target; give the file a table [target], or --sensitivity")


@pytest.mark.parametrize(
    ("line", "option", "said"),
    [
        ('[setting]\nbase = "paper-dom"\n', ("--base", "paper-dom"), "no such design or file"),
        ('fits = "finger:200"\n', ("--fits", "finger:200"), "must be from 6 to 100 mm"),
    ],
)
@pytest.mark.parametrize("more", [(), ("--process", "any")])
def test_an_error_on_the_base_names_what_was_written(tmp_path, line, option, said, more):
    path = tmp_path / "target.toml"
    path.write_text(f"[target]\nsensitivity_kPa_per_N = 1.9\n{line}")
    result = run("select", str(path), *more)
    assert result.exit_code == 2
    key = "setting.base" if option[0] == "--base" else "target.fits"
    assert f'error: {path}: {key} = "{option[1]}": {said}' in result.stderr
    result = run("select", "--sensitivity", "1.9", *option, *more)
    assert result.exit_code == 2
    assert f"error: {' '.join(option)}: {said}" in result.stderr


def test_no_target_is_an_error():
    result = run("select")
    assert result.exit_code == 2
    assert "no target; give a target file, or --sensitivity" in result.stderr


@pytest.mark.slow
def test_no_kernel_is_loaded():
    code = (
        "import sys; from typer.testing import CliRunner; from pneutouch.cli.app import app; "
        f"assert CliRunner().invoke(app, {[*ASKED, '--json']!r}).exit_code == 0; "
        "print([m for m in ('cadquery', 'trimesh', 'matplotlib', 'xarray', 'lib3mf') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
