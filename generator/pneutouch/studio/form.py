"""Forms of the page, built from declared fields, and questions: a design with changes, which can be saved."""

import datetime
import json
import os
import types
import typing
from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from types import MappingProxyType
from typing import Any

from pydantic import BaseModel
from starlette.requests import Request

from pneutouch.catalogue import KINDS, DesignSource, Library, user_folder
from pneutouch.catalogue.library import CachedLibrary, examples
from pneutouch.catalogue.listing import listing
from pneutouch.errors import InputError, PneutouchError
from pneutouch.output.new import check_free, new_changed, write_design
from pneutouch.shape import SHAPES, sizes_of, starting_sizes
from pneutouch.spec.contact import SIZES
from pneutouch.spec.design import DesignFile
from pneutouch.spec.fields import Declaration, declarations, table_of
from pneutouch.spec.files import read_bytes
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.spec.read import override, parse_changes, read_toml
from pneutouch.spec.target import Target
from pneutouch.spec.toml_text import assignments, flat
from pneutouch.spec.values import plain_name
from pneutouch.studio.guard import ChangedFileError

_TWICE = ("contact.plate_diameter_mm",)
"""Fields that the form leaves out, for another table has the same."""

_KIND_OF_MATERIAL = {"membrane.material": "elastomer", "connector.material": "rigid", "given.materials": "elastomer"}

Option = dict[str, str]


@dataclass(frozen=True, slots=True)
class FormField:
    """A field of a form: its label, bounds, default, kind (see `_kind`), and the names to choose from."""

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
    """A table of a form, with its fields."""

    name: str
    fields: list[FormField]


@dataclass(frozen=True, slots=True)
class DesignForm:
    """The form of a design: its fields, the size fields of each pressing object, those of each shape with the share of
    R0 that they begin with, the printers that run each material, and the printers that cast, which need a mould."""

    groups: list[FormGroup]
    sizes: dict[str, list[str]]
    shapes: dict[str, dict[str, Any]]
    printers: dict[str, list[str]]
    castings: list[str]


@dataclass(frozen=True, slots=True)
class TargetForm:
    """The form of a target, with an example as the form would send it."""

    groups: list[FormGroup]
    example: dict[str, str]


def design_form(library: Library) -> DesignForm:
    """The form of a design file."""
    sizes = {str(kind): [f"contact.{key}" for key in keys] for kind, keys in SIZES.items()}
    castings = [name for name, one in library.all("printers", Printer).items() if one.is_casting]
    return DesignForm(_groups(DesignFile, library), sizes, _shapes(), _printers(library), castings)


def _shapes() -> dict[str, dict[str, Any]]:
    """Size fields of every shape, with what they begin with for an inner radius of 1 mm; None: left out at first."""
    return {
        shape: {f"membrane.{key}": starting_sizes(shape, 1.0, digits=6).get(key) for key in sizes_of(shape)}
        for shape in SHAPES
    }


def target_form(library: Library, bases: Mapping[str, str]) -> TargetForm:
    """The form of a target; its base is one of the designs that the page may open."""
    return TargetForm(_groups(Target, library, {"setting.base": designs_of(bases)}), _example_target())


def _example_target() -> dict[str, str]:
    """The first shipped target as texts by ``table.key``, as the form sends it."""
    tables = read_toml(next(each for each in examples().values() if each.kind == "target").path)
    pairs = (text.partition("=") for text in assignments(flat(tables)))
    return {name: value for name, _, value in pairs}


def _printers(library: Library) -> dict[str, list[str]]:
    """Names of the printers that run each material, by the material's name."""
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
    """The tables of a file with their fields; ``options``: choices by ``table.key`` that replace the declared ones."""
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


_LABELS = {"max_diameter_mm": "max dome diameter", "max_footprint_mm": "max whole diameter"}
"""Words for keys that leave open which diameter they bound."""


def _label(declared: Declaration) -> str:
    """Label of a field: its key in words, without the unit, which is shown next to it."""
    unit = declared.unit.replace("/", "_per_").replace("%", "percent")
    words = _LABELS.get(declared.key) or declared.key.removesuffix(f"_{unit}").replace("_", " ")
    return words[:1].upper() + words[1:]


def _kinds(annotation: Any) -> list[Any]:
    """The types that an annotation is made of, outermost first."""
    kinds = [annotation]
    for kind in kinds:
        kinds += [each for each in typing.get_args(kind) if isinstance(each, type) or typing.get_origin(each)]
    return kinds


def _kind(kinds: list[Any], declared: Declaration) -> str:
    """Kind of a field for the page: number, whole, numbers, flag, choice, names, texts, date or text."""
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
    """Title of a part; empty if its file cannot be read: the error appears when the part is chosen."""
    try:
        return str(getattr(library.load(registry, name), "title", ""))
    except PneutouchError:
        return ""


PAGE = "the page"
"""Name in place of a file's, for values that come from the page."""

_MOST_FIELDS = 200
_LONGEST_TEXT = 4000


@dataclass(frozen=True)
class Question:
    """A design as the page sends it: a ``base``, by the page's name for it, with changed fields.

    ``values`` holds by ``table.key`` the text of a change ``table.key=text``, or None if the key is left out. They
    apply to one ``version`` of the base's file (`version_of`); None accepts any version.
    """

    base: str
    values: Mapping[str, str | None]
    version: str | None = None

    @classmethod
    def of(cls, content: Any) -> "Question":
        """The question in a JSON document of the page. Raises InputError if there is none."""
        if not isinstance(content, dict) or {*content, "version"} != {"base", "values", "version"}:
            raise InputError("a question is an object with the keys base and values")
        base, values, version = content["base"], content["values"], content.get("version")
        if not isinstance(base, str) or not isinstance(values, dict) or not isinstance(version, str | None):
            raise InputError("base is a text and values is an object")
        if len(values) > _MOST_FIELDS:
            raise InputError(f"values has {len(values)} fields; at most {_MOST_FIELDS} are taken")
        for key, value in values.items():
            if value is not None and not isinstance(value, str):
                raise InputError("each value is a text, or null where the key is left out", key=key)
            if value is not None and len(value) > _LONGEST_TEXT:
                raise InputError(f"the text is longer than {_LONGEST_TEXT} characters", key=key)
        return cls(base, values, version)

    def source(self, bases: Mapping[str, str], library: Library) -> DesignSource:
        """The design as a source; ``bases`` holds the name or path of a design by the page's name for it.

        Raises InputError naming key and value, and ChangedFileError.
        """
        return self.read(bases, library)[0]

    def read(self, bases: Mapping[str, str], library: Library) -> tuple[DesignSource, str]:
        """The design as `source` returns it, and the version of its base's file that was read."""
        if self.base not in bases:
            raise InputError("unknown design", key="base", value=self.base)
        base = DesignSource.of(bases[self.base], library)
        version = version_of(base)
        if self.version not in (None, version):
            remedy = "Reset takes the values that it has now"
            raise ChangedFileError(f"the file of {self.base} was changed since this page read it", remedy=remedy)
        content = {key: dict(value) if isinstance(value, dict) else value for key, value in base.content.items()}
        for name in (name for name, text in self.values.items() if text is None):
            _leave_out(content, name)
        given = [f"{name}={text}" for name, text in self.values.items() if text is not None]
        return DesignSource(base.name, override(content, parse_changes(given), DesignFile), PAGE), version


def version_of(base: DesignSource) -> str:
    """The version of a design's file: a digest of its values, whatever their order and the comments beside them."""
    return sha256(json.dumps(base.content, sort_keys=True, default=str).encode()).hexdigest()


def _leave_out(content: dict[str, Any], name: str) -> None:
    """Remove ``table.key`` or a whole table from the content, if it is there."""
    table, _, key = name.partition(".")
    tables = content.get(table)
    if not key:
        content.pop(table, None)
    elif isinstance(tables, dict):
        tables.pop(key, None)


_WRITTEN = ("designs", "calibrations", "pads")


class PageLibrary(CachedLibrary):
    """A cached library that looks for designs, calibrations and pads anew each time: they are written meanwhile."""

    def paths(self, kind: str) -> dict[str, Path]:
        """Names of one kind with their files, sorted by name."""
        return Library.paths(self, kind) if kind in _WRITTEN else super().paths(kind)

    def load(self, kind: str, name: str, *, file: str | None = None, key: str | None = None) -> Any:
        """Load one thing by name; raises InputError as a library does."""
        if kind in _WRITTEN:
            return Library.load(self, kind, name, file=file, key=key)
        return super().load(kind, name, file=file, key=key)


async def json_body(request: Request, what: str) -> Any:
    """The JSON document of a request. Raises InputError, which calls it ``what``, if the body is not JSON."""
    try:
        content = json.loads(await request.body())
        # JSON can escape halves of surrogate pairs; such a text has no bytes, so that no answer could repeat it.
        json.dumps(content, ensure_ascii=False).encode()
    except (ValueError, RecursionError):
        raise InputError(f"the {what} is not JSON") from None
    return content


_ENDING = ".toml"
_KEYS = {"question", "name", "replace"}


class NameTakenError(InputError):
    """Error for the name of a file that exists and is not to be replaced."""


def save_design(request: Mapping[str, Any], bases: dict[str, str]) -> dict[str, str]:
    """Write the design of ``question`` as ``name`` into the folder of the user's designs, and add it to ``bases``.

    An existing file is replaced only with ``replace``. A design without changes is copied with its comments. Returns
    its name and file. Raises NameTakenError if it is not to be replaced, ChangedFileError, and InputError that names
    the key."""
    name, overwrite = _checked(request)
    question, library = Question.of(request.get("question")), Library.default()
    folder = user_folder() / KINDS["designs"].folder
    path = folder / f"{name}{_ENDING}"
    _check_open(name, path, bases, library)
    source = question.source(bases, library)
    source.changed({})
    if not overwrite and os.path.lexists(path):
        raise NameTakenError(
            "there is such a file already", file=path, key="name", remedy="give another name, or replace it"
        )
    check_free(name, folder, overwrite=overwrite)
    if question.values:
        new_changed(source, name, folder, overwrite=overwrite)
    else:
        original = library.design_file(bases[question.base])
        write_design(name, folder, read_bytes(original).decode("utf-8-sig"), overwrite=overwrite)
    bases[name] = str(path.resolve())
    return {"name": name, "file": str(path)}


def _checked(request: Mapping[str, Any]) -> tuple[str, bool]:
    """Name of the design, and True if an existing file is to be replaced. Raises InputError."""
    if not request.keys() <= {*_KEYS, "uploads"}:
        raise InputError(f"a design to be saved has the keys {', '.join(sorted(_KEYS))}")
    name, overwrite = request.get("name"), request.get("replace", False)
    if not isinstance(name, str) or not isinstance(overwrite, bool):
        raise InputError("name is a text and replace is true or false")
    return plain_name(name.strip().removesuffix(_ENDING), key="name"), overwrite


def _check_open(name: str, path: Path, bases: Mapping[str, str], library: Library) -> None:
    """Raise InputError if a design of this name is open on the page from another file: two would share it."""
    if name not in bases or not Path(bases[name]).is_file():
        return
    if Path(bases[name]).resolve() != path.resolve():
        problem = f"{bases[name]} is open by this name"
        raise InputError(problem, key="name", value=name, remedy="give another name")
