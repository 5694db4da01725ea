"""Written documents are of their schemas, and a schema refuses what is not."""

from __future__ import annotations

import copy
import json

import pytest

from pneutouch.evaluation.result import predicted_in_full
from pneutouch.formats import FORMATS, format_of, versioned
from pneutouch.output.files import json_bytes
from pneutouch.results.record import plain as data
from pneutouch.schemas import document_kinds, schema_of
from tests.schemas.held import PRINTED, WRITTEN, hold, hold_folder, validator

SHALLOW = ("indentation.depth_mm=2", "indentation.steps=4")
"""Pressed a little, for the solid's documents: as many keys, in less time."""


def as_written(document):
    return json.loads(json_bytes(document))


def test_every_written_document_is_held_by_a_command_or_a_file():
    written = {name for name, kind in document_kinds().items() if kind.form == "JSON"}
    assert written == {*PRINTED.values(), *WRITTEN.values(), "exported-design"}


@pytest.mark.parametrize(
    ("design", "changes", "model"),
    [
        ("paper-dome", (), "membrane"),
        ("paper-dome", ("contact.anywhere=true", "pneumatics.driving_pressures_kPa=[0]"), "atlas"),
        ("agilus-dome", ("pneumatics.gauge=honeywell-abp2-5psi",), "atlas"),
        ("graded-dome", ("pneumatics.driving_pressures_kPa=[0]", *SHALLOW), "solid"),
        (
            "paper-dome",
            (
                "contact.object=ball",
                "contact.ball_radius_mm=8",
                "contact.friction=inf",
                "pneumatics.driving_pressures_kPa=[0]",
                *SHALLOW,
            ),
            "solid",
        ),
    ],
    ids=["membrane", "anywhere", "gauge", "graded", "ball"],
)
def test_a_prediction_is_of_its_schema(evaluated, design, changes, model):
    document = as_written(data(predicted_in_full(evaluated(design, *changes, model=model))))
    hold("prediction", document)
    for path, value in ((("model",), 3), (("rating", "share"), "much"), (("states",), [{}]), (("surprise",), 1)):
        wrong = copy.deepcopy(document)
        owner = wrong
        for key in path[:-1]:
            owner = owner[key]
        owner[path[-1]] = value
        assert not validator("prediction").is_valid(wrong), path


@pytest.mark.slow
def test_a_selection_is_of_its_schema(command):
    words = (
        "select",
        "--sensitivity",
        "2",
        "--inner-radius",
        "9.25",
        "--wall",
        "1.5",
        "--material",
        "TangoPlus",
        "--json",
    )
    hold("selection", json.loads(command(*words).stdout))


def test_an_exported_reader_is_of_its_schema(command, tmp_path):
    words = ("export-reader", "paper-dome", "--model", "membrane", "--set", "pneumatics.driving_pressures_kPa=0,12")
    assert command(*words).returncode == 0
    assert hold_folder(tmp_path) == 2


def test_a_comparison_is_of_its_schema(command, tmp_path):
    assert command("compare", "paper-dome", "soft-pad", "--model", "membrane").returncode == 0
    assert hold_folder(tmp_path) == 2


def test_a_response_is_of_its_schema(command, tmp_path):
    for load in (("--step", "2N"), ("--sine", "5", "--peak", "0.2mm")):
        done = command("respond", "paper-dome", *load, "--model", "atlas", "--json")
        assert done.returncode == 0, done.stderr
        hold("response", json.loads(done.stdout))
        assert hold_folder(tmp_path) == 2


def test_a_file_states_its_format_and_its_schema_refuses_another():
    for name, kind in document_kinds().items():
        if kind.form != "JSON" or name not in FORMATS:
            continue
        schema = schema_of(name)
        for form in schema.get("anyOf", [schema]):
            assert form["properties"]["format"]["const"] == format_of(name)
    stated = {"base": "paper-dome", "values": {}, "version": "1"}
    assert validator("exported-design").is_valid(versioned("exported-design", stated))
    assert not validator("exported-design").is_valid({**stated, "format": "pneutouch/plan/1"})


@pytest.mark.slow
def test_what_is_known_of_specimens_and_stacks_is_of_its_schema(command, tmp_path):
    assert command("build", "texture-specimen").returncode == 0
    assert command("build", "agilus-dome", "--model", "membrane", "--voxels").returncode == 0
    names = {path.name for path in tmp_path.rglob("*.json")}
    assert {"specimen.json", "stack.json"} <= names
    assert hold_folder(tmp_path) >= 3


@pytest.mark.slow
def test_measured_figures_are_of_their_schema(command, tmp_path):
    words = ("--pressures", "0,12", "--kinds", "steps,loop", "--runs", "1", "--rest", "2", "--rate", "20")
    assert command("simulate", "paper-dome", *words, "--model", "atlas", "--out", "sim").returncode == 0
    (folder,) = (tmp_path / "sim").iterdir()
    assert command("characterize", str(folder), "--design", "paper-dome", "--model", "atlas").returncode == 0
    assert hold_folder(tmp_path) == 4


@pytest.mark.slow
def test_a_built_folder_is_of_its_schemas(built):
    assert hold_folder(built("paper-dome")) == 2


def test_a_number_states_the_unit_of_its_key():
    state = schema_of("prediction")["properties"]["states"]["items"]["properties"]
    assert state["sensitivity_kPa_per_N"]["x-unit"] == "kPa/N"
    assert state["stiffness_N_per_mm"]["description"].endswith("Unit: N/mm.")
