"""Schemas of the JSON documents that the program writes."""

from collections.abc import Callable
from functools import partial
from importlib import import_module

from pneutouch.formats import FORMATS, KEY, format_of
from pneutouch.results.calibration import OutcomeRecord
from pneutouch.results.comparison import ComparisonRecord
from pneutouch.results.fit import MaterialFit
from pneutouch.results.folder import Manifest
from pneutouch.results.measured import MeasuredCampaign
from pneutouch.results.response import LoadResponse
from pneutouch.results.scan import ScanRecord
from pneutouch.results.simulation import CampaignTruth
from pneutouch.results.specimen import SpecimenRecord
from pneutouch.results.stack import StackRecord
from pneutouch.schemas.kind import DocumentKind
from pneutouch.schemas.shape import Schema
from pneutouch.schemas.typed import of_record

_DOCUMENTS: dict[str, tuple[type | str, str, str]] = {
    "prediction": ("prediction.prediction", "A prediction", "`prediction.json` of `build`, `pneutouch predict --json`"),
    "manifest": (Manifest, "A manifest", "`manifest.json` of every output folder"),
    "plan": ("campaign.plan", "A test plan", "`plan.json` of `plan`, `pneutouch plan --json`"),
    "figures": (
        MeasuredCampaign,
        "Measured figures",
        "`figures.json` of `characterize`, `pneutouch characterize --json`",
    ),
    "selection": ("selection.selection", "A selection", "`pneutouch select --json`"),
    "comparison": (ComparisonRecord, "A comparison", "`comparison.json` of `compare`, `pneutouch compare --json`"),
    "calibration-report": (OutcomeRecord, "A calibration's report", "`pneutouch calibrate --json`"),
    "reader": ("reader.reader", "A reader of force", "`reader.json` of `export-reader`"),
    "fit": (MaterialFit, "A fitted material law", "`fit.json` of `fit-material`, `pneutouch fit-material --json`"),
    "response": (LoadResponse, "A simulated signal", "`response.json` of `respond`, `pneutouch respond --json`"),
    "scan": (ScanRecord, "A scan of a specimen", "`scan.json` of `scan`, `pneutouch scan --json`"),
    "truth": (CampaignTruth, "Truth of a simulated campaign", "`truth.json` of `simulate`"),
    "specimen-report": (SpecimenRecord, "A built texture specimen", "`specimen.json` of `build`"),
    "stack": (StackRecord, "A voxel stack", "`stack.json` of every stack for voxel printing"),
    "exported-design": (
        "objects.exported_design",
        "A design exported from the studio",
        "saved by `Export` in the studio",
    ),
}


def _made(name: str, source: type | str) -> Schema:
    """The schema of a document, from its record or by the function that makes it."""
    if isinstance(source, str):
        module, _, function = source.partition(".")
        make: Callable[[], Schema] = getattr(import_module(f"pneutouch.schemas.written.{module}"), function)
        schema = make()
    else:
        schema = of_record(source)
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
