"""A dead volume of zero behind a tube is marked as the paper's idealisation wherever the figure stands."""

from __future__ import annotations

import json

import pytest

from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.result import predicted
from pneutouch.results.record import plain as data
from pneutouch.units import ML
from tests.evaluation.calibrated import changed, library_of

NOTE = "the paper's idealisation: connector and tube as drawn hold"


def test_prediction_states_what_the_drawing_holds(evaluated):
    evaluation = evaluated("paper-dome", model="atlas")
    drawn = (evaluation.assembly.internal_volume + evaluation.assembly.tube_volume) / ML
    # 300 mm of tube with a 2.5 mm bore, and a connector of some hundred cubic millimetres.
    assert drawn == pytest.approx(0.3 * 3.14159 * 1.25**2 + 0.1, abs=0.1)
    document = data(predicted(evaluation))
    assert document["dead_volume_mL"] == 0
    assert document["dead_volume_note"] == f"{NOTE} {drawn:.2f} mL"
    assert f"dead volume of 0 mL is {NOTE} {drawn:.2f} mL" in document["assumptions"]


@pytest.mark.parametrize(
    "changes", [("pneumatics.tube_length_mm=0",), ("pneumatics.dead_volume_mL=0.4",)], ids=["no tube", "a volume"]
)
def test_a_dead_volume_that_can_be_has_no_note(evaluated, changes):
    evaluation = evaluated("paper-dome", *changes, model="atlas")
    assert evaluation.assembly.dead_volume_note == ""
    assert "dead_volume_note" not in data(predicted(evaluation))
    assert not any(NOTE in line for line in evaluation.prediction.assumptions)


def test_a_volume_computed_from_the_parts_has_no_note(evaluated):
    assert evaluated("fingertip-dome", model="atlas").assembly.dead_volume_note == ""


def test_the_text_of_predict_has_the_note(command):
    done = command("predict", "paper-dome", "--model", "atlas")
    assert done.returncode == 0, done.stderr
    head, *rest = done.stdout.splitlines()
    assert head.endswith("dead volume 0.000 mL, the paper's idealisation")
    (at,) = [k for k, line in enumerate(rest) if line.startswith("with the 1.50 mL")]
    drawn = [line.split() for line in rest[at + 2 : at + 6]]
    assert [float(row[0]) for row in drawn] == [0, 5, 12, 22] and all(1.5 < float(row[1]) < 2.2 for row in drawn)


def test_the_figures_with_the_gas_as_drawn_are_those_of_the_design_that_states_it(evaluated):
    idealised = data(predicted(evaluated("paper-dome", model="atlas")))
    drawn_mL = idealised["dead_volume_as_drawn_mL"]
    stated = data(predicted(evaluated("paper-dome", f"pneumatics.dead_volume_mL={drawn_mL!r}", model="atlas")))
    for one, other in zip(idealised["as_drawn"], stated["states"], strict=True):
        for key in ("sensitivity_kPa_per_N", "stiffness_N_per_mm", "range_end_mm", "cavity_volume_mL"):
            assert one[key] == pytest.approx(other[key], rel=1e-9)
    assert "as_drawn" not in stated and "dead_volume_as_drawn_mL" not in stated


def test_a_measured_sensor_has_the_gas_that_was_measured(library, tmp_path):
    """A calibration fits the dead volume: nothing of it is an idealisation, and the drawing does not replace it."""
    place = library_of(tmp_path, library, changed(design={"dead_volume_mL": 0.0}))
    document = data(predicted(evaluate("paper-dome@mine", model="atlas", library=place)))
    assert document["dead_volume_mL"] > 0
    assert not {"dead_volume_note", "dead_volume_as_drawn_mL", "as_drawn"} & document.keys()


def test_a_membrane_names_the_volume_and_asks_no_other_model(evaluated):
    document = data(predicted(evaluated("paper-dome", model="membrane")))
    assert document["dead_volume_as_drawn_mL"] > 1 and "as_drawn" not in document


@pytest.mark.slow
def test_the_plan_has_the_note(command):
    done = command("plan", "paper-dome", "--specimens", "1", "--out", "plans", "--json")
    assert done.returncode == 0, done.stderr
    assert NOTE in json.loads(done.stdout)["dead_volume_note"]


@pytest.mark.slow
def test_the_sheet_has_the_note_at_every_place_of_the_figure(evaluated):
    from pneutouch.evaluation.sheet import sheet_data
    from pneutouch.report import sheet_charts, sheet_tables

    sheet = sheet_data(evaluated("paper-dome", model="atlas"), "0")
    (tile,) = [one for one in sheet_tables.key_figures(sheet) if one.name == "Dead volume"]
    (operating,) = [row for row in sheet_tables.operating(sheet) if row[0] == "Dead volume"]
    for text in (tile.condition, operating[3], sheet_charts.tradeoff(sheet).caption, sheet.prediction.assumptions[-1]):
        assert NOTE in text
