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


def _made(path: str) -> Schema:
    module, _, function = path.partition(".")
    make: Callable[[], Schema] = getattr(import_module(f"pneutouch.schemas.written.{module}"), function)
    return make()


def written_kinds() -> dict[str, DocumentKind]:
    """Every document that is written, by name."""
    return {
        name: DocumentKind("JSON", title, where, partial(_made, path))
        for name, (path, title, where) in _DOCUMENTS.items()
    }
