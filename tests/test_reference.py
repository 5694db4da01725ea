"""What is declared stands on the pages of the reference that are made of it: commands, fields, names, profiles."""

from __future__ import annotations

import inspect
import json
import shlex
import typing
from functools import cache

import pytest
import reference_pages
import typer
from pydantic import BaseModel
from reference_pages import commands, interface, printers
from reference_pages.markdown import cell, plain

import pneutouch
from pneutouch.cli.app import app
from pneutouch.cli.commands import COMMANDS
from pneutouch.schemas import document_kinds, schema_of
from pneutouch.schemas.catalogue import _MODELS
from pneutouch.spec.fields import declarations, table_of
from pneutouch.spec.values import Quantity
from tests.schemas.test_files import tables

NAMES = [name for entries in COMMANDS.values() for name in entries]
FORMS = {"TOML": "files.md", "JSON": "documents.md"}


@cache
def pages():
    return reference_pages.pages()


def section(page, name, level="##"):
    """The text under a heading, as far as the next one of its level."""
    _, heading, rest = pages()[page].partition(f"\n{level} {name}\n")
    assert heading, f"{page}: no {level} {name}"
    return rest.partition(f"\n{level} ")[0]


@cache
def group():
    return typer.main.get_command(app)


def command_of(name):
    return group().get_command(typer.Context(group()), name)


@pytest.mark.parametrize("name", NAMES)
def test_every_command_has_its_arguments_and_options_with_their_help(name):
    command = command_of(name)
    text = section("commands.md", name, "###")
    assert f"\npneutouch {name}" in text
    assert len(command.params) > 1
    for parameter in command.params:
        if parameter.name == "help":
            continue
        words = (
            parameter.opts if parameter.param_type_name == "option" else [parameter.metavar or parameter.name.upper()]
        )
        (row,) = (line for line in text.splitlines() if line.startswith(f"| `{cell(words[0])}`"))
        assert all(f"`{cell(word)}`" in row for word in [*words, *parameter.secondary_opts])
        assert parameter.help and cell(plain(parameter.help)) in row
        assert all(f"{end:g}" in row for end in (parameter.min, parameter.max) if end is not None)
        if isinstance(parameter.show_default, str):
            assert plain(parameter.show_default) in row
        elif isinstance(parameter.default, int | float | str) and parameter.default not in (False, True, ""):
            assert f"| `{parameter.default}` |" in row


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_the_example_of_a_command_can_be_read(name):
    program, given, *words = shlex.split(commands.EXAMPLES[name])
    assert (program, given) == ("pneutouch", name)
    commands.parsed(name).make_context(name, words)


def models_in(declared):
    """The models of a union, or the one model."""
    if inspect.isclass(declared):
        yield from [declared] if issubclass(declared, BaseModel) else []
        return
    for one in typing.get_args(declared):
        yield from models_in(one)


def models_of(kinds):
    """Every table of a file: the models that its model is made of."""
    found, left = [], list(kinds)
    for model in left:
        if model in found or model is Quantity:
            continue
        found.append(model)
        left += [table for key in model.model_fields if (table := table_of(model, key)) is not None]
    return found


@pytest.mark.parametrize("name", _MODELS)
def test_every_declared_field_of_a_file_stands_in_its_section(name):
    from importlib import import_module

    module, _, model = _MODELS[name][0].partition(".")
    declared = getattr(import_module(f"pneutouch.spec.{module}"), model)
    kinds = list(models_in(declared))
    assert kinds
    text = section("files.md", name)
    for table in models_of(kinds):
        for field in declarations(table):
            key = table.model_fields[field.key].alias or field.key
            rows = [line for line in text.splitlines() if line.startswith(f"| `{key}` |")]
            assert any(cell(plain(field.help)) in row for row in rows), f"{name}: {table.__name__}.{field.key}"
            (row, *_) = (row for row in rows if cell(plain(field.help)) in row)
            assert not field.unit or f"| {cell(plain(field.unit))} |" in row
            assert field.low is None or f"from {field.low:g} to {field.high:g}" in row


@pytest.mark.parametrize("name", document_kinds())
def test_every_key_of_a_schema_stands_in_its_section_and_the_schema_is_a_file(name):
    kind = document_kinds()[name]
    text = section(FORMS[kind.form], name)
    assert f"<schemas/{name}.schema.json>" in text
    assert json.loads(pages()[f"schemas/{name}.schema.json"]) == schema_of(name)
    keys = {key for table in tables(kind.make()) for key in table["properties"]}
    # Of sourced numbers the page states once what they are.
    quantity = {"value", "low", "high", "spread", "source"}
    assert not [key for key in keys - quantity if f"\n| `{key}` |" not in text]


def test_every_public_name_has_an_entry_and_the_fields_that_it_takes():
    text = pages()["interface.md"]
    for name in set(pneutouch.__all__) - {"__version__"}:
        assert f":: pneutouch.{name}" in text and f"\n   pneutouch.{name}\n" in text and f"\n### {name}\n" in text
    for kind, model in interface._FIELDS.values():
        assert all(f"\n| `{keyword}` |" in text for keyword in interface.keywords(model)), kind


def sources(value):
    """Every source in a profile."""
    if isinstance(value, dict):
        yield from [value["source"]] if "source" in value else []
    for one in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from sources(one)


@pytest.mark.parametrize("name", [*printers.printers(), *printers.curves()])
def test_every_source_of_a_profile_stands_on_the_page(name):
    listed = {**printers.printers(), **printers.curves()}
    text = pages()["printers.md"]
    found = list(sources(listed[name].model_dump()))
    assert len(found) > 2
    assert all(cell(plain(source)) in text for source in found)


@pytest.mark.slow
def test_a_page_that_is_made_no_more_is_removed_and_no_other_file(tmp_path):
    (tmp_path / "schemas").mkdir()
    for name in ("old.md", "schemas/old.schema.json", "formats.txt"):
        (tmp_path / name).write_text("")
    reference_pages.write(tmp_path)
    there = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()}
    assert there == {*pages(), "formats.txt"}
    before = (tmp_path / "commands.md").stat().st_mtime_ns
    reference_pages.write(tmp_path)
    assert (tmp_path / "commands.md").stat().st_mtime_ns == before
