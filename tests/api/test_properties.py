"""What holds for every design and every wrong value, drawn at random."""

from __future__ import annotations

import itertools
import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

import pneutouch as pt
from pneutouch.api.fields import keywords
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import Declaration, declaration, table_of
from tests.api.test_design import FIELDS

LISTS = ("driving_pressures_kPa",)


def declared() -> dict[str, Declaration]:
    """Declarations of the numbers, by keyword."""
    places = {name: place.split(".") for name, place in keywords(DesignFile).items() if "." in place}
    every = {name: declaration(table_of(DesignFile, table), key) for name, (table, key) in places.items()}
    return {name: each for name, each in every.items() if each.low is not None}


NUMBERS = declared()


@given(one=st.fixed_dictionaries({}, optional=FIELDS), other=st.fixed_dictionaries({}, optional=FIELDS))
def test_fields_are_replaced_in_any_order(one, other):
    other = {name: value for name, value in other.items() if name not in one}
    if "profile" in one | other or "material" in one | other:
        # A printer is chosen for the resin where none is named: once chosen it stays.
        one = {**one, "profile": "j735"}
    design = pt.Design("mine", profile="j735")
    assert (
        design.replace(**one).replace(**other)
        == design.replace(**other).replace(**one)
        == design.replace(**one, **other)
    )
    assert design.replace() == design and design.replace(name="other").file == design.file


@given(fields=st.fixed_dictionaries({}, optional=FIELDS))
def test_a_design_as_data_is_json_and_is_the_design(fields):
    design = pt.Design("mine", **fields)
    tables = json.loads(json.dumps(design.to_dict(), allow_nan=False))
    assert tables == design.to_dict()
    assert pt.Design("mine", **{name: table for name, table in tables.items() if table != {}}).to_dict() == tables


@given(name=st.sampled_from(sorted(NUMBERS)), above=st.booleans(), data=st.data())
def test_a_number_out_of_its_bounds_is_refused_by_keyword_value_and_bounds(name, above, data):
    field = NUMBERS[name]
    if isinstance(field.default, int):
        beyond = st.integers(int(field.high) + 1, 10**400) if above else st.integers(-(10**400), int(field.low) - 1)
    elif above:
        beyond = st.floats(math.nextafter(field.high, math.inf), math.inf)
    else:
        beyond = st.floats(-math.inf, math.nextafter(field.low, -math.inf))
    value = data.draw(beyond)
    with pytest.raises(pt.InputError) as caught:
        pt.Design(**{name: [value] if name in LISTS else value})
    assert caught.value.key.partition("[")[0] == name
    assert caught.value.value == value
    assert caught.value.file is None and "must be" in str(caught.value)


class Odd:
    def __repr__(self):
        raise RuntimeError("never shown")


ENDLESS: list[object] = []
ENDLESS.append(ENDLESS)
ODD = st.one_of(
    st.sampled_from([Odd(), Odd, float, 1j, b"\xff", ENDLESS, "1.5", math.nan, {}, {"a": ENDLESS}, set(), Ellipsis]),
    st.recursive(
        st.none() | st.text(max_size=5) | st.binary(max_size=5),
        lambda inner: st.lists(inner, min_size=1, max_size=3),
        max_leaves=8,
    ).filter(lambda value: value is not None),
    st.builds(lambda: itertools.count()),
    st.builds(lambda: range(10**12)),
)


@pytest.mark.slow
@given(name=st.sampled_from(sorted(NUMBERS)), value=ODD)
def test_what_is_no_number_is_refused_by_its_keyword(name, value):
    with pytest.raises(pt.InputError) as caught:
        pt.Design(**{name: value})
    assert caught.value.key.partition("[")[0] == name
    assert str(caught.value).startswith(name) and len(str(caught.value)) < 2000


@given(
    word=st.text(min_size=1, max_size=30).filter(
        lambda word: (
            word not in keywords(DesignFile) and word not in DesignFile.model_fields and word not in ("name", "self")
        )
    )
)
def test_an_unknown_keyword_is_refused_by_its_name(word):
    with pytest.raises(pt.InputError) as caught:
        pt.Design(**{word: 1})
    assert (caught.value.key, caught.value.value) == (word, 1)


@pytest.mark.parametrize("values", [itertools.count(1), range(1, 10**6), [1.0 + 1e-6 * k for k in range(100_001)]])
def test_more_values_than_a_field_takes_are_refused_and_none_is_left_out(values):
    with pytest.raises(pt.InputError, match=r"wall_thickness_mm.*a list of 1 to 10000 values"):
        pt.sweep("paper-dome", wall_thickness_mm=values)
    with pytest.raises(pt.InputError, match=r"driving_pressures_kPa.*at most"):
        pt.load("paper-dome").predict(values)


NO_NUMBERS = (10**400, -(10**400), math.inf, math.nan, True, "12", None)


@given(values=st.lists(st.floats(0, 100), max_size=3), wrong=st.sampled_from(NO_NUMBERS))
def test_a_pressure_or_age_that_is_no_finite_number_is_refused_by_its_keyword(values, wrong):
    given_wrong = [*values, wrong]
    for call, name in (
        (lambda: pt.calibrate("nowhere", hold_out_kPa=given_wrong), "hold_out_kPa"),
        (lambda: pt.simulate("paper-dome", "nowhere", driving_pressures_kPa=given_wrong), "driving_pressures_kPa"),
        (lambda: pt.simulate("paper-dome", "nowhere", ages_days=given_wrong), "ages_days"),
        (lambda: pt.scan("lines", "paper-dome", driving_pressures_kPa=given_wrong), "driving_pressures_kPa"),
        (lambda: pt.scan("lines", "paper-dome", noise_kPa=10**400), "noise_kPa"),
        (lambda: pt.sweep("paper-dome", inner_radius_mm=[6, 10**400]), "inner_radius_mm"),
    ):
        with pytest.raises(pt.InputError, match="must be ") as caught:
            call()
        assert name in caught.value.key


def test_one_driving_pressure_is_a_list_of_one():
    design = pt.load("paper-dome")
    one, listed = design.predict(10, model="membrane"), design.predict([10], model="membrane")
    assert one.to_dict() == listed.to_dict()
    assert design.replace(driving_pressures_kPa=10) == design.replace(driving_pressures_kPa=[10])
    compared, by_list = (pt.compare(design, "soft-pad", driving_pressures_kPa=p, model="membrane") for p in (10, [10]))
    assert compared.to_dict() == by_list.to_dict()


@pytest.mark.parametrize("name", ["sine_Hz", "step_N", "step_mm", "peak_N", "peak_mm", "duration_s"])
@pytest.mark.parametrize("value", ["5", 10**400, math.nan, True, [5]])
def test_a_load_that_is_no_number_is_refused_by_its_keyword(name, value):
    with pytest.raises(pt.InputError, match="must be a finite number") as caught:
        pt.respond("paper-dome", **{name: value})
    assert caught.value.key == name


@pytest.mark.parametrize("name", [6, None, 1.5, ["a"]])
def test_a_name_that_is_no_text_is_refused(name):
    for call in (lambda: pt.Design(name), lambda: pt.Design().replace([6] if name is None else name)):
        with pytest.raises(pt.InputError, match="must be a text; give a text") as caught:
            call()
        assert caught.value.key == "name"


@pytest.mark.parametrize("given", [5, [5], {"a": 1}, ["steps", None]])
def test_what_is_no_list_of_texts_is_refused_by_its_keyword(given):
    for call, name in (
        (lambda: pt.simulate("paper-dome", "nowhere", kinds=given), "kinds"),
        (lambda: pt.simulate("paper-dome", "nowhere", resins=given), "resins"),
        (lambda: pt.plan("paper-dome", resins=given), "resins"),
        (lambda: pt.calibrate("nowhere", fit=given), "fit"),
    ):
        with pytest.raises(pt.InputError, match="must be ") as caught:
            call()
        assert caught.value.key.partition("[")[0] == name


@pytest.mark.slow
def test_one_kind_and_one_resin_are_lists_of_one():
    with pytest.raises(pt.InputError, match='must be "steps"') as caught:
        pt.simulate("paper-dome", "nowhere", kinds="step")
    assert (caught.value.key, caught.value.value) == ("kinds[0]", "step")
    one, listed = pt.plan("paper-dome", resins="TangoPlus"), pt.plan("paper-dome", resins=["TangoPlus"])
    assert one.to_dict() == listed.to_dict()


@pytest.mark.parametrize("call", [pt.characterize, pt.calibrate])
def test_data_that_are_no_path_are_refused(call):
    with pytest.raises(pt.InputError, match="data = 5: must be a path; give a campaign's folder"):
        call(5)


def test_a_keyword_without_its_first_word_is_told_the_whole_one():
    with pytest.raises(pt.InputError, match="Did you mean inner_radius_mm") as caught:
        pt.Design(radius_mm=6)
    assert caught.value.key == "radius_mm"


def test_an_unknown_material_is_refused_at_once():
    with pytest.raises(pt.InputError) as caught:
        pt.Design(material="TangoPlu")
    assert (caught.value.key, caught.value.value) == ("material", "TangoPlu")
    with pytest.raises(pt.InputError) as caught:
        pt.Design(material="ABS")
    assert caught.value.key == "material"


def test_a_wall_is_that_of_the_dome_and_the_moulds_has_its_name():
    with pytest.raises(pt.InputError) as caught:
        pt.Design(wall_mm=1)
    assert caught.value.key == "wall_mm" and "wall_thickness_mm" in str(caught.value)
    assert pt.Design(mould_wall_mm=5).mould_wall_mm == 5.0


@pytest.mark.slow
def test_results_of_several_things_are_walked_through():
    prediction = pt.load("paper-dome").predict([0, 12], model="atlas")
    assert [state.driving_pressure_kPa for state in prediction] == [0, 12] and len(prediction) == 2
    assert prediction[1] is prediction.states[1]
    found = pt.select(sensitivity_kPa_per_N=1.9, driving_pressure_kPa=12, materials=["TangoPlus"])
    assert tuple(found) == found.designs and found[0] is found.designs[0] and len(found) == len(found.designs) > 0
    assert not pt.select(sensitivity_kPa_per_N=50, materials=["TangoPlus"])


def test_a_home_of_nobody_is_refused(monkeypatch):
    monkeypatch.setenv("PNEUTOUCH_HOME", "~nobody-of-this-name/x")
    with pytest.raises(pt.InputError) as caught:
        pt.load("paper-dome")
    assert caught.value.key == "PNEUTOUCH_HOME"
