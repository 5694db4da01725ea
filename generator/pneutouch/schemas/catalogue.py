"""All schemas by name, and those of the TOML files that the program reads, made from the declarations of their keys."""

from functools import partial, reduce
from importlib import import_module
from operator import or_
from typing import Any

from pneutouch.errors import InputError, nearest
from pneutouch.evaluation.evaluate import CLAMPS
from pneutouch.formats import version_of
from pneutouch.mechanics import MODEL_CHOICES
from pneutouch.mechanics.models.choice import CLOSURES, USUAL
from pneutouch.schemas.documents import written_kinds
from pneutouch.schemas.pieces import (
    NUMBER,
    TEXT,
    DocumentKind,
    Schema,
    any_of,
    described_by,
    items,
    model_schema,
    record,
)
from pneutouch.spec.tray import MAX_VALUES
from pneutouch.wording import data_of

_SCALAR = {"type": ["number", "string", "boolean"]}
_VALUE = any_of(_SCALAR, items({"anyOf": [_SCALAR, {"type": "array"}]}))


def _fields(value: dict[str, Any], help: str) -> Schema:
    """Schema of a table of a design's fields, of schema ``value``: keys as ``"table.key"``, or tables of keys."""
    return {
        "type": "object",
        "additionalProperties": {"anyOf": [value, {"type": "object", "additionalProperties": value}]},
        "description": help,
    }


def sweep_schema() -> Schema:
    """The schema of a sweep file, which `workflows.sweep.read` reads."""
    steps = record(
        "A range of equal steps.",
        {
            "from": described_by("First value.", NUMBER),
            "to": described_by("Last value.", NUMBER),
            "count": {"type": "integer", "minimum": 2, "maximum": MAX_VALUES, "description": "Number of values."},
        },
    )
    values = any_of({**items(_SCALAR), "minItems": 1, "maxItems": MAX_VALUES}, steps)
    keys = {
        "design": {
            **described_by("Name of the base design, or a .toml in the folder of the sweep file.", TEXT),
            "minLength": 1,
        },
        "model": {
            **described_by("Model; left out: solid, and harmonic for contact off the axis.", TEXT),
            "enum": [*MODEL_CHOICES, USUAL],
        },
        "closure": {
            **described_by("Contact closure of the membrane model.", TEXT),
            "enum": list(CLOSURES),
            "default": "variational",
        },
        "clamp": {**described_by("Where the solid is held.", TEXT), "enum": list(CLAMPS), "default": "base"},
        "set": _fields(_VALUE, 'Fields of every point: "table.key" = value.'),
        "grid": _fields(values, 'Fields that are varied, every combination: "table.key" = values, or a range.'),
        "point": described_by("Points in place of a grid, one [[point]] each.", items(_fields(_VALUE, "One point."))),
    }
    return record("Designs that differ in some fields.", keys, optional=[key for key in keys if key != "design"])


_MODELS: dict[str, list[str]] = data_of(__file__)["models"]
"""Model in `spec`, title and place of every file with a single model, by the name of its schema."""


def _of_model(path: str) -> Schema:
    module, _, name = path.partition(".")
    return model_schema(getattr(import_module(f"pneutouch.spec.{module}"), name))


def _specimen() -> Schema:
    """The schema of a specimen file, each of whose layers is of one of several kinds."""
    from pneutouch.spec.specimen import LAYERS, Specimen

    kinds: Any = reduce(or_, dict.fromkeys(LAYERS.values()))
    layers, whole = model_schema(kinds), model_schema(Specimen)
    definitions = {key: one for key, one in {**whole["$defs"], **layers["$defs"]}.items() if key != "Layer"}
    whole["properties"]["layer"]["items"] = {"anyOf": layers["anyOf"]}
    return {**whole, "$defs": definitions}


def _file_kinds() -> dict[str, DocumentKind]:
    """Every kind of file that the program reads, by name."""
    declared = {
        name: DocumentKind("TOML", title, where, partial(_of_model, path))
        for name, (path, title, where) in _MODELS.items()
    }
    return {
        **declared,
        "specimen": DocumentKind("TOML", "A texture specimen", "`designs/specimens/`", _specimen),
        "sweep": DocumentKind("TOML", "A sweep", "given to `sweep`", sweep_schema),
    }


def described(schema: Any) -> Any:
    """A copy of a schema whose descriptions also state unit, bounds and default, for readers that show only these."""
    if isinstance(schema, list):
        return [described(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    inner = {key: one if key in ("default", "enum", "const") else described(one) for key, one in schema.items()}
    facts = _sentences(schema)
    if facts and isinstance(schema.get("description", ""), str):
        help = str(schema.get("description", ""))
        added = [fact for fact in facts if fact.lower().rstrip(".") not in help.lower()]
        inner["description"] = " ".join([*([f"{help.rstrip('.')}."] if help else []), *added])
    return inner


def bounds(schema: Schema) -> str:
    """Bounds of a number, of a list's numbers, or of a sourced number: ``from 1 to 100``; "" without any."""
    while schema.get("type") == "array" and isinstance(schema.get("items"), dict) and "minimum" not in schema:
        schema = schema["items"]
    low, high = schema.get("minimum", schema.get("x-minimum")), schema.get("maximum", schema.get("x-maximum"))
    above, below = schema.get("exclusiveMinimum"), schema.get("exclusiveMaximum")
    if low is not None and high is not None:
        return f"from {low:g} to {high:g}"
    lower = f"at least {low:g}" if low is not None else f"more than {above:g}" if above is not None else ""
    upper = f"at most {high:g}" if high is not None else f"less than {below:g}" if below is not None else ""
    return ", ".join(each for each in (lower, upper) if each)


def default_text(value: Any) -> str:
    """A default value as TOML writes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return f"[{', '.join(map(default_text, value))}]"
    return f"{value:g}" if isinstance(value, int | float) else f'"{value}"'


def _sentences(schema: Schema) -> list[str]:
    unit, limits, registry = schema.get("x-unit"), bounds(schema), schema.get("x-registry")
    if schema.get("type") == "array" and "x-unit" not in schema and "default" not in schema and not registry:
        # The items of a list state their own bounds.
        return []
    facts = []
    if limits:
        facts.append(f"{limits[:1].upper()}{limits[1:]}{f' {unit}' if unit else ''}.")
    elif unit:
        facts.append(f"Unit: {unit}.")
    if registry:
        facts.append(f"One of the {registry}: see pneutouch list.")
    if "default" in schema:
        facts.append(f"Default: {default_text(schema['default'])}.")
    return facts


DRAFT = "https://json-schema.org/draft/2020-12/schema"


def document_kinds() -> dict[str, DocumentKind]:
    """Every kind of document with its schema: those that are read, then those that are written."""
    return {**_file_kinds(), **written_kinds()}


def schema_of(name: str) -> Schema:
    """The schema of a kind of document, as data; its descriptions also state unit, bounds and default.

    Raises InputError for a name of no kind.
    """
    kinds = document_kinds()
    if name not in kinds:
        raise InputError(f"unknown.{nearest(name, kinds)}", key="name", value=name)
    kind = kinds[name]
    made = kind.make()
    return {"$schema": DRAFT, "$id": f"urn:pneutouch:{name}:{version_of(name)}", "title": kind.title, **described(made)}
