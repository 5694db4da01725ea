"""``pneutouch scan`` as a user meets it."""

from __future__ import annotations

import hashlib
import json

import numpy as np
import pytest
from typer.testing import CliRunner

from pneutouch.cli import scan as command
from pneutouch.cli.app import app
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.spec.options import ScanOptions
from pneutouch.units import KPA
from pneutouch.workflows.scan import separating
from tests.schemas.held import hold, hold_folder

ASKED = ["scan", "texture-specimen", "--design", "paper-dome"]
assert command


def run(*arguments: str):
    return CliRunner().invoke(app, list(arguments))


@pytest.fixture(scope="module")
def scanned(tmp_path_factory):
    out = tmp_path_factory.mktemp("scan")
    result = run(*ASKED, "--out", str(out), "--json")
    assert result.exit_code == 0, result.stderr
    return json.loads(result.stdout), out / "texture-specimen-paper-dome-scan"


@pytest.mark.slow
def test_a_scan_is_of_its_schema(scanned):
    said, folder = scanned
    hold("scan", said)
    assert hold_folder(folder) == 2


@pytest.mark.slow
def test_stiff_state_shows_both_patterns_within_three_percent(scanned):
    said, _ = scanned
    assert [state["label"] for state in said["states"]] == ["0 kPa", "22 kPa"]
    stiff = said["states"][1]
    for pattern in stiff["patterns"]:
        assert pattern["detected"] and abs(pattern["frequency_error_relative"]) < 0.03
    surface = stiff["patterns"][0]
    assert surface["true_frequency_Hz"] == pytest.approx(4 / 3, rel=1e-6)
    assert surface["amplitude_kPa"] == pytest.approx(surface["model_amplitude_kPa"], rel=0.1)
    # The patch is smaller in the stiff state, and everything larger: the model's answer to Figure 9.
    soft = said["states"][0]
    assert soft["contact_radius_mm"] > stiff["contact_radius_mm"]
    for one, other in zip(soft["patterns"], stiff["patterns"], strict=True):
        assert one["model_amplitude_kPa"] < other["model_amplitude_kPa"]


def test_folder_holds_signals_figure_document_and_manifest(scanned):
    said, folder = scanned
    manifest = json.loads((folder / "manifest.json").read_text())
    assert set(manifest["files"]) == {"scan.json", "scan.svg", "signal-1.csv", "signal-2.csv"}
    for name, entry in manifest["files"].items():
        assert hashlib.sha256((folder / name).read_bytes()).hexdigest() == entry["sha256"]
    written = json.loads((folder / "scan.json").read_text())
    assert written.pop("format") == "pneutouch/scan/1"
    assert written == {k: v for k, v in said.items() if k != "folder"}
    lines = (folder / "signal-2.csv").read_text().splitlines()
    assert lines[0] == "time_s,pressure_kPa,place_mm,noiseless_kPa,bar_1,bar_2,bar_3"
    columns = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    assert np.diff(columns[:, 0]) == pytest.approx(0.01)
    assert columns[:, 2] == pytest.approx(said["path_mm"][0] + 4 * columns[:, 0], abs=1e-3)
    assert np.abs(columns[:, 1] - columns[:, 3]).max() < 0.02


@pytest.fixture(scope="module")
def again(tmp_path_factory):
    """The same scan, with text on stdout."""
    out = tmp_path_factory.mktemp("again")
    result = run(*ASKED, "--out", str(out))
    assert result.exit_code == 0, result.stderr
    return result.stdout, out / "texture-specimen-paper-dome-scan"


@pytest.mark.slow
def test_same_input_same_bytes(scanned, again):
    for path in sorted(scanned[1].iterdir()):
        assert (again[1] / path.name).read_bytes() == path.read_bytes(), path.name


@pytest.mark.slow
def test_measured_signals_are_read_like_simulated_ones(tmp_path):
    time = np.arange(0, 15, 0.01)
    pressure = 3 + 0.02 * np.sin(2 * np.pi * time * 4 / 3) + 0.03 * np.sin(2 * np.pi * time * 2 / 3)
    pressure += 0.002 * np.random.default_rng(1).standard_normal(time.size)
    path = tmp_path / "mine.csv"
    path.write_text(
        "time_s,pressure_kPa\n" + "\n".join(f"{t:.9g},{p:.9g}" for t, p in zip(time, pressure, strict=True))
    )
    result = run(*ASKED, "--pressures", "", "--data", str(path), "--out", str(tmp_path / "out"), "--json")
    assert result.exit_code == 0, result.stderr
    (state,) = json.loads(result.stdout)["states"]
    for pattern, size in zip(state["patterns"], (0.02, 0.03, 0.03), strict=True):
        assert pattern["detected"] and pattern["amplitude_kPa"] == pytest.approx(size, rel=0.05)


@pytest.mark.slow
def test_held_force_and_speed(tmp_path):
    result = run(*ASKED, "--control", "force", "--speed", "3", "--out", str(tmp_path), "--json")
    assert result.exit_code == 0, result.stderr
    said = json.loads(result.stdout)
    assert said["states"][0]["patterns"][0]["true_frequency_Hz"] == pytest.approx(1.0)
    assert all(pattern["model_amplitude_kPa"] == 0 for state in said["states"] for pattern in state["patterns"])


@pytest.mark.slow
def test_text_names_patterns_and_folder(again):
    text, folder = again
    assert "surface pattern" in text and "note: 22 kPa: pitches 3, 6 mm" in text
    assert text.rstrip().endswith(str(folder))


@pytest.mark.slow
def test_separate_ranks_domes():
    result = run(*ASKED, "--separate", "3@0,6@2", "--json")
    assert result.exit_code == 0, result.stderr
    said = json.loads(result.stdout)
    contrasts = [dome["contrast"] for dome in said["domes"]]
    assert contrasts == sorted(contrasts, reverse=True) and contrasts[0] > 1


@pytest.mark.slow
def test_separate_drives_no_dome_above_its_rated_pressure(library):
    """Built as it is printed, each dome at each of its pressures is within what `check` calls rated."""
    said = separating("texture-specimen", "paper-dome", "3@0,6@2", ScanOptions(), library=library)
    highest = 0.0
    for dome in said.domes:
        sizes = {f"membrane.{key}": getattr(dome, key) for key in ("inner_radius_mm", "wall_thickness_mm")}
        changes = {"membrane.material": dome.resin, **sizes, "pneumatics.driving_pressures_kPa": [0.0]}
        rating = evaluate("paper-dome", changes, model="atlas", library=library).rating
        pressures_kPa = [state.driving_pressure_kPa for state in dome.states]
        assert [rating.severity(pressure_kPa * KPA) for pressure_kPa in pressures_kPa] == [None, None]
        highest = max(highest, *(pressure_kPa / rating.pressure_kPa for pressure_kPa in pressures_kPa))
    assert highest > 0.9


@pytest.mark.slow
def test_separate_prints_a_line_a_dome_and_says_where_none_can():
    said = json.loads(run(*ASKED, "--separate", "3@0,6@2", "--json").stdout)
    assert run(*ASKED, "--separate", "3@0,6@2").stdout.count("\n") == len(said["domes"]) + 3
    none = run(*ASKED, "--separate", "3@7,6@7.9", "--noise", "100")
    assert none.exit_code == 1 and "none of" in none.stdout


SHORT = """
[block]
length_mm = {length}
[[layer]]
kind = "{kind}"
{period} = 6
{more}
"""


@pytest.mark.parametrize(
    ("length", "kind", "period", "more", "said"),
    [
        (36, "bars", "pitch_mm", "", "must last 9.7"),
        (60, "gyroid", "cell_mm", "volume_fraction = 0.4", "the scan model covers bars alone"),
    ],
)
def test_specimens_that_cannot_be_scanned(tmp_path, length, kind, period, more, said):
    path = tmp_path / "mine.toml"
    path.write_text(SHORT.format(length=length, kind=kind, period=period, more=more))
    result = run("scan", str(path), "--design", "paper-dome", "--out", str(tmp_path / "out"))
    assert result.exit_code == 2 and said in result.stderr, result.stderr


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["scan", "texture-specimn", "--design", "paper-dome"], "texture-specimn: no such"),
        (["scan", "paper-dome", "--design", "paper-dome"], "no specimen"),
        (["scan", "texture-specimen", "--design", "texture-specimen"], "is a specimen"),
        (["scan", "texture-specimen", "--design", "no-dome"], "no-dome"),
        ([*ASKED, "--pressures", "0,x"], "--pressures 0,x"),
        ([*ASKED, "--pressures", ""], "nothing to scan"),
        ([*ASKED, "--pressures", "60"], "limit point"),
        ([*ASKED, "--preload", "1000"], "reaches"),
        ([*ASKED, "--preload", "-1"], "must be from 1e-06 to 1000 N"),
        ([*ASKED, "--preload", "9"], "times the patch, whose radius is"),
        ([*ASKED, "--speed", "0"], "--speed 0"),
        ([*ASKED, "--noise", "-1"], "noise"),
        ([*ASKED, "--control", "forc"], 'must be "height" or "force"'),
        pytest.param([*ASKED, "--data", "nowhere.csv"], "nowhere.csv: no such file", marks=pytest.mark.slow),
        ([*ASKED, "--separate", "3@0"], "PITCH1@DEPTH1"),
        ([*ASKED, "--separate", "3@0,3@0"], "the same"),
        ([*ASKED, "--separate", "3@0,6@20"], "block's 8 mm"),
    ],
)
def test_wrong_input_is_said_so(arguments, said, tmp_path):
    result = run(*arguments, "--out", str(tmp_path))
    assert result.exit_code == 2 and said in result.stderr, result.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--separate", "0@0,6@2"], "a pitch must be more than 0"),
        (["--separate", "3@0,6@2", "--speed", "-4"], "--speed -4: must be from 0.01 to 1000 mm/s"),
        (["--separate", "3@0,6@2", "--preload", "nan"], "--preload nan: must be a number, such as 12.5"),
        (["--separate", "3@0,6@2", "--pressures", "0"], "--pressures cannot be given with --separate"),
        (["--speed", "1e-4"], "must be from 0.01 to 1000 mm/s"),
        (["--noise", "-1"], "--noise -1: must be from 0 to 100 kPa"),
        (["--pressures", "nan"], "--pressures nan: must be numbers with commas between, such as 20,6"),
    ],
)
def test_options_that_no_scan_can_have_are_refused(command, words, said):
    result = command("scan", "texture-specimen", "--design", "paper-dome", *words)
    assert result.returncode == 2, result.stderr
    assert said in result.stderr
    assert "Traceback" not in result.stderr


def test_a_specimen_that_is_not_there_is_named_as_one(command):
    done = command("scan", "texture", "--design", "paper-dome")
    assert done.returncode == 2
    assert done.stderr.splitlines()[-1] == (
        "error: SPECIMEN texture: no such specimen or file; give the name or the path of a specimen. "
        "Did you mean texture-specimen?"
    )
    done = command("scan", "texture-specimen", "--design", "paper-dom")
    assert "error: --design paper-dom: no such design or file" in done.stderr
