"""Saves the design of the page as a file of the user's, as ``pneutouch new NAME --from DESIGN --set ...`` does."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pneutouch.catalogue import KINDS, Library, user_folder
from pneutouch.errors import InputError
from pneutouch.output.new import check_free, new_changed, write_design
from pneutouch.spec.files import read_bytes
from pneutouch.spec.values import plain_name
from pneutouch.studio.question import Question

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
