"""An unknown place of contact: in the interval where the design requests it, in the prediction and on the sheet."""

from __future__ import annotations

import dataclasses
import json
import math

import numpy as np
import pytest
from typer.testing import CliRunner

import pneutouch
from pneutouch.cli.app import app
from pneutouch.evaluation.anywhere import contact_anywhere, contact_chart
from pneutouch.evaluation.result import predicted
from pneutouch.mechanics.atlas.figures import FIGURES
from pneutouch.report.anywhere import contact_panels, contact_section
from pneutouch.report.blocks import Items, SheetTable, Text, found
from pneutouch.results.record import plain as data

S, SOURCE = "sensitivity_kPa_per_N", "place of contact"


@pytest.fixture(scope="module")
def plain(evaluated):
    return evaluated("paper-dome", model="atlas")


@pytest.fixture(scope="module")
def anywhere(evaluated):
    return evaluated("paper-dome", "contact.anywhere=true", model="atlas")


def test_it_is_off_by_default(plain):
    document = data(predicted(plain))
    assert "contact_anywhere" not in document
    for entry in map(data, plain.uncertainty):
        assert SOURCE not in entry["figures"][S]["shares"]
        assert any("misalignment" in note for note in entry["notes"])


def test_it_widens_the_sensitivity_by_its_variance_and_nothing_else(plain, anywhere):
    before, after = data(plain.uncertainty[0])["figures"], data(anywhere.uncertainty[0])["figures"]
    chart = contact_chart(anywhere.prediction, anywhere.sensor)
    u, wide, narrow = (
        chart.standard_uncertainties[0],
        after[S]["standard_uncertainty_relative"],
        before[S]["standard_uncertainty_relative"],
    )
    assert wide**2 == pytest.approx(narrow**2 + u**2, rel=2e-3)
    assert after[S]["value"] == before[S]["value"]
    assert after[S]["shares"][SOURCE] == pytest.approx((u / wide) ** 2, rel=5e-3)
    assert sum(after[S]["shares"].values()) == pytest.approx(1.0, abs=1e-5)
    assert {name: after[name] for name in FIGURES if name != S} == {name: before[name] for name in FIGURES if name != S}


def test_the_summary_names_what_a_measurement_can_improve_first(anywhere):
    entry = data(anywhere.uncertainty[0])
    share = entry["figures"][S]["shares"][SOURCE]
    assert "measure first: ageing" in entry["summary"]
    assert f"An unknown place of contact has {share:.0%} of the variance." in entry["summary"]


def test_driving_pressure_makes_the_share_smaller(anywhere):
    shares = [entry["figures"][S]["shares"][SOURCE] for entry in map(data, anywhere.uncertainty)]
    assert np.all(np.diff(shares) < 0.0)


def test_the_source_states_what_it_assumes(anywhere):
    (source,) = (one for one in data(anywhere.uncertainty[0])["sources"] if one["name"] == SOURCE)
    assert not source["known"] and source["figures"] == [S]
    for words in ("JCGM 100", "0.3 R0", "0.6 R0", "20 degrees"):
        assert words in source["origin"]


@pytest.mark.slow
def test_samples_agree_with_the_interval(anywhere):
    sampled = data(predicted(anywhere, samples=4000))["states"][0]["uncertainty"]
    interval, drawn = sampled["figures"][S], sampled["monte_carlo"]["figures"][S]
    assert math.log(drawn["high"] / drawn["low"]) == pytest.approx(
        math.log(interval["high"] / interval["low"]), rel=0.06
    )


def test_the_prediction_states_errors_of_each_contact(anywhere):
    content = data(predicted(anywhere))["contact_anywhere"]
    assert [state["driving_pressure_kPa"] for state in content["states"]] == [0, 22]
    for state in content["states"]:
        assert len(state["force_error_percent"]) == len(content["contacts"])
        assert all(len(row) == len(state["pressure_rise_kPa"]) for row in state["force_error_percent"])
    balls = [k for k, one in enumerate(content["contacts"]) if one["object"] == "ball" and one["offset_mm"] == 0]
    errors = [content["states"][0]["force_error_percent"][k][0] for k in balls]
    # A ball makes the reading state more than the force; a smaller one more so.
    assert errors == sorted(errors, reverse=True) and min(errors) > 0.0


def test_the_python_interface_requests_it_for_a_prediction():
    state = pneutouch.load("paper-dome").predict([12], model="atlas", contact_anywhere=True).at(12)
    assert SOURCE in state.uncertainty["figures"][S]["shares"]
    design = pneutouch.load("paper-dome").replace(anywhere=True)
    assert design.predict([12], model="atlas").at(12).uncertainty == state.uncertainty


def test_the_flag_is_short_for_the_key_of_the_design():
    words = ["predict", "paper-dome", "--model", "atlas", "--set", "pneumatics.driving_pressures_kPa=[12]", "--json"]
    flag, key = (
        CliRunner().invoke(app, [*words, *more])
        for more in (["--contact-anywhere"], ["--set", "contact.anywhere=true"])
    )
    assert flag.exit_code == 0 and flag.stdout == key.stdout
    assert "contact_anywhere" in json.loads(flag.stdout)


@pytest.mark.parametrize(
    ("change", "reason"), [({"friction": 0.5}, "friction"), ({"ambient_pressure": 0.5}, "gas stiffness")]
)
def test_outside_the_table_the_reason_stands_in_its_place(plain, change, reason):
    sensor = plain.sensor.replace(**change)
    content = data(contact_anywhere(plain.prediction, sensor))
    assert list(content) == ["unknown"] and reason in content["unknown"]
    (why,) = contact_section(contact_chart(plain.prediction, sensor))[1:]
    assert isinstance(why, Text) and reason in why.text


def test_a_design_with_a_ball_states_why_the_place_is_not_counted(evaluated):
    evaluation = evaluated(
        "paper-dome",
        "contact.object=ball",
        "contact.ball_radius_mm=20",
        "contact.anywhere=true",
        "pneumatics.driving_pressures_kPa=[0]",
        "indentation.depth_mm=2",
    )
    (entry,) = map(data, evaluation.uncertainty)
    assert SOURCE not in entry["figures"][S]["shares"]
    assert any("place of contact is not in the budget" in note and "ball" in note for note in entry["notes"])


def test_the_section_has_a_row_a_contact_and_a_column_a_reading(plain):
    chart = contact_chart(plain.prediction, plain.sensor)
    section = contact_section(chart)
    (table,), (notes,) = found(section, SheetTable), found(section, Items)
    assert all(len(row) == len(table.head) == 5 for row in table.rows)
    assert [row[0].split()[0] for row in table.rows][-2:] == ["plate,", "plate,"]
    assert f"{chart.standard_uncertainties[0]:.0%} at" in notes.lines[0]
    one = dataclasses.replace(plain.prediction, states=plain.prediction.states[:1])
    (table,) = found(contact_section(contact_chart(one, plain.sensor)), SheetTable)
    assert len(table.head) == 3


def test_edges_have_rows_next_to_those_of_balls(plain):
    chart = contact_chart(plain.prediction, plain.sensor)
    size = plain.sensor.dome.inner_radius
    by_contact = {(row.kind, round(row.radius / size, 3), round(row.offset / size, 3)): row for row in chart.rows[:-2]}
    edge, ball = (by_contact[kind, 1.0, 0.0].errors_percent for kind in ("edge", "ball"))
    assert all(0.0 < e < b for e, b in zip(np.ravel(edge), np.ravel(ball), strict=True))
    (table,) = found(contact_section(chart), SheetTable)
    labels = [row[0] for row in table.rows]
    assert f"edge of {size:.3g} mm radius, across the pole" in labels
    assert f"edge of {0.3 * size:.3g} mm radius, {0.3 * size:.3g} mm off the axis" in labels
    contacts = data(contact_anywhere(plain.prediction, plain.sensor))["contacts"]
    assert [one["object"] for one in contacts] == [row.kind for row in chart.rows]
    assert {one["object"] for one in contacts} == {"ball", "edge", "plate"}


def test_the_chart_has_a_curve_a_driving_pressure_and_axes_with_units(plain):
    chart = contact_chart(plain.prediction, plain.sensor)
    panels = contact_panels(chart)
    quantities = "radius, contact central  (mm)", "offset from the axis  (mm)", "tilt of a plate  (degrees)"
    assert tuple(panel.x for panel in panels) == quantities
    for panel, curves in zip(panels, (chart.by_radius, chart.by_offset, chart.by_tilt), strict=True):
        drawn = [line for line in panel.lines if line.label]
        for line, errors_percent in zip(drawn, curves.errors_percent, strict=True):
            np.testing.assert_array_equal(line.y, errors_percent)
    assert len({panel.ylim for panel in panels}) == 1
