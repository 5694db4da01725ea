"""A tray file: which designs are printed together, how many of each, and how they are distinguished."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema, field_validator, model_validator

from pneutouch.errors import shown
from pneutouch.spec.design import Printable
from pneutouch.spec.fields import Table, number
from pneutouch.spec.values import is_finite

LEAST_COPIES, MOST_COPIES = 1, 200


def _by_key(value: dict[str, Any]) -> WithJsonSchema:
    """Values by ``table.key``, or as tables of keys: TOML makes tables of dots that are not in quotes."""
    either = {"anyOf": [value, {"type": "object", "additionalProperties": value}]}
    return WithJsonSchema({"type": "object", "additionalProperties": either})


def _setting(given: Any) -> Any:
    """One error, not one for each kind that does not match."""
    good = all(map(is_finite, given)) if isinstance(given, list) else isinstance(given, str) or is_finite(given)
    if not good:
        raise ValueError(f"{given!r:.60}: must be a finite number, text or a list of finite numbers")
    return given


EntryValue = Annotated[str | float | int | list[float | int], BeforeValidator(_setting)]
_VALUE = {"anyOf": [{"type": "string"}, {"type": "number"}, {"type": "array", "items": {"type": "number"}}]}
Role = Literal["membrane", "connector", "ring", "plug"]
Marks = Literal["engraved", "raised", "none"]


class TrayHead(Table):
    """[tray]: the printer and how parts lie on it."""

    title: Printable = Field(default="Tray of touch sensors", max_length=80, description="Title of the label list.")
    profile: str | None = Field(
        default=None,
        min_length=1,
        description="Printer; left out: the printer of the first entry's membrane.",
        json_schema_extra={"registry": "printers"},
    )
    spacing_mm: float = number(3.0, unit="mm", low=0.5, high=50, help="Least distance between bounding boxes.")
    margin_mm: float = number(5.0, unit="mm", low=0, high=50, help="Border of the envelope that is left free.")
    bodies: list[Role] | None = Field(
        default=None,
        min_length=1,
        max_length=50,
        description="a list of membrane, connector, ring, plug; left out: all that this printer prints.",
    )
    marks: Marks = Field(default="engraved", description="engraved, raised or none.")


class Entry(Table):
    """[[entry]]: one design, or one for each value of one of its fields.

    ``over`` has at most one key, ``table.key``, with its values; ``set`` holds for all of them.
    """

    design: str = Field(min_length=1, description="name of a design, or a .toml in the folder of the tray file")
    copies: int = Field(default=1, ge=LEAST_COPIES, le=MOST_COPIES, description=f"from {LEAST_COPIES} to {MOST_COPIES}")
    over: Annotated[
        dict[str, Annotated[list[EntryValue], Field(min_length=1, max_length=50)]],
        _by_key({"type": "array", "minItems": 1, "maxItems": 50, "items": _VALUE}),
    ] = Field(default={}, description='one "table.key" with its values')
    set: Annotated[dict[str, EntryValue], _by_key(_VALUE)] = Field(
        default={}, description='"table.key" = value for every part of the entry'
    )

    @field_validator("over", "set", mode="before")
    @classmethod
    def _flat(cls, given: Any) -> Any:
        """Keys as ``table.key``: TOML makes tables of dots that are not in quotes."""
        if not isinstance(given, dict):
            return given
        flat: dict[str, Any] = {}
        for key, value in given.items():
            flat |= {f"{key}.{inner}": v for inner, v in value.items()} if isinstance(value, dict) else {key: value}
        return flat

    @model_validator(mode="after")
    def _one_key_over(self) -> Entry:
        if len(self.over) > 1:
            raise ValueError(f"over varies {', '.join(self.over)}; it must vary one key, write more entries instead")
        for key, values in self.over.items():
            if key in self.set:
                raise ValueError(f"{key} is in set and in over; it must be in one of them")
            repeated = next((value for k, value in enumerate(values) if value in values[:k]), None)
            if repeated is not None:
                raise ValueError(f"over: {key}: {shown(repeated)} is there twice; raise copies instead")
        return self


class Tray(Table):
    """A whole tray file."""

    tray: TrayHead = TrayHead()
    entry: list[Entry] = Field(min_length=1, max_length=50, description="one [[entry]] a design")
