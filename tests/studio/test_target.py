"""The answer to a target: that of ``select``, and states of the page that are the designs that it saves."""

from __future__ import annotations

import json
import shlex
import tomllib
from itertools import product

import pytest

from pneutouch.catalogue import DesignSource
from pneutouch.errors import InputError, PneutouchError
from pneutouch.output.new import PRINTED_PORT
from pneutouch.results.record import plain
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import declarations, table_of
from pneutouch.spec.read import validate
from pneutouch.spec.target import Target
from pneutouch.studio.candidate import state_of
from pneutouch.studio.form import Question
from pneutouch.studio.guard import faults_of
from pneutouch.studio.search import target_of
from pneutouch.studio.server import bases_of
from pneutouch.workflows.select.checks import assigned
from tests.conftest import ROOT
from tests.refusals import refused
from tests.studio.asked import FIELDS, asked, opened
from tests.studio.served import is_declared


@pytest.fixture(scope="module")
def found():
    steps = []
    content = asked(FIELDS, report=lambda done, total, what: steps.append((done, total, what)))
    return content, steps


@pytest.mark.slow
def test_the_answer_is_what_select_prints_and_its_first_card_what_it_saves(found, command, tmp_path, library):
    content, steps = found
    card = content["cards"][0]
    said = command(*shlex.split(card["command"])[1:], "--json", "--out", str(tmp_path))
    printed = json.loads(said.stdout)
    assert {**json.loads(json.dumps(content["selection"])), "written": printed["written"]} == printed
    saved = DesignSource.of(printed["written"], library).changed({})
    assert opened(card["state"], library) == saved
    assert steps == [
        (k, 5, what) for k, what in enumerate(("base", "search", "print rules", "solid", "trade-off chart"))
    ]


@pytest.mark.slow
def test_every_card_is_its_design_with_the_figures_of_the_table(found, library):
    content, _ = found
    designs = content["selection"]["designs"]
    assert [card["rank"] for card in content["cards"]] == [design["rank"] for design in designs]
    for card, design in zip(content["cards"], designs, strict=True):
        base = validate(DesignFile, {"connector": {"port": PRINTED_PORT}}, "a test")
        whole = validate(DesignFile, assigned(base, design["set"], "my-sensor"), "a test")
        assert opened(card["state"], library) == whole
        rows = {what: (value, added) for what, value, added in card["rows"]}
        value, interval = rows["Sensitivity"]
        assert value == f"{design['sensitivity_kPa_per_N']:.3f} kPa/N"
        low_kPa_per_N, high_kPa_per_N = (float(word) for word in interval.split(" (")[0].split(" to "))
        product_of_ends = low_kPa_per_N * high_kPa_per_N
        assert product_of_ends == pytest.approx(design["sensitivity_kPa_per_N"] ** 2, rel=0.02)
        assert rows["Driving pressure"][0] == f"{design['driving_pressure_kPa']:.2f} kPa"
        assert rows["Force range"][0] == f"0 to {design['force_range_N'][1]:.2f} N"
        assert rows["Diameter"][0] == f"{design['footprint_mm']:.1f} mm"
        assert (card["kind"] == "runner-up") is design["runner_up"]
        assert card["passes"] is bool(design["passes_check"])
        assert shlex.split(card["command"])[-2:] == ["--write", "my-sensor"]


def test_the_chart_holds_its_designs_under_their_fronts(found):
    content, _ = found
    chart = content["chart"]
    assert (chart["driving_pressure_kPa"], chart["window_kPa_per_N"], chart["least_force_N"]) == (
        12,
        [1.805, 1.995],
        15,
    )
    fronts = {front["title"]: front for front in chart["fronts"]}
    for card in content["cards"]:
        front, at = fronts[card["title"].split(" (")[0]], card["at"]
        beyond = [
            force
            for level, force in zip(front["sensitivity_kPa_per_N"], front["force_N"], strict=True)
            if level >= at["sensitivity_kPa_per_N"]
        ]
        assert max(beyond) >= 0.985 * at["force_N"]
        assert at["sensitivity_kPa_per_N"] * at["force_N"] <= chart["gauge_kPa"]


@pytest.mark.slow
def test_where_nothing_is_found_it_says_so_in_the_words_of_select(command):
    content = asked({**FIELDS, "target.force_range_N": "150"})
    said = command("select", "--sensitivity", "1.9", "--at", "12", "--force-range", "150", "--max-diameter", "25")
    assert said.returncode == 1
    lines = said.stdout.splitlines()
    assert content["headline"] == lines[0] == "no design meets the target"
    assert [card["kind"] for card in content["cards"]] == ["nearest", "dropped", "dropped"]
    for words in [*(card["note"] for card in content["cards"]), *content["remarks"]]:
        assert words in lines
    assert {card["command"] for card in content["cards"]} == {None}
    assert content["chart"]["fronts"]


@pytest.mark.slow
def test_what_one_change_makes_possible_is_a_card_whose_state_has_the_change():
    content = asked({"target.sensitivity_kPa_per_N": "8"})
    said, process = content["selection"]["single_changes"]
    card, _ = [card for card in content["cards"] if card["kind"] == "changed"]
    assert (said["field"], process["field"]) == ("setting.tube_length_mm", "setting.processes")
    assert float(card["state"]["values"]["pneumatics.tube_length_mm"]) == said["value"]


@pytest.mark.parametrize(
    ("values", "field", "flags"),
    [
        ({}, "target.sensitivity_kPa_per_N", None),
        ({"target.driving_pressure_kPa": "12"}, "target.force_range_N", ["--at", "12"]),
        ({"target.sensitivity_kPa_per_N": "-1"}, "target.sensitivity_kPa_per_N", ["--sensitivity", "-1"]),
        ({"target.sensitivity_kPa_per_N": "two"}, "target.sensitivity_kPa_per_N", None),
        ({**FIELDS, "target.fits": '"thumb"'}, "target.fits", ["--sensitivity", "1.9", "--fits", "thumb"]),
        (
            {**FIELDS, "given.materials": '["Tanga"]'},
            "given.materials",
            ["--sensitivity", "1.9", "--material", "Tanga"],
        ),
        (
            {**FIELDS, "setting.profile": '"none-such"'},
            "setting.profile",
            ["--sensitivity", "1", "--profile", "none-such"],
        ),
        (
            {**FIELDS, "given.inner_radius_mm": "20"},
            "target.max_diameter_mm",
            ["--sensitivity", "1.9", "--inner-radius", "20", "--max-diameter", "25"],
        ),
        (
            {**FIELDS, "setting.assignments": '["connector.port=none-such"]'},
            "setting.assignments",
            ["--sensitivity", "1.9", "--set", "connector.port=none-such"],
        ),
        ({**FIELDS, "setting.assignments": '["membrane.material=Agilus30"]'}, "setting.assignments", None),
        (
            {**FIELDS, "setting.processes": '["any","casting"]'},
            "setting.processes",
            ["--sensitivity", "1", "--process", "any,casting"],
        ),
        ({**FIELDS, "setting.processes": '["casting"]', "setting.profile": "j735"}, "setting.profile", None),
        ({**FIELDS, "setting.base": '"/etc/passwd"'}, "setting.base", None),
        ({**FIELDS, "setting.colour": "1"}, "setting.colour", None),
    ],
)
def test_an_error_stands_at_its_field_in_the_words_of_the_command(values, field, flags, command):
    with pytest.raises(PneutouchError) as raised:
        asked(values)
    first = faults_of(raised.value).problems[0]
    assert field in first.fields
    if flags is not None:
        said = command("select", *flags)
        assert said.returncode == 2
        assert first.message.rpartition(": ")[2] in " ".join(said.stderr.split())


def test_no_path_is_opened_as_a_base(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text((ROOT / "designs" / "paper-dome.toml").read_text())
    with refused("setting.base"):
        asked({**FIELDS, "setting.base": json.dumps(str(path))})
    with refused("base"):
        asked(FIELDS, base=str(path))


def test_a_design_that_the_studio_began_with_is_a_base_by_its_path(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text((ROOT / "designs" / "paper-dome.toml").read_text())
    bases, first = bases_of(str(path))
    question = Question("paper-dome", {"target.force_range_N": "5", "setting.base": f'"{first}"'})
    assert target_of(question, bases).setting.base == str(path)


STATED = {
    "target": {
        "sensitivity_kPa_per_N": 2.5,
        "tolerance_percent": 7.0,
        "force_range_N": 3.0,
        "stiffness_least_N_per_mm": 0.125,
        "stiffness_most_N_per_mm": 1e3,
        "max_diameter_mm": 30.0,
        "max_footprint_mm": 60.0,
        "fits": "finger:17.5",
        "same_sensitivity_at_kPa": [0.0, 22.0],
        "same_within_percent": 3.3,
        "widest_range": True,
    },
    "given": {"inner_radius_mm": 6.0, "wall_thickness_mm": 1.1, "mix": "TangoPlus+VeroClear", "graded": True},
    "setting": {
        "base": "paper-dome",
        "assignments": ["connector.port=thread-M5", 'document.title="two words"'],
        "profile": "j735",
        "tube_length_mm": 250.0,
        "dead_volume_mL": 0.0,
    },
    "weights": {"robustness": 2.0, "tunability": 0.5},
}


@pytest.mark.parametrize(
    "content",
    [
        {**STATED, "target": {k: v for k, v in STATED["target"].items() if not k.startswith("stiff")}},
        {
            "target": {"stiffness_least_N_per_mm": 0.125, "stiffness_most_N_per_mm": 1e3, "driving_pressure_kPa": 5.5},
            "given": {"materials": ["TangoPlus", "FLX9950"]},
            "weights": {"contact_anywhere": True},
        },
        {"target": {"force_range_N": 3.0}, "setting": {"processes": ["polyjet", "casting"]}},
    ],
    ids=["a grade", "resins", "processes"],
)
def test_the_words_of_a_target_give_it_to_the_command(content, command, monkeypatch):
    from pneutouch.cli.select import target_words

    taken = []

    def take(target, *rest, **more):
        taken.append(target)
        raise InputError("taken")

    monkeypatch.setattr("pneutouch.workflows.select.search.search", take)
    target = Target.model_validate(content)
    said = command("select", *target_words(target))
    assert taken == [target], said.stderr


def test_every_shipped_design_is_a_state_over_every_other(library):
    bases, _ = bases_of(None)
    files = {name: DesignSource.of(name, library).changed({}) for name in bases}
    for base, name in product(bases, bases):
        state = state_of(files[name], base, bases, library)
        assert opened(json.loads(json.dumps(plain(state))), library) == files[name], (base, name)
        assert bool(state.values) is (files[name] != files[base])


def test_the_form_of_a_target_is_made_of_the_declared_fields(client):
    answer = client.get("/api/form/target").json()
    fields = {field["name"]: field for group in answer["groups"] for field in group["fields"]}
    for name in Target.model_fields:
        for declared in declarations(table_of(Target, name)):
            field = fields.pop(f"{name}.{declared.key}")
            assert is_declared(field, declared)
    assert not fields
    example = Target.model_validate(tomllib.loads((ROOT / "docs/examples/fingertip.toml").read_text()))
    assert target_of(Question("paper-dome", answer["example"]), {}) == example


def test_a_target_is_a_job_of_the_studio():
    from pneutouch.studio.job import answered

    bases, _ = bases_of(None)
    arguments = {"base": "paper-dome", "values": {"target.force_range_N": "0"}, "files": [], "bases": bases}
    answer = answered({"kind": "select", "arguments": arguments, "folder": "."}, lambda *progress: None)
    problem = {"message": "must be from 0.0001 to 100000 N", "fields": ["target.force_range_N"]}
    assert plain(answer) == {"status": 422, "content": {"problems": [problem]}}
