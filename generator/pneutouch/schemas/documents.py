"""Schemas of the documents that the program writes: each from its record, with tables that are declared elsewhere."""

import json
from collections.abc import Callable
from functools import partial

from pneutouch.export.reader.render import SCHEMA
from pneutouch.formats import FORMATS, KEY, format_of
from pneutouch.results.behaviour import CalibratedBy
from pneutouch.results.calibration import OutcomeRecord
from pneutouch.results.comparison import ComparisonRecord
from pneutouch.results.fit import MaterialFit
from pneutouch.results.folder import Manifest
from pneutouch.results.measured import MeasuredCampaign
from pneutouch.results.plan import PlannedCampaign
from pneutouch.results.prediction import PredictionRecord
from pneutouch.results.response import LoadResponse
from pneutouch.results.scan import ScanRecord
from pneutouch.results.selection import GradedRecord, ProcessesRecord, SelectionRecord
from pneutouch.results.simulation import CampaignTruth
from pneutouch.results.specimen import SpecimenRecord
from pneutouch.results.stack import StackRecord
from pneutouch.schemas.models import model_schema
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
    mapping,
    or_null,
    record,
)
from pneutouch.schemas.record_schema import of_record
from pneutouch.spec.campaign import Rig
from pneutouch.spec.contact import SIZES, ContactTable
from pneutouch.spec.target import Target


def _made(name: str, source: type | Callable[[], Schema]) -> Schema:
    """The schema of a document, from its record or by the function that makes it."""
    schema = of_record(source) if isinstance(source, type) else source()
    return _with_format(name, schema) if name in FORMATS else schema


def _with_format(name: str, schema: Schema) -> Schema:
    """The schema with the key that states the format in a file; in each form if there are several."""
    if "anyOf" in schema:
        return {**schema, "anyOf": [_with_format(name, one) for one in schema["anyOf"]]}
    if KEY in schema["properties"]:
        return schema
    stated = {"const": format_of(name), "description": "Format of the file; not in the output of a command."}
    return {**schema, "properties": {KEY: stated, **schema["properties"]}}


def written_kinds() -> dict[str, DocumentKind]:
    """Every document that is written, by name."""
    return {
        name: DocumentKind("JSON", title, where, partial(_made, name, source))
        for name, (source, title, where) in _DOCUMENTS.items()
    }


_OF_SEARCH: dict[str, Schema] = {
    "notes": described_by("Notes in words.", TEXTS),
    "rounds": described_by("Rounds of the search.", NUMBER),
    "solves": described_by("Presses that the solid solved.", NUMBER),
}


def contact(notes: bool = False) -> Schema:
    """Schema of the pressing object, given if that is no frictionless plate."""
    sizes = {key: NUMBER for keys in SIZES.values() for key in keys}
    corners = {"type": "array", "items": NUMBERS}
    more: dict[str, Schema] = _OF_SEARCH if notes else {}
    keys: dict[str, Schema] = {
        "object": choice(*SIZES),
        "label": described_by("In words.", TEXT),
        "plate_diameter_mm": NUMBER,
        "plate_rim_mm": NUMBER,
        **{**sizes, "profile_mm": corners},
        "friction": any_of(NUMBER, {"const": "inf"}),
        "offset_mm": NUMBER,
        "tilt_deg": NUMBER,
        "shear_mm": NUMBER,
        **more,
    }
    helped = {key: schema | _help(key) for key, schema in keys.items()}
    return record("What presses the sensor, where that is no frictionless plate.", helped, set(keys) - {"label"})


def _help(key: str) -> Schema:
    """The help of the design file's key."""
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
    return of_record(PlannedCampaign, instead)


def exported_design() -> Schema:
    """Schema of the file that **Export** on the page saves and **Open** reads."""
    value: Schema = {"type": ["string", "null"]}
    keys = {
        "version": described_by("Version of the program.", TEXT),
        "base": described_by("The design that gives everything else.", TEXT),
        "values": described_by("What differs from the base, by TABLE.KEY; null: taken out.", mapping(value)),
    }
    return record("A design that the studio exported.", keys)


def prediction() -> Schema:
    """Schema of the output of ``pneutouch predict --json``, part of which ``prediction.json`` holds."""
    source = model_schema(CalibratedBy)["properties"]
    keys = {key: {k: v for k, v in field.items() if k != "default"} for key, field in source.items()}
    unknown = [key for key, field in CalibratedBy.model_fields.items() if field.default is None]
    keys |= {key: or_null(keys[key]) for key in unknown}
    calibration = record("The calibration that the prediction is of.", keys)
    instead = {"PredictionRecord.contact": contact(), "PredictionRecord.calibration": calibration}
    return of_record(PredictionRecord, instead)


def reader() -> Schema:
    """Schema of ``reader.json``."""
    schema: Schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    return schema


def selection() -> Schema:
    """Schema of the output of ``pneutouch select --json``."""
    of_base = {"target": _target(), "contact": contact(notes=True)}
    kinds = ("SelectionRecord", "ProcessRecord", "GradedRecord")
    instead = {f"{kind}.{key}": schema for kind in kinds for key, schema in of_base.items()}
    made = [of_record(kind, instead) for kind in (SelectionRecord, GradedRecord, ProcessesRecord)]
    return {"anyOf": [_saved(schema) for schema in made], "description": "Designs for a target."}


def _saved(schema: Schema) -> Schema:
    """The schema with the file that the command wrote."""
    written = described_by("The design file that was written; null: none.", or_null(TEXT))
    return {**schema, "properties": {**schema["properties"], "written": written}}


def _target() -> Schema:
    """The target with every key, null where it requires nothing."""
    tables = model_schema(Target)["$defs"]
    helps = {key: tables[field.annotation.__name__]["description"] for key, field in Target.model_fields.items()}  # type: ignore[union-attr]
    keys = {
        key: described_by(f"{help} Every key is there; null: free.", {"type": "object"}) for key, help in helps.items()
    }
    return record("The target, as a target file has it.", keys)


_DOCUMENTS: dict[str, tuple[type | Callable[[], Schema], str, str]] = {
    "prediction": (prediction, "A prediction", "`prediction.json` of `build`, `pneutouch predict --json`"),
    "manifest": (Manifest, "A manifest", "`manifest.json` of every output folder"),
    "plan": (plan, "A test plan", "`plan.json` of `plan`, `pneutouch plan --json`"),
    "figures": (
        MeasuredCampaign,
        "Measured figures",
        "`figures.json` of `characterize`, `pneutouch characterize --json`",
    ),
    "selection": (selection, "A selection", "`pneutouch select --json`"),
    "comparison": (ComparisonRecord, "A comparison", "`comparison.json` of `compare`, `pneutouch compare --json`"),
    "calibration-report": (OutcomeRecord, "A calibration's report", "`pneutouch calibrate --json`"),
    "reader": (reader, "A reader of force", "`reader.json` of `export-reader`"),
    "fit": (MaterialFit, "A fitted material law", "`fit.json` of `fit-material`, `pneutouch fit-material --json`"),
    "response": (LoadResponse, "A simulated signal", "`response.json` of `respond`, `pneutouch respond --json`"),
    "scan": (ScanRecord, "A scan of a specimen", "`scan.json` of `scan`, `pneutouch scan --json`"),
    "truth": (CampaignTruth, "Truth of a simulated campaign", "`truth.json` of `simulate`"),
    "specimen-report": (SpecimenRecord, "A built texture specimen", "`specimen.json` of `build`"),
    "stack": (StackRecord, "A voxel stack", "`stack.json` of every stack for voxel printing"),
    "exported-design": (exported_design, "A design exported from the studio", "saved by `Export` in the studio"),
}
