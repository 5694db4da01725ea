"""All schemas by name.

Unit, bounds and default of a field in words: for its description, and for the tables of the reference.
"""

from typing import Any

from pneutouch.errors import InputError, nearest
from pneutouch.formats import version_of
from pneutouch.schemas.documents import written_kinds
from pneutouch.schemas.files import file_kinds
from pneutouch.schemas.pieces import DocumentKind

Schema = dict[str, Any]


def described(schema: Any) -> Any:
    """A schema whose descriptions state unit, bounds and default too, for readers that show nothing else."""
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
    """The bounds of a number, of the numbers of a list, or of a sourced number: ``from 1 to 100``; "" without any."""
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
    """A default as TOML writes it."""
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
    return {**file_kinds(), **written_kinds()}


def schema_of(name: str) -> Schema:
    """The schema of a kind of document, as data: descriptions state unit, bounds and default too.

    Raises InputError for a name that is none.
    """
    kinds = document_kinds()
    if name not in kinds:
        raise InputError(f"unknown.{nearest(name, kinds)}", key="name", value=name)
    kind = kinds[name]
    made = kind.make()
    return {"$schema": DRAFT, "$id": f"urn:pneutouch:{name}:{version_of(name)}", "title": kind.title, **described(made)}
