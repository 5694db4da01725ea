"""New files: a commented design, and copies of designs, specimens, examples and profiles."""

from __future__ import annotations

import json
import tomllib

import pytest

from pneutouch.catalogue import DesignSource, Library, load_scene
from pneutouch.catalogue.library import COMMANDS, examples
from pneutouch.parts import assemble
from pneutouch.shape import SHAPES, starting_sizes
from tests.conftest import ROOT


def test_a_design_is_copied_with_its_comments_to_a_name_of_its_own(command, tmp_path):
    done = command("new", "mine", "--from", "graded-dome")
    assert (done.returncode, done.stdout, done.stderr) == (0, "designs/mine.toml\n", "next: pneutouch check mine\n")
    assert (tmp_path / "designs/mine.toml").read_text() == (ROOT / "designs/graded-dome.toml").read_text()
    again = command("new", "mine", "--from", "graded-dome")
    assert again.returncode == 2 and "there is such a file already" in again.stderr
    nameless = command("new", "--from", "graded-dome")
    assert nameless.returncode == 2 and "NAME: graded-dome is the name of the original" in nameless.stderr


def test_a_design_is_copied_from_a_path_as_well_and_a_bad_one_is_not(command, tmp_path):
    (tmp_path / "theirs.toml").write_text("[membrane]\ninner_radius_mm = 7\n")
    assert command("new", "mine", "--from", "theirs.toml").returncode == 0
    assert (tmp_path / "designs/mine.toml").read_text() == "[membrane]\ninner_radius_mm = 7\n"
    (tmp_path / "bad.toml").write_text("[membrane]\ninner_radius_mm = -7\n")
    bad = command("new", "other", "--from", "bad.toml")
    assert bad.returncode == 2 and "inner_radius_mm = -7" in bad.stderr
    assert not (tmp_path / "designs/other.toml").exists()


def test_a_specimen_goes_where_specimens_are_found(command):
    done = command("new", "waves", "--from", "texture-specimen")
    assert (done.stdout, done.stderr) == ("designs/specimens/waves.toml\n", "next: pneutouch check waves\n")
    found = json.loads(command("list", "specimens", "--json").stdout)["specimens"]
    assert "waves" in [entry["name"] for entry in found]


@pytest.mark.parametrize("name", examples())
def test_an_example_goes_to_the_working_folder_and_its_command_is_named(name, command, tmp_path):
    done = command("new", "--from", name)
    kind = examples()[name].kind
    path = f"{name}/campaign.toml" if kind == "campaign" else f"{name}.toml"
    assert (done.returncode, done.stdout) == (0, f"{path}\n")
    assert (tmp_path / path).read_bytes() == (ROOT / "docs/examples" / f"{name}.toml").read_bytes()
    first = f"put the files of your runs into {name} and name them in {path}, then"
    before, words = (first, name) if kind == "campaign" else ("next", path)
    assert done.stderr == f"{before}: pneutouch {COMMANDS[kind]} {words}\n"
    assert command("new", "--from", name).returncode == 2


def test_the_campaign_is_one_whose_files_are_still_to_come(command):
    command("new", "mine", "--from", "campaign")
    done = command("characterize", "mine")
    assert done.returncode == 2
    assert "mine/tip-1-0kPa-1.csv" in done.stderr and "no such file" in done.stderr


def test_examples_are_listed_with_their_kind(command):
    listed = json.loads(command("list", "examples", "--json").stdout)["examples"]
    assert {entry["name"]: entry["kind"] for entry in listed} == {
        "campaign": "campaign",
        "fingertip": "target",
        "seven-resins": "tray",
        "wall-and-resin": "sweep",
    }
    assert "What a fingertip needs" in command("list", "examples").stdout


@pytest.mark.parametrize(
    ("source", "path", "after"),
    [
        ("silicone-casting", "printprofiles/ours.toml", "coupons --profile ours"),
        ("smc-pse543", "printprofiles/gauges/ours.toml", "predict paper-dome --set pneumatics.gauge=ours"),
        ("DragonSkin20", "printprofiles/materials/ours.toml", "new ours-dome --material ours"),
        ("VeroClear", "printprofiles/materials/ours.toml", "list materials"),
    ],
)
def test_a_profile_is_copied_to_where_its_name_is_found(command, tmp_path, source, path, after):
    done = command("new", "ours", "--from", source)
    assert (done.returncode, done.stdout) == (0, f"{path}\n"), done.stderr
    shipped = path.replace("ours.toml", f"{source}.toml")
    assert (tmp_path / path).read_bytes() == (ROOT / shipped).read_bytes()
    first, then = done.stderr.split(", then: pneutouch ")
    assert first.startswith("put the title") and first.endswith(path)
    assert then == f"{after}\n"
    followed = command(*after.split())
    assert followed.returncode == 0, followed.stderr
    again = command("new", "ours", "--from", source)
    assert again.returncode == 2 and "there is such a file already" in again.stderr


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (
            ["abs-filament", "--from", "j735"],
            "abs-filament.toml is a printer of this name, which the new file would hide",
        ),
        (["--from", "j735"], "j735 is the name of the original; give the copy another name"),
        (["../ours", "--from", "j735"], "cannot be a name"),
        (["ours", "--from", "j735", "--set", "print.profile=j735"], "change the file of the copy"),
        (
            ["ours", "--from", "j735", "--out", "here"],
            "--out here: is of designs, specimens and examples; leave it out",
        ),
        (["ours", "--from", "smc-pse54"], "Did you mean smc-pse543?"),
    ],
)
def test_a_copy_of_a_profile_hides_none_and_takes_nothing_of_a_design(command, tmp_path, words, problem):
    done = command("new", *words)
    assert done.returncode == 2 and problem in done.stderr, done.stderr
    assert not (tmp_path / "printprofiles").exists() and not (tmp_path / "here").exists()


@pytest.mark.slow
def test_a_silicone_of_a_laboratorys_own_is_cast_on_a_copied_profile(command, tmp_path):
    """The way from the installed program: a material, a profile that runs it, a design, its print rules."""
    command("new", "our-casting", "--from", "silicone-casting")
    command("new", "OurGel", "--from", "DragonSkin20")
    for path, before, after in (
        ("printprofiles/our-casting.toml", 'resins = ["DragonSkin20", ', 'resins = ["OurGel", '),
        ("printprofiles/materials/OurGel.toml", 'base_resins = ["DragonSkin20"]', 'base_resins = ["OurGel"]'),
    ):
        text = (tmp_path / path).read_text()
        assert before in text
        (tmp_path / path).write_text(text.replace(before, after))
    done = command("new", "gel-dome", "--material", "OurGel")
    assert done.returncode == 0 and "profile our-casting " in done.stderr, done.stderr
    checked = command("check", "gel-dome")
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_what_there_is_not_is_refused(command):
    unknown = command("new", "mine", "--from", "fingertipp")
    assert unknown.returncode == 2 and "--from fingertipp" in unknown.stderr and "fingertip" in unknown.stderr
    assert command("new").returncode == 2
    assert command("new", "../x", "--from", "fingertip").returncode == 2
    assert command("new", "paper-dome", "--from", "fingertip-dome").returncode == 2


def written(tmp_path, name):
    return tomllib.loads((tmp_path / f"designs/{name}.toml").read_text())


@pytest.mark.slow
def test_a_process_brings_a_profile_a_seat_without_glue_and_pressures_that_it_stands(command, tmp_path):
    done = command("new", "mine", "--process", "casting", "--material", "DragonSkin20")
    assert (done.returncode, done.stdout) == (0, "designs/mine.toml\n")
    taken = "profile silicone-casting (Silicone casting in printed moulds) runs DragonSkin20"
    assert done.stderr == f"{taken}\nnext: pneutouch check mine\n"
    design = written(tmp_path, "mine")
    assert design["membrane"]["material"] == "DragonSkin20"
    assert design["print"] == {**design["print"], "profile": "silicone-casting", "connector_profile": "abs-filament"}
    assert Library.default().load("seats", design["connector"]["seat"]).family != "glued-flange"
    checked = command("check", "mine")
    assert checked.returncode == 0, checked.stdout
    assert "driving" not in checked.stdout


def test_a_material_alone_takes_the_printer_that_runs_it(command, tmp_path):
    done = command("new", "mine", "--material", "Agilus30")
    assert done.returncode == 0 and "profile j735 " in done.stderr
    assert written(tmp_path, "mine")["print"]["profile"] == "j735"
    done = command("new", "other", "--process", "polyjet")
    assert "runs TangoPlus, the resin taken because none is given" in done.stderr
    assert written(tmp_path, "other")["membrane"]["material"] == "TangoPlus"


def test_of_several_profiles_that_run_a_resin_the_first_is_stated_and_the_others_named(command, tmp_path):
    own = (ROOT / "printprofiles/j735.toml").read_text().replace("Stratasys J735", "The printer next door")
    (tmp_path / "printprofiles").mkdir()
    (tmp_path / "printprofiles/next-door.toml").write_text(own)
    done = command("new", "mine", "--material", "Agilus30")
    taken = written(tmp_path, "mine")["print"]["profile"]
    others = {"j735", "j750", "j850", "next-door"} - {taken}
    assert f"profile {taken} (" in done.stderr and all(other in done.stderr for other in others)
    assert command("new", "plain").stderr == "next: pneutouch check plain\n"
    assert (
        written(tmp_path, "plain")["connector"]["port"]
        == written(tmp_path, "mine")["connector"]["port"]
        != "barb-4x2.5"
    )


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (["--process", "casting", "--material", "TangoPlus"], "TangoPlus is not made by it; it takes polyjet"),
        (["--process", "cast"], "--process cast: unknown. Did you mean casting?"),
        (["--process", "filament", "--material", "Elastic50A"], "is not made by it; it takes resin"),
        (["--process", "casting", "--material", "ABS"], "ABS is rigid"),
        (["--material", "DragonSkn20"], "no such name among the materials. Did you mean DragonSkin20?"),
        (["--from", "paper-dome", "--process", "casting"], "--process cannot be given with a copy"),
    ],
)
def test_a_process_the_resin_is_not_made_by_is_refused(command, tmp_path, words, problem):
    done = command("new", "mine", *words)
    assert done.returncode == 2 and problem in done.stderr, done.stderr
    assert not (tmp_path / "designs").exists()


@pytest.mark.parametrize("shape", [name for name in SHAPES if name != "hemisphere"])
def test_a_new_design_of_every_shape_states_its_sizes_and_can_be_drawn(shape, command, tmp_path, library):
    assert command("new", "pad", "--shape", shape, "--out", str(tmp_path)).returncode == 0
    source = DesignSource.of(str(tmp_path / "pad.toml"), library)
    membrane = source.changed({}).membrane
    assert membrane.shape == shape
    assert starting_sizes(shape, membrane.inner_radius_mm).items() <= membrane.model_dump().items()
    assert assemble(load_scene(source, {}, library)).bodies


@pytest.mark.parametrize("process", ["filament", "resin", "polyjet"])
def test_a_new_design_of_every_printing_process_passes_its_check(command, process):
    assert command("new", "mine", "--process", process).returncode == 0
    checked = command("check", "mine", "--json")
    assert checked.returncode == 0
    severities = {finding["severity"] for finding in json.loads(checked.stdout)["findings"]}
    assert severities <= {"note"}


def test_a_process_cannot_be_given_with_a_copy_and_the_remedy_is_one(command):
    """``--set`` changes a design; a profile is changed in its file."""
    refused = command("new", "x", "--from", "TangoPlus", "--process", "casting")
    assert refused.returncode == 2
    assert "--process cannot be given with a copy" in refused.stderr
    assert "it is one of the materials: change the file of the copy" in refused.stderr and "--set" not in refused.stderr
    of_design = command("new", "x", "--from", "paper-dome", "--process", "casting")
    assert of_design.returncode == 2 and "change it with --set" in of_design.stderr


def test_every_known_name_is_listed_once(command, tmp_path):
    command("new", "ours", "--from", "j735")
    command("new", "ours", "--from", "smc-pse543")
    listed = command("new", "x", "--from", "zzzzzzzzzzzzzzzz").stderr
    names = listed.partition("Known: ")[2].strip().rstrip(".").split(", ")
    assert "ours" in names and len(names) == len(set(names))


def test_a_name_of_two_kinds_is_not_copied_by_chance(command, tmp_path):
    command("new", "ours", "--from", "j735")
    assert command("new", "ours", "--from", "smc-pse543").returncode == 0
    for more in ((), ("--process", "casting")):
        refused = command("new", "x", "--from", "ours", *more)
        assert refused.returncode == 2, refused.stdout
        assert "--from ours: stands for one of the printers (" in refused.stderr
        assert "ours.toml) and one of the gauges (" in refused.stderr
        assert "give the one to copy a name of its own" in refused.stderr
    assert not (tmp_path / "printprofiles/x.toml").exists()


def test_a_new_design_takes_changes_with_its_process_and_writes_nothing_for_a_wrong_one(command, tmp_path):
    words = ["--process", "filament", "--set", "connector.seat=clamped-flange-M2-gasket"]
    made = command("new", "soft", *words, "--set", "membrane.inner_radius_mm=8")
    assert made.returncode == 0, made.stderr
    written = tomllib.loads((tmp_path / "designs" / "soft.toml").read_text())
    assert written["connector"]["seat"] == "clamped-flange-M2-gasket" and written["membrane"]["inner_radius_mm"] == 8
    assert written["print"]["profile"] == "tpu-filament"
    assert command("check", "soft").returncode == 0
    wrong = command("new", "other", *words, "--set", "membrane.inner_radius_mm=-8")
    assert wrong.returncode == 2 and not (tmp_path / "designs" / "other.toml").exists()
