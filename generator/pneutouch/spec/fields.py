"""Declarations of parameters, each once, with unit, bounds, default and help; and the base of every TOML table.

Command line, commented design file, datasheet's table and error messages all read the declaration.
"""

import types
import typing
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, JsonValue, SerializerFunctionWrapHandler, model_serializer
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, PydanticCustomError
from pydantic_core.core_schema import no_info_after_validator_function


class Table(BaseModel):
    """Base of every TOML table: no unknown keys, no silent conversions, no infinities, immutable."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False, defer_build=True)


class SparseTable(Table):
    """A table whose dumps omit keys of ``left_out`` at their default: their hash does not depend on unused keys."""

    left_out: ClassVar[tuple[str, ...]] = ()

    @model_serializer(mode="wrap")
    def _without_defaults(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        fields = type(self).model_fields
        usual = {key for key in self.left_out if getattr(self, key) == fields[key].get_default()}
        return {key: value for key, value in handler(self).items() if key not in usual}


@dataclass(frozen=True, slots=True)
class OneOf:
    """Annotation of a text that must be one of the names that ``names()`` returns when it is checked."""

    names: Callable[[], Iterable[str]]

    def __get_pydantic_core_schema__(self, source: Any, handler: Callable[[Any], CoreSchema]) -> CoreSchema:
        """Core schema that refuses any other text, with the error that pydantic gives for a Literal."""
        return no_info_after_validator_function(self._checked, handler(source))

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: Any) -> dict[str, Any]:
        """JSON schema with the names as its ``enum``."""
        return {**handler(core), "enum": list(self.names())}

    def _checked(self, value: str) -> str:
        known = [f"'{name}'" for name in self.names()]
        if f"'{value}'" not in known:
            raise PydanticCustomError("literal_error", "not one of {expected}", {"expected": " or ".join(known)})
        return value


@dataclass(frozen=True, slots=True)
class Declaration:
    """Declaration of the field ``key``. ``low``, ``high``: None without bounds; ``registry``: None if it is no name."""

    key: str
    unit: str
    low: float | None
    high: float | None
    default: Any
    help: str
    registry: str | None
    one_of: OneOf | None = None

    @property
    def right(self) -> str:
        """Description of a valid value: ``from 1 to 100 mm``, ``one of the materials``, else the help."""
        if self.low is not None:
            unit = f" {self.unit}" if self.unit else ""
            return f"from {self.low:g} to {self.high:g}{unit}"
        return f"one of the {self.registry}" if self.registry else self.help


class FieldsError(ValueError):
    """Error on fields of a table; ``fields`` holds their keys, as ``table.key`` if the table is a whole file."""

    def __init__(self, problem: str, *fields: str) -> None:
        super().__init__(problem)
        self.fields = fields


class EntryError(ValueError):
    """Error on one entry of a list, with its ``index`` from 0 and its ``value``."""

    def __init__(self, problem: str, index: int, value: Any) -> None:
        super().__init__(problem)
        self.index, self.value = index, value


def list_check(
    low: float, high: float, unit: str, *, once: bool = True, ends: bool = True
) -> Callable[[list[Any]], list[Any]]:
    """Check of a list: numbers from ``low`` to ``high``, ``ends`` included or not; no entry twice if ``once``."""

    def check(values: list[Any]) -> list[Any]:
        for index, value in enumerate(values):
            if not isinstance(value, str) and not (low <= value <= high if ends else low < value < high):
                raise EntryError(f"must be from {low:g} to {high:g} {unit}".rstrip(), index, value)
            if once and value in values[:index]:
                raise EntryError("every entry may appear once only", index, value)
        return values

    return check


def number(default: float | None, *, unit: str, low: float, high: float, help: str) -> Any:
    """Declare a number in ``unit``, from ``low`` to ``high`` inclusive; a default of None makes it optional."""
    extra: dict[str, JsonValue] = {"unit": unit, "low": low, "high": high}
    return Field(default=default, ge=low, le=high, description=help, json_schema_extra=extra)


def numbers(default: list[float] | None, *, unit: str, low: float, high: float, help: str) -> Any:
    """Declare a list of 1 to 50 numbers; the bounds are declared only, a validator of the field must enforce them."""
    extra: dict[str, JsonValue] = {"unit": unit, "low": low, "high": high}
    return Field(
        default=default, min_length=1, max_length=50, description=help, json_schema_extra=extra, validate_default=True
    )


def name(default: str | None, *, registry: str, help: str) -> Any:
    """Declare a name that the catalogue resolves in ``registry`` (materials, printers, ports ...)."""
    return Field(default=default, min_length=1, description=help, json_schema_extra={"registry": registry})


def declaration(model: type[BaseModel], key: str) -> Declaration:
    """Return the declaration of ``key`` in ``model``."""
    info: FieldInfo = model.model_fields[key]
    extra = extra_of(model, key)

    def entry(word: str) -> Any:
        return extra.get(word)

    return Declaration(
        key=key,
        unit=str(entry("unit") or ""),
        low=entry("low"),
        high=entry("high"),
        default=info.get_default(call_default_factory=True),
        help=info.description or "",
        registry=entry("registry"),
        one_of=next((known for known in info.metadata if isinstance(known, OneOf)), None),
    )


def extra_of(model: type[BaseModel], key: str) -> Mapping[str, Any]:
    """Entries of a field's declaration beyond pydantic's own, such as unit and bounds; empty without any."""
    extra = model.model_fields[key].json_schema_extra
    return extra if isinstance(extra, dict) else {}


def declarations(model: type[BaseModel]) -> list[Declaration]:
    """Return the declarations of a table in the order they were written."""
    return [declaration(model, key) for key in model.model_fields]


def table_of(model: type[BaseModel], key: str) -> type[BaseModel] | None:
    """Model of the table ``key``, or of the tables in the list ``key``; None for a plain value or an unknown key."""
    info = model.model_fields.get(key)
    if info is None:
        return None
    kinds: list[Any] = [info.annotation]
    for kind in kinds:
        # Optional, union and annotated types hold the model one or two levels down.
        kinds += typing.get_args(kind) if not isinstance(kind, type) else ()
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            return kind
    return None


def entries_of(model: type[BaseModel], key: str, within: int = 0) -> str | None:
    """Kind of the entries of the list ``key``: numbers, names, texts, tables or lists; None if it is no list, or mixed.

    ``within`` is the depth of the list that is meant: 0 for ``key`` itself, 1 for a list inside it.
    """
    held = _kinds(model.model_fields[key].annotation)
    for _ in range(within + 1):
        lists = [kind for kind in held if typing.get_origin(kind) is list]
        if not lists:
            return None
        held = _kinds(typing.get_args(lists[0])[0])
    if all(kind in (float, int) for kind in held):
        return "numbers"
    if all(kind is str for kind in held):
        return "names" if declaration(model, key).registry else "texts"
    if all(isinstance(kind, type) and issubclass(kind, BaseModel) for kind in held):
        return "tables"
    return "lists" if all(typing.get_origin(kind) is list for kind in held) else None


def _kinds(annotation: Any) -> list[Any]:
    """Types that an annotation allows, without None and bounds; for a Literal the types of its words."""
    origin, parts = typing.get_origin(annotation), typing.get_args(annotation)
    if origin is typing.Annotated:
        return _kinds(parts[0])
    if origin is typing.Literal:
        return [*dict.fromkeys(type(word) for word in parts)]
    if origin in (typing.Union, types.UnionType):
        return [kind for part in parts for kind in _kinds(part) if kind is not types.NoneType]
    return [annotation]


MaterialKind = Literal["elastomer", "rigid"]


def is_one_of_list(table: type[BaseModel], key: str, value: Any) -> bool:
    """True if a value is a number or a text, and ``key`` a list of these for which one entry is enough."""
    if any(getattr(bound, "min_length", 0) > 1 for bound in table.model_fields[key].metadata):
        return False
    if isinstance(value, str):
        return entries_of(table, key) in ("names", "texts")
    return isinstance(value, float | int) and not isinstance(value, bool) and entries_of(table, key) == "numbers"
