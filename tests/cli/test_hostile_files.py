"""Files made to reach what is not theirs: the commands refuse them in one message and write nothing outside."""

from __future__ import annotations

import json
import tomllib
import zipfile

import pytest

from tests.conftest import ROOT

SECRET = "TOP-SECRET-LINE"

CAMPAIGN = """
design = "paper-dome"
[[runs]]
file = {file}
sensor = "A"
resin = "TangoPlus"
"""


@pytest.fixture
def outside(tmp_path):
    (tmp_path / "secret.csv").write_text(f"{SECRET}\n1,2,3\n")
    (tmp_path / "secret.toml").write_text(f"{SECRET} = 1\n[membrane]\n")
    (tmp_path / "inner").mkdir()
    return tmp_path / "inner"


def refused(done, *words):
    assert done.returncode == 2, done.stderr
    assert "internal fault" not in done.stderr and SECRET not in done.stderr + done.stdout
    for word in words:
        assert word in done.stderr, done.stderr


@pytest.mark.parametrize("file", ["../secret.csv", "ABSOLUTE", "link.csv"])
@pytest.mark.parametrize("verb", ["characterize", "calibrate"])
def test_a_campaigns_run_stays_in_its_folder(verb, file, outside, tmp_path, command):
    (outside / "link.csv").symlink_to(tmp_path / "secret.csv")
    name = file.replace("ABSOLUTE", str(tmp_path / "secret.csv"))
    (outside / "campaign.toml").write_text(CAMPAIGN.format(file=json.dumps(name)))
    refused(command(verb, "inner"), "runs[0].file", "leads out of the folder")
    assert not (tmp_path / "outputs").exists()


def test_a_campaigns_design_stays_in_its_folder(outside, command):
    (outside / "campaign.toml").write_text('design = "../secret.toml"' + CAMPAIGN.format(file='"a.csv"')[22:])
    refused(command("characterize", "inner"), "campaign.toml", "design", "leads out of the folder")


def test_a_sweeps_and_a_trays_design_stay_in_their_folder(outside, tmp_path, command):
    (outside / "sweep.toml").write_text(
        f'design = "{tmp_path}/secret.toml"\n[grid]\n"membrane.wall_thickness_mm" = [1, 2]'
    )
    refused(command("sweep", "inner/sweep.toml"), "design", "leads out of the folder")
    (outside / "tray.toml").write_text('[[entry]]\ndesign = "../secret.toml"')
    refused(command("tray", "inner/tray.toml"), "entry.design", "leads out of the folder")


def test_a_targets_base_stays_in_its_folder(outside, command):
    (outside / "target.toml").write_text('[target]\nsensitivity_kPa_per_N = 2\n[setting]\nbase = "../secret.toml"')
    refused(command("select", "inner/target.toml"), "setting.base", "leads out of the folder")


@pytest.mark.slow
def test_a_campaign_planned_for_a_file_holds_that_file(tmp_path, command):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/dome.toml").write_text("[membrane]\ninner_radius_mm = 8\n")
    done = command("plan", "mine/dome.toml", "--specimens", "1")
    assert done.returncode == 0, done.stderr
    folder = tmp_path / "outputs/dome-plan"
    assert tomllib.loads((folder / "campaign.toml").read_text())["design"] == "dome.toml"
    assert (folder / "dome.toml").read_bytes() == (tmp_path / "mine/dome.toml").read_bytes()


def test_a_results_files_name_writes_no_tables_into_a_profile(tmp_path, command):
    name = 'a\n[shore_a]\nvalue = 1\nsource = "x"\n#.toml'
    (tmp_path / name).write_text('lab = "our lab"\ndate = 2026-11-21\n[puck.TangoPlus]\nshore_a = [27, 28, 29]\n')
    done = command("coupons", "--results", name)
    assert done.returncode == 0, done.stderr
    written = (tmp_path / "printprofiles/materials/TangoPlus.toml").read_text()
    assert tomllib.loads(written)["shore_a"]["value"] == 28
    assert written.splitlines()[0].startswith("# Written by pneutouch coupons from a-[shore_a]-value")


@pytest.mark.parametrize("name", ["..toml", "a\nb.toml", "a\\b.toml", f"{'x' * 150}.toml"])
@pytest.mark.parametrize("verb", ["build", "predict", "plan"])
def test_a_design_whose_file_name_names_nothing_is_refused(verb, name, tmp_path, command):
    (tmp_path / name).write_text("[membrane]\n")
    refused(command(verb, f"./{name}"), "rename the file")
    assert not (tmp_path / "outputs").exists()


@pytest.mark.parametrize(
    "verb", ["predict", "check", "build", "plan", "simulate", "tray", "show", "scan", "characterize"]
)
def test_names_that_no_file_can_have(verb, command):
    for name in ("x" * 300, "a/" * 3000 + "b.toml", "x" * 300 + ".toml"):
        refused(command(verb, name))


@pytest.mark.parametrize("out", [".", "..", "", "/", "x" * 300 + ".nc", "a.nc/b.nc"])
def test_a_sweeps_output_that_is_no_file(out, command, tmp_path):
    (tmp_path / "a.nc").write_text("")
    grid = ["--design", "paper-dome", "--over", "membrane.wall_thickness_mm=1,2", "--model", "membrane"]
    refused(command("sweep", *grid, "--out", out))
    assert [path.name for path in tmp_path.iterdir()] == ["a.nc"]


@pytest.mark.parametrize("versions", ["{", "[1]", '"x"', "9" * 5000, "[" * 5000])
def test_a_3mf_whose_versions_are_damaged_is_shown_and_rebuilt_without_them(versions, built, tmp_path, command):
    source = built("paper-dome") / "paper-dome.3mf"
    marked = tmp_path / "marked.3mf"
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(marked, "w") as new:
        for entry in old.namelist():
            content = old.read(entry)
            if entry.endswith(".model"):
                start = (
                    content.index(
                        b">",
                        content.index(b'name="pt:versions"' if b'name="pt:versions"' in content else b':versions"'),
                    )
                    + 1
                )
                content = (
                    content[:start] + versions.encode().replace(b'"', b"&quot;") + content[content.index(b"<", start) :]
                )
            new.writestr(entry, content)
    done = command("show", "marked.3mf", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["recipe"]["versions"] == {}


def test_a_damaged_journal_is_left_aside(tmp_path, command):
    from pneutouch.output.files import digest

    grid = ["sweep", "--design", "paper-dome", "--over", "membrane.wall_thickness_mm=1,2", "--model", "membrane"]
    parts = tmp_path / "a.nc.parts"
    parts.mkdir()
    lines = [b"", b"\xff\xfe", b"{}", b"[1]", b'"x"', b'{"sweep": 1}', b'{"sweep": "x", "records": 3}', b"9" * 5000]
    (parts / "journal").write_bytes(b"\n".join(digest(line)[:16].encode() + b" " + line for line in lines) + b"\n")
    done = command(*grid, "--out", "a.nc")
    assert done.returncode == 0, done.stderr
    assert command(*grid, "--out", "b.nc").returncode == 0
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()
    assert not parts.exists()


def test_shipped_files_obey_the_rule_of_names():
    from pneutouch.spec.values import name_of

    for path in (*ROOT.glob("designs/**/*.toml"), *ROOT.glob("docs/examples/*.toml")):
        assert name_of(path) == path.stem
