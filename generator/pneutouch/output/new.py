"""Write a commented design file for a new design."""

import os
import re
from pathlib import Path

from pneutouch.catalogue import Library
from pneutouch.errors import InputError
from pneutouch.spec.template import design_template

NAME_PATTERN = r"[A-Za-z0-9][A-Za-z0-9_-]*"
NAME_RULE = "use letters, digits, - and _, starting with a letter or digit"


def new_design(name: str, folder: Path) -> Path:
    """Write ``folder/name.toml`` with every key, its default, unit, bounds and help; never over a file."""
    return write_design(name, folder, design_template(name))


def check_name(name: str, folder: Path) -> Path:
    """The file of a new design. Raises InputError for a bad name, and for one that would hide another design."""
    if not re.fullmatch(NAME_PATTERN, name):
        raise InputError(NAME_RULE, key="name", value=name)
    path = folder / f"{name}.toml"
    known = Library.default().paths("designs").get(name)
    if known is not None and known.resolve() != path.resolve():
        problem = f"{known} is a design of this name, which the new file would hide"
        raise InputError(problem, key="name", value=name, remedy="give another name")
    return path


def write_design(name: str, folder: Path, text: str) -> Path:
    """Write the text of a design as ``folder/name.toml``; never over a file."""
    path = check_name(name, folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
    except FileExistsError:
        what = "there is such a file already; give another name" if path.exists() else f"{folder} is not a folder"
        raise InputError(f"{what}", file=path) from None
    except OSError as error:
        raise InputError(str(error.strerror), file=path, remedy="give a folder you may write to with `out`") from None
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(text)
    return path
