"""Schemas of the JSON documents that the program writes."""

from collections.abc import Callable
from functools import partial
from importlib import import_module

from pneutouch.schemas.kind import DocumentKind
from pneutouch.schemas.shape import Schema

VERSION = 1
"""Number of the form of every document; one that is changed so that older programs cannot read it gets the next."""

_DOCUMENTS = {
    "prediction": ("prediction.prediction", "A prediction", "`prediction.json` of `build`, `pneutouch predict --json`"),
    "manifest": ("folder.manifest", "A manifest", "`manifest.json` of every output folder"),
    "plan": ("campaign.plan", "A test plan", "`plan.json` of `plan`, `pneutouch plan --json`"),
    "figures": (
        "campaign.figures",
        "Measured figures",
        "`figures.json` of `characterize`, `pneutouch characterize --json`",
    ),
    "selection": ("selection.selection", "A selection", "`pneutouch select --json`"),
    "comparison": ("reports.comparison", "A comparison", "`comparison.json` of `compare`, `pneutouch compare --json`"),
    "calibration-report": ("reports.calibration_report", "A calibration's report", "`pneutouch calibrate --json`"),
    "reader": ("reader.reader", "A reader of force", "`reader.json` of `export-reader`"),
}


def _made(name: str, path: str) -> Schema:
    module, _, function = path.partition(".")
    make: Callable[[], Schema] = getattr(import_module(f"pneutouch.schemas.written.{module}"), function)
    return make() if name == "reader" else _with_format(name, make())


def _with_format(name: str, schema: Schema) -> Schema:
    """The same with the key that may state its format; of each form where there are several."""
    if "anyOf" in schema:
        return {**schema, "anyOf": [_with_format(name, one) for one in schema["anyOf"]]}
    stated = {"const": f"pneutouch/{name}/{VERSION}", "description": "Format of the document; older ones have none."}
    return {**schema, "properties": {"format": stated, **schema["properties"]}}


def written_kinds() -> dict[str, DocumentKind]:
    """Every document that is written, by name."""
    return {
        name: DocumentKind("JSON", title, where, partial(_made, name, path))
        for name, (path, title, where) in _DOCUMENTS.items()
    }
