"""The pages of every file that is read and every document that is written, from their schemas."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from pneutouch.schemas import document_kinds, schema_of
from pneutouch.schemas.catalogue import bounds, default_text
from pneutouch.schemas.pieces import DocumentKind
from reference_pages import markdown
from reference_pages.markdown import code, plain, table

Schema = dict[str, Any]

HEAD = ("key", "meaning", "type", "unit", "bounds", "default")

_INTRO = {
    "TOML": "Every TOML file that the program reads, with every key, made from the declarations. A key without a "
    "default and not marked *required* may be left out. Files of the catalogue lie in folders of these names, yours "
    "before the shipped ones. A *sourced number* is a table `{ value, low, high, spread, source }`: a value in the "
    "unit of its key, or a range, and where it comes from.",
    "JSON": "Every JSON document that the program writes, with every key, made from the declarations. The name of a "
    "key ends in its unit. A key that is not marked *required* is there where it applies.",
}
_TITLES = {"TOML": "Files that are read", "JSON": "Documents that are written"}

_WORDS = {
    "number": "number",
    "integer": "whole number",
    "string": "text",
    "boolean": "true or false",
    "object": "table",
    "array": "list",
    "null": "null",
}
"""Kinds of value of JSON in words."""


def page(form: str) -> str:
    """The page of one form."""
    kinds = {name: kind for name, kind in document_kinds().items() if kind.form == form}
    heads = [(f"[{name}](#{name})", kind.title, plain(kind.where)) for name, kind in kinds.items()]
    sections = [section(name, kind) for name, kind in kinds.items()]
    return markdown.page(_TITLES[form], _INTRO[form], table(("kind", "what it is", "where"), heads), *sections)


def schema_files() -> dict[str, str]:
    """The schema of every kind as a file, by its path."""
    return {_schema_path(name): json.dumps(schema_of(name), indent=2) + "\n" for name in document_kinds()}


def section(name: str, kind: DocumentKind) -> str:
    """The section of a kind of document: where it lies, its schema, and each of its tables with every key."""
    schema = kind.make()
    file = _schema_path(name).rpartition("/")[2]
    blocks = [
        f"## {name}",
        f"{kind.title}: {kind.where}. Its schema: {{download}}`{file} <{_schema_path(name)}>`, "
        f"which `pneutouch schema {name}` prints.",
    ]
    places = {one["$ref"]: path for path, one in _walked(schema, schema) if "$ref" in one}
    for path, one in _walked(schema, schema):
        whole = resolved(one, schema)
        required = set(whole.get("required", ()))
        rows = [
            _row_of(key, field, schema, key in required, path, places) for key, field in whole["properties"].items()
        ]
        title = f"### {name}: {plain(path)}" if path else ""
        help = plain(whole.get("description", "")) if path else ""
        blocks += [block for block in (title, help, table(HEAD, rows)) if block]
    return "\n\n".join(blocks)


def row(key: str, field: Schema, root: Schema, required: bool) -> tuple[str, ...]:
    """What is declared of a key, by `HEAD`."""
    whole = {**resolved(field, root), **field}
    help = plain(whole.get("description", ""))
    default = code(default_text(field["default"])) if "default" in field else "*required*" if required else ""
    return code(key), help, _type(field, root), plain(field.get("x-unit", "")), bounds(field), default


def resolved(schema: Schema, root: Schema) -> Schema:
    """A schema, or the definition that it refers to."""
    whole: Schema = root["$defs"][schema["$ref"].rpartition("/")[2]] if "$ref" in schema else schema
    return whole


def _schema_path(name: str) -> str:
    return f"schemas/{name}.schema.json"


def _row_of(
    key: str, field: Schema, root: Schema, required: bool, path: str, places: dict[str, str]
) -> tuple[str, ...]:
    """A row; the type of a table that is shown under another key names that place."""
    name, help, kind, *rest = row(key, field, root, required)
    here = f"{path}.{key}" if path else key
    shown = next((places[ref] for ref in _references(field) if ref in places), here)
    return name, help, kind if shown.removesuffix("[]") == here else f"{kind}, as {code(shown)}", *rest


def _forms(schema: Schema) -> list[Schema]:
    """The forms that a value may have, where there are several."""
    return [*schema.get("anyOf", ()), *schema.get("oneOf", ())]


def _references(field: Schema) -> list[str]:
    """Definitions that a field refers to, those of its items too."""
    within = [field, *_forms(field), *([field["items"]] if isinstance(field.get("items"), dict) else ())]
    return [one["$ref"] for one in within if "$ref" in one]


def _walked(schema: Schema, root: Schema) -> Iterator[tuple[str, Schema]]:
    """Every table of a schema with its path; a definition that several keys have, at the first of them."""
    seen: set[str] = set()

    def walk(one: Schema, path: str) -> Iterator[tuple[str, Schema]]:
        name = one.get("$ref", "")
        if name in seen or name.endswith("/Quantity"):
            return
        seen.update({name} - {""})
        whole = resolved(one, root)
        if "properties" in whole:
            yield path, one
            for key, field in whole["properties"].items():
                yield from walk(field, f"{path}.{key}" if path else key)
        if isinstance(whole.get("items"), dict):
            yield from walk(whole["items"], f"{path}[]")
        if isinstance(whole.get("additionalProperties"), dict):
            yield from walk(whole["additionalProperties"], f"{path}.NAME")
        for k, form in enumerate(_forms(whole)):
            yield from walk(form, path or form.get("$ref", f"form {k + 1}").rpartition("/")[2])

    yield from walk(schema, "")


def _type(field: Schema, root: Schema) -> str:
    """The kind of value in words."""
    if "$ref" in field:
        name = field["$ref"].rpartition("/")[2]
        return "sourced number" if name == "Quantity" else _type(resolved(field, root), root)
    if "enum" in field:
        return ", ".join("null" if word is None else code(default_text(word)) for word in field["enum"])
    if "const" in field:
        return code(default_text(field["const"]))
    if _forms(field):
        return " or ".join(dict.fromkeys(_type(one, root) for one in _forms(field)))
    if field.get("type") == "array":
        return f"list of {_type(field['items'], root)}" if field.get("items") else "list"
    if "format" in field:
        return "date"
    kinds = field.get("type", "any value")
    return " or ".join(_WORDS.get(kind, kind) for kind in ([kinds] if isinstance(kinds, str) else kinds))
