"""Keys that were renamed, read from the tables of CHANGELOG.md."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

CHANGELOG = Path(__file__).resolve().parents[2] / "CHANGELOG.md"

HEADER = ("file or command", "old key", "new key")


@dataclass(frozen=True)
class Rename:
    """A key and its new name in the documents named: commands, names of files, or ``*``.

    A dotted old key, ``states.told``, is renamed below that key alone; of the new one the last part counts.
    """

    documents: tuple[str, ...]
    old: str
    new: str

    def concerns(self, command: str, files: Sequence[str] = ()) -> bool:
        names = {"*", command, *files, *(name.rsplit(".", 1)[0] for name in files)}
        return not names.isdisjoint(self.documents)


def renamed(key: str, path: Sequence[str], renames: Sequence[Rename]) -> str:
    """The new name of a key that stands below ``path``, old or new names; numbers in the path count entries of lists."""
    parents = [part for part in path if not part.isdigit()]
    for rename in renames:
        if rename.old == key:
            return rename.new
        *above, last = rename.old.split(".")
        here = parents[-len(above) :]
        if (
            above
            and last == key
            and here in (above, [renamed(part, above[:k], renames) for k, part in enumerate(above)])
        ):
            return rename.new.rsplit(".", 1)[-1]
    return key


def read_renames(text: str | None = None) -> list[Rename]:
    """Renames of every table with the header of three columns: file or command, old key, new key."""
    rows = [cells(line) for line in (text or CHANGELOG.read_text()).splitlines()]
    table, renames = False, []
    for row in rows:
        table = len(row) == len(HEADER) and (table or tuple(cell.lower() for cell in row) == HEADER)
        if table and tuple(cell.lower() for cell in row) != HEADER and set("".join(row)) - set("-: "):
            documents = tuple(name.strip(" `").removeprefix("pneutouch ") for name in row[0].split(","))
            renames.append(Rename(documents, row[1], row[2]))
    return renames


def cells(line: str) -> list[str]:
    return [cell.strip(" `") for cell in line.strip().strip("|").split("|")] if line.startswith("|") else []
