"""Targets that have a table of their own: one row for each process, and a grade."""

from __future__ import annotations

import json
import shlex

import pytest

from pneutouch.catalogue import DesignSource
from pneutouch.results.record import plain
from pneutouch.spec.design import DesignFile
from pneutouch.spec.read import validate
from pneutouch.studio.form import Question
from pneutouch.studio.search import search
from pneutouch.studio.server import bases_of
from pneutouch.workflows.select.checks import assigned
from tests.conftest import ROOT
from tests.studio.asked import FIELDS, asked, opened


@pytest.mark.slow
def test_the_best_of_each_process_is_a_card_that_is_the_row_saved(command, tmp_path, library):
    values = {
        "target.sensitivity_kPa_per_N": "1.9",
        "given.inner_radius_mm": "9.25",
        "given.wall_thickness_mm": "1.5",
        "given.materials": '["TangoPlus","DragonSkin20"]',
        "setting.processes": '["casting","filament","polyjet"]',
    }
    steps = []
    content = asked(values, report=lambda done, total, what: steps.append((done, total, what)))
    assert content["headline"] == "2 of 3 processes with a design that meets the target"
    assert [card["label"] for card in content["cards"]] == ["casting", "polyjet"]
    assert [row[:3] for row in content["table"]["rows"]] == [
        ["1", "casting", "DragonSkin20"],
        ["2", "polyjet", "TangoPlus"],
    ]
    second = content["cards"][1]
    said = command(*shlex.split(second["command"])[1:], "--json", "--out", str(tmp_path))
    printed = json.loads(said.stdout)
    assert {**json.loads(json.dumps(content["selection"])), "written": printed["written"]} == printed
    assert opened(second["state"], library) == DesignSource.of(printed["written"], library).changed({})
    assert second["passes"] and ["Profile", "Stratasys Objet260 Connex", ""] in second["rows"]
    assert steps[0] == (0, 12, "casting, base") and [done for done, _, _ in steps] == sorted(
        done for done, _, _ in steps
    )
    assert content["remarks"][-1].startswith("filament: left out: ")


def test_a_process_in_which_nothing_meets_the_target_shows_what_is_nearest():
    fixed = {"given.inner_radius_mm": "9.25", "given.wall_thickness_mm": "1.5", "given.materials": '["TangoPlus"]'}
    content = asked({**FIELDS, **fixed, "target.sensitivity_kPa_per_N": "9", "setting.processes": '["polyjet"]'})
    (card,) = content["cards"]
    assert (card["kind"], card["command"], card["passes"], content["table"]) == ("nearest", None, False, None)
    assert card["note"].removeprefix("it misses: ") in content["remarks"][0]
    assert content["headline"] == "none of 1 processes with a design that meets the target"


@pytest.mark.slow
def test_the_best_of_each_shape_is_a_card_that_is_the_row_saved(command, tmp_path, library):
    values = {
        "target.sensitivity_kPa_per_N": "2.4",
        "target.driving_pressure_kPa": "12",
        "given.materials": '["TangoPlus"]',
        "setting.shapes": '["disc", "cap"]',
        "weights.prefer": "low",
    }
    content = asked(values)
    assert [card["label"] for card in content["cards"]] == ["disc", "cap"]
    assert [row[1] for row in content["table"]["rows"]] == ["disc", "cap"]
    second = content["cards"][1]
    said = command(*shlex.split(second["command"])[1:], "--json", "--out", str(tmp_path))
    printed = json.loads(said.stdout)
    assert {**json.loads(json.dumps(content["selection"])), "written": printed["written"]} == printed
    assert opened(second["state"], library) == DesignSource.of(printed["written"], library).changed({})


@pytest.mark.slow
def test_a_grade_is_one_card_with_the_table_of_the_command(tmp_path, command, library, monkeypatch):
    monkeypatch.setattr("pneutouch.workflows.select.graded._TRIALS", 6)
    path = tmp_path / "shallow.toml"
    text = (ROOT / "designs" / "paper-dome.toml").read_text()
    path.write_text(text.replace("[indentation]", "[indentation]\ndepth_mm = 4\nsteps = 6"))
    bases, first = bases_of(str(path))
    values = {
        "target.sensitivity_kPa_per_N": "1.9",
        "target.tolerance_percent": "25",
        "target.same_sensitivity_at_kPa": "[0, 22]",
        "target.same_within_percent": "9",
        "given.graded": "true",
        "given.wall_thickness_mm": "1.2",
        "setting.base": first,
        "setting.profile": "j735",
    }
    arguments = {"base": "paper-dome", "values": values, "files": [], "bases": bases}
    steps = []
    content = plain(search(arguments, None, lambda done, total, what: steps.append((done, total))))
    assert steps == [(done, 6) for done in range(1, 7)]
    words = shlex.split("select --graded --sensitivity 1.9 --tolerance 25% --same-at 0,22 --same-within 9% --wall 1.2")
    said = command(*words, "--base", str(path), "--profile", "j735", "--json")
    assert content["selection"] == json.loads(said.stdout)
    (card,) = content["cards"]
    state = Question.of(card["state"]).source(bases, library).changed({})
    base = DesignSource.of(str(path), library).changed({})
    assert state == validate(DesignFile, assigned(base, content["selection"]["design"]["set"], "my-sensor"), "a test")
    assert [row[0] for row in content["table"]["rows"]][1:] == [one["name"] for one in content["selection"]["constant"]]
    assert (card["command"] is None) is not content["selection"]["met"]
    assert content["chart"] is None
