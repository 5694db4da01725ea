"""The schema of an exported reader, which stands next to the templates of its code."""

import json

from pneutouch.export.reader.render import SCHEMA
from pneutouch.schemas.shape import Schema


def reader() -> Schema:
    """Schema of ``reader.json``."""
    schema: Schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    return schema
