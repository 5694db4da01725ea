"""Schemas of files: every good file is valid, and what a schema refuses the reader refuses as well."""

from __future__ import annotations

import copy
from functools import cache

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from pneutouch.errors import InputError
from pneutouch.schemas import document_kinds, schema_of
from pneutouch.spec.fields import declarations
from tests.schemas.reads import READERS, as_json, good_files

FILES = good_files()
CASES = [(name, k) for name, contents in FILES.items() for k in range(len(contents))]


@cache
def validator(name):
    schema = schema_of(name)
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def tables(schema):
    """Every table of a schema: what has keys of its own."""
    if isinstance(schema, dict):
        if "properties" in schema:
            yield schema
        for key, one in schema.items():
            yield from tables(one) if key not in ("default", "enum", "required") else ()
    elif isinstance(schema, list):
        for one in schema:
            yield from tables(one)


def test_there_is_a_schema_for_every_file_that_is_read():
    assert set(READERS) == {name for name, kind in document_kinds().items() if kind.form == "TOML"}
    assert set(FILES) == set(READERS)


@pytest.mark.parametrize(("name", "place"), CASES, ids=[f"{name}-{k}" for name, k in CASES])
def test_every_good_file_is_valid(name, place):
    content = FILES[name][place]
    READERS[name](copy.deepcopy(content))
    validator(name).validate(as_json(content))


@pytest.mark.parametrize("name", document_kinds())
def test_every_table_is_closed_and_every_key_is_described(name):
    schema = schema_of(name)
    assert schema["$id"] == f"urn:pneutouch:{name}:1"
    found = list(tables(schema))
    assert found
    for table in found:
        assert table["additionalProperties"] is False
        if name == "reader":
            # Written by hand, with its own tests.
            continue
        for key, field in table["properties"].items():
            helped = {"description", "$ref", "properties"} & set(field) or "$ref" in field.get("items", {})
            assert helped, f"{name}: {key}: {field}"


def test_a_declared_field_is_in_the_schema_with_its_help_unit_bounds_and_default():
    from pneutouch.spec.design import Pneumatics

    table = schema_of("design")["$defs"]["Pneumatics"]["properties"]
    for field in declarations(Pneumatics):
        shown = table[field.key]["description"]
        assert shown.startswith(field.help.rstrip("."))
        assert field.unit in shown
        if field.low is not None:
            assert f"rom {field.low:g} to {field.high:g} {field.unit}" in shown
        if isinstance(field.default, float):
            assert f"Default: {field.default:g}." in shown


def places(value, path=()):
    """Paths of every key and entry of a content."""
    entries = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, one in entries:
        yield (*path, key)
        yield from places(one, (*path, key))


VALUES = st.one_of(
    st.booleans(),
    st.integers(-(10**12), 10**12),
    st.floats(),
    st.text(st.characters(codec="utf-8", exclude_characters="\x00"), max_size=12),
    st.lists(st.integers(-5, 5), max_size=4),
    st.dictionaries(st.sampled_from(["low", "high", "value", "membrane"]), st.integers(-5, 5), max_size=2),
)


@st.composite
def mutants(draw):
    """A good file with one to three of its values replaced, keys taken out or put in."""
    name, place = draw(st.sampled_from(CASES))
    content = copy.deepcopy(FILES[name][place])
    for _ in range(draw(st.integers(1, 3))):
        paths = list(places(content))
        assume(paths)
        *above, last = draw(st.sampled_from(paths))
        owner = content
        for step in above:
            owner = owner[step]
        how = draw(st.sampled_from(["replace", "remove", "add", "scale"]))
        if how == "remove":
            del owner[last]
        elif how == "add" and isinstance(owner, dict):
            owner[draw(st.text("abcz_", min_size=1, max_size=4))] = draw(VALUES)
        elif how == "scale" and type(owner[last]) in (int, float):
            owner[last] = owner[last] * draw(st.sampled_from([-1, 0, 1e-6, 10, 1e6]))
        else:
            owner[last] = draw(VALUES)
    return name, content


@given(mutants())
def test_what_a_schema_refuses_the_reader_refuses(case):
    name, content = case
    if not validator(name).is_valid(as_json(content)):
        with pytest.raises(InputError):
            READERS[name](content)


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("design", {"membrane": {"inner_radius_mm": 0.5}}),
        ("design", {"membrane": {"inner_radius": 5}}),
        ("design", {"contact": {"friction": "much"}}),
        ("design", {"pneumatics": {"driving_pressures_kPa": [0, 2000]}}),
        ("target", {"weights": {}}),
        ("specimen", {"layer": [{"kind": "dots"}]}),
        ("sweep", {"design": "paper-dome", "modle": "solid"}),
    ],
)
def test_a_wrong_file_is_refused_by_schema_and_reader(name, change):
    assert not validator(name).is_valid(change)
    with pytest.raises(InputError):
        READERS[name](change)
