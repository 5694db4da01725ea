"""Designs pressed off the axis: which model answers, what is refused and why, and what the answer has."""

import numpy as np
import pytest

from pneutouch.catalogue import Library
from pneutouch.catalogue.scene import load_scene
from pneutouch.cli.prediction_text import _sheared
from pneutouch.errors import InputError
from pneutouch.evaluation.calibrated import check_fitted
from pneutouch.evaluation.evaluate import evaluate, sensor_of
from pneutouch.evaluation.result import by_model
from pneutouch.evaluation.sheet import object_section
from pneutouch.mechanics.atlas.coverage import outside_atlas
from pneutouch.mechanics.harmonic.press import OffAxisPress
from pneutouch.mechanics.models.choice import USUAL, models_for
from pneutouch.parts import assemble
from pneutouch.report.blocks import SheetTable, found
from pneutouch.report.conditions import off_axis, shear_rows
from pneutouch.results.record import plain as data
from pneutouch.workflows.select.base import check_central

BALL = {"contact.object": "ball", "contact.ball_radius_mm": 8.0, "contact.offset_mm": 2.0}
EDGE = {"contact.object": "edge", "contact.edge_radius_mm": 3.0}
SHEAR = {"contact.shear_mm": 1.0, "contact.friction": 0.3}
SHORT = {"pneumatics.driving_pressures_kPa": [0.0], "indentation.depth_mm": 3.0, "indentation.steps": 6}


def _sensor(changes):
    return sensor_of(assemble(load_scene("paper-dome", changes)))


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        (BALL, "2 mm off the axis"),
        ({"contact.tilt_deg": 5.0}, "leans by 5°"),
        (SHEAR, "moves 1 mm sideways"),
        (EDGE, "no body of revolution: edge of"),
    ],
    ids=["ball", "plate", "shear", "edge"],
)
def test_other_models_refuse_by_name_with_the_reason(changes, why):
    for model in ("membrane", "atlas", "solid"):
        with pytest.raises(InputError, match=why) as caught:
            evaluate("paper-dome", changes, model=model)
        assert caught.value.key == "model" and caught.value.value == model
        assert "harmonic" in str(caught.value.remedy)
    sensor = _sensor(changes)
    assert models_for(sensor, 0.02).models == ("harmonic",)
    assert why in str(outside_atlas(sensor))


def test_a_central_scene_is_left_to_the_cheaper_models():
    assert "harmonic" not in models_for(_sensor({}), 0.02).models


@pytest.mark.parametrize(
    ("changes", "key", "text"),
    [
        ({**BALL, "contact.tilt_deg": 5.0}, "contact", "only a plate can lean"),
        (
            {"contact.object": "cone", "contact.cone_half_angle_deg": 60.0, "contact.cone_tip_radius_mm": 2.0}
            | {"contact.offset_mm": 1.0},
            "contact",
            "only a plate or a ball",
        ),
        ({"contact.tilt_deg": 60.0}, "contact.tilt_deg", "45"),
        ({"contact.shear_mm": 2.0}, "contact", "without friction"),
        ({"contact.shear_mm": 60.0, "contact.friction": 0.6}, "contact.shear_mm", "50"),
        (
            {"contact.object": "cone", "contact.cone_half_angle_deg": 60.0, "contact.cone_tip_radius_mm": 2.0}
            | {"contact.shear_mm": 1.0, "contact.friction": 0.6},
            "contact",
            "an edge or a cylinder moves sideways",
        ),
        ({"contact.offset_mm": -1.0}, "contact.offset_mm", "0"),
    ],
)
def test_what_cannot_stand_off_the_axis_is_refused(changes, key, text):
    with pytest.raises(InputError, match=text) as caught:
        load_scene("paper-dome", changes)
    assert str(caught.value.key).startswith(key)


class _ReachedError(Exception):
    """The press was begun: all checks of the input are passed."""


def _reached(*_):
    raise _ReachedError


def test_an_offset_off_the_dome_is_refused_with_the_largest_that_works(monkeypatch):
    with pytest.raises(InputError, match="60 degrees") as caught:
        evaluate("paper-dome", {**BALL, "contact.offset_mm": 17.0})
    assert caught.value.key == "contact.offset_mm"
    # A sphere of 10.75 mm and one of 8 mm touch at 60 degrees where their centres are 18.75 sin 60 apart; one that is
    # then pressed down by the depth without meeting the connector stands nearer.
    largest = np.floor(100 * np.sqrt(18.75**2 - (0.75 * 9.25 + 8.0) ** 2)) / 100
    assert largest < 18.75 * np.sin(np.pi / 3) and f"at most {largest:g} mm" in str(caught.value.remedy)
    with monkeypatch.context() as patch:
        patch.setattr(OffAxisPress, "run", _reached)
        for offset, works in ((largest, True), (largest + 0.01, False)):
            with pytest.raises(_ReachedError if works else InputError):
                changes = {**BALL, "contact.offset_mm": offset, "pneumatics.driving_pressures_kPa": [0.0]}
                evaluate("paper-dome", changes, model=USUAL)


def test_a_tilt_that_touches_the_connector_is_refused_with_the_largest_that_works():
    with pytest.raises(InputError, match="connector") as caught:
        evaluate("paper-dome", {"contact.tilt_deg": 30.0, "pneumatics.driving_pressures_kPa": [0.0]}, model=USUAL)
    assert caught.value.key == "contact.tilt_deg" and caught.value.file
    largest = float(str(caught.value.remedy).split("at most ")[1].split("°")[0])
    # The middle of a plate that touches a sphere of 10.75 mm is at 10.75/cos, its low edge 15 sin lower.
    low = 10.75 / np.cos(np.radians(largest)) - 15.0 * np.sin(np.radians(largest))
    top = _sensor({}).dome.base.ring_height
    assert low - top == pytest.approx(0.75 * 9.25, abs=0.01)


def test_the_search_and_friction_of_the_flange_refuse_it():
    with pytest.raises(InputError, match="central and level") as caught:
        check_central(load_scene("paper-dome", {"contact.offset_mm": 2.0}))
    assert caught.value.key == "contact.offset_mm"
    with pytest.raises(InputError, match="flange"):
        evaluate("paper-dome", {"contact.offset_mm": 2.0}, model=USUAL, clamp="flange")


@pytest.mark.slow
def test_the_answer_states_its_harmonics_and_the_forces_in_all_directions():
    evaluation = evaluate("paper-dome", {**BALL, **SHORT}, model=USUAL, library=Library.default())
    assert evaluation.prediction.model == evaluation.options.model == "harmonic"
    (state,) = data(by_model(evaluation.prediction))["states"]
    off_axis = state["off_axis"]
    assert state["driving_pressure_kPa"] == 0.0
    assert off_axis["harmonics"] in (6, 8, 12) and 0 < off_axis["last_change_percent"] < 1.0
    assert len(off_axis["sideways_force_N"]) == len(off_axis["moment_N_mm"]) == 7
    # The ball pushes the dome away from its side.
    assert 0.05 < off_axis["sideways_force_N"][-1] / state["curve"]["contact_force_N"][-1] < 0.5
    central = evaluate("paper-dome", {**BALL, **SHORT, "contact.offset_mm": 0.0})
    (middle,) = data(by_model(central.prediction))["states"]
    assert middle["curve"]["contact_force_N"][-1] > state["curve"]["contact_force_N"][-1]
    assert any("2 mm off the dome's" in line for line in evaluation.prediction.assumptions)


def test_a_central_press_with_friction_by_name_is_the_solids():
    changes = {**SHORT, "contact.friction": 0.6}
    by_name, solid = (
        data(by_model(evaluate("paper-dome", changes, model=model).prediction)) for model in ("harmonic", USUAL)
    )
    (ours,), (theirs,) = by_name["states"], solid["states"]
    assert (by_name["model"], solid["model"], ours["off_axis"]["harmonics"]) == ("harmonic", "solid", 0)
    assert ours["sensitivity_kPa_per_N"] == pytest.approx(theirs["sensitivity_kPa_per_N"], rel=1e-7)
    for name in ("contact_force_N", "pressure_rise_kPa"):
        assert ours["curve"][name] == pytest.approx(theirs["curve"][name], rel=1e-7, abs=1e-9)


@pytest.mark.slow
def test_a_shear_is_reported_in_the_document_the_text_and_the_sheets_table():
    prediction = evaluate("paper-dome", {**SHEAR, **SHORT}, model=USUAL).prediction
    record = by_model(prediction)
    (state,) = data(record)["states"]
    sheared, last = state["off_axis"]["shear"], state["off_axis"]["moment_N_mm"][-1]
    assert prediction.model == "harmonic" and any("then 1 mm sideways" in line for line in prediction.assumptions)
    lists = [value for value in sheared.values() if isinstance(value, list)]
    assert len(lists) == 6 and {len(values) for values in lists} == {11}
    # It begins at the end of the press, and a level plate that has slipped has the coefficient times the force.
    assert sheared["contact_force_N"][0] == pytest.approx(state["curve"]["contact_force_N"][-1], rel=1e-9)
    assert sheared["moment_N_mm"][0] == pytest.approx(last, abs=1e-6)
    assert sheared["sideways_force_N"][-1] == pytest.approx(-0.3 * sheared["contact_force_N"][-1], rel=1e-3)
    assert sheared["ended"] is None and 0.0 < sheared["slips_throughout_mm"] < 1.0
    assert sheared["peak_sideways_force_N"] == min(sheared["sideways_force_N"])
    (line,) = _sheared(record.states)
    assert "0 kPa" in line and f"{sheared['slips_throughout_mm']:.2f} mm" in line
    (row,) = shear_rows(prediction.states)
    tables = found(off_axis(prediction.states), SheetTable)
    assert all(len(cells) == len(table.head) for table in tables for cells in table.rows)
    assert row in tables[-1].rows and row[1] == "1.00" and row[3] == f"{sheared['sideways_force_N'][-1]:.3f}"


@pytest.mark.slow
def test_friction_holds_a_ball_that_would_slide_off():
    slips, held = (
        data(by_model(evaluate("paper-dome", {**BALL, **SHORT, "contact.friction": friction}, model=USUAL).prediction))
        for friction in (0.0, 0.6)
    )
    assert held["model"] == "harmonic" and any("friction coefficient 0.6" in line for line in held["assumptions"])
    (without,), (state,) = slips["states"], held["states"]
    assert 0 < state["off_axis"]["last_change_percent"] < 1.0
    assert state["off_axis"]["sideways_force_N"][-1] < 0.5 * without["off_axis"]["sideways_force_N"][-1]


@pytest.mark.parametrize(
    ("changes", "key", "text"),
    [
        ({**EDGE, "contact.edge_radius_mm": 0.2}, "contact.edge_radius_mm", "at least 0.36 mm"),
        ({**EDGE, "contact.offset_mm": 12.0}, "contact.offset_mm", "at most 9.5 mm"),
    ],
)
def test_an_edge_that_the_mesh_or_the_dome_does_not_take_is_refused_with_what_works(changes, key, text):
    with pytest.raises(InputError, match=text) as caught:
        evaluate("paper-dome", changes, model=USUAL)
    assert (caught.value.key, caught.value.value) == (key, changes[key])


def test_the_section_has_a_bar_where_it_stands():
    section = object_section(_sensor({**EDGE, "contact.offset_mm": 2.0}))
    assert section is not None
    x, z = section[~np.isnan(section[:, 0])].T
    assert (x.min(), x.max()) == pytest.approx((-1.0, 5.0))
    # The nose touches the sphere of 10.75 mm where the line of their centres meets it.
    centre = np.sqrt(13.75**2 - 2.0**2)
    assert z.min() == pytest.approx(centre - 3.0, abs=1e-5)
    assert np.isclose(z[np.isclose(x, 5.0)], centre).any() and z.max() == pytest.approx(centre + 12.0, abs=1e-5)


@pytest.mark.slow
def test_a_cylinder_across_the_dome_pushes_straight_down():
    lying = {"contact.object": "cylinder", "contact.cylinder_radius_mm": 12.0}
    (state,) = data(by_model(evaluate("paper-dome", {**lying, **SHORT}, model=USUAL).prediction))["states"]
    assert np.abs(state["off_axis"]["sideways_force_N"]).max() < 1e-6
    round_, flat = ({"contact.object": "ball", "contact.ball_radius_mm": 12.0}, {})
    ends = [evaluate("paper-dome", {**c, **SHORT}).prediction.states[0].force[-1] for c in (round_, flat)]
    # It meets more of the dome than a ball of its radius and less than a plate.
    assert ends[0] < state["curve"]["contact_force_N"][-1] < ends[1]


@pytest.mark.parametrize(
    ("key", "value"),
    [("contact.offset_mm", 2.0), ("contact.tilt_deg", 5.0), ("contact.shear_mm", 1.0), ("contact.object", "edge")],
)
def test_a_fit_and_the_search_refuse_it_by_its_key(key, value):
    changes = {"contact.friction": 0.3, **(EDGE if value == "edge" else {key: value})}
    with pytest.raises(InputError, match="central and level") as caught:
        check_central(load_scene("paper-dome", changes))
    assert (caught.value.key, caught.value.value) == (key, value)
    with pytest.raises(InputError, match="covers") as caught:
        check_fitted(load_scene("paper-dome", changes), _sensor(changes))
    assert (caught.value.key, caught.value.value) == (key, value)
