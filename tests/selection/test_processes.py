"""One target over several processes: the best of each, on a profile that makes it, confirmed by the solid."""

from __future__ import annotations

import json

import pytest

from pneutouch.catalogue import load_scene
from pneutouch.errors import InputError
from pneutouch.spec.read import validate
from pneutouch.spec.target import Target
from pneutouch.workflows.select.processes import select, select_processes
from tests.selection.targets import document

DOME = {"inner_radius_mm": 9.25, "wall_thickness_mm": 1.5}
TARGET = {"sensitivity_kPa_per_N": 1.9}


def selection(processes, library, **tables):
    setting = {**tables.pop("setting", {}), "processes": processes}
    target = validate(Target, {"target": TARGET, "given": DOME, "setting": setting, **tables}, "target")
    return select_processes(target, "target", library)


@pytest.fixture(scope="module")
def both(library):
    given = {**DOME, "materials": ["TangoPlus", "FLX9940", "DragonSkin20"]}
    return selection(["casting", "polyjet"], library, given=given)


@pytest.mark.slow
def test_each_process_has_its_best_on_a_profile_that_makes_it(both, library):
    assert [process for process, _ in both.best] == ["casting", "polyjet"]
    assert both.profiles == {"casting": "silicone-casting", "polyjet": "objet260-connex"}
    for process, run in both.best:
        best = run.answer.designs[0]
        assert best.resin.material.is_cast == (process == "casting")
        assert run.problem.sensitivity == 1.9
        solid = best.contact is not None or run.confirmed[0].within
        assert solid and run.left_out == {}
        assert 1 in run.judged


@pytest.mark.slow
def test_a_cast_design_is_clamped_unless_the_target_says_otherwise(both, library, tmp_path):
    (_, run), (_, second) = both.best
    assert run.base.seat.family == "clamped-flange"
    changes = dict(text.split("=", 1) for text in run.assignments(run.answer.designs[0]))
    assert changes["connector.seat"].strip('"') == "clamped-flange-M2"
    assert second.base.seat.family == "glued-flange"


@pytest.mark.slow
def test_a_process_without_a_resin_named_is_left_out_with_the_reason(both, library):
    none = selection(["casting"], library, given={**DOME, "materials": ["TangoPlus"]})
    assert none.left_out == {"casting": "no profile of it makes TangoPlus"} and none.best == []


@pytest.mark.parametrize(
    ("processes", "tables", "problem"),
    [
        (["cast"], {}, '= "cast": must be "any", "polyjet", "filament", "resin" or "casting"'),
        ("cast", {}, '"cast": must be'),
        ([], {}, "must be a list with at least one entry: Show the best design of each of these processes"),
        (["any", "casting"], {}, "any stands for all of them"),
        (["casting"], {"given": {"graded": True}}, "setting.processes and given.graded contradict each other"),
        (["casting"], {"setting": {"profile": "j735"}}, "a profile is of one process"),
        (["polyjet"], {"given": {"mix": "TangoPlus+VeroClear"}}, "a mix is printed on one machine"),
    ],
)
def test_what_cannot_be_searched_is_refused(library, processes, tables, problem):
    with pytest.raises(InputError, match=problem):
        selection(processes, library, **tables)


def test_a_document_has_processes_where_they_are_given_alone():
    setting = Target.model_validate({"target": TARGET, "setting": {"processes": "any"}}).model_dump()["setting"]
    assert setting["processes"] == ["any"]
    assert "processes" not in Target.model_validate({"target": TARGET}).model_dump()["setting"]


@pytest.mark.slow
def test_each_answer_is_that_of_the_target_on_its_profile_alone(both, library):
    run = both.best[0][1]
    assert run.target.setting.profile == "silicone-casting" and run.target.setting.processes is None
    alone = select(run.target, "target", library, written=1)
    assert document(alone) == document(run)


def test_the_base_of_a_printed_design_is_cast_as_well(library):
    assert load_scene("paper-dome", {"print.profile": "silicone-casting", "membrane.material": "DragonSkin20"})


FILE = """[target]
sensitivity_kPa_per_N = 1.9
[given]
inner_radius_mm = 9.25
wall_thickness_mm = 1.5
materials = ["TangoPlus", "DragonSkin20"]
[setting]
processes = ["polyjet", "casting"]
"""


@pytest.mark.slow
def test_a_file_and_options_give_one_answer_and_the_row_picked_is_saved(command, tmp_path):
    (tmp_path / "target.toml").write_text(FILE)
    done = command("select", "target.toml", "--pick", "2", "--write", "from-file", "--json")
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert set(document["processes"]) == {"polyjet", "casting"} and document["met"]
    assert document["processes"]["casting"]["designs"][0]["material"] == "DragonSkin20"
    assert load_scene(str(tmp_path / document["written"])).printer.is_casting
    words = "select --sensitivity 1.9 --inner-radius 9.25 --wall 1.5 --material TangoPlus,DragonSkin20"
    saved = ("--pick", "2", "--write", "by-words", "--json")
    typed = json.loads(command(*words.split(), "--process", "polyjet,casting", *saved).stdout)
    assert typed["processes"] == document["processes"]
    texts = [(tmp_path / one["written"]).read_text().splitlines() for one in (document, typed)]
    differ = [pair for pair in zip(*texts, strict=True) if pair[0] != pair[1]]
    assert all("from-file" in left and "by-words" in right for left, right in differ)


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        ("--process casting --charts charts", "--charts cannot be given with --process"),
        ("--process cast", '--process cast: must be "any"'),
        ("--process casting --profile j735", "--profile: processes and profile contradict each other"),
    ],
)
def test_what_a_command_cannot_search_is_refused_by_its_options(command, words, problem):
    refused = command("select", "--sensitivity", "1.9", *words.split())
    assert refused.returncode == 2 and problem in refused.stderr


def test_a_key_of_a_file_that_cannot_be_searched_is_named_with_the_file(command, tmp_path):
    (tmp_path / "target.toml").write_text(FILE.replace('"casting"]', '"cast"]'))
    refused = command("select", "target.toml")
    assert refused.returncode == 2 and 'target.toml: setting.processes[1] = "cast": must be "any"' in refused.stderr
