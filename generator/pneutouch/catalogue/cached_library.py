"""A library that reads every file once: the points of a sweep name the same few materials, printers and parts, and a
selection needs every resin several times."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pneutouch.catalogue.library import Library


@dataclass(frozen=True)
class CachedLibrary(Library):
    """A library over ``folders`` that do not change while it is used; the objects that it returns are immutable and
    shared."""

    _files: dict[str, dict[str, Path]] = field(default_factory=dict, repr=False, compare=False)
    _things: dict[tuple[str, str], Any] = field(default_factory=dict, repr=False, compare=False)

    def paths(self, kind: str) -> dict[str, Path]:
        """Names of one kind with their files, sorted by name."""
        if kind not in self._files:
            self._files[kind] = super().paths(kind)
        return self._files[kind]

    def load(self, kind: str, name: str, *, file: str | None = None, key: str | None = None) -> Any:
        """Load one thing by name; raises InputError as a library does."""
        if (kind, name) not in self._things:
            self._things[kind, name] = super().load(kind, name, file=file, key=key)
        return self._things[kind, name]
