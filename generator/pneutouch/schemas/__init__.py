"""JSON schemas (draft 2020-12) of the files that the program reads and of the documents that it writes."""

from pneutouch.schemas.catalogue import document_kinds, schema_of

__all__ = ["document_kinds", "schema_of"]
