"""Order of a tray, from a tray file or from the flags of the command line."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pneutouch.errors import InputError
from pneutouch.spec.files import design_inside, is_file
from pneutouch.spec.names import file_name, name_of
from pneutouch.spec.over import parse_over
from pneutouch.spec.read import Changes, read_toml, validate
from pneutouch.spec.tray import LEAST_COPIES, MOST_COPIES, Tray


@dataclass(frozen=True)
class TrayOrder:
    """A tray with the name of its output, the file or flags it is from (for messages), and overrides of all entries."""

    name: str
    where: str
    tray: Tray
    overrides: Changes = field(default_factory=dict)
    folder: Path | None = None

    def design(self, name: str) -> str:
        """A design as the catalogue takes it: a path in a tray file is in the folder of that file."""
        return name if self.folder is None else design_inside(self.folder, name, file=self.where, key="entry.design")


def is_tray_file(path: Path) -> bool:
    """True if a path is a TOML file with the tables of a tray; designs have none, and a missing file neither."""
    return path.suffix == ".toml" and is_file(path) and not {"tray", "entry"}.isdisjoint(read_toml(path))


def order_of_file(path: Path, overrides: Changes | None = None, **head: Any) -> TrayOrder:
    """Read a tray file; ``head`` (profile, marks) comes before its [tray]. Raises InputError naming file and key."""
    content = read_toml(path)
    given = {key: value for key, value in head.items() if value is not None}
    if given:
        table = content.setdefault("tray", {})
        if isinstance(table, dict):
            table.update(given)
    return TrayOrder(name_of(path), str(path), validate(Tray, content, str(path)), overrides or {}, path.parent)


def order_of_flags(
    designs: Sequence[str], over: Sequence[str] = (), copies: int = 1, overrides: Changes | None = None, **head: Any
) -> TrayOrder:
    """One entry a design, each over the values of ``table.key=VALUES`` (see `spec.over`), ``copies`` of each.

    Raises InputError naming the parameter.
    """
    if not LEAST_COPIES <= copies <= MOST_COPIES:
        raise InputError(f"must be from {LEAST_COPIES} to {MOST_COPIES}", key="copies", value=copies)
    varied = parse_over(over)
    entries = [{"design": design, "copies": copies, "over": varied} for design in designs]
    stem = file_name(Path(designs[0]).stem)
    title = f"{stem}, {copies} of each" if len(designs) == 1 else f"{len(designs)} designs, {copies} of each"
    content = {"tray": {"title": title, **{k: v for k, v in head.items() if v is not None}}, "entry": entries}
    return TrayOrder(f"{stem}-tray", "the command line", validate(Tray, content, "the command line"), overrides or {})
