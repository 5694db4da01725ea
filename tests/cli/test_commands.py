"""The command line as a user meets it: figures, exit codes, JSON alone on stdout, light imports."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from functools import cache

import pytest

HEAVY = {"cadquery", "OCP", "trimesh", "matplotlib", "scipy", "lib3mf", "typst", "jinja2", "vtkmodules"}


def test_predict_gives_the_papers_limit_point_and_heights(command, root):
    result = command("predict", "paper-dome", "--model", "membrane", "--json", cwd=root)
    assert result.returncode == 0, result.stderr
    document = json.loads(result.stdout)
    point = document["limit_point"]
    assert point["driving_pressure_kPa"] == pytest.approx(41.90, abs=0.02)
    assert point["apex_height_inner_mm"] == pytest.approx(16.70, abs=0.01)
    assert point["apex_height_outer_mm"] == pytest.approx(17.40, abs=0.01)
    heights = {state["driving_pressure_kPa"]: state["apex_height_inner_mm"] for state in document["states"]}
    assert heights[12.0] == pytest.approx(10.010, abs=1e-3)
    assert heights[22.0] == pytest.approx(10.853, abs=1e-3)


def test_set_overrides_a_field(command, root):
    words = [
        "--model",
        "membrane",
        "--set",
        "membrane.material=FLX9960",
        "--set",
        "pneumatics.driving_pressures_kPa=[20]",
        "--json",
    ]
    document = json.loads(command("predict", "paper-dome", *words, cwd=root).stdout)
    assert document["limit_point"]["driving_pressure_kPa"] == pytest.approx(224.3, abs=0.05)
    assert [state["driving_pressure_kPa"] for state in document["states"]] == [20.0]


def test_designs_are_found_from_anywhere(command):
    assert command("predict", "paper-dome").returncode == 0


def test_check_exits_1_where_a_rule_is_broken_and_0_otherwise(command, root):
    assert command("check", "paper-dome", cwd=root).returncode == 0
    broken = command("check", "stiff-dome", "--set", "membrane.wall_thickness_mm=0.5", "--json", cwd=root)
    assert broken.returncode == 1
    document = json.loads(broken.stdout)
    assert document["passed"] is False
    assert document["findings"][0]["severity"] == "error"


def test_list_shows_designs_materials_printers_and_parts(command, root):
    document = json.loads(command("list", "--json", cwd=root).stdout)
    assert set(document) == {
        "designs",
        "pads",
        "specimens",
        "examples",
        "calibrations",
        "materials",
        "mixing",
        "printers",
        "gauges",
        "parts",
    }
    assert "paper-dome" in [entry["name"] for entry in document["designs"]]
    assert len(document["designs"]) >= 5
    assert {entry["kind"] for entry in document["parts"]} == {"ports", "seats", "mounts", "tubes"}
    text = command("list", "materials", cwd=root).stdout
    assert "FLX9960-DM (TangoPlus + VeroClear)" in text
    assert command("list", "material", cwd=root).returncode == 2


def test_a_group_without_entries_is_listed_as_none(command):
    assert command("list", "calibrations").stdout == "calibrations\n  none\n"


def test_list_shows_the_others_beside_a_broken_file(command, tmp_path, root):
    folder = tmp_path / "designs"
    folder.mkdir()
    whole = (root / "designs/paper-dome.toml").read_text()
    (folder / "mine.toml").write_text(whole)
    (folder / "wide.toml").write_text(whole.replace("inner_radius_mm = 9.25", 'inner_radius_mm = "wide"'))
    (folder / "torn.toml").write_text("a = [\n")
    (folder / "two words.toml").write_text(whole)
    listed = command("list", "designs", "--json")
    assert listed.returncode == 2
    entries = {entry["name"]: entry for entry in json.loads(listed.stdout)["designs"]}
    assert entries["mine"] == {"name": "mine", "title": "The paper's sensor"} and "title" in entries["paper-dome"]
    assert entries["wide"]["error"].startswith('membrane.inner_radius_mm = "wide": ')
    assert entries["torn"]["error"].startswith("line 1, column 6: this is no value")
    assert "rename the file" in entries["two words"]["error"]
    broken = {name for name, entry in entries.items() if "error" in entry}
    assert broken == {"wide", "torn", "two words"}
    assert all(entries[name]["file"] == str(folder / f"{name}.toml") and not entries[name]["title"] for name in broken)
    text = command("list")
    assert text.returncode == 2 and text.stderr.startswith(f"error: cannot be read: {folder}/torn.toml, ")
    assert re.search('^  wide +cannot be read: membrane.inner_radius_mm = "wide": ', text.stdout, re.MULTILINE)
    assert "The paper's sensor" in text.stdout and "FLX9960-DM" in text.stdout


def test_new_writes_a_design_that_predicts_and_never_overwrites(command, tmp_path):
    assert command("new", "my-sensor").returncode == 0
    path = tmp_path / "designs/my-sensor.toml"
    assert "# Inner radius R0" in path.read_text()
    assert command("predict", "my-sensor").returncode == 0
    before = path.read_text()
    again = command("new", "my-sensor")
    assert again.returncode == 2
    assert "already" in again.stderr
    assert path.read_text() == before
    hiding = command("new", "paper-dome")
    assert hiding.returncode == 2
    assert "would hide" in hiding.stderr
    for name in ("../x", "a b", "", "-x"):
        assert command("new", "--", name).returncode == 2


@pytest.mark.parametrize(
    ("words", "place", "name"),
    [
        (["select", "fingertip"], "fingertip: no such file", "fingertip"),
        (["select", "fingertip.toml"], "fingertip.toml: no such file", "fingertip"),
        (["sweep", "wall-and-resin"], "wall-and-resin: no such file", "wall-and-resin"),
        (["tray", "seven-resins"], 'design = "seven-resins": no such design or file', "seven-resins"),
        (["characterize", "campaign"], "campaign: no such file or folder", "campaign"),
        (["predict", "seven-resins"], "DESIGN seven-resins: no such design or file", "seven-resins"),
    ],
)
def test_an_example_s_name_in_place_of_a_file_states_how_to_copy_it(command, words, place, name):
    done = command(*words)
    assert done.returncode == 2
    said = done.stderr.splitlines()[-1]
    assert place in said and f"is copied by `pneutouch new --from {name}`" in said


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["select", "no-target.txt"], "no-target.txt: no such file; give the path of a target file"),
        (
            ["select", "paper-dome"],
            "paper-dome: no such file; give the path of a target file; a design is given as --base",
        ),
        (
            ["sweep", "paper-dome"],
            "paper-dome: no such file; give the path of a sweep file; a design to vary is given as",
        ),
    ],
)
def test_a_file_that_is_not_there_is_named(command, words, said):
    done = command(*words)
    assert done.returncode == 2
    assert done.stderr.startswith(f"error: {said}")


def test_one_driving_pressure_is_a_list_of_one(command):
    words = ["predict", "paper-dome", "--model", "membrane", "--json", "--set"]
    one = command(*words, "pneumatics.driving_pressures_kPa=5")
    assert one.returncode == 0, one.stderr
    assert one.stdout == command(*words, "pneumatics.driving_pressures_kPa=[5]").stdout
    wrong = command(*words, "pneumatics.driving_pressures_kPa=5000")
    assert wrong.returncode == 2
    assert wrong.stderr == "error: --set pneumatics.driving_pressures_kPa[0]=5000: must be from -100 to 1000 kPa\n"


def test_build_prints_the_folder_and_nothing_else_on_stdout(built_as_a_user):
    result, folder = built_as_a_user
    assert result.returncode == 0, result.stderr
    document = json.loads(result.stdout)
    assert document["folder"] == "sensors/paper-dome"
    assert (folder / document["folder"] / "manifest.json").is_file()
    assert "warning: walls: connector: a wall is" in result.stderr


def test_an_output_that_is_a_file_is_refused_before_any_work(command, tmp_path, monkeypatch):
    def work(*_, **__):
        raise AssertionError("the rules are checked")

    monkeypatch.setattr("pneutouch.workflows.build.refuse", work)
    (tmp_path / "file").write_text("x")
    result = command("build", "paper-dome", "--out", str(tmp_path / "file"))
    assert result.returncode == 2
    assert "--out" in result.stderr
    assert "Traceback" not in result.stderr


@cache
def modules_after(*words):
    """Names of all modules that a command has loaded when it ends."""
    code = f"import sys; sys.argv = {['pneutouch', *words]!r}\nfrom pneutouch.cli import run\ntry: run()\nexcept SystemExit: pass\nprint('MODULES', *sys.modules)"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(result.stdout.split("MODULES")[-1].split())


def rooms(modules):
    """Second parts of the names of our own modules: pneutouch.mechanics.membrane is of mechanics."""
    return {name.split(".")[1] for name in modules if name.startswith("pneutouch.")}


@pytest.mark.parametrize(
    "words",
    [
        ["--help"],
        ["predict", "--help"],
        ["predict", "paper-dome", "--model", "membrane", "--json"],
        ["predict", "paper-dome", "--model", "atlas"],
        ["list"],
    ],
)
def test_light_commands_load_no_heavy_package(words):
    assert modules_after(*words) & HEAVY == set()


@pytest.mark.parametrize("model", ["membrane", "atlas", "solid"])
def test_figures_alone_load_neither_print_rules_nor_drawings(model):
    loaded = modules_after("predict", "paper-dome", "--model", model)
    assert rooms(loaded) & {"printability", "report", "export", "output", "selection", "workflows"} == set()
    assert "pneutouch.spec.specimen" not in loaded


def test_the_solid_loads_lapack_without_the_packages_around_it():
    loaded = modules_after("predict", "paper-dome", "--model", "solid")
    assert "pneutouch.mechanics.solid.banded" in loaded
    assert not {"scipy.linalg", "scipy.sparse", "scipy.interpolate", "scipy.optimize", "numpy.f2py"} & loaded


@pytest.mark.slow
def test_a_selection_loads_neither_scipys_packages_nor_masked_arrays_and_random_numbers():
    loaded = modules_after(
        "select", *["--sensitivity", "1.9", "--at", "12", "--force-range", "15", "--max-diameter", "25"]
    )
    assert "pneutouch.mechanics.solid.banded" in loaded
    assert not {"scipy.linalg", "scipy.sparse", "numpy.ma", "numpy.random", "matplotlib", "cadquery"} & loaded


def test_a_command_loads_no_other_commands_module():
    loaded = modules_after("select", "--help")
    assert "pneutouch.cli.select" in loaded
    assert not {"pneutouch.cli.sweep", "pneutouch.cli.tray", "pneutouch.cli.calibrate"} & loaded


def test_the_command_line_computes_with_one_thread_whatever_the_environment_says():
    """The order of a threaded sum, and so the last digits of a result, would follow the number of cores."""
    code = (
        "import os, sys; sys.argv = ['pneutouch', '--version']\n"
        "import pneutouch.cli\n"
        "try: pneutouch.cli.run()\n"
        "except SystemExit: print({os.environ[name] for name in pneutouch.cli._THREADS})"
    )
    environment = {**os.environ, "OMP_NUM_THREADS": "2", "OPENBLAS_NUM_THREADS": "4"}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "{'1'}"
