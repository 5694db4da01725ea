"""The shipped examples of files that commands take, other than designs: targets, trays, sweeps and campaigns."""

from dataclasses import dataclass
from pathlib import Path

from pneutouch.catalogue.places import shipped_root
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


def _example(path: Path) -> Example:
    content = read_toml(path)
    kind = next(kind for key, kind in _KINDS.items() if key in content)
    title, _, _ = path.read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ").partition(": ")
    return Example(path, kind, title)
