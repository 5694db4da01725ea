"""The schema of a sweep file, whose keys are those of the design that it varies."""

from typing import Any

from pneutouch.evaluation.evaluate import CLAMPS
from pneutouch.mechanics import MODEL_CHOICES
from pneutouch.mechanics.membrane_contact import CLOSURES
from pneutouch.mechanics.models import USUAL
from pneutouch.schemas.shape import NUMBER, TEXT, any_of, described_by, items, record
from pneutouch.spec.over import MAX_VALUES

_SCALAR = {"type": ["number", "string", "boolean"]}
_VALUE = any_of(_SCALAR, items({"anyOf": [_SCALAR, {"type": "array"}]}))


def _fields(value: dict[str, Any], help: str) -> dict[str, Any]:
    """A table of fields of the design: keys in quotes as ``"table.key"``, or tables of keys."""
    return {
        "type": "object",
        "additionalProperties": {"anyOf": [value, {"type": "object", "additionalProperties": value}]},
        "description": help,
    }


def sweep_schema() -> dict[str, Any]:
    """The schema of a sweep file, see `workflows.sweep.read`."""
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
