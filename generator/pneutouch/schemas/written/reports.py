"""Schema of comparisons."""

from pneutouch.evaluation.comparison_record import ComparisonRecord
from pneutouch.schemas.shape import TEXT, Schema
from pneutouch.schemas.typed import typed


def _with_folder(schema: Schema) -> Schema:
    """The schema with the folder that the command wrote."""
    folder = {**TEXT, "description": "Folder that it was written to; only in the output of the command."}
    return {**schema, "properties": {**schema["properties"], "folder": folder}}


def comparison() -> Schema:
    """Schema of ``comparison.json`` and of the output of ``pneutouch compare --json``."""
    return _with_folder(typed(ComparisonRecord, {}))
