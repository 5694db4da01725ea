"""A parameter of the simulator: declared once, with unit, default and the reason for it."""

from __future__ import annotations

from dataclasses import field, fields
from typing import Any


def parameter(default: Any, unit: str, reason: str) -> Any:
    """A dataclass field in an inner unit, with the reason for its default."""
    return field(default=default, metadata={"unit": unit, "reason": reason})


def parameters(model: Any) -> dict[str, Any]:
    """Value, unit and reason of each parameter of a dataclass, by name; an infinite value is null."""
    found = {}
    for one in fields(model):
        value = getattr(model, one.name)
        value = list(value) if isinstance(value, tuple) else value
        found[one.name] = {
            "value": None if value == float("inf") else value,
            "unit": one.metadata["unit"],
            "reason": one.metadata["reason"],
        }
    return found
