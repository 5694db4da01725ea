"""``fit-material``: from a laboratory's file to a material that designs use."""

from __future__ import annotations

import json
import tomllib

import numpy as np
import pytest

from pneutouch.bench.tensile.law_fit import tension
from pneutouch.catalogue import Library
from pneutouch.mechanics.models.solid import solid_result
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.spec.material import HyperelasticLaw, Material
from tests.conftest import ROOT
from tests.schemas.held import hold, hold_folder

STRETCH = np.linspace(1.02, 2.6, 80)
SILICONES = ("DragonSkin10", "DragonSkin20", "DragonSkin30", "Ecoflex0010", "Ecoflex0030", "Ecoflex0050", "MoldStar16")
SILICONES = (*SILICONES, "RTV615", "SortaClear40")


def write(path, factor=1.0):
    rows = zip(STRETCH, factor * tension("yeoh", (0.06, 0.009), STRETCH), strict=True)
    path.write_text("\n".join(["stretch,stress (MPa)", *(f"{a:.6f},{b:.8f}" for a, b in rows)]) + "\n")
    return path


def test_a_tensile_test_becomes_a_material(command, tmp_path):
    write(tmp_path / "pull.csv")
    line = ("fit-material", "pull.csv", "--name", "Ours", "--like", "DragonSkin20", "--json")
    first = command(*line, cwd=tmp_path)
    assert first.returncode == 0, first.stderr
    content = json.loads(first.stdout)
    hold("fit", content)
    assert hold_folder(tmp_path) == 2
    assert content["law"]["name"] == "yeoh"
    assert content["law"]["constants"] == pytest.approx([0.06, 0.009], rel=0.01)
    path = tmp_path / "printprofiles/materials/Ours.toml"
    law = tomllib.loads(path.read_text())["law"]
    assert law["largest_stretch"] == 2.0
    assert law["misfit_percent"] < 1
    before = path.read_bytes()
    assert command(*line, cwd=tmp_path).stdout == first.stdout
    assert path.read_bytes() == before
    assert {file.name for file in (tmp_path / "outputs/fit-Ours").iterdir()} == {"fit.json", "fit.svg", "manifest.json"}
    assert "next: pneutouch predict paper-dome --set membrane.material=Ours" in command(*line[:-1], cwd=tmp_path).stderr
    path.write_text("# mine\n" + path.read_text())
    refused = command(*line, cwd=tmp_path)
    assert refused.returncode == 2
    assert "was not written by pneutouch fit-material" in refused.stderr


def test_tension_and_equibiaxial_data_give_a_law_of_two_invariants(command, tmp_path):
    for name, ratio, most in (("pull", -0.5, 2.4), ("both", 1.0, 1.6)):
        stretch = np.linspace(1.02, most, 30)
        stress = tension("mooney-rivlin", (0.06, 0.02), stretch, ratio)
        rows = [f"{a:.6f},{b:.8f}" for a, b in zip(stretch, stress, strict=True)]
        (tmp_path / f"{name}.csv").write_text("\n".join(["stretch,engineering stress (MPa)", *rows]) + "\n")
    line = ("fit-material", "pull.csv", "both.csv", "--name", "Ours", "--like", "DragonSkin20")
    done = command(*line, "--kinds", "tension,equibiaxial", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    content = json.loads(done.stdout)
    hold("fit", content)
    assert [one["kind"] for one in content["specimens"]] == ["tension", "equibiaxial"]
    law = tomllib.loads((tmp_path / "printprofiles/materials/Ours.toml").read_text())["law"]
    assert law["name"] == "mooney-rivlin"
    assert law["constants"] == pytest.approx([0.06, 0.02], rel=0.01)
    assert law["kinds"] == ["tension", "equibiaxial"]
    wrong = command(*line, "--kinds", "tension", cwd=tmp_path)
    assert wrong.returncode == 2
    assert "--kinds" in wrong.stderr


def test_three_specimens_give_low_high_and_spread(command, tmp_path):
    for k, factor in enumerate((0.9, 1.0, 1.1)):
        write(tmp_path / f"{k}.csv", factor)
    done = command("fit-material", "0.csv", "1.csv", "2.csv", "--name", "Ours", "--density", "1.1", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    modulus = tomllib.loads((tmp_path / "printprofiles/materials/Ours.toml").read_text())["shear_modulus_MPa"]
    assert modulus["low"] == pytest.approx(0.9 * modulus["value"], rel=0.02)
    assert modulus["spread"] == pytest.approx(0.1 * modulus["value"], rel=0.05)


@pytest.mark.parametrize(
    ("words", "match"),
    [
        (("pull.csv", "--name", "Ours"), "--density"),
        (("pull.csv", "--name", "Ours", "--like", "ABS"), "is rigid"),
        (("pull.csv", "--name", "a/b", "--density", "1"), "cannot be a name"),
        (("pull.csv", "--name", "Ours", "--density", "1", "--puck", "20"), "such as 20x6"),
        (("pull.csv", "--name", "Ours", "--density", "1", "--shore-a", "200"), "from 0 to 100"),
        (("pull.csv", "--name", "Ours", "--density", "1", "--stretch-to", "0.5"), "from 1.1 to 20"),
        (
            ("pull.csv", "--name", "Ours", "--density", "1030"),
            "--density 1030: must be from 0.5 to 3 g/cm3; is it in kg",
        ),
        (("pull.csv", "--name", "Ours", "--density", "0"), "--density 0: must be from 0.5 to 3 g/cm3"),
        (("none.csv", "--name", "Ours", "--density", "1"), "no such file"),
    ],
)
def test_bad_input_is_refused_and_leaves_nothing(command, tmp_path, words, match):
    write(tmp_path / "pull.csv")
    done = command("fit-material", *words, cwd=tmp_path)
    assert done.returncode == 2
    assert match in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["pull.csv"]


def test_data_that_no_law_follows_make_no_material(command, tmp_path):
    """Of two specimens, one twice as stiff, and of one that yields."""
    write(tmp_path / "soft.csv")
    write(tmp_path / "stiff.csv", factor=2.5)
    rows = [f"{a:.6f},{0.1 * (1 - np.exp(-25 * (a - 1))):.8f}" for a in STRETCH]
    (tmp_path / "yields.csv").write_text("\n".join(["stretch,stress (MPa)", *rows]) + "\n")
    for files in (["soft.csv", "stiff.csv"], ["yields.csv"]):
        done = command("fit-material", *files, "--name", "Ours", "--density", "1.03", cwd=tmp_path)
        assert done.returncode == 2, done.stdout
    assert not (tmp_path / "outputs").exists()


@pytest.mark.parametrize("name", SILICONES)
def test_the_shipped_silicones_state_their_fit(name):
    material = Library((ROOT,)).load("materials", name)
    assert material.is_cast
    law, modulus = material.law, material.shear_modulus_MPa
    assert law.largest_stretch == (2.5 if modulus.nominal < 0.1 else 2.0)
    assert law.misfit_percent <= (8.0 if name in ("Ecoflex0010", "Ecoflex0030") else 5.0)
    assert "10.1089/soro.2019.0115" in law.source and "ODbL" in law.source
    sensor = material_sensor(material)
    assert sensor.wall.shear_modulus == modulus.nominal
    assert (sensor.wall.law is None) == (law.name == "neo-hookean")


def bare(largest):
    """Dragon Skin 20 with its law, as if fitted up to a stretch."""
    material: Material = Library((ROOT,)).load("materials", "DragonSkin20")
    law = HyperelasticLaw(**{**material.law.model_dump(), "largest_stretch": largest})
    return material_sensor(material.model_copy(update={"law": law}))


def test_a_law_asked_beyond_its_range_is_reported():
    short, long = (solid_result(bare(largest), np.array([0.0]), cells=16) for largest in (1.3, 6.0))
    (event,) = [event for event in short.states[0].events if event.kind == "law range"]
    assert not event.ends_range
    assert "fitted up to 1.3" in event.message
    assert not [event for event in long.states[0].events if event.kind == "law range"]
    assert short.limits.law_range < (long.limits.law_range or np.inf)
    assert ("law range", short.limits.law_range) in short.limits.named()


def test_python_gives_what_the_command_gives(tmp_path, monkeypatch):
    import pneutouch as pt

    monkeypatch.chdir(tmp_path)
    result = pt.fit_material(write(tmp_path / "pull.csv"), "Ours", like="DragonSkin20", lab="Soft lab")
    assert result["law"]["label"] == "Yeoh, 2 terms"
    assert not (tmp_path / "printprofiles").exists()
    result.save("out")
    written = tomllib.loads((tmp_path / "printprofiles/materials/Ours.toml").read_text())
    assert written["law"]["source"].endswith("Soft lab")
    with pytest.raises(pt.InputError, match="stretch_to"):
        pt.fit_material(tmp_path / "pull.csv", "Ours", like="DragonSkin20", stretch_to=0.5)


def test_a_material_of_no_profile_is_stated_to_need_casting(command, tmp_path):
    write(tmp_path / "pull.csv")
    line = ("fit-material", "pull.csv", "--name", "Ours", "--density", "1.1")
    missing = "printprofiles/materials/Ours.toml has no table [casting], which a material that is cast needs"
    done = command(*line, cwd=tmp_path)
    assert missing in done.stderr
    assert (
        "add Ours to the resins of a profile of your own (pneutouch new PROFILE --from silicone-casting" in done.stderr
    )
    assert "[casting]" not in command(*line[:4], "--like", "DragonSkin20", cwd=tmp_path).stderr
