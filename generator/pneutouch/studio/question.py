"""A question of the page: a design with the fields that differ from its file, and its saving as a file."""

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from starlette.requests import Request

from pneutouch.catalogue import KINDS, DesignSource, Library, user_folder
from pneutouch.catalogue.library import CachedLibrary
from pneutouch.errors import InputError
from pneutouch.output.new import check_free, new_changed, write_design
from pneutouch.spec.design import DesignFile
from pneutouch.spec.files import read_bytes
from pneutouch.spec.read import override, parse_changes
from pneutouch.spec.values import plain_name

PAGE = "the page"
"""Stands for the file where values come from the page."""

_MOST_FIELDS = 200
_LONGEST_TEXT = 4000


@dataclass(frozen=True)
class Question:
    """A design of the catalogue, or the one the studio was started with, by ``base``; and changed fields.

    ``values`` holds by ``table.key`` the text of a change ``table.key=text``, or None if the key is left out.
    """

    base: str
    values: Mapping[str, str | None]

    @classmethod
    def of(cls, content: Any) -> "Question":
        """The question in a JSON document of the page. Raises InputError if there is none."""
        if not isinstance(content, dict) or set(content) != {"base", "values"}:
            raise InputError("a question is an object with the keys base and values")
        base, values = content["base"], content["values"]
        if not isinstance(base, str) or not isinstance(values, dict):
            raise InputError("base is a text and values is an object")
        if len(values) > _MOST_FIELDS:
            raise InputError(f"values has {len(values)} fields; at most {_MOST_FIELDS} are taken")
        for key, value in values.items():
            if value is not None and not isinstance(value, str):
                raise InputError("each value is a text, or null where the key is left out", key=key)
            if value is not None and len(value) > _LONGEST_TEXT:
                raise InputError(f"the text is longer than {_LONGEST_TEXT} characters", key=key)
        return cls(base, values)

    def source(self, bases: Mapping[str, str], library: Library) -> DesignSource:
        """The design as a source; ``bases`` are designs by name or path, by the name that the page has for them.

        Raises InputError naming key and value.
        """
        if self.base not in bases:
            raise InputError("unknown design", key="base", value=self.base)
        base = DesignSource.of(bases[self.base], library)
        content = {key: dict(value) if isinstance(value, dict) else value for key, value in base.content.items()}
        for name in (name for name, text in self.values.items() if text is None):
            _leave_out(content, name)
        given = [f"{name}={text}" for name, text in self.values.items() if text is not None]
        return DesignSource(base.name, override(content, parse_changes(given), DesignFile), PAGE)


def _leave_out(content: dict[str, Any], name: str) -> None:
    """Take a key out of the tables, where it is there."""
    table, _, key = name.partition(".")
    tables = content.get(table)
    if not key:
        content.pop(table, None)
    elif isinstance(tables, dict):
        tables.pop(key, None)


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


async def json_body(request: Request, what: str) -> Any:
    """The document in a body. Raises InputError, which names it by ``what``, if there is none."""
    try:
        content = json.loads(await request.body())
        # JSON can escape halves of surrogate pairs; such a text has no bytes, so that no answer could repeat it.
        json.dumps(content, ensure_ascii=False).encode()
    except (ValueError, RecursionError):
        raise InputError(f"the {what} is not JSON") from None
    return content


_ENDING = ".toml"
_KEYS = {"question", "name", "replace"}


class NameTakenError(InputError):
    """There is a file of this name already, and it is not to be replaced."""


def save_design(request: Mapping[str, Any], bases: dict[str, str]) -> dict[str, str]:
    """Write the design of ``question`` as ``name`` into the folder of the user's designs, and add it to ``bases``.

    Over a file with ``replace`` alone. A design without changes is copied with its comments. Returns its name and
    file. Raises NameTakenError if there is such a file, and InputError that names the key.
    """
    name, overwrite = _checked(request)
    question, library = Question.of(request.get("question")), Library.default()
    folder = user_folder() / KINDS["designs"].folder
    path = folder / f"{name}{_ENDING}"
    _check_open(name, path, bases, library)
    source = question.source(bases, library)
    source.changed({})
    if not overwrite and os.path.lexists(path):
        raise NameTakenError(
            "there is such a file already", file=path, key="name", remedy="give another name, or replace it"
        )
    check_free(name, folder, overwrite=overwrite)
    if question.values:
        new_changed(source, name, folder, overwrite=overwrite)
    else:
        original = library.design_file(bases[question.base])
        write_design(name, folder, read_bytes(original).decode("utf-8-sig"), overwrite=overwrite)
    bases[name] = str(path.resolve())
    return {"name": name, "file": str(path)}


def _checked(request: Mapping[str, Any]) -> tuple[str, bool]:
    """Name and whether a file is to be replaced."""
    if not request.keys() <= {*_KEYS, "uploads"}:
        raise InputError(f"a design to be saved has the keys {', '.join(sorted(_KEYS))}")
    name, overwrite = request.get("name"), request.get("replace", False)
    if not isinstance(name, str) or not isinstance(overwrite, bool):
        raise InputError("name is a text and replace is true or false")
    return plain_name(name.strip().removesuffix(_ENDING), key="name"), overwrite


def _check_open(name: str, path: Path, bases: Mapping[str, str], library: Library) -> None:
    """Refuse the name of a design that is open on the page from another place: it would mean two."""
    if name not in bases or not Path(bases[name]).is_file():
        return
    if Path(bases[name]).resolve() != path.resolve():
        problem = f"{bases[name]} is open by this name"
        raise InputError(problem, key="name", value=name, remedy="give another name")
