"""A lab's own profile: the shipped one with measured numbers in place of quoted ones."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneutouch.bench.finding import MARK, ProfileChange, ReadingSource
from pneutouch.catalogue import KINDS, Library
from pneutouch.errors import InputError
from pneutouch.output.files import replace_files
from pneutouch.spec.read import read_toml
from pneutouch.spec.toml_text import toml_text

HEAD = "# Written by pneutouch coupons"
"""First words of every profile that is ours to overwrite."""


@dataclass(frozen=True, slots=True)
class MeasuredProfile:
    """A profile to write: its file, its text, and its changes."""

    path: Path
    text: str
    changes: list[dict[str, Any]]


def base_file(kind: str, name: str, library: Library) -> Path:
    """The first profile of a known name that the command did not write; its own where there is no other."""
    candidates = [root / KINDS[kind].folder / f"{name}.toml" for root in library.folders]
    there = [path for path in candidates if path.is_file()]
    return next((path for path in there if not _is_ours(path)), there[0])


def local_profiles(
    changes: Sequence[ProfileChange], source: ReadingSource, library: Library, out: Path
) -> list[MeasuredProfile]:
    """One profile for each material and printer that something was measured of, checked but not written.

    Quantities that an earlier run of the command measured and this one did not are kept. Raises InputError if a file
    of that name was not written by the command.
    """
    profiles = []
    for kind, name in dict.fromkeys((change.kind, change.name) for change in changes):
        path = out / KINDS[kind].folder / f"{name}.toml"
        earlier = _earlier(path, [change for change in changes if (change.kind, change.name) == (kind, name)])
        content = read_toml(base_file(kind, name, library))
        _carry(earlier, content)
        change_list = [_put(content, change, path) for change in changes if (change.kind, change.name) == (kind, name)]
        KINDS[kind].validate(content, str(path))
        profiles.append(
            MeasuredProfile(
                path, head(source, "the shipped profile with the measured numbers") + toml_text(content), change_list
            )
        )
    return profiles


def head(source: ReadingSource, what: str) -> str:
    """The first lines of a profile that the command writes."""
    return (
        f"{HEAD} from {source.where} ({source.lab}, {source.date.isoformat()}): {what}.\n"
        "# Edit this line away and the command will no longer overwrite the file; delete the file to go back.\n"
    )


def write_profiles(profiles: Sequence[MeasuredProfile]) -> None:
    """Write every profile, or none. Raises InputError if a folder cannot be written."""
    replace_files({profile.path: profile.text.encode() for profile in profiles})


def _is_ours(path: Path) -> bool:
    with path.open(encoding="utf-8", errors="replace") as file:
        return file.read(len(HEAD)) == HEAD


def _earlier(path: Path, changes: Sequence[ProfileChange]) -> dict[str, Any]:
    """The content of the file that the command wrote before; empty if there is none."""
    there = check_ours(path, ", ".join(".".join(change.keys) for change in changes))
    return read_toml(path) if there else {}


def check_ours(path: Path, keys: str) -> bool:
    """True if the command wrote the file. Raises InputError if it did not; ``keys`` are the entries to write."""
    if not (path.exists() or path.is_symlink()):
        return False
    if path.is_file() and not path.is_symlink() and _is_ours(path):
        return True
    raise InputError(
        "was not written by pneutouch coupons, so it is left as it is",
        file=path,
        remedy=f"put {keys} into it by hand, move it away, or give another folder with `out`",
    )


def _carry(earlier: dict[str, Any], content: dict[str, Any]) -> None:
    """Take over the quantities whose source is a coupon."""
    for key, value in earlier.items():
        if not isinstance(value, dict):
            continue
        if MARK in str(value.get("source", "")):
            content[key] = value
        elif isinstance(content.get(key), dict):
            _carry(value, content[key])


def _put(content: dict[str, Any], change: ProfileChange, path: Path) -> dict[str, Any]:
    """Put a quantity in its place; its old and new values, as data."""
    *tables, last = change.keys
    owner = content
    for table in tables:
        owner = owner[table]
    before = owner.get(last)
    owner[last] = change.content
    return {"file": str(path), "key": ".".join(change.keys), "before": before, "after": change.content}
