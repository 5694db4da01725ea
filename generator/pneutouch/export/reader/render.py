"""The files of a reader from its document: bytes by file name."""

from __future__ import annotations

import json
import pprint
from collections.abc import Mapping
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
TEMPLATES = HERE / "templates"
SCHEMA = HERE / "reader.schema.json"


def reader_files(record: Mapping[str, Any]) -> dict[str, bytes]:
    """All files of a reader but ``reader.json`` itself, by their names in its folder."""
    return {
        "reader.schema.json": SCHEMA.read_bytes(),
        "pressure_reader.py": _rendered("pressure_reader.py.j2", record, source=_module(), table=_table(record)),
    }


def _rendered(template: str, record: Mapping[str, Any], **more: Any) -> bytes:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,  # program text, and every text in it is written as a literal of its language
    )
    environment.filters["literal"] = json.dumps
    return environment.get_template(template).render(record=record, **more).encode()


def _table(record: Mapping[str, Any]) -> str:
    """The part of the document that `reading.ForceReader` reads, as a literal of Python."""
    parts = {key: record[key] for key in ("grid", "gas", "box", "rating", "gauge", "conditions")}
    return pprint.pformat(parts, width=118, compact=True)


def _module() -> str:
    """The source of `reading` without its docstring: the module that is shipped is the one that is used here."""
    text = (HERE / "reading.py").read_text(encoding="utf-8")
    return text.split('"""', 2)[2].lstrip("\n")
