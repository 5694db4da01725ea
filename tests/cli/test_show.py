"""``show`` and ``build`` with a 3MF, as a user meets them."""

from __future__ import annotations

import json
import shutil

import pytest

from pneutouch import __version__
from pneutouch.cli.show import NO_RECIPE, OF_A_JOB
from pneutouch.export.threemf import threemf
from tests.export.threemf_files import with_metadata, with_recipe

NAME = "paper-dome"


@pytest.fixture
def built_file(built, tmp_path):
    return shutil.copy(built(NAME) / f"{NAME}.3mf", tmp_path / "sensor.3mf")


@pytest.fixture
def foreign(evaluated, tmp_path):
    path = tmp_path / "foreign.3mf"
    path.write_bytes(threemf("x", evaluated(NAME).assembly.bodies, {"Title": "not\x85 ours\u202e"}))
    return path


def test_show_prints_bodies_metadata_and_recipe(command, built_file, evaluated):
    evaluation = evaluated(NAME)
    result = command("show", "sensor.3mf")
    assert result.returncode == 0 and result.stderr == ""
    for solid, body in zip(evaluation.assembly.solids, evaluation.assembly.bodies, strict=True):
        (line,) = [row for row in result.stdout.splitlines() if row.startswith(f"{solid.name} ")]
        assert solid.material.label in line
        assert solid.material.colour in line
        assert line.split()[-1] == str(len(body.triangles))
        assert float(line.split()[-2]) == pytest.approx(body.volume, abs=0.051)
    design = evaluation.scene.design
    assert f"recipe of {NAME}" in result.stdout
    for key, value in (
        ("membrane.inner_radius_mm", design.membrane.inner_radius_mm),
        ("membrane.material", design.membrane.material),
        ("made by", f"pneutouch {__version__}"),
        ("model", "solid"),
    ):
        assert [line for line in result.stdout.splitlines() if line.split() == f"{key} {value}".split()], key


def test_show_json_is_one_document(command, built_file, evaluated):
    result = command("show", "sensor.3mf", "--json")
    document = json.loads(result.stdout)
    assembly = evaluated(NAME).assembly
    assert [body["name"] for body in document["bodies"]] == [body.name for body in assembly.bodies]
    for entry, body in zip(document["bodies"], assembly.bodies, strict=True):
        assert entry["volume_mm3"] == pytest.approx(body.volume, rel=1e-5)
        assert entry["size_mm"] == pytest.approx((body.bounds[1] - body.bounds[0]).tolist(), abs=1e-5)
    assert document["thumbnail"] is True
    assert document["recipe"]["input_hash"] == document["metadata"]["input-hash"]
    assert document["recipe"]["versions"]["pneutouch"] == __version__
    assert document["recipe"]["inputs"]["design"] == evaluated(NAME).scene.design.model_dump(mode="json")
    assert "recipe" not in document["metadata"]


def test_a_3mf_of_another_maker_is_shown_without_recipe(command, foreign):
    result = command("show", "foreign.3mf")
    assert result.returncode == 0
    assert NO_RECIPE in result.stdout and OF_A_JOB not in result.stdout
    assert "\x85" not in result.stdout and "\u202e" not in result.stdout
    assert json.loads(command("show", "foreign.3mf", "--json").stdout)["recipe"] is None


def test_a_print_job_of_a_build_is_said_to_be_ours(command, built, tmp_path):
    shutil.copy(next((built(NAME) / "jobs").glob("*.3mf")), tmp_path / "job.3mf")
    result = command("show", "job.3mf")
    assert OF_A_JOB in result.stdout and NO_RECIPE not in result.stdout


@pytest.mark.slow
def test_build_from_a_3mf_gives_the_same_bytes_in_a_folder_whose_library_changed(command, built, built_file, tmp_path):
    paths = tmp_path / "printprofiles"
    (paths / "materials").mkdir(parents=True)
    for name in ("materials/TangoPlus", "materials/Agilus30", "materials/ABS", "objet260-connex", "abs-filament"):
        (paths / f"{name}.toml").write_text('title = "broken"\n')
    result = command("build", "sensor.3mf", "--out", "again")
    assert result.returncode == 0, result.stderr
    assert "was made with" not in result.stderr
    folder = built(NAME)
    ours = {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*") if p.is_file()}
    again = tmp_path / "again" / NAME
    assert {p.relative_to(again): p.read_bytes() for p in again.rglob("*") if p.is_file()} == ours


@pytest.mark.slow
def test_another_version_is_said_on_stderr(command, built_file, tmp_path, monkeypatch):
    """What a rebuild writes is tested elsewhere: here nothing is written."""
    monkeypatch.setattr("pneutouch.workflows.build.build", lambda evaluation, out, report: out / evaluation.scene.name)
    with_recipe(tmp_path / "sensor.3mf", tmp_path / "old.3mf", lambda recipe: recipe.update(version="0.0.7"))
    result = command("build", "old.3mf", "--json")
    assert result.returncode == 0, result.stderr
    assert (
        f"note: old.3mf was made with pneutouch 0.0.7 (here {__version__}): what is built may differ" in result.stderr
    )
    assert json.loads(result.stdout)["design"] == NAME
    assert "other versions" in command("show", "old.3mf").stdout


@pytest.mark.parametrize(
    "words",
    [
        ["--set", "membrane.inner_radius_mm=8"],
        ["--model", "solid"],
        ["--tolerance", "2%"],
        ["--closure", "variational"],
        ["--clamp", "base"],
    ],
)
def test_nothing_can_be_set_beside_a_3mf(command, built_file, tmp_path, words):
    result = command("build", "sensor.3mf", *words)
    assert result.returncode == 2
    assert f"error: sensor.3mf: {words[0]} cannot be given with a 3MF" in result.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["sensor.3mf"]


def bad_files(tmp_path, good):
    content = good.read_bytes()
    (tmp_path / "folder.3mf").mkdir()
    (tmp_path / "text.3mf").write_text("solid x")
    (tmp_path / "short.3mf").write_bytes(content[:-30])
    with_metadata(good, tmp_path / "damaged.3mf", recipe="{")
    with_recipe(good, tmp_path / "altered.3mf", lambda r: r["inputs"].update(clamp="flange"), rehash=False)
    with_recipe(good, tmp_path / "outside.3mf", lambda r: r["inputs"]["design"]["membrane"].update(inner_radius_mm=0.0))


@pytest.mark.parametrize("name", ["none", "folder", "text", "short", "damaged", "altered", "outside"])
def test_bad_files_are_input_errors_without_traceback_and_nothing_is_written(command, built_file, tmp_path, name):
    bad_files(tmp_path, tmp_path / "sensor.3mf")
    before = sorted(tmp_path.rglob("*"))
    for words in (["show", f"{name}.3mf", "--json"], ["build", f"{name}.3mf"]):
        result = command(*words)
        assert result.returncode == 2
        assert result.stdout == ""
        assert result.stderr.startswith(f"error: {name}.3mf: ")
        assert "Traceback" not in result.stderr and "internal fault" not in result.stderr
    assert sorted(tmp_path.rglob("*")) == before


def test_a_foreign_3mf_cannot_be_built(command, foreign, tmp_path):
    result = command("build", "foreign.3mf")
    assert result.returncode == 2
    assert "holds no recipe" in result.stderr
    assert list(tmp_path.iterdir()) == [foreign]
