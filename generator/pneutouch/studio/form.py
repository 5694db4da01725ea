"""The forms of the page, made from the declared fields of a design file and of a target."""

import datetime
import types
import typing
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from pydantic import BaseModel

from pneutouch.catalogue import Library
from pneutouch.catalogue.library import examples
from pneutouch.catalogue.listing import listing
from pneutouch.errors import PneutouchError
from pneutouch.spec.contact import SIZES
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import Declaration, declarations, table_of
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import assignments, read_toml
from pneutouch.spec.target import Target

_TWICE = ("contact.plate_diameter_mm",)
"""Fields that stand in two tables, and in the form once."""

_KIND_OF_MATERIAL = {"membrane.material": "elastomer", "connector.material": "rigid", "given.materials": "elastomer"}

Option = dict[str, str]


@dataclass(frozen=True, slots=True)
class FormField:
    """A field of a form, with the names to choose from."""

    name: str
    label: str
    unit: str
    low: float | None
    high: float | None
    default: str | float | None
    help: str
    kind: str
    optional: bool
    options: list[Option]


@dataclass(frozen=True, slots=True)
class FormGroup:
    """The fields of a table."""

    name: str
    fields: list[FormField]


@dataclass(frozen=True, slots=True)
class DesignForm:
    """The form of a design: fields, sizes by object, printers by material, and profiles that cast, which alone need a
    mould."""

    groups: list[FormGroup]
    sizes: dict[str, list[str]]
    printers: dict[str, list[str]]
    castings: list[str]


@dataclass(frozen=True, slots=True)
class TargetForm:
    """The form of a target, with an example as it sends it."""

    groups: list[FormGroup]
    example: dict[str, str]


def design_form(library: Library) -> DesignForm:
    """The form of a design file."""
    sizes = {str(kind): [f"contact.{key}" for key in keys] for kind, keys in SIZES.items()}
    castings = [name for name, one in library.all("printers", Printer).items() if one.is_casting]
    return DesignForm(_groups(DesignFile, library), sizes, _printers(library), castings)


def target_form(library: Library, bases: Mapping[str, str]) -> TargetForm:
    """The form of a target; its base is one of the designs that the page may open."""
    return TargetForm(_groups(Target, library, {"setting.base": designs_of(bases)}), _example_target())


def _example_target() -> dict[str, str]:
    """The target of the shipped examples by ``table.key``, as the form sends it."""
    example = next(each for each in examples().values() if each.kind == "target")
    tables = read_toml(example.path)
    content = {f"{table}.{key}": value for table, fields in tables.items() for key, value in fields.items()}
    pairs = (text.partition("=") for text in assignments(content))
    return {name: value for name, _, value in pairs}


def _printers(library: Library) -> dict[str, list[str]]:
    """The printers that run each material, by its name."""
    printers = library.all("printers", Printer)
    materials = library.all("materials", Material)
    return {
        name: [printer for printer, one in printers.items() if one.mode_for(material)]
        for name, material in materials.items()
    }


def designs_of(bases: Mapping[str, str]) -> list[Option]:
    """The designs that can be opened, with their titles and their names in commands."""
    titles = {entry["name"]: entry["title"] for entry in listing("designs")["designs"] if "error" not in entry}
    known = Library.default().paths("designs")
    return [
        {"name": name, "title": titles.get(name, ""), "words": name if name in known else given}
        for name, given in bases.items()
    ]


def _groups(
    file: type[BaseModel], library: Library, options: Mapping[str, list[Option]] = MappingProxyType({})
) -> list[FormGroup]:
    """The tables of a file with their fields; ``options`` are the names to choose from that the page gives."""
    groups = []
    for name in file.model_fields:
        model = table_of(file, name)
        if model is not None:
            fields = [_field(name, model, each, library, options) for each in declarations(model)]
            groups.append(FormGroup(name, [field for field in fields if field.name not in _TWICE]))
    return groups


def _field(
    table: str, model: type[BaseModel], declared: Declaration, library: Library, options: Mapping[str, list[Option]]
) -> FormField:
    name = f"{table}.{declared.key}"
    kinds = _kinds(model.model_fields[declared.key].annotation)
    return FormField(
        name=name,
        label=_label(declared),
        unit=declared.unit,
        low=declared.low,
        high=declared.high,
        default=declared.default if isinstance(declared.default, str | float | int) else None,
        help=declared.help,
        kind=_kind(kinds, declared),
        optional=types.NoneType in kinds,
        options=options[name] if name in options else _options(name, kinds, declared, library),
    )


def _label(declared: Declaration) -> str:
    """The key in words, without its unit, which stands next to it."""
    unit = declared.unit.replace("/", "_per_").replace("%", "percent")
    words = declared.key.removesuffix(f"_{unit}").replace("_", " ")
    return words[:1].upper() + words[1:]


def _kinds(annotation: Any) -> list[Any]:
    """The types that an annotation is made of, outermost first."""
    kinds = [annotation]
    for kind in kinds:
        kinds += [each for each in typing.get_args(kind) if isinstance(each, type) or typing.get_origin(each)]
    return kinds


def _kind(kinds: list[Any], declared: Declaration) -> str:
    """number, whole, numbers, flag, choice, names, texts, date or text: how the page shows a field."""
    if list[str] in kinds:
        return "names" if declared.registry else "texts"
    if any(
        typing.get_origin(kind) is list and typing.get_origin(*typing.get_args(kind)) is typing.Literal
        for kind in kinds
    ):
        return "names"
    if declared.registry or declared.one_of or any(typing.get_origin(kind) is typing.Literal for kind in kinds):
        return "choice"
    if bool in kinds:
        return "flag"
    if any(typing.get_origin(kind) is list for kind in kinds):
        return "numbers"
    kind = {int: "whole", float: "number", datetime.date: "date"}
    return next((name for type_, name in kind.items() if type_ in kinds), "text")


def _options(name: str, kinds: list[Any], declared: Declaration, library: Library) -> list[Option]:
    for kind in kinds:
        if typing.get_origin(kind) is typing.Literal:
            return [{"name": str(each), "title": ""} for each in typing.get_args(kind)]
    if declared.registry is None:
        return [{"name": each, "title": ""} for each in (declared.one_of.names() if declared.one_of else ())]
    if declared.registry == "materials":
        return _materials(_KIND_OF_MATERIAL.get(name), library)
    registry = declared.registry
    return [{"name": each, "title": _title(registry, each, library)} for each in library.paths(registry)]


def _materials(kind: str | None, library: Library) -> list[Option]:
    known = library.all("materials", Material)
    titles = {name: f"{one.label}, cast" if one.is_cast else one.label for name, one in known.items()}
    return [{"name": name, "title": titles[name]} for name, one in known.items() if kind in (None, one.kind)]


def _title(registry: str, name: str, library: Library) -> str:
    """The title of a part; none where its file cannot be read, which the field then reports when it is chosen."""
    try:
        return str(getattr(library.load(registry, name), "title", ""))
    except PneutouchError:
        return ""
