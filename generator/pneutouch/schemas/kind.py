"""Kind of a document: its form, its title, its place, and the function that makes its schema."""

from collections.abc import Callable
from typing import Any, Literal, NamedTuple


class DocumentKind(NamedTuple):
    """A kind of document that is read or written; ``where`` states where it lies or what takes it."""

    form: Literal["TOML", "JSON"]
    title: str
    where: str
    make: Callable[[], dict[str, Any]]
