"""The recipe in a 3MF: it is everything, it comes back exactly, and one that was tampered with is refused."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pneutouch.catalogue import KINDS, Library, ResolvedDesign, load_scene
from pneutouch.catalogue.library import elastomers, shipped_root
from pneutouch.errors import InputError
from pneutouch.evaluation import evaluate
from pneutouch.evaluation.evaluate import PredictionOptions
from pneutouch.export.threemf import threemf
from pneutouch.export.threemf_read import Package, read_threemf
from pneutouch.output.files import input_hash as hash_of
from pneutouch.output.recipe import BuildRecipe, evaluate_recipe, read_recipe, scene_kinds
from pneutouch.parts import assemble
from pneutouch.spec.read import parse_changes
from pneutouch.workflows.build import build, input_hash
from tests.conftest import ROOT
from tests.export.threemf_files import recipe_in

DESIGNS = sorted(path.stem for path in (ROOT / "designs").glob("*.toml"))


def content(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def package_of(recipe: BuildRecipe, name="x.3mf") -> Package:
    """A package as reading gives it, without the file."""
    metadata = {"input-hash": hash_of(recipe.inputs(), recipe.version)}
    return Package(Path(name), (), metadata, recipe.text(), False, ())


def renamed(scene: ResolvedDesign) -> ResolvedDesign:
    return dataclasses.replace(scene, where="x.3mf")


def test_every_field_of_a_scene_has_its_shelf():
    shelves = scene_kinds()
    assert set(shelves.values()) <= set(KINDS)
    assert {*shelves, "name", "where"} == {field.name for field in dataclasses.fields(ResolvedDesign)}


@pytest.mark.parametrize("name", DESIGNS)
def test_the_recipe_of_every_design_comes_back_as_it_went(name, library):
    scene = load_scene(name, None, library)
    recipe = BuildRecipe(scene, elastomers(library), PredictionOptions("auto", "printed", "flange", 0.031))
    back = read_recipe(package_of(recipe))
    assert back == dataclasses.replace(recipe, scene=renamed(scene))
    assert back.text() == recipe.text()


@pytest.mark.parametrize("kind", ["ports", "seats", "mounts"])
def test_every_part_comes_back(kind, library):
    key = {"ports": "port", "seats": "seat", "mounts": "mount"}[kind]
    scene = load_scene("paper-dome", None, library)
    for name in library.paths(kind):
        changed = dataclasses.replace(scene, **{key: library.load(kind, name)})
        if changed.seat.family == "one-piece":
            continue
        if changed.seat.family == "cast-ring":
            changed = load_scene("cast-dome", {"connector.seat": name}, library)
        assert read_recipe(package_of(BuildRecipe(changed, {}, PredictionOptions()))).scene == renamed(changed)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    radius=st.floats(2, 100),
    share=st.floats(0.06, 0.5),
    tolerance=st.floats(0.011, 99),
    pressures=st.lists(st.floats(0, 1000), min_size=1, max_size=5, unique=True),
    title=st.text("aé漢&<\"' ", max_size=20),
)
def test_numbers_and_text_come_back_exactly(library, radius, share, tolerance, pressures, title):
    changes = [
        f"membrane.inner_radius_mm={radius!r}",
        f"membrane.wall_thickness_mm={min(radius * share, 50)!r}",
        f"pneumatics.driving_pressures_kPa={pressures!r}",
        f"document.title={json.dumps(title, ensure_ascii=False)}",
    ]
    scene = load_scene("paper-dome", parse_changes(changes), library)
    recipe = BuildRecipe(scene, {}, PredictionOptions("auto", tolerance=tolerance))
    assert read_recipe(package_of(recipe)) == dataclasses.replace(recipe, scene=renamed(scene))


def test_settings_that_the_model_does_not_use_do_not_change_the_inputs(library):
    scene = load_scene("paper-dome", None, library)
    plain = BuildRecipe(scene, {}, PredictionOptions("solid")).inputs()
    assert BuildRecipe(scene, {}, PredictionOptions("solid", closure="printed", tolerance=0.5)).inputs() == plain
    assert BuildRecipe(scene, {}, PredictionOptions("membrane", closure="printed")).inputs()["closure"] == "printed"
    assert BuildRecipe(scene, {}, PredictionOptions("auto", tolerance=0.5)).inputs()["tolerance"] == 0.5


def test_the_input_hash_in_the_file_is_that_of_the_recipe_in_it(built, evaluated):
    path = built("paper-dome") / "paper-dome.3mf"
    recipe, recorded = recipe_in(path), read_threemf(path).metadata["input-hash"]
    assert recorded == input_hash(evaluated("paper-dome")) == hash_of(recipe["inputs"], recipe["version"])
    manifest = json.loads((path.parent / "manifest.json").read_text())
    assert manifest["inputs"] == recipe["inputs"]
    assert manifest["input_hash"] == recorded


def test_a_recipe_with_a_hundred_resins_comes_back(tmp_path, library):
    """Too long for one entry of metadata."""
    resin = library.load("materials", "TangoPlus")
    recipe = BuildRecipe(
        load_scene("paper-dome", None, library), {f"{k:03}": resin for k in range(100)}, PredictionOptions()
    )
    path, metadata = (
        tmp_path / "x.3mf",
        {"recipe": recipe.text(), "input-hash": hash_of(recipe.inputs(), recipe.version)},
    )
    path.write_bytes(threemf("x", assemble(recipe.scene).bodies, metadata))
    back = read_recipe(read_threemf(path))
    assert len(recipe.text()) > 2**17
    assert back.resins == recipe.resins
    assert back.text() == recipe.text()


OPTIONS = ["membrane.material=FLX9940", "pneumatics.driving_pressures_kPa=[0]", "document.date=2026-11-21"]


def lab_evaluation(folder: Path):
    """By `auto`, of a resin of the lab's own where ``folder`` holds its file."""
    library = Library((folder, ROOT))
    return evaluate("paper-dome", parse_changes(OPTIONS), model="auto", tolerance=0.03, library=library)


@pytest.fixture(scope="module")
def lab(tmp_path_factory) -> Path:
    """A folder with a lab's own resin and mix, and what was built with it, which is the only build of the tests here."""
    folder = tmp_path_factory.mktemp("lab")
    shelf = folder / "printprofiles/materials"
    shelf.mkdir(parents=True)
    text = (ROOT / "printprofiles/materials/FLX9940.toml").read_text()
    mix = '\n[mix]\nsource = "weighed cartridges"\n[mix.fractions]\nTangoPlus = 0.75\nVeroClear = 0.25\n'
    (shelf / "FLX9940.toml").write_text(text + mix)
    evaluation = lab_evaluation(folder)
    assert evaluation.prediction.model == "atlas"
    build(evaluation, folder / "before")
    return folder


@pytest.fixture(scope="module")
def again(lab) -> Path:
    """The 3MF alone built again, under another name, where any look at a library with a user's files fails."""

    def refusing(method):
        def refuse(library=None, *words):
            assert library is not None and library.folders == (shipped_root(),), "the library was read"
            return method(library, *words)

        return refuse

    copy = lab / "renamed by a user.3MF"
    copy.write_bytes((lab / "before/paper-dome/paper-dome.3mf").read_bytes())
    with pytest.MonkeyPatch.context() as patch:
        for method in ("paths", "load", "all", "default", "design_file"):
            patch.setattr(Library, method, refusing(getattr(Library, method)))
        return build(evaluate_recipe(read_recipe(read_threemf(copy))), lab / "again")


@pytest.mark.slow
def test_a_3mf_builds_again_to_the_same_bytes_without_any_library(lab, again):
    assert content(again) == content(lab / "before/paper-dome")


@pytest.mark.slow
def test_what_was_asked_of_auto_is_asked_again(again):
    assert "meets 3.0%" in json.loads((again / "prediction.json").read_text())["error_estimate"]["model_choice"]


@pytest.mark.slow
def test_a_changed_library_changes_a_build(lab, tmp_path):
    """Its mix is in the 3MF; without it the inputs, which the 3MF holds as well, are others."""
    before = read_threemf(lab / "before/paper-dome/paper-dome.3mf")
    assert sorted(before.bodies[0].mix.values()) == [0.25, 0.75]
    assert before.metadata["input-hash"] == input_hash(lab_evaluation(lab))
    assert before.metadata["input-hash"] != input_hash(lab_evaluation(tmp_path))


def test_without_a_recipe_there_is_nothing_to_rebuild(tmp_path, evaluated):
    path = tmp_path / "plain.3mf"
    path.write_bytes(threemf("x", evaluated("paper-dome").assembly.bodies, {"Title": "t"}))
    package = read_threemf(path)
    assert package.recipe is None
    with pytest.raises(InputError, match=r"plain\.3mf: holds no recipe, so it cannot be rebuilt; give"):
        read_recipe(package)
