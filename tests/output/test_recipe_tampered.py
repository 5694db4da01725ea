"""Recipes that were damaged or tampered with: refused, naming the file and what would be right."""

from __future__ import annotations

from pathlib import Path

import pytest

from pneutouch.errors import InputError
from pneutouch.export.threemf_read import read_threemf
from pneutouch.mechanics.models.choice import DEFAULT_TOLERANCE
from pneutouch.output.recipe import evaluate_recipe, other_versions, read_recipe
from pneutouch.workflows.build import build
from tests.export.threemf_files import with_metadata, with_recipe
from tests.refusals import refused


@pytest.fixture(scope="session")
def cheap(tmp_path_factory, evaluated) -> Path:
    """A 3MF whose prediction costs nothing."""
    evaluation = evaluated("paper-dome", "pneumatics.driving_pressures_kPa=[0]", model="membrane")
    return build(evaluation, tmp_path_factory.mktemp("cheap")) / "paper-dome.3mf"


def remove(*path):
    def change(recipe):
        for key in path[:-1]:
            recipe = recipe[key]
        del recipe[path[-1]]

    return change


def put(value, *path):
    def change(recipe):
        for key in path[:-1]:
            recipe = recipe[key]
        recipe[path[-1]] = value

    return change


def copied(source, target):
    def change(recipe):
        recipe["inputs"][target] = recipe["inputs"][source]

    return change


def at(*path):
    return ("inputs", *path)


TAMPERED = {
    "radius out of range": (
        put(1000.0, *at("design", "membrane", "inner_radius_mm")),
        "design: membrane.inner_radius_mm = 1000.0: must be from 1 to 100 mm",
    ),
    "wall as text": (
        put("thick", *at("design", "membrane", "wall_thickness_mm")),
        'design: membrane.wall_thickness_mm = "thick": must be a number',
    ),
    "unknown key": (put(1, *at("design", "membrane", "radius")), "design: membrane.radius: unknown key"),
    "steps without end": (put(10**9, *at("design", "indentation", "steps")), "from 2 to 1000"),
    "not a date": (put("soon", *at("design", "document", "date")), "document.date"),
    "document a list": (put([], *at("design", "document")), "document"),
    "design a number": (put(3, *at("design")), "design = 3: must be a table"),
    "a bad colour": (put("red", *at("membrane_material", "colour")), "membrane_material: colour"),
    "no source": (
        remove(*at("membrane_material", "shear_modulus_MPa", "source")),
        "membrane_material: shear_modulus_MPa.source: missing",
    ),
    "no port": (remove(*at("port")), "inputs: port: missing"),
    "unknown input": (put({}, *at("ports")), "inputs: ports: unknown. Did you mean port?"),
    "another family": (put("needle", *at("port", "family")), "port: family"),
    "resin under a rigid name": (copied("connector_material", "membrane_material"), "is rigid; it must be elastomer"),
    "connector of rubber": (copied("membrane_material", "connector_material"), "is elastomer; it must be rigid"),
    "a printer that cannot": (copied("connector_printer", "printer"), "cannot run TangoPlus"),
    "a step without end": (put(1e-12, *at("printer", "resolution", "x_um")), "their steps must be at least 0.001 mm"),
    "a rigid resin to compare": (put({}, *at("compared_resins", "ABS")), "compared_resins.ABS"),
    "resins a list": (put([], *at("compared_resins")), "compared_resins: must be a table"),
    "model": (put("oracle", *at("model")), 'model = "oracle": unknown'),
    "model a list": (put(["solid"], *at("model")), "model = "),
    "clamp": (put("knee", *at("clamp")), 'clamp = "knee": unknown'),
    "closure": (put("open", *at("closure")), 'closure = "open": unknown'),
    "closure missing": (put(None, *at("closure")), "closure = nothing: must be given with model membrane"),
    "tolerance given": (put(0.1, *at("tolerance")), "tolerance = 0.1: must not be given with model membrane"),
    "inputs a list": (put([], "inputs"), "inputs"),
    "no inputs": (remove("inputs"), "inputs: missing"),
    "another form": (put(2, "format"), "format = 2: not the format of this file"),
    "form as text": (put("1", "format"), 'format = "1": not the format of this file'),
    "name with a way out": (put("../../home/x", "name"), 'name = "../../home/x": cannot be a name; use letters'),
    "name absolute": (put("/etc/x", "name"), "cannot be a name; use letters"),
    "name of another system": (put("..\\x", "name"), "cannot be a name; use letters"),
    "name of dots": (put("..", "name"), "cannot be a name; use letters"),
    "no name": (put("", "name"), "cannot be a name; use letters"),
    "name with a line": (put("a\nb", "name"), "cannot be a name; use letters"),
    "name without end": (put("x" * 300, "name"), "cannot be a name; use letters"),
    "name a number": (put(7, "name"), "name = 7"),
    "version with a line": (put("1\nerror", "version"), "must be a version number"),
}


@pytest.mark.parametrize(("change", "said"), TAMPERED.values(), ids=TAMPERED.keys())
def test_a_forged_recipe_is_refused_with_the_file_and_what_would_be_right(cheap, tmp_path, change, said):
    path = with_recipe(cheap, tmp_path / "bad.3mf", change)
    with pytest.raises(InputError) as error:
        read_recipe(read_threemf(path))
    lines = str(error.value).splitlines()
    assert all(line.startswith(f"{path}: recipe: ") for line in lines), lines
    assert said in str(error.value)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    "text",
    ["", "{", "[]", "null", "3", '"x"', "[" * 60_000, '{"format": 1, "name": NaN}', '{"format": Infinity}', "{}"],
)
def test_a_damaged_recipe_is_refused(cheap, tmp_path, text):
    path = with_metadata(cheap, tmp_path / "bad.3mf", recipe=text)
    with pytest.raises(InputError, match=r"bad\.3mf: recipe: "):
        read_recipe(read_threemf(path))


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 0, -0.1, 100, "2%", True])
def test_a_tolerance_out_of_range_is_refused(cheap, tmp_path, value):
    def change(recipe):
        recipe["inputs"] |= {"model": "auto", "closure": "variational", "tolerance": value}

    path = with_recipe(cheap, tmp_path / "bad.3mf", change, rehash=value not in (float("inf"),) and value == value)
    with pytest.raises(InputError, match=r"tolerance|not a number"):
        read_recipe(read_threemf(path))


def test_a_value_altered_within_its_range_is_refused(cheap, tmp_path):
    change = put(9.3, *at("design", "membrane", "inner_radius_mm"))
    path = with_recipe(cheap, tmp_path / "bad.3mf", change, rehash=False)
    with pytest.raises(InputError, match=r"recipe: altered or damaged: it does not match the input hash"):
        read_recipe(read_threemf(path))
    honest = with_recipe(cheap, tmp_path / "good.3mf", change)
    assert read_recipe(read_threemf(honest)).scene.design.membrane.inner_radius_mm == 9.3


def test_what_cannot_be_evaluated_names_the_3mf(cheap, tmp_path):
    beyond = with_recipe(cheap, tmp_path / "a.3mf", put([500.0], *at("design", "pneumatics", "driving_pressures_kPa")))
    with refused("pneumatics.driving_pressures_kPa[0]", 500.0):
        evaluate_recipe(read_recipe(read_threemf(beyond)))

    def tight(recipe):
        recipe["inputs"] |= {"model": "auto", "closure": "variational", "tolerance": 1e-4}

    strict = with_recipe(cheap, tmp_path / "b.3mf", tight)
    with pytest.raises(InputError, match=r'b\.3mf: tolerance = "0\.01%"'):
        evaluate_recipe(read_recipe(read_threemf(strict)))


def test_other_versions_are_named(cheap, tmp_path):
    package = read_threemf(cheap)
    assert other_versions(package, read_recipe(package)) == []
    path = with_recipe(cheap, tmp_path / "old.3mf", put("0.0.7", "version"))
    package = read_threemf(path)
    (text,) = other_versions(package, read_recipe(package))
    assert text.startswith("pneutouch 0.0.7 (here ")
    for damaged in ("{", "[]", '{"numpy": ["1"]}'):
        package = read_threemf(with_metadata(cheap, tmp_path / "odd.3mf", versions=damaged))
        assert len(other_versions(package, read_recipe(package))) == ("numpy" in damaged)


def test_the_default_tolerance_is_left_where_none_was_asked_for(cheap):
    assert read_recipe(read_threemf(cheap)).options.tolerance == DEFAULT_TOLERANCE
