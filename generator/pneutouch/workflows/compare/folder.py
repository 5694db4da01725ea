"""An output folder read back: the files that its manifest lists, as they were written."""

import json
from pathlib import Path
from typing import Any

from pneutouch.errors import InputError
from pneutouch.output.files import MANIFEST, digest

_LARGEST = 512 * 2**20
"""Bytes of the largest file that is read: a thousand times a usual one."""


def manifest_of(folder: Path) -> dict[str, Any]:
    """The manifest of an output folder. Raises InputError where there is none, or where it is damaged."""
    try:
        content = json.loads(_bytes(folder / MANIFEST))
        listed = content["files"]
        if isinstance(listed, dict) and all(isinstance(entry["sha256"], str) for entry in listed.values()):
            return dict(content)
    except FileNotFoundError:
        raise InputError(
            f"holds no {MANIFEST}: neither a build nor a characterization",
            file=folder,
            remedy="give a folder that pneutouch build or characterize wrote, or a design",
        ) from None
    except (ValueError, KeyError, TypeError, RecursionError):
        pass
    raise InputError(f"its {MANIFEST} is damaged or not ours", file=folder, remedy="make the folder again")


def listed_file(folder: Path, name: str, manifest: dict[str, Any]) -> bytes:
    """A file of an output folder. Raises InputError where it is missing or not as it was written."""
    entry = manifest["files"].get(name)
    try:
        content = _bytes(folder / name) if entry else b""
    except FileNotFoundError:
        entry = None
    if entry is None:
        raise InputError(f"holds no {name}", file=folder, remedy="make the folder again")
    if digest(content) != entry["sha256"]:
        raise InputError("was changed after it was written", file=folder / name, remedy="make the folder again")
    return content


def _bytes(path: Path) -> bytes:
    """Content of a plain file of a sensible size. Raises InputError for another, FileNotFoundError without one."""
    try:
        if path.is_file() and path.stat().st_size > _LARGEST:
            raise InputError("too large to be ours", file=path)
        if path.exists() and not path.is_file():
            raise InputError("not a plain file", file=path)
        return path.read_bytes()
    except FileNotFoundError:
        raise
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror or error}", file=path) from None
