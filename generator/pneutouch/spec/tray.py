"""A tray file, with the grammar of ``table.key=VALUES``: values with commas between, or a range ``from:to:count``."""

from collections.abc import Sequence
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema, field_validator, model_validator

from pneutouch.errors import InputError, shown
from pneutouch.spec.design import Printable
from pneutouch.spec.fields import Table, name, number
from pneutouch.spec.read import toml_value
from pneutouch.spec.values import is_finite

LEAST_COPIES, MOST_COPIES = 1, 200


def _by_key(value: dict[str, Any]) -> WithJsonSchema:
    """JSON schema of values by ``table.key``, or of tables of keys, which TOML makes of dots outside quotes."""
    either = {"anyOf": [value, {"type": "object", "additionalProperties": value}]}
    return WithJsonSchema({"type": "object", "additionalProperties": either})


def _setting(given: Any) -> Any:
    """Return a valid value, else raise one ValueError, in place of an error for each type of the union."""
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
    profile: str | None = name(
        None, registry="printers", help="Printer; left out: the printer of the first entry's membrane."
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
        """Entries with keys ``table.key`` in place of the tables that TOML makes of dots outside quotes."""
        if not isinstance(given, dict):
            return given
        flat: dict[str, Any] = {}
        for key, value in given.items():
            flat |= {f"{key}.{inner}": v for inner, v in value.items()} if isinstance(value, dict) else {key: value}
        return flat

    @model_validator(mode="after")
    def _one_key_over(self) -> "Entry":
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


MAX_VALUES = 10_000

_OPENING = ("[", "{", "'", '"')


def parse_over(texts: Sequence[str]) -> dict[str, list[Any]]:
    """Values by key from texts ``table.key=VALUES``. Raises InputError for other texts and for a repeated key."""
    varied: dict[str, list[Any]] = {}
    for text in texts:
        key, equals, values = (part.strip() for part in text.partition("="))
        if not equals or not values:
            example = "membrane.material=TangoPlus,FLX9940 or membrane.wall_thickness_mm=1:2:5"
            raise InputError(f"write table.key=VALUES, such as {example}", key="over", value=text)
        if key in varied:
            raise InputError(f"{key} is given twice", key="over", value=text)
        varied[key] = _values(key, values, text)
    return varied


def spread(where: str, key: str, start: Any, stop: Any, count: Any) -> list[float | int]:
    """``count`` even values from ``start`` to ``stop``, whole numbers if ends and values are. Raises InputError."""
    shown = f"from {start} to {stop} count {count}"
    ends = (start, stop)
    if not all(map(is_finite, ends)):
        raise InputError(f"{shown}: the ends must be finite numbers", file=where, key=key)
    if isinstance(count, bool) or not isinstance(count, int) or not 2 <= count <= MAX_VALUES:
        raise InputError(f"{shown}: the count must be a whole number from 2 to {MAX_VALUES}", file=where, key=key)
    # Twelve digits: the values are read and selected by people, and 1.1 must be 1.1.
    inner = [float(f"{start + (stop - start) * (k / (count - 1)):.12g}") for k in range(1, count - 1)]
    values: list[float | int] = [start, *inner, stop]
    if isinstance(start, int) and isinstance(stop, int) and all(float(v).is_integer() for v in values):
        return [int(v) for v in values]
    return [float(v) for v in values]


def _values(key: str, text: str, given: str) -> list[Any]:
    """Values of a range ``from:to:count``, or TOML values and bare words between commas outside brackets and quotes."""
    parts = [] if text.startswith(_OPENING) else text.split(":")
    if len(parts) == 3:
        return spread("over", key, *(toml_value(part.strip()) for part in parts))
    if len(parts) == 2:
        raise InputError("a range is written from:to:count, such as 1:2:5", key="over", value=given)
    pieces = text.removesuffix(",").split(",")
    values = []
    while pieces:
        word = pieces.pop(0).strip()
        if word.startswith(_OPENING):
            while toml_value(word) is word and pieces:
                word = f"{word},{pieces.pop(0)}".rstrip()
            if toml_value(word) is word:
                remedy = "write lists as [1, 2] and texts as 'A, B'"
                raise InputError(f"{word} is not closed, or not TOML", key="over", value=given, remedy=remedy)
        values.append(toml_value(word))
    return values
