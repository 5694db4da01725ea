"""What the program states of one kind of document: its form, its title, where it lies, and how its schema is made."""

from collections.abc import Callable
from typing import Any, Literal, NamedTuple


class DocumentKind(NamedTuple):
    """A kind of document that is read or written; ``where`` states where it lies or what takes it."""

    form: Literal["TOML", "JSON"]
    title: str
    where: str
    make: Callable[[], dict[str, Any]]
