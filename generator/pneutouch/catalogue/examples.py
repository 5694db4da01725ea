"""The shipped examples of files that commands take, other than designs: targets, trays, sweeps and campaigns."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch.catalogue.places import shipped_root
from pneutouch.errors import InputError
from pneutouch.spec.files import exists
from pneutouch.spec.read import read_toml

FOLDER = "docs/examples"

_KINDS = {"target": "target", "entry": "tray", "grid": "sweep", "point": "sweep", "runs": "campaign"}
"""Kind of file by a key that only files of this kind have."""

COMMANDS = {"target": "select", "tray": "tray", "sweep": "sweep", "campaign": "characterize"}
"""The command that takes a kind."""


@dataclass(frozen=True, slots=True)
class Example:
    """An example: its file, the kind of file it is, and its title, which is its first line."""

    path: Path
    kind: str
    title: str


def examples() -> dict[str, Example]:
    """The shipped examples by name."""
    return {path.stem: _example(path) for path in sorted((shipped_root() / FOLDER).glob("*.toml"))}


def example_remedy(name: str) -> str | None:
    """Command that copies the example of this name, given when a file was expected; None if there is no such
    example."""
    name = name.removesuffix(".toml")
    example = examples().get(name)
    if example is None:
        return None
    what = f"a {example.kind} file for {COMMANDS[example.kind]}"
    return f"the example of this name, {what}, is copied by `pneutouch new --from {name}`"


def read_given(path: Path, otherwise: str) -> dict[str, Any]:
    """Content of a TOML file that a user gave. Raises InputError; for a missing file its remedy is the example of this
    name, if there is one, else ``otherwise``."""
    try:
        return read_toml(path)
    except InputError as error:
        if not exists(path):
            error.remedy = example_remedy(str(path)) or otherwise
        raise


def _example(path: Path) -> Example:
    content = read_toml(path)
    kind = next(kind for key, kind in _KINDS.items() if key in content)
    title, _, _ = path.read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ").partition(": ")
    return Example(path, kind, title)
