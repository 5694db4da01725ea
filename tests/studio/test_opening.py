"""Files that are opened on the page: each becomes its design in every field, or is refused in one clear message."""

from __future__ import annotations

import json
import random
import shutil

import pytest

from pneutouch import __version__
from pneutouch.catalogue import DesignSource
from pneutouch.errors import InputError
from pneutouch.results.record import plain
from pneutouch.spec.read import read_toml
from pneutouch.spec.toml_text import toml_text
from pneutouch.studio.design_jobs import open_file
from pneutouch.studio.form import Question, version_of
from pneutouch.studio.guard import faults_of
from pneutouch.studio.server import bases_of
from tests.conftest import ROOT
from tests.export import test_threemf_unsafe as unsafe
from tests.export.threemf_files import with_metadata, with_model, with_recipe
from tests.output.test_recipe_tampered import TAMPERED, cheap
from tests.schemas.held import hold
from tests.stability.fuzz.mutate import damaged_toml

__all__ = ["cheap"]

BASES, _ = bases_of(None)
DESIGNS = sorted(path.stem for path in (ROOT / "designs").glob("*.toml"))


def opened(path):
    """What the page is answered for a file."""
    arguments = {"files": [{"name": path.name, "path": str(path)}], "bases": BASES}
    return plain(open_file(arguments, path.parent, lambda *_: None))


def fields(source):
    return source.changed({}).model_dump(by_alias=True)


def shown(content, library):
    """The design that the page shows."""
    return fields(Question.of(content["question"]).source(BASES, library))


def refused(path, *words):
    """The message for a file that is refused: it names the file as the user knows it, and not where it lies."""
    with pytest.raises(InputError) as error:
        opened(path)
    messages = [each.message for each in faults_of(error.value).problems]
    assert messages[0].startswith(path.name), messages
    assert str(path.parent) not in " ".join(messages)
    for word in words:
        assert word in " ".join(messages), messages
    return messages


@pytest.mark.parametrize("name", DESIGNS)
def test_every_design_comes_as_it_is_under_its_name_and_another(name, tmp_path, library):
    wanted = fields(DesignSource.of(name, library))
    for called in (name, "another"):
        path = tmp_path / f"{called}.toml"
        shutil.copy(ROOT / f"designs/{name}.toml", path)
        content = opened(path)
        assert shown(content, library) == wanted
        assert (content["name"], content["notes"]) == (called, [])
        # It is one of the bases, whatever its name.
        assert content["question"] == {
            "base": name,
            "values": {},
            "version": version_of(DesignSource.of(name, library)),
        }


@pytest.mark.parametrize("title", ["1, 2", "none", "a, b", "true", '"quoted"', "x = [1]", "a=b; c", "ä漢", "7", "inf"])
def test_fields_of_every_kind_are_carried(title, tmp_path, library):
    import datetime

    content = read_toml(ROOT / "designs/graded-dome.toml")
    content["document"] = {"title": title, "revision": "b, c", "date": datetime.date(2026, 2, 3)}
    content["membrane"] |= {"inner_radius_mm": 7.123456789012345, "wall_thickness_mm": 1 / 3}
    content["pneumatics"] = {"driving_pressures_kPa": [0.1, 3.0], "dead_volume_mL": 0.25}
    content["contact"] = {"object": "profile", "profile_mm": [[0.0, 0.0], [7.0, 1.5, 0.3]], "friction": float("inf")}
    content["indentation"] = {"depth_mm": 2.0, "plate_diameter_mm": 31.5}
    path = tmp_path / "mine.toml"
    path.write_text(toml_text(content))
    found = opened(path)
    assert shown(found, library) == fields(DesignSource("mine", content, "mine.toml"))
    assert shown(found, library)["document"]["title"] == title


def test_what_a_base_states_and_the_file_leaves_out_is_left_out(tmp_path, library):
    path = tmp_path / "paper-dome.toml"
    path.write_text("[membrane]\nwall_thickness_mm = 1.5\n")
    found = opened(path)
    assert found["question"]["base"] == "paper-dome"
    # The paper's design states no dead volume.
    assert found["question"]["values"]["pneumatics.dead_volume_mL"] is None
    assert shown(found, library) == fields(DesignSource("x", {}, "x"))


def test_a_calibration_is_carried_or_missed_in_words(tmp_path, library):
    path = tmp_path / "mine.toml"
    path.write_text('calibration = "A7"\n')
    assert 'calibration = "A7"' in refused(path)[0]
    path.write_text('calibration = "none"\n')
    found = opened(path)
    assert found["question"]["values"]["calibration"] == "none"
    assert shown(found, library)["calibration"] == "none"


def test_a_3mf_becomes_the_design_it_was_built_from(built, tmp_path, library):
    path = tmp_path / "sensor.3mf"
    shutil.copy(built("paper-dome") / "paper-dome.3mf", path)
    found = opened(path)
    version = version_of(DesignSource.of("paper-dome", library))
    question = {"base": "paper-dome", "values": {}, "version": version}
    assert found == {"name": "paper-dome", "question": question, "notes": []}


def test_what_a_3mf_has_of_its_own_is_said(built, tmp_path):
    def change(recipe):
        recipe["version"] = "0.0.1"
        recipe["inputs"]["design"]["membrane"]["wall_thickness_mm"] = 1.25
        recipe["inputs"]["membrane_material"]["shear_modulus_MPa"]["value"] *= 2
        recipe["inputs"]["clamp"] = "flange"

    found = opened(with_recipe(built("paper-dome") / "paper-dome.3mf", tmp_path / "theirs.3mf", change))
    assert found["question"]["values"] == {"membrane.wall_thickness_mm": "1.25"}
    assert found["notes"] == [
        f"made with pneutouch 0.0.1 (here {__version__})",
        "its membrane material is not the one of this name here, which the page takes",
        "it was predicted with clamp flange, the page predicts without",
        "pneutouch build theirs.3mf builds it as it was",
    ]


@pytest.mark.slow
def test_the_model_of_a_3mf_is_said(cheap, tmp_path):
    path = tmp_path / "theirs.3mf"
    shutil.copy(cheap, path)
    assert opened(path)["notes"][0] == "it was predicted with model membrane, the page predicts without"


def export(**changed):
    content = {
        "format": "pneutouch/exported-design/1",
        "version": __version__,
        "base": "paper-dome",
        "values": {},
        **changed,
    }
    return json.dumps({key: value for key, value in content.items() if value is not ...})


def test_an_exported_design_comes_back(tmp_path, library):
    path = tmp_path / "paper-dome.json"
    values = {"membrane.wall_thickness_mm": "1.4", "pneumatics.dead_volume_mL": None}
    path.write_text(export(values=values))
    hold("exported-design", json.loads(path.read_text()))
    assert opened(path)["question"] == {"base": "paper-dome", "values": values}
    path.write_text(export(version="0.0.1"))
    assert opened(path)["notes"] == [f"exported by pneutouch 0.0.1 (here {__version__})"]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "not JSON"),
        ("[" * 9999, "not JSON"),
        ("[]", "not an exported design"),
        ("{}", "not a design that was exported here"),
        (export(format="pneutouch/exported-design/2"), "of a later version"),
        (export(format=1), "format = 1: not the format of this file"),
        (export(format="pneutouch/plan/1"), "not the format of this file"),
        (export(base=...), "has the keys"),
        (export(more=1), "has the keys"),
        (export(base="../../etc/passwd"), "unknown design"),
        (export(base=7), "base is a text"),
        (export(values={"membrane.wall_thickness_mm": "99"}), "must be from 0.05 to 50 mm"),
        (export(values={"membrane.wall_thickness_mm": 1}), "each value is a text"),
        (export(values={"membrane.__class__": "1"}), "unknown key"),
        (export(values={f"membrane.x{k}": "1" for k in range(300)}), "at most 200"),
        (export(values={"membrane.material": "x" * 5000}), "longer than"),
        (export(values={"membrane.material": "Tanga"}), "Tanga"),
        (" " * 70_000, "larger than"),
    ],
)
def test_what_is_no_exported_design_is_one_clear_message(text, says, tmp_path):
    path = tmp_path / "design.json"
    path.write_text(text)
    with pytest.raises(InputError, match=says):
        opened(path)


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("a.stl", b"solid x", "the page opens no file of this kind; give a 3MF that pneutouch build wrote"),
        ("a.toml", b"\xff\xfe", "not UTF-8"),
        ("a.toml", b"[membrane\n", "a.toml"),
        ("a.toml", b"a = " + b"[" * 9000, "a.toml"),
        ("a.toml", b"x = 1\n" * 300_000, "larger than"),
        ("a.toml", b"[membrane]\nwall_thickness_mm = 99\n", "membrane.wall_thickness_mm = 99"),
        ("a.toml", b"[[runs]]\nfile = 'a.csv'\n", "runs: unknown"),
        ("a.toml", b"[membrane]\nmaterial = '../../etc/passwd'\n", "no such name among the materials"),
        ("a.toml", b"calibration = '../../../etc/passwd'\n", "calibration"),
        ("..toml", b"", "rename the file"),
        ("a.toml", b"[block]\n", "a texture specimen"),
        ("a.3mf", b"solid x", "not a zip archive"),
    ],
)
def test_what_is_no_design_is_one_clear_message(name, content, says, tmp_path):
    path = tmp_path / name
    path.write_bytes(content)
    refused(path, says)


HOSTILE = {
    "entities": lambda good, path: with_model(good, path, unsafe.typed(unsafe.EXTERNAL, "utf-16")),
    "a bomb": lambda good, path: path.write_bytes(unsafe.bomb(2**28 + 1)),
    "a lie": lambda good, path: path.write_bytes(unsafe.lying(1000)),
    "many parts": lambda good, path: path.write_bytes(unsafe.many(1001)),
    "encrypted": lambda good, path: path.write_bytes(unsafe.encrypted()),
    "cut": lambda good, path: path.write_bytes(good.read_bytes()[:-30]),
    "components": lambda good, path: with_model(good, path, unsafe.chained(30, 10)),
    "no recipe": lambda good, path: path.write_bytes(unsafe.GOOD),
    "damaged recipe": lambda good, path: with_metadata(good, path, recipe="[" * 60_000),
    "altered": lambda good, path: with_recipe(good, path, lambda r: r["inputs"].update(clamp="flange"), rehash=False),
    "too long": lambda good, path: with_recipe(
        good, path, lambda r: r["inputs"]["design"]["document"].update(title="x" * 90)
    ),
}
"""3MF files that are unsafe or damaged, by what is wrong with them."""


@pytest.mark.parametrize(
    "name", [pytest.param(each, marks=pytest.mark.slow) if each in ("a bomb", "a lie") else each for each in HOSTILE]
)
def test_every_unsafe_3mf_is_refused_in_words(name, built, tmp_path):
    path = tmp_path / "bad.3mf"
    HOSTILE[name](built("paper-dome") / "paper-dome.3mf", path)
    refused(path)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.slow
@pytest.mark.parametrize(("change", "said"), TAMPERED.values(), ids=TAMPERED.keys())
def test_every_forged_recipe_is_refused_in_words(change, said, cheap, tmp_path):
    refused(with_recipe(cheap, tmp_path / "bad.3mf", change), said)


@pytest.mark.parametrize("name", ["paper-dome", "graded-dome", "long-tube"])
def test_damaged_design_files_are_designs_or_refused(name, tmp_path, library):
    text, rng = (ROOT / f"designs/{name}.toml").read_text(), random.Random(18)
    path, accepted = tmp_path / "mine.toml", 0
    for _ in range(20):
        path.write_bytes(damaged_toml(text, rng))
        try:
            found = opened(path)
        except InputError as error:
            assert "mine.toml" in faults_of(error).problems[0].message
            continue
        accepted += 1
        assert shown(found, library) == fields(DesignSource("mine", read_toml(path), "mine.toml"))
    assert accepted < 20


def test_one_file_at_a_time(tmp_path):
    with pytest.raises(InputError, match="one file is opened at a time"):
        open_file({"files": [], "bases": BASES}, tmp_path, lambda *_: None)
