"""A parameter of the simulator: declared once, with unit, default and the reason for it."""

from dataclasses import field, fields
from typing import Any, TypedDict


class ParameterRecord(TypedDict):
    """A parameter as documents list it."""

    value: float | list[float] | None
    unit: str
    reason: str


def parameter(default: Any, unit: str, reason: str) -> Any:
    """A dataclass field in an internal unit, with the reason for its default."""
    return field(default=default, metadata={"unit": unit, "reason": reason})


def parameters(model: Any) -> dict[str, ParameterRecord]:
    """Value, unit and reason of each parameter of a dataclass, by name; an infinite value is null."""
    listed = {}
    for one in fields(model):
        value = getattr(model, one.name)
        value = list(value) if isinstance(value, tuple) else None if value == float("inf") else value
        listed[one.name] = ParameterRecord(value=value, unit=one.metadata["unit"], reason=one.metadata["reason"])
    return listed
