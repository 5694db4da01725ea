"""A design from keyword arguments: fields, files, errors, and the same answers as the command line's."""

from __future__ import annotations

import inspect

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pneutouch as pt
from pneutouch.api.fields import keywords
from pneutouch.errors import InputError
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import table_of
from pneutouch.spec.target import Target

FIELDS = {
    "inner_radius_mm": st.floats(2, 100),
    "wall_thickness_mm": st.floats(0.05, 1.9),
    "material": st.sampled_from(["TangoPlus", "FLX9950"]),
    "connector_material": st.sampled_from(["ABS", "VeroClear"]),
    "tube_length_mm": st.floats(0, 20000),
    "steps": st.integers(2, 1000),
    "driving_pressures_kPa": st.lists(st.floats(0, 1000), min_size=1, max_size=4, unique=True).map(sorted),
    "title": st.text("aé漢&<\"' ", max_size=20),
    "connector_profile": st.sampled_from(["abs-filament", "j735"]),
    "orientation": st.just("dome-down"),
}


@pytest.mark.slow
@given(fields=st.fixed_dictionaries({}, optional=FIELDS))
def test_keywords_come_back_from_the_design_and_from_its_file(fields, tmp_path_factory):
    design = pt.Design("mine", **fields)
    assert {name: getattr(design, name) for name in fields} == fields
    assert pt.Design("mine").replace(**fields) == design
    path = design.save(tmp_path_factory.mktemp("saved") / "mine.toml")
    assert pt.load(path).to_dict() == pt.load(path).replace().to_dict() == design.to_dict()


def test_every_field_of_the_files_has_one_keyword():
    for model in (DesignFile, Target):
        named = keywords(model)
        tables = {name: table_of(model, name) for name in model.model_fields}
        fields = [f"{name}.{key}" for name, table in tables.items() if table for key in table.model_fields]
        fields += [name for name, table in tables.items() if table is None]
        assert sorted(named.values()) == sorted(fields)
    assert keywords(DesignFile)["material"] == "membrane.material"
    assert keywords(DesignFile)["connector_material"] == "connector.material"
    assert set(inspect.signature(pt.Design).parameters) == {"name", *keywords(DesignFile)}


def test_what_a_design_accepts_is_named_by_its_table():
    """A rule's name alone means nothing: `walls` is no wall."""
    assert pt.Design(accepted_walls="twelve printed").accepted_walls == "twelve printed"
    with pytest.raises(pt.InputError):
        pt.Design(walls="twelve printed")


@pytest.mark.parametrize("age", ["1y", -0.1, 2.0, float("nan"), [1.0]])
def test_an_age_that_is_no_share_of_a_year_is_refused_by_its_keyword(age, tmp_path):
    with pytest.raises(pt.InputError) as caught:
        pt.load("paper-dome").export_reader(tmp_path, age_years=age)
    assert caught.value.key == "age_years"


@pytest.mark.parametrize(("title", "after"), [(None, "mine"), ("A sensor", "A sensor")])
def test_a_design_saved_under_a_name_is_headed_by_it(title, after, tmp_path):
    design = pt.Design(name="selected-1", title=title or "selected-1")
    assert pt.load(design.save(tmp_path / "mine.toml")).title == after
    assert design.replace("mine").title == after


def test_tables_arrays_and_scalars_of_numpy_are_taken():
    design = pt.Design(
        pneumatics={"tube_length_mm": 80, "driving_pressures_kPa": np.array([0, 10])},
        steps=np.int64(5),
        inner_radius_mm=np.float32(6),
    )
    assert (design.tube_length_mm, design.driving_pressures_kPa, design.steps) == (80, [0, 10], 5)
    assert design == pt.Design(tube_length_mm=80, driving_pressures_kPa=(0, 10), steps=5, inner_radius_mm=6)
    with pytest.raises(AttributeError, match="wall_thickness_mm"):
        _ = design.wall_thickness


def test_a_printer_that_runs_the_resin_is_chosen_where_none_is_named():
    assert pt.Design().profile == "objet260-connex"
    assert pt.Design(material="Agilus30").profile == "j735"
    with pytest.raises(pt.InputError, match="cannot run Agilus30"):
        pt.Design(material="Agilus30", profile="objet260-connex").check()


@pytest.mark.parametrize(
    ("fields", "key", "value", "words"),
    [
        ({"inner_radius_mm": 0.5}, "inner_radius_mm", 0.5, "must be from 1 to 100 mm"),
        ({"inner_radius": 6}, "inner_radius", 6, "Did you mean inner_radius_mm"),
        ({"connector_material": 3}, "connector_material", 3, "must be text"),
        ({"pneumatics": {"tube_lenth_mm": 3}}, "pneumatics.tube_lenth_mm", 3, "tube_length_mm"),
        (
            {"tube_length_mm": 3, "pneumatics": {"tube_length_mm": 4}},
            "pneumatics",
            {"tube_length_mm": 4},
            "given twice",
        ),
        ({"material": "Tanga"}, "material", "Tanga", "Did you mean TangoPlus"),
    ],
)
def test_errors_name_the_keyword_its_value_and_what_would_be_right(fields, key, value, words):
    with pytest.raises(pt.InputError, match=words) as caught:
        pt.Design(**fields).check()
    error = caught.value
    assert (error.file, error.key, error.value, error.exit_code) == (None, key, value, 2)


def test_errors_of_a_file_name_the_file(tmp_path):
    (tmp_path / "bad.toml").write_text("[membrane]\nmaterial = 3\n")
    with pytest.raises(pt.InputError) as caught:
        pt.load(tmp_path / "bad.toml")
    assert (caught.value.file, caught.value.key) == (str(tmp_path / "bad.toml"), "membrane.material")
    with pytest.raises(pt.InputError, match="Did you mean paper-dome") as caught:
        pt.load("paper-doom")
    assert (caught.value.key, caught.value.value) == ("design", "paper-doom")
    assert "Did you mean paper-dome?" in caught.value.remedy


@pytest.mark.parametrize(
    "options", [{"model": "membrane", "closure": "printed"}, {"tolerance": 0.02}, {"model": "atlas"}]
)
def test_a_prediction_is_the_command_lines(options, printed):
    words = [word for key, value in options.items() for word in (f"--{key}", value)]
    assert pt.load("paper-dome").predict(**options).to_dict() == printed("predict", "paper-dome", *words)


def test_changed_fields_predict_as_set_does(printed):
    ours = pt.load("paper-dome").replace(wall_thickness_mm=1.2).predict([5, 0], model="atlas").to_dict()
    sets = ("--set", "membrane.wall_thickness_mm=1.2", "--set", "pneumatics.driving_pressures_kPa=[0, 5]")
    assert ours == printed("predict", "paper-dome", "--model", "atlas", *sets)


def test_a_tolerance_goes_with_auto_alone():
    with pytest.raises(pt.InputError, match="give one of both") as caught:
        pt.load("paper-dome").predict(model="solid", tolerance=0.02)
    assert caught.value.key == "tolerance"


@pytest.mark.slow
def test_a_check_is_the_command_lines(printed):
    assert pt.load("stiff-dome").check().to_dict() == printed("check", "stiff-dome")
    broken = pt.load("stiff-dome").replace(wall_thickness_mm=0.5)
    assert not broken.check().passed
    with pytest.raises(pt.RuleBrokenError) as caught:
        broken.build("nowhere")
    assert caught.value.exit_code == 1


@pytest.mark.slow
def test_a_build_has_the_bytes_of_the_command_lines(built, tmp_path):
    ours, theirs = pt.load("paper-dome").build(tmp_path), built("paper-dome")
    names = sorted(path.relative_to(theirs) for path in theirs.rglob("*") if path.is_file())
    assert sorted(path.relative_to(ours) for path in ours.rglob("*") if path.is_file()) == names
    assert all((ours / name).read_bytes() == (theirs / name).read_bytes() for name in names)


def test_the_bodies_are_closed_and_the_membrane_has_the_volume_of_its_solid():
    design = pt.load("paper-dome")
    membrane = next(body for body in design.bodies if body.name == "membrane")
    assert membrane.volume == pytest.approx(design.assembly.solid("membrane").volume, rel=2e-3)


def test_a_section_shows_every_body_at_its_size():
    design = pt.Design(inner_radius_mm=6, wall_thickness_mm=1, material="Agilus30")
    ax = design.plot_section()
    low, high = (
        np.min([b.bounds[0] for b in design.bodies], axis=0),
        np.max([b.bounds[1] for b in design.bodies], axis=0),
    )
    drawn = np.vstack([patch.get_path().vertices for patch in ax.patches])
    np.testing.assert_allclose([drawn[:, 0].min(), drawn[:, 0].max()], [low[0], high[0]], atol=0.02)
    np.testing.assert_allclose([drawn[:, 1].min(), drawn[:, 1].max()], [low[2], high[2]], atol=0.02)
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_aspect()) == ("x (mm)", "z (mm)", 1.0)
    assert design.plot_section(ax) is ax


def test_a_mould_is_drawn_around_the_membrane_and_a_printed_one_has_none():
    cast = pt.load("cast-dome")
    drawn = np.vstack([patch.get_path().vertices for patch in cast.plot_mould(labels=False).patches])
    outer = cast.inner_radius_mm + cast.wall_thickness_mm
    assert drawn[:, 1].min() < -outer - 1
    assert np.abs(drawn[:, 0]).max() > outer + 1
    with pytest.raises(pt.InputError, match="printed, not cast"):
        pt.load("paper-dome").plot_mould()


@pytest.mark.parametrize(
    ("keyword", "field"),
    [
        ("material", "membrane.material"),
        ("connector_material", "connector.material"),
        ("mould_material", "mould.material"),
        ("port", "connector.port"),
        ("gauge", "pneumatics.gauge"),
        ("profile", "print.profile"),
    ],
)
def test_a_name_that_nothing_has_is_refused_at_once(keyword, field):
    with pytest.raises(InputError) as refused:
        pt.Design(**{keyword: "nope"})
    assert refused.value.value == "nope" and refused.value.key in (keyword, field)
