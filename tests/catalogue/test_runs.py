"""A material that the profile named does not make: what makes it is named, and what its file does not state."""

from __future__ import annotations

import pytest

import pneutouch as pt
from pneutouch.errors import InputError
from tests.conftest import ROOT

OWN = ("--set", "membrane.material=OurGel", "--set", "print.profile=our-casting")


@pytest.fixture
def gel(tmp_path):
    """A silicone without [casting] in a casting profile of the user's own; the material's file."""
    folder = tmp_path / "printprofiles"
    (folder / "materials").mkdir(parents=True)
    profile = (ROOT / "printprofiles/silicone-casting.toml").read_text().replace("resins = [", 'resins = ["OurGel", ')
    (folder / "our-casting.toml").write_text(profile)
    whole = (ROOT / "printprofiles/materials/DragonSkin20.toml").read_text().replace('["DragonSkin20"]', '["OurGel"]')
    whole = whole.replace('"Dragon Skin 20"', '"OurGel"')
    path = folder / "materials/OurGel.toml"
    path.write_text(whole.partition("[casting]")[0])
    return path


@pytest.mark.parametrize(
    "words",
    [
        ("check", "cast-dome", *OWN),
        ("build", "cast-dome", *OWN),
        ("predict", "cast-dome", *OWN),
        ("coupons", "--profile", "our-casting", "--material", "OurGel"),
        ("select", "--sensitivity", "2.2", "--at", "5", "--profile", "our-casting", "--material", "OurGel"),
        ("new", "mine", "--material", "OurGel"),
    ],
)
def test_a_material_is_not_cast_before_its_file_states_how(command, gel, words):
    done = command(*words)
    assert done.returncode == 2, done.stderr
    assert f"{gel}: casting: missing" in done.stderr
    assert "add the table [casting] with parts_by_mass, pot_life_min, cure_h" in done.stderr
    assert "or fit it again: pneutouch fit-material --like DragonSkin20" in done.stderr


@pytest.mark.slow
def test_it_is_left_out_of_a_search_with_the_reason(command, gel):
    words = ("--sensitivity", "2.2", "--at", "5", "--profile", "our-casting", "--material", "DragonSkin20")
    done = command("select", *words, "--material", "OurGel")
    assert done.returncode == 0, done.stderr
    assert "OurGel" in done.stdout and "its file has no table [casting]" in done.stdout


@pytest.mark.parametrize(
    ("words", "taken"),
    [
        (("check", "paper-dome", "--set", "membrane.material=DragonSkin20"), "print.profile = silicone-casting"),
        (("coupons", "--material", "DragonSkin20"), "--profile silicone-casting"),
        (("select", "--sensitivity", "2.2", "--at", "5", "--material", "DragonSkin20"), "--profile silicone-casting"),
    ],
)
def test_the_profile_that_makes_a_material_is_named(command, words, taken):
    done = command(*words)
    assert done.returncode == 2
    assert f"Dragon Skin 20 takes {taken} (process casting)" in done.stderr


@pytest.mark.slow
def test_a_search_names_the_process_as_its_option(command):
    done = command("select", "--sensitivity", "2.2", "--at", "5", "--material", "DragonSkin20")
    assert "or give --process casting" in done.stderr
    taken = ("--material", "DragonSkin20", "--process", "casting")
    assert command("select", "--sensitivity", "2.2", "--at", "5", *taken).returncode == 0


def test_a_search_in_python_names_the_keyword_that_it_has(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match="or give `processes` casting"):
        pt.select(sensitivity_kPa_per_N=2.2, driving_pressure_kPa=5, materials="DragonSkin20")
    with pytest.raises(InputError, match='= "cast": must be "any"'):
        pt.select(sensitivity_kPa_per_N=2.2, driving_pressure_kPa=5, processes="cast")


def test_a_process_is_left_out_with_the_table_that_a_file_lacks(command, gel):
    words = ("--sensitivity", "2.2", "--at", "5", "--material", "OurGel", "--process", "casting")
    done = command("select", *words)
    said = done.stdout + done.stderr
    assert done.returncode == 1, said
    assert f"casting: left out: {gel}: casting: missing" in said
    assert "add the table [casting] with parts_by_mass, pot_life_min, cure_h" in said
    assert "no profile of it" not in said
    printed = command("select", *words[:-1], "polyjet")
    assert "polyjet: left out: no profile of it makes OurGel" in printed.stdout + printed.stderr


def test_a_material_of_no_profile_is_refused_with_the_reason(command, gel):
    assert "OurGel has no table [casting]" in command("coupons", "--material", "OurGel").stderr
    (gel.parents[1] / "our-casting.toml").unlink()
    refused = command("coupons", "--material", "OurGel").stderr
    remedy = "add OurGel to the resins of a profile of your own: pneutouch new NAME --from PROFILE"
    assert f"no profile runs OurGel; {remedy}" in refused


def test_a_refusal_passes_over_a_profile_that_is_not_valid(command, tmp_path):
    """The broken file is another matter: what is refused is the material, with the profiles that can be read."""
    (tmp_path / "printprofiles").mkdir()
    (tmp_path / "printprofiles/broken.toml").write_text('title = "Ours"\nresins = 3\n')
    done = command("predict", "paper-dome", "--set", "membrane.material=DragonSkin20")
    assert done.returncode == 2
    assert "Dragon Skin 20 takes print.profile = silicone-casting (process casting)" in done.stderr
    assert "broken.toml" not in done.stderr
    search = command("select", "--sensitivity", "2.2", "--at", "5", "--material", "DragonSkin20")
    assert search.returncode == 2 and "--profile silicone-casting" in search.stderr
    assert "--process casting" in search.stderr and "broken.toml" not in search.stderr
