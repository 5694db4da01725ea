"""The library of the page: files are read once, but for those that the page itself writes into the user's folder."""

from pathlib import Path
from typing import Any

from pneutouch.catalogue import Library
from pneutouch.catalogue.cached_library import CachedLibrary

_WRITTEN = ("designs", "calibrations")


class PageLibrary(CachedLibrary):
    """A cached library that searches for designs and calibrations each time."""

    def paths(self, kind: str) -> dict[str, Path]:
        """Names of one kind with their files, sorted by name."""
        return Library.paths(self, kind) if kind in _WRITTEN else super().paths(kind)

    def load(self, kind: str, name: str, *, file: str | None = None, key: str | None = None) -> Any:
        """Load one thing by name; raises InputError as a library does."""
        if kind in _WRITTEN:
            return Library.load(self, kind, name, file=file, key=key)
        return super().load(kind, name, file=file, key=key)
