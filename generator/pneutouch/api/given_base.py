"""A design that is given as an object in place of its name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pneutouch.api.design import Design
from pneutouch.api.fields import WHERE
from pneutouch.catalogue import Library
from pneutouch.errors import PneutouchError
from pneutouch.holding import temporary_folder
from pneutouch.output.new import new_changed


def with_base_named(fields: Mapping[str, Any]) -> tuple[dict[str, Any], Design | None]:
    """Keyword arguments of a target with a base that is a design named by its name, and that design."""
    setting = fields.get("setting")
    inner = setting.get("base") if isinstance(setting, Mapping) else None
    if isinstance(inner, Design) and isinstance(setting, Mapping):
        return {**fields, "setting": {**setting, "base": inner.name}}, inner
    base = fields.get("base")
    return ({**fields, "base": base.name}, base) if isinstance(base, Design) else (dict(fields), None)


class GivenBase:
    """A library that has a design by its name, and the words in place of the file that holds it meanwhile."""

    def __init__(self, design: Design | None, folder: Path) -> None:
        self._folder, self._design, self.library = folder, design, Library.default()
        if design is not None:
            new_changed(design.source, design.name, folder / "designs")
            self.library = Library((folder, *self.library.folders))

    def named(self, document: dict[str, Any]) -> dict[str, Any]:
        """A document of a selection whose ``base`` names the design."""
        if "processes" in document:
            return {**document, "processes": {key: self.named(one) for key, one in document["processes"].items()}}
        if self._design is None or not self._holds(document["base"]):
            return document
        where = self._design.source.where
        return {**document, "base": self._design.name if where == WHERE else where}

    def blame(self, error: PneutouchError) -> None:
        """Name the design's own file, or none, in an error."""
        for each in (error, *error.others):
            if self._design is not None and each.file is not None and self._holds(each.file):
                each.file = self._design.source.where

    def _holds(self, file: str) -> bool:
        return Path(file).is_relative_to(self._folder)


@contextmanager
def given_base(design: Design | None) -> Iterator[GivenBase]:
    """The library of a selection on a design; None: as it is."""
    with temporary_folder() as folder:
        base = GivenBase(design, folder)
        try:
            yield base
        except PneutouchError as error:
            base.blame(error)
            raise
