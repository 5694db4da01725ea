"""``pneutouch schema`` as a user meets it."""

from __future__ import annotations

import json

from jsonschema import Draft202012Validator

from pneutouch.schemas import document_kinds


def test_it_lists_every_kind_and_prints_the_schema_of_one(command):
    listed = command("schema")
    assert listed.returncode == 0
    assert [line.split()[0] for line in listed.stdout.splitlines()[1:]] == list(document_kinds())
    assert set(json.loads(command("schema", "--json").stdout)) == set(document_kinds())
    for words in (["schema", "design"], ["schema", "design", "--json"]):
        schema = json.loads(command(*words).stdout)
        Draft202012Validator.check_schema(schema)
        assert schema["$schema"].endswith("2020-12/schema")


def test_an_unknown_name_is_an_error_that_names_the_nearest(command):
    result = command("schema", "desing")
    assert result.returncode == 2
    assert result.stderr == "error: NAME desing: unknown. Did you mean design?\n"
