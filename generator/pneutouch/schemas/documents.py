"""Schemas of the documents that the program writes, each made from its record in `results`, or by a function."""

import ast
import dataclasses
import inspect
import itertools
import json
import sys
import textwrap
import types
import typing
from collections.abc import Callable, Mapping
from functools import partial
from importlib import import_module
from typing import Any, Literal, Union

from pneutouch.export.reader.render import SCHEMA
from pneutouch.formats import FORMATS, KEY, format_of
from pneutouch.results.behaviour import CalibratedBy
from pneutouch.results.plan import PlannedCampaign
from pneutouch.results.prediction import PredictionRecord
from pneutouch.results.selection import GradedRecord, ProcessesRecord, SelectionRecord, ShapesRecord
from pneutouch.schemas.pieces import (
    NUMBER,
    NUMBERS,
    TEXT,
    TEXTS,
    DocumentKind,
    Schema,
    any_of,
    choice,
    described_by,
    items,
    mapping,
    model_schema,
    or_null,
    record,
)
from pneutouch.spec.campaign import Rig
from pneutouch.spec.contact import SIZES, SOFTNESS, ContactTable
from pneutouch.spec.target import Target
from pneutouch.wording import data_of

_PLAIN: dict[Any, str] = {str: "string", float: "number", int: "integer", bool: "boolean"}


def _of_record(kind: type, instead: Mapping[str, Schema] | None = None) -> Schema:
    """The schema of a record, with the texts below its fields as descriptions of the keys.

    ``instead`` holds schemas, by ``Record.key``, for keys whose schema does not follow from the type of the field.
    """
    given = instead or {}
    hints = typing.get_type_hints(kind, vars(sys.modules[kind.__module__]))
    helps = {name: text for base in reversed(kind.__mro__) for name, text in _helps(base).items()}
    keys, optional = {}, []
    for field in dataclasses.fields(kind):
        hint, has_default = hints[field.name], field.default is not dataclasses.MISSING
        if has_default and field.default is None:
            left = tuple(each for each in typing.get_args(hint) if each is not types.NoneType)
            hint = Union[left]  # noqa: UP007
        made = given.get(f"{kind.__name__}.{field.name}") or _of_hint(hint, given)
        keys[field.name] = {**made, "description": helps[field.name]}
        optional += [field.name] if has_default else []
    help = " ".join((kind.__doc__ or "").replace("``", "`").split())
    return record(help, keys, optional=optional)


def _helps(kind: type) -> dict[str, str]:
    """The texts below the fields of a dataclass, by field; empty for another class."""
    if not dataclasses.is_dataclass(kind):
        return {}
    (tree,) = ast.parse(textwrap.dedent(inspect.getsource(kind))).body
    assert isinstance(tree, ast.ClassDef)
    texts = {}
    for one, below in itertools.pairwise(tree.body):
        if isinstance(one, ast.AnnAssign) and isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
            texts[ast.unparse(one.target)] = " ".join(str(below.value.value).split())
    return texts


def _of_hint(hint: Any, given: Mapping[str, Schema]) -> Schema:
    origin, inner = typing.get_origin(hint), typing.get_args(hint)
    if dataclasses.is_dataclass(hint):
        assert isinstance(hint, type)
        return _of_record(hint, given)
    if origin is tuple:
        if inner[-1] is Ellipsis:
            return items(_of_hint(inner[0], given))
        return {**items(_of_hint(inner[0], given)), "minItems": len(inner), "maxItems": len(inner)}
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return mapping(_of_hint(inner[1], given))
    if origin in (Union, types.UnionType):
        kinds = [_of_hint(each, given) for each in inner if each is not types.NoneType]
        one = kinds[0] if len(kinds) == 1 else any_of(*kinds)
        return or_null(one) if types.NoneType in inner else one
    if origin is Literal:
        return {"enum": list(inner)}
    if origin in (list, dict):
        return items(_of_hint(inner[0], given)) if origin is list else mapping(_of_hint(inner[1], given))
    return {"type": _PLAIN[hint]} if hint in _PLAIN else {}


def _made(name: str, path: str) -> Schema:
    """The schema of the document ``name``, from its record at a ``path`` in `results`, or by its function."""
    module, _, kind = path.partition(".")
    schema = _of_record(getattr(import_module(f"pneutouch.results.{module}"), kind)) if path else _MAKERS[name]()
    return _with_format(name, schema) if name in FORMATS else schema


def _with_format(name: str, schema: Schema) -> Schema:
    """The schema with the key that states the format in a file, in each of its forms if there are several."""
    if "anyOf" in schema:
        return {**schema, "anyOf": [_with_format(name, one) for one in schema["anyOf"]]}
    if KEY in schema["properties"]:
        return schema
    stated = {"const": format_of(name), "description": "Format of the file; not in the output of a command."}
    return {**schema, "properties": {KEY: stated, **schema["properties"]}}


def written_kinds() -> dict[str, DocumentKind]:
    """Every kind of document that the program writes, by name."""
    return {
        name: DocumentKind("JSON", title, where, partial(_made, name, path))
        for name, (path, title, where) in data_of(__file__)["documents"].items()
    }


_OF_SEARCH: dict[str, Schema] = {
    "notes": described_by("Notes in words.", TEXTS),
    "rounds": described_by("Rounds of the search.", NUMBER),
    "solves": described_by("Presses that the solid solved.", NUMBER),
}


def contact(notes: bool = False) -> Schema:
    """Schema of the object that presses, written if it is no frictionless plate; ``notes``: with notes on a search."""
    sizes = {key: NUMBER for keys in SIZES.values() for key in keys}
    corners = {"type": "array", "items": NUMBERS}
    more: dict[str, Schema] = _OF_SEARCH if notes else {}
    keys: dict[str, Schema] = {
        "object": choice(*SIZES),
        "label": described_by("In words.", TEXT),
        "plate_diameter_mm": NUMBER,
        "plate_rim_mm": NUMBER,
        **{**sizes, "profile_mm": corners},
        **dict.fromkeys(SOFTNESS, NUMBER),
        "friction": any_of(NUMBER, {"const": "inf"}),
        "offset_mm": NUMBER,
        "tilt_deg": NUMBER,
        "shear_mm": NUMBER,
        **more,
    }
    helped = {key: schema | _help(key) for key, schema in keys.items()}
    return record("What presses the sensor, where that is no frictionless plate.", helped, set(keys) - {"label"})


def _help(key: str) -> Schema:
    """The help of a key of the design file's table [contact], as a description; empty for another key."""
    field = ContactTable.model_fields.get(key)
    return {} if field is None else {"description": field.description}


def plan() -> Schema:
    """Schema of ``plan.json`` and of the output of ``pneutouch plan --json``."""
    rig = model_schema(Rig)["properties"]
    rig = {key: {k: v for k, v in field.items() if k != "default"} for key, field in rig.items()}
    instead = {
        "PlannedCampaign.contact": contact(),
        "PlannedCampaign.rig": record("The rig.", {**rig, "file": described_by("Path of the file.", or_null(TEXT))}),
    }
    return _of_record(PlannedCampaign, instead)


def exported_design() -> Schema:
    """Schema of the file that **Export** in the studio saves and **Open** reads."""
    value: Schema = {"type": ["string", "null"]}
    keys = {
        "version": described_by("Version of the program.", TEXT),
        "base": described_by("The design that gives everything else.", TEXT),
        "values": described_by("What differs from the base, by TABLE.KEY; null: taken out.", mapping(value)),
    }
    return record("A design that the studio exported.", keys)


def prediction() -> Schema:
    """Schema of the output of ``pneutouch predict --json``; ``prediction.json`` holds a part of it."""
    source = model_schema(CalibratedBy)["properties"]
    keys = {key: {k: v for k, v in field.items() if k != "default"} for key, field in source.items()}
    unknown = [key for key, field in CalibratedBy.model_fields.items() if field.default is None]
    keys |= {key: or_null(keys[key]) for key in unknown}
    calibration = record("The calibration that the prediction is of.", keys)
    instead = {"PredictionRecord.contact": contact(), "PredictionRecord.calibration": calibration}
    return _of_record(PredictionRecord, instead)


def reader() -> Schema:
    """Schema of ``reader.json``, read from the file that is shipped with the reader."""
    schema: Schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    return schema


def selection() -> Schema:
    """Schema of the output of ``pneutouch select --json``."""
    of_base = {"target": _target(), "contact": contact(notes=True)}
    kinds = ("SelectionRecord", "ProcessRecord", "GradedRecord")
    instead = {f"{kind}.{key}": schema for kind in kinds for key, schema in of_base.items()}
    made = [_of_record(kind, instead) for kind in (SelectionRecord, GradedRecord, ProcessesRecord, ShapesRecord)]
    return {"anyOf": [_saved(schema) for schema in made], "description": "Designs for a target."}


def _saved(schema: Schema) -> Schema:
    """The schema with a key for the design file that the command wrote."""
    written = described_by("The design file that was written; null: none.", or_null(TEXT))
    return {**schema, "properties": {**schema["properties"], "written": written}}


def _target() -> Schema:
    """Schema of a target with every key, null where it requires nothing."""
    tables = model_schema(Target)["$defs"]
    helps = {key: tables[field.annotation.__name__]["description"] for key, field in Target.model_fields.items()}  # type: ignore[union-attr]
    keys = {
        key: described_by(f"{help} Every key is there; null: free.", {"type": "object"}) for key, help in helps.items()
    }
    return record("The target, as a target file has it.", keys, optional=Target.left_out)


_MAKERS: dict[str, Callable[[], Schema]] = {
    "prediction": prediction,
    "plan": plan,
    "selection": selection,
    "reader": reader,
    "exported-design": exported_design,
}
"""Functions that make the schemas which do not follow from a record alone."""
