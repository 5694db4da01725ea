"""All schemas by name."""

from typing import Any

from pneutouch.errors import InputError, nearest
from pneutouch.formats import version_of
from pneutouch.schemas.documents import written_kinds
from pneutouch.schemas.facts import described
from pneutouch.schemas.files import file_kinds
from pneutouch.schemas.kind import DocumentKind

DRAFT = "https://json-schema.org/draft/2020-12/schema"


def document_kinds() -> dict[str, DocumentKind]:
    """Every kind of document with its schema: those that are read, then those that are written."""
    return {**file_kinds(), **written_kinds()}


def schema_of(name: str) -> dict[str, Any]:
    """The schema of a kind of document, as data: descriptions state unit, bounds and default too.

    Raises InputError for a name that is none.
    """
    kinds = document_kinds()
    if name not in kinds:
        raise InputError(f"unknown.{nearest(name, kinds)}", key="name", value=name)
    kind = kinds[name]
    made = kind.make()
    return {"$schema": DRAFT, "$id": f"urn:pneutouch:{name}:{version_of(name)}", "title": kind.title, **described(made)}
