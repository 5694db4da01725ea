"""One target over several processes: the best of each, on a profile that makes it, confirmed by the solid."""

from __future__ import annotations

import json

import pytest

from pneutouch.catalogue import load_scene
from pneutouch.errors import InputError
from pneutouch.spec.target import Target
from pneutouch.workflows.select.processes import select_processes

DOME = {"inner_radius_mm": 9.25, "wall_thickness_mm": 1.5}
TARGET = {"sensitivity_kPa_per_N": 1.9}


def selection(processes, library, **tables):
    target = Target.model_validate({"target": TARGET, "given": DOME, **tables})
    return select_processes(target, "target", processes, library)


@pytest.fixture(scope="module")
def both(library):
    given = {**DOME, "materials": ["TangoPlus", "FLX9940", "DragonSkin20"]}
    return selection(["casting", "polyjet"], library, given=given)


def test_each_process_has_its_best_on_a_profile_that_makes_it(both, library):
    assert [process for process, _ in both.best] == ["casting", "polyjet"]
    assert both.profiles == {"casting": "silicone-casting", "polyjet": "objet260-connex"}
    for process, run in both.best:
        best = run.answer.designs[0]
        assert best.resin.material.is_cast == (process == "casting")
        assert run.problem.sensitivity_kPa_per_N == 1.9
        solid = best.contact is not None or run.confirmed[0].within
        assert solid and run.left_out == {}
        assert 1 in run.judged


def test_a_cast_design_is_clamped_unless_the_target_says_otherwise(both, library, tmp_path):
    run = both.pick(1)
    assert run.base.seat.family == "clamped-flange"
    changes = dict(text.split("=", 1) for text in run.assignments(run.answer.designs[0]))
    assert changes["connector.seat"].strip('"') == "clamped-flange-M2"
    assert both.pick(2).base.seat.family == "glued-flange"
    with pytest.raises(InputError, match="from 1 to 2"):
        both.pick(3)


def test_a_process_without_a_resin_named_is_left_out_with_the_reason(both, library):
    none = selection(["casting"], library, given={**DOME, "materials": ["TangoPlus"]})
    assert none.left_out == {"casting": "no profile of it makes TangoPlus"} and none.best == []


@pytest.mark.parametrize(
    ("processes", "tables", "problem"),
    [
        (["cast"], {}, "unknown. Did you mean casting?"),
        (["casting"], {"setting": {"profile": "j735"}}, "a profile is of one process"),
        (["polyjet"], {"given": {"mix": "TangoPlus+VeroClear"}}, "a mix is printed on one machine"),
    ],
)
def test_what_cannot_be_searched_is_refused(library, processes, tables, problem):
    with pytest.raises(InputError, match=problem):
        selection(processes, library, **tables)


def test_the_base_of_a_printed_design_is_cast_as_well(library):
    assert load_scene("paper-dome", {"print.profile": "silicone-casting", "membrane.material": "DragonSkin20"})


def test_the_command_shows_a_row_a_process_and_saves_the_one_picked(command, tmp_path):
    words = [
        "select",
        "--sensitivity",
        "1.9",
        "--inner-radius",
        "9.25",
        "--wall",
        "1.5",
        "--process",
        "polyjet,casting",
    ]
    words += ["--material", "TangoPlus", "--material", "DragonSkin20", "--pick", "2", "--write", "mine"]
    done = command(*words, "--json")
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert set(document["processes"]) == {"polyjet", "casting"} and document["met"]
    assert document["processes"]["casting"]["designs"][0]["material"] == "DragonSkin20"
    assert load_scene(str(tmp_path / document["written"])).printer.is_casting
    refused = command("select", "--sensitivity", "1.9", "--process", "casting", "--charts", "charts")
    assert refused.returncode == 2 and "--charts cannot be given with --process" in refused.stderr
