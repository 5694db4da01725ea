"""Documents that tests produce, held against their schemas."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator

PRINTED = {
    "predict": "prediction",
    "plan": "plan",
    "characterize": "figures",
    "select": "selection",
    "compare": "comparison",
    "calibrate": "calibration-report",
    "fit-material": "fit",
    "respond": "response",
    "scan": "scan",
}
"""Names of schemas by the command that prints such a document."""

WRITTEN = {
    "prediction.json": "prediction",
    "manifest.json": "manifest",
    "plan.json": "plan",
    "figures.json": "figures",
    "comparison.json": "comparison",
    "reader.json": "reader",
    "fit.json": "fit",
    "response.json": "response",
    "scan.json": "scan",
    "truth.json": "truth",
    "specimen.json": "specimen-report",
    "pad.json": "pad-report",
    "pad-figures.json": "pad-figures",
    "stack.json": "stack",
}
"""Names of schemas by the file that holds such a document."""


@cache
def validator(name: str) -> Draft202012Validator:
    from pneutouch.schemas import schema_of

    return Draft202012Validator(schema_of(name))


def hold(name: str, document: Any) -> None:
    """Fail where a document is not of its schema, with the place and what is wrong."""
    found = [f"{error.json_path}: {error.message:.300}" for error in validator(name).iter_errors(document)]
    assert not found, f"{name}: " + "\n".join(found[:10])


def hold_folder(folder: Path) -> int:
    """Hold the documents of an output folder; how many there are."""
    found = [path for path in folder.rglob("*.json") if path.name in WRITTEN]
    for path in found:
        hold(WRITTEN[path.name], json.loads(path.read_text(encoding="utf-8")))
    return len(found)
