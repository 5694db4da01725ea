"""Errors as the page takes them: the fields that an error is about come from the error, not from its words."""

import pytest
from pydantic import ValidationError

from pneutouch.errors import InputError, PneutouchError
from pneutouch.spec.contact import ContactTable
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import FieldsError
from pneutouch.spec.read import validate
from pneutouch.spec.target import Target
from pneutouch.studio.guard import faults_of

BASE = {"target": {"sensitivity_kPa_per_N": 2.0}}

CASES = {
    "a wall thicker than the radius": (
        DesignFile,
        {"membrane": {"inner_radius_mm": 3.0, "wall_thickness_mm": 4.0}},
        ["membrane.inner_radius_mm", "membrane.wall_thickness_mm"],
    ),
    "a depth beyond the dome": (
        DesignFile,
        {"membrane": {"inner_radius_mm": 5.0, "wall_thickness_mm": 1.0}, "indentation": {"depth_mm": 5.0}},
        ["membrane.inner_radius_mm", "indentation.depth_mm"],
    ),
    "a ball that leans": (
        DesignFile,
        {"contact": {"object": "ball", "ball_radius_mm": 4.0, "tilt_deg": 3.0}},
        ["contact.object", "contact.tilt_deg"],
    ),
    "two diameters": (
        Target,
        {"target": {"sensitivity_kPa_per_N": 2.0, "max_diameter_mm": 9.0}, "given": {"inner_radius_mm": 8.0}},
        ["target.max_diameter_mm", "given.inner_radius_mm"],
    ),
    "a grade without a requirement": (
        Target,
        {**BASE, "given": {"mix": "TangoPlus+VeroClear", "graded": True}},
        ["target.same_sensitivity_at_kPa", "target.widest_range", "given.graded"],
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_an_error_on_a_table_or_a_file_names_its_fields(case):
    model, content, fields = CASES[case]
    with pytest.raises(InputError) as caught:
        validate(model, content, "here.toml")
    assert sorted(faults_of(caught.value).problems[0].fields) == sorted(fields)


def test_the_words_of_an_error_name_no_field():
    """A problem that mentions a field by its name is about none, unless it says so."""
    error = InputError("as membrane.wall_thickness_mm is not known", key="membrane")
    assert faults_of(error).problems[0].fields == []
    said = InputError("x", key="membrane", fields=["membrane.wall_thickness_mm"])
    assert faults_of(said).problems[0].fields == ["membrane.wall_thickness_mm"]


def test_fields_of_an_error_are_fields_of_its_table():
    for content in ({"object": "ball"}, {"object": "plate", "shear_mm": 1.0}, {"ball_radius_mm": 3.0}):
        with pytest.raises(ValidationError) as caught:
            ContactTable.model_validate(content)
        (detail,) = caught.value.errors()
        error = detail["ctx"]["error"]
        assert isinstance(error, FieldsError) and error.fields
        assert set(error.fields) <= set(ContactTable.model_fields)


def test_fields_pass_between_processes():
    import pickle

    error = pickle.loads(pickle.dumps(PneutouchError("x", fields=["a.b"])))
    assert error.fields == ("a.b",)
