"""Which model answers at which tolerance, why, and what it states of itself."""

from __future__ import annotations

import json
import re
import sys
from dataclasses import asdict, replace
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneutouch.errors import BeyondLimitError, InputError
from pneutouch.mechanics import predict
from pneutouch.mechanics.models import choice
from pneutouch.mechanics.models.accuracy import NUMERICAL
from pneutouch.mechanics.models.choice import model_named, models_for, parse_tolerance
from pneutouch.mechanics.models.interface import ModelAnswer, SensorModel
from pneutouch.mechanics.predict import contact_words
from pneutouch.mechanics.sensor import Dome, GasCircuit, IndentationProtocol, Sensor, WallMaterial
from pneutouch.mechanics.solid.indenter import ball
from pneutouch.shape.hemisphere import Hemisphere
from pneutouch.units import KPA, ML
from tests.refusals import refused

CENTRAL = ("membrane", "atlas", "solid")

PAPER = Sensor(
    Dome(Hemisphere(9.25, 1.5)),
    WallMaterial(0.17, 0.49),
    GasCircuit(ambient_pressure=0.101325, dead_volume=0.0, gauge_limit=0.1),
    IndentationProtocol(plate_radius=15.0, depth=4.5, steps=14),
)

OUTSIDE = {
    "law": ({"law": ("mooney-rivlin", (0.07, 0.015))}, "law of its own"),
    "Poisson ratio": ({"poisson_ratio": 0.48}, "Poisson ratio 0.48"),
    "flange": ({"flange": (2.25, 2.25)}, "flange"),
    "thin wall": ({"wall_thickness": 0.05 * 9.25}, r"wall 0\.05 R0"),
    "thick wall": ({"wall_thickness": 0.4 * 9.25}, r"wall 0\.4 R0"),
    "depth": ({"depth": 0.76 * 9.25}, r"depth 0\.76 R0"),
    "soft resin in air": ({"shear_modulus": 0.03}, "ambient pressure"),
}


def said(prediction):
    return prediction.error_estimate.model_choice


@pytest.mark.parametrize(("text", "value"), [("2%", 0.02), ("0.02", 0.02), (" 1.6 % ", 0.016), ("100%", 1.0)])
def test_tolerances_are_read_as_shares(text, value):
    assert parse_tolerance(text) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("text", ["", "%", "two", "0", "-1%", "nan", "inf", "2%%", "0%", "1e9", "5", "150%"])
def test_what_is_no_tolerance_is_refused_in_words(text):
    with refused("tolerance"):
        parse_tolerance(text)


@given(st.floats(1e-6, 0.99))
def test_a_percentage_and_its_share_are_the_same(value):
    assert parse_tolerance(f"{100 * value!r}%") == pytest.approx(parse_tolerance(repr(value)), rel=1e-12)


def test_stated_errors_fall_as_the_models_get_dearer():
    errors = [NUMERICAL[model] for model in CENTRAL]
    assert errors == sorted(errors, reverse=True) and len(set(errors)) == len(errors)


@given(st.floats(min(NUMERICAL.values()), 50.0))
def test_every_model_on_the_way_meets_the_tolerance_and_the_rest_say_why_not(tolerance):
    way = models_for(PAPER, tolerance)
    assert way.models[-1] == "solid"
    assert all(NUMERICAL[model] <= tolerance for model in way.models)
    assert list(way.models) == [model for model in CENTRAL if model in way.models]
    assert {line.split(":")[0] for line in way.passed} == set(CENTRAL) - set(way.models)


def test_at_two_percent_the_atlas_answers_and_names_both_parts_of_its_error():
    found = predict("x", PAPER, [0.0, 0.022], model="auto", tolerance=0.02)
    assert found.model == "atlas"
    assert "meets 2.0%" in said(found) and "passed over membrane" in said(found)
    assert found.error_estimate.sensitivity_tabulation_relative == pytest.approx(0.0075)
    assert found.error_estimate.sensitivity_discretisation_relative == pytest.approx(0.011)


def test_at_one_point_two_percent_the_solid_answers():
    found = predict("x", PAPER, [0.022], model="auto", tolerance=0.012)
    assert found.model == "solid"
    assert "atlas: its stated error of 1.8% is more than 1.2%" in said(found)


@pytest.mark.parametrize("tolerance", [0.0109, 1e-6, 0.0, -1.0, float("nan")])
def test_below_what_the_solid_can_state_is_an_error(tolerance):
    with pytest.raises(InputError, match=r"the best is the solid's 1\.1%"):
        predict("x", PAPER, [0.0], model="auto", tolerance=tolerance)


def test_under_a_ball_the_solid_states_its_greater_error_and_answers_no_smaller_tolerance():
    pressed = PAPER.replace(steps=4, body=ball(10.0), plate_radius=10.0)
    answered = predict("x", pressed, [0.022], model="auto", tolerance=0.02)
    assert answered.model == "solid" and "stated error, 2.0% in sensitivity, meets 2.0%" in said(answered)
    with pytest.raises(InputError, match=r"the best is the solid's 2%"):
        predict("x", pressed, [0.022], model="auto", tolerance=0.019)


def test_a_tolerance_of_many_times_takes_the_membrane():
    found = predict("x", PAPER, [0.0], model="auto", tolerance=20.0)
    assert found.model == "membrane" and "20" in said(found)


@pytest.mark.parametrize("case", OUTSIDE)
def test_outside_its_box_the_atlas_is_passed_over_and_the_reason_told(case):
    changes, reason = OUTSIDE[case]
    sensor = PAPER.replace(**changes)
    way = models_for(sensor, 0.02)
    (line,) = [text for text in way.passed if text.startswith("atlas")]
    assert way.models == ("solid",) and re.search(reason, line)
    with pytest.raises(InputError, match=reason):
        predict("x", sensor, [0.0], model="atlas")


@pytest.mark.parametrize("case", ["law", "flange", "depth", "soft resin in air"])
def test_auto_falls_through_to_the_solid(case):
    changes, _ = OUTSIDE[case]
    found = predict("x", PAPER.replace(steps=4, **changes), [0.0], model="auto", tolerance=0.02)
    assert found.model == "solid" and "passed over atlas" in said(found)


def test_a_contact_that_reaches_the_plates_edge_goes_to_the_solid():
    small = PAPER.replace(plate_radius=3.0)
    found = predict("x", small, [0.022], model="auto", tolerance=0.02)
    assert found.model == "solid" and "the contact reaches the plate's edge" in said(found)
    with pytest.raises(InputError) as caught:
        predict("x", small, [0.022], model="atlas")
    assert (caught.value.key, caught.value.value) == ("model", "atlas") and "solid" in caught.value.remedy


@pytest.mark.parametrize(
    ("changes", "pressure", "word"),
    [
        ({"shear_modulus": 1.64, "depth": 6.9375}, 0.0, "buckles"),
        ({"break_stretch": 1.35, "depth": 6.9375}, 0.022, "break strain"),
    ],
)
def test_a_range_that_ends_by_buckling_or_tearing_is_left_to_the_solid_unless_the_atlas_is_asked(
    changes, pressure, word
):
    sensor = PAPER.replace(**changes)
    auto, asked = (predict("x", sensor, [pressure], model=model) for model in ("auto", "atlas"))
    assert auto.model == "solid" and word in said(auto)
    assert asked.model == "atlas" and asked.states[0].figures is not None


def test_a_press_that_leaves_the_known_states_goes_to_the_solid(monkeypatch):
    """Nothing but the support of the states is taken away here, as at an edge that the survey did not reach."""
    from pneutouch.mechanics.atlas.table import Atlas

    slices = Atlas.slices

    def shallow(self, *words):
        cut = slices(self, *words)
        support = cut.support.copy()
        support[:, :, 6:] = False
        return replace(cut, support=support)

    monkeypatch.setattr(Atlas, "slices", shallow)
    found = predict("x", PAPER, [0.022], model="auto", tolerance=0.02)
    assert found.model == "solid" and "leaves the states that the atlas covers" in said(found)


def test_auto_is_the_model_it_names():
    auto, atlas = (predict("x", PAPER, [0.012, 0.022], model=m) for m in ("auto", "atlas"))
    assert [s.figures for s in auto.states] == [s.figures for s in atlas.states]
    assert atlas.error_estimate.model_choice is None
    assert auto.assumptions == atlas.assumptions


def test_beyond_the_limit_point_every_model_says_so_with_nearly_the_same_limit():
    limits = []
    for model in ("atlas", "auto", "solid"):
        with pytest.raises(BeyondLimitError) as caught:
            predict("x", PAPER, [0.0, 0.0405], model=model)
        limits.append(caught.value.limit)
    assert limits == pytest.approx([limits[2]] * 3, rel=5e-4)
    assert limits[2] / KPA == pytest.approx(39.6, abs=0.1)


def test_gas_of_a_dead_volume_in_millilitres_is_stated():
    found = predict("x", PAPER.replace(dead_volume=2 * ML), [0.0], model="auto")
    assert "dead volume 2 mL" in found.assumptions[-1]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, "rigid, flat, frictionless plate"),
        ({"body": ball(5.0), "friction": 0.5}, ", friction coefficient 0.5 (Coulomb), central and straight down"),
        ({"body": ball(5.0), "offset": 1.5}, "frictionless, its axis 1.5 mm off the dome's, straight down"),
        ({"tilt": np.radians(5.0)}, "rigid flat plate, frictionless, leaning by 5°, straight down"),
    ],
)
def test_what_presses_the_sensor_is_stated(changes, words):
    assert words in contact_words(PAPER.replace(**changes).protocol)


def test_the_command_line_takes_a_tolerance(command, root):
    words = ["predict", "paper-dome", "--set", "indentation.depth_mm=4.5", "--json"]
    result = command(*words, "--tolerance", "2%", cwd=root)
    assert result.returncode == 0, result.stderr
    document = json.loads(result.stdout)
    assert document["model"] == "atlas" and "meets 2.0%" in document["error_estimate"]["model_choice"]


@pytest.mark.parametrize(
    "words",
    [
        ["--tolerance", "two"],
        ["--tolerance", "-2%"],
        ["--tolerance", "0.5%"],
        ["--tolerance", "2%", "--model", "solid"],
    ],
)
def test_bad_tolerances_exit_2_in_one_line(command, root, words):
    result = command("predict", "paper-dome", *words, "--json", cwd=root)
    assert result.returncode == 2 and result.stdout == ""
    assert "--tolerance" in result.stderr and "Traceback" not in result.stderr


def test_the_atlas_asked_by_name_says_what_its_answer_lacks():
    """A wall that buckles lies at the edge of the table; asked for it, the atlas answers and says so."""
    hard = PAPER.replace(shear_modulus=0.91, depth=0.75 * 9.25)
    found = predict("", hard, [0.0], model="atlas")
    assert [e.kind for e in found.states[0].events if e.ends_range] == ["inward buckling"]
    assert "buckles" in said(found)


def test_a_batch_of_the_atlas_answers_as_each_sensor_alone():
    """Sensors of other walls, resins, steps and driving pressures in one pass; one of them beyond its limit point."""
    atlas = model_named("atlas")
    thin, other_steps = PAPER.replace(wall_thickness=1.1), PAPER.replace(wall_thickness=1.3, steps=9)
    sensors = [PAPER, thin, other_steps, PAPER.replace(shear_modulus=0.4), PAPER]
    pressures = [np.array(some) * KPA for some in ([0.0, 12.0], [5.0], [0.0, 3.0], [0.0, 20.0, 40.0], [50.0])]
    together = atlas.answer(sensors, pressures)
    for sensor, driven, answer in zip(sensors[:4], pressures[:4], together[:4], strict=True):
        alone = atlas.answer_one(sensor, driven)
        assert len(answer.result.states) == driven.size
        assert answer.result.limits.limit_point == pytest.approx(alone.result.limits.limit_point, rel=1e-12)
        for name in ("apex_inner", "apex_outer", "volume", "pressure"):
            assert getattr(answer.result.inflation, name) == pytest.approx(getattr(alone.result.inflation, name), 1e-9)
        assert asdict(answer.result.limit_point) == pytest.approx(asdict(alone.result.limit_point), rel=1e-9)
        for one, other in zip(answer.result.states, alone.result.states, strict=True):
            assert one.force == pytest.approx(other.force, rel=1e-9)
            assert one.figures.sensitivity == pytest.approx(other.figures.sensitivity, rel=1e-9)
    assert isinstance(together[4], BeyondLimitError) and together[4].pressure == pytest.approx(50.0 * KPA)


class _Halved(SensorModel):
    """The solid at half the force, under a name of its own."""

    name = "halved"

    def covers(self, sensor):
        return None if sensor.protocol.friction == 0.0 else "it knows no friction"

    def answer(self, sensors, driving_pressures):
        solid = model_named("solid").answer(sensors, driving_pressures)
        halved = [replace(state, force=0.5 * state.force) for state in solid[0].result.states]
        return [ModelAnswer(replace(solid[0].result, states=tuple(halved)))]

    def errors(self, sensor, driving_pressures):
        return model_named("solid").errors(sensor, driving_pressures)

    def assumptions(self, sensor):
        return ("half of the force",)

    def stated_error(self, sensor):
        return 0.015


def test_a_model_is_one_file_and_one_line(monkeypatch):
    """A module with a ``MODEL`` and its line of the table answer by name and for `auto`, at their place."""
    module = ModuleType("halved_model")
    module.MODEL = _Halved()
    monkeypatch.setitem(sys.modules, "halved_model", module)
    monkeypatch.setattr(choice, "MODELS", {"halved": "halved_model", **choice.MODELS})
    named, auto, solid = (predict("x", PAPER, [0.0], model=m, tolerance=0.016) for m in ("halved", "auto", "solid"))
    assert named.model == auto.model == "halved" and named.assumptions[0] == "half of the force"
    assert named.states[0].force == pytest.approx(0.5 * solid.states[0].force, rel=1e-12)
    with pytest.raises(InputError) as caught:
        predict("x", PAPER.replace(friction=0.3), [0.0], model="halved")
    assert (caught.value.key, caught.value.value) == ("model", "halved")


def test_the_remedy_of_a_model_is_never_the_model_that_has_just_refused():
    """A flange as printed and contact off the axis: no model covers both, named or by choice."""
    scene = PAPER.replace(flange=(2.25, 2.25), offset=2.0)
    for model in ("harmonic", "solid", "auto"):
        with pytest.raises(InputError) as caught:
            predict("x", scene, [0.0], model=model)
        assert caught.value.key == "model"
        assert not {"harmonic", "solid", "auto"} & set(caught.value.remedy.split())


def test_a_table_with_a_limitation_states_no_error_of_its_own():
    found = predict("", PAPER.replace(depth=0.15 * 9.25), [0.0], model="atlas")
    assert found.error_estimate.sensitivity_tabulation_relative is None
    assert found.error_estimate.model_choice is not None
