"""``pneutouch sweep`` as a user meets it; the commands and the Python of docs/howto/sweep.md are run."""

from __future__ import annotations

import contextlib
import io
import json
import re
import shlex
import shutil

import pytest
import xarray

from pneutouch.workflows.sweep.variables import POINT, STATE
from tests.cli.test_commands import HEAVY, modules_after
from tests.conftest import ROOT
from tests.workflows.sweep.conftest import cluster

__all__ = ["cluster"]

TEXT = (ROOT / "docs/howto/sweep.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", TEXT, re.DOTALL)


COMMANDS = [line for block in blocks("sh") for line in block.splitlines() if line.startswith("pneutouch ")]


@pytest.fixture
def bench(tmp_path):
    """A folder with the example in it that the page names."""
    shutil.copy(ROOT / "docs/examples/wall-and-resin.toml", tmp_path)
    return tmp_path


@pytest.mark.slow
@pytest.mark.parametrize("line", [line for line in COMMANDS if "--scheduler" not in line])
def test_the_page_s_commands_run(line, command, bench):
    result = command(*shlex.split(line)[1:])
    assert result.returncode == 0, result.stderr
    path = json.loads(result.stdout)["dataset"] if "--json" in line else result.stdout.splitlines()[-1]
    data = xarray.load_dataset(bench / path, engine="scipy")
    assert set(data.data_vars) == {variable.name for variable in (*STATE, *POINT)}
    assert (data.status == "ok").sum() > 20


@pytest.mark.slow
def test_the_page_s_cluster_commands_run(command, bench, cluster):
    (line,) = [line for line in COMMANDS if "--scheduler" in line]
    local, *_ = COMMANDS
    result = command(*shlex.split(line.replace("tcp://127.0.0.1:8786", cluster.address))[1:])
    assert result.returncode == 0, result.stderr
    assert command(*shlex.split(local)[1:], "--workers", "1").returncode == 0
    assert (bench / "cluster.nc").read_bytes() == (bench / "outputs/wall-and-resin.nc").read_bytes()


@pytest.mark.slow
def test_the_page_s_python_and_list_run(command, bench, monkeypatch):
    assert command("sweep", "wall-and-resin.toml", "--workers", "1").returncode == 0
    monkeypatch.chdir(bench)
    output = io.StringIO()
    with contextlib.redirect_stdout(output):
        for block in blocks("python"):
            exec(compile(block, "sweep.md", "exec"), {})
    *sensitivities, refused = output.getvalue().replace("[", "").replace("]", "").split()
    assert len(sensitivities) == 7
    assert int(refused) == 2  # 22 kPa on TangoPlus thinner than 0.787 mm, its wall at that limit (41.9 kPa at 1.5 mm)
    (bench / "list.toml").write_text(blocks("toml")[0])
    result = command("sweep", "list.toml", "--json")
    assert json.loads(result.stdout)["states"] == {"ok": 6, "refused": 0, "failed": 0}


def test_the_page_names_every_variable():
    for variable in (*STATE, *POINT):
        assert f"`{variable.name}`" in TEXT, variable.name


def test_the_dataset_is_named_on_stdout_and_the_states_on_stderr(command, tmp_path):
    words = ["--design", "paper-dome", "--over", "membrane.wall_thickness_mm=0.5,1.5", "--model", "membrane"]
    result = command("sweep", *words)
    head, *rows, blank, path = result.stdout.splitlines()
    assert (result.returncode, blank, path) == (0, "", "outputs/paper-dome-sweep.nc")
    assert head.split()[:2] == ["membrane_wall_thickness_mm", "kPa"]
    assert [line.split()[0] for line in rows] == ["0.5"] * 4 + ["1.5"] * 4
    assert [line.split()[-1] for line in rows] == ["ok"] * 3 + ["refused"] + ["ok"] * 4
    first, *written = [line for line in result.stderr.splitlines() if not line.endswith(" ...")]
    assert first == "2 points, states: 7 ok, 1 refused, 0 failed"
    over = ["driving_pressure_kPa", "membrane_wall_thickness_mm"]
    pictures = [f"paper-dome-sweep-over-{name}.{kind}" for name in over for kind in ("png", "svg")]
    names = sorted(path.name for path in (tmp_path / "outputs").iterdir())
    assert names == ["paper-dome-sweep-manifest.json", *pictures, "paper-dome-sweep.csv", "paper-dome-sweep.nc"]
    assert sorted(line.partition(": outputs/")[2] for line in written) == [*pictures, "paper-dome-sweep.csv"]
    before = {name: (tmp_path / "outputs" / name).read_bytes() for name in names}
    (tmp_path / "outputs/paper-dome-sweep.csv").unlink()
    again = command("sweep", *words)
    assert "was there already" in again.stderr
    assert {path.name: path.read_bytes() for path in (tmp_path / "outputs").iterdir()} == before


TAKEN = (
    "x.csv",
    "x-over-membrane_wall_thickness_mm.svg",
    "x-over-membrane_wall_thickness_mm.png",
    "x-over-driving_pressure_kPa.png",
    "x-manifest.json",
)


@pytest.mark.parametrize("fresh", [[], ["--fresh"]], ids=["", "fresh"])
@pytest.mark.parametrize("name", TAKEN)
def test_files_of_others_are_not_replaced(name, fresh, command, tmp_path):
    (tmp_path / name).write_text("mine")
    words = ["--design", "paper-dome", "--over", "membrane.wall_thickness_mm=1,1.5", "--model", "membrane"]
    result = command("sweep", *words, "--out", "x.nc", *fresh)
    assert result.returncode == 2
    assert result.stderr.startswith(f"error: {name}: ") and "--out" in result.stderr
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "mine"


def test_a_table_that_was_edited_is_not_replaced_and_an_unchanged_one_is(command, tmp_path):
    words = ["sweep", "--design", "paper-dome", "--model", "membrane", "--out", "x.nc", "--fresh", "--over"]
    for walls in ("1,1.5", "1,2"):
        assert command(*words, f"membrane.wall_thickness_mm={walls}").returncode == 0
    table = tmp_path / "x.csv"
    table.write_text(table.read_text() + "my remark\n")
    edited = {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()}
    for walls in ("1,2", "1,1.5"):
        result = command(*words, f"membrane.wall_thickness_mm={walls}")
        assert result.returncode == 2 and result.stderr.startswith("error: x.csv: ")
        assert {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()} == edited
    table.rename(tmp_path / "mine.csv")
    assert command(*words, "membrane.wall_thickness_mm=1,1.5").returncode == 0


def test_pictures_of_a_longer_name_are_in_no_place_of_this_one_s(command, tmp_path):
    (tmp_path / "x-over-all-over-membrane_wall_thickness_mm.svg").write_text("mine")
    words = ["--design", "paper-dome", "--over", "membrane.wall_thickness_mm=1,1.5", "--model", "membrane"]
    assert command("sweep", *words, "--out", "x.nc").returncode == 0
    again = command("sweep", *words, "--out", "x.nc", "--fresh")
    assert again.returncode == 0, again.stderr


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "give a sweep file, or --design"),
        (["--design", "paper-dome"], "give a sweep file, or --design"),
        (["missing.toml"], "missing.toml: no such file"),
        (["wall-and-resin.toml", "--design", "paper-dome"], "one or the other"),
        (["wall-and-resin.toml", "--over", "membrane.material=FLX9940"], "one or the other"),
        (["paper-dome", "--over", "membrane.material=FLX994"], "Did you mean FLX9940?"),
        (["wall-and-resin.toml", "--set", "membrane.material=FLX9940"], "varied too"),
        (["wall-and-resin.toml", "--set", "membrane.material"], "--set membrane.material"),
        (["wall-and-resin.toml", "--workers", "0"], "--workers 0"),
        (["wall-and-resin.toml", "--model", "solit"], "Did you mean solid?"),
        (["wall-and-resin.toml", "--out", "x.csv"], "ends in .nc"),
    ],
)
def test_bad_words_exit_2_and_leave_nothing(words, message, command, bench):
    result = command("sweep", *words)
    assert (result.returncode, result.stdout) == (2, "")
    assert message in result.stderr
    assert "Traceback" not in result.stderr
    assert list(bench.iterdir()) == [bench / "wall-and-resin.toml"]


def test_other_commands_load_nothing_of_it():
    unwanted = {"xarray", "pandas", "dask", "distributed"}
    for words in (["--help"], ["sweep", "--help"], ["predict", "paper-dome", "--model", "membrane", "--json"]):
        loaded = modules_after(*words)
        assert loaded & (unwanted | HEAVY) == set(), words
