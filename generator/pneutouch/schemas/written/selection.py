"""The schema of a selection: designs for a target, a grade for one, or the designs of several processes."""

from pneutouch.results.selection import GradedRecord, ProcessesRecord, SelectionRecord
from pneutouch.schemas.models import model_schema
from pneutouch.schemas.shape import TEXT, Schema, described_by, or_null, record
from pneutouch.schemas.typed import of_record
from pneutouch.schemas.written.parts import contact
from pneutouch.spec.target import Target


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
