"""An output folder read back: the files that its manifest lists, as they were written."""

import json
import os
from pathlib import Path
from typing import Any

from pneutouch.errors import InputError
from pneutouch.output.files import MANIFEST, digest
from pneutouch.spec.files import read_bytes

_MOST_BYTES = 100_000_000
"""Of the largest file that is read: hundreds of times a usual one."""


def manifest_of(folder: Path) -> dict[str, Any]:
    """The manifest of an output folder. Raises InputError where there is none, or where it is damaged."""
    if not os.path.lexists(folder / MANIFEST):
        raise InputError(
            f"holds no {MANIFEST}: neither a build nor a characterization",
            file=folder,
            remedy="give a folder that pneutouch build or characterize wrote, or a design",
        )
    text = read_bytes(folder / MANIFEST, _MOST_BYTES, "manifest")
    try:
        content = json.loads(text)
        listed = content["files"]
        if isinstance(listed, dict) and all(isinstance(entry["sha256"], str) for entry in listed.values()):
            return dict(content)
    except (ValueError, KeyError, TypeError, RecursionError):
        pass
    raise InputError(f"its {MANIFEST} is damaged or not ours", file=folder, remedy="make the folder again")


def listed_file(folder: Path, name: str, manifest: dict[str, Any]) -> bytes:
    """A file of an output folder. Raises InputError where it is missing or not as it was written."""
    entry = manifest["files"].get(name)
    if entry is None or not os.path.lexists(folder / name):
        raise InputError(f"holds no {name}", file=folder, remedy="make the folder again")
    content = read_bytes(folder / name, _MOST_BYTES, "file of an output folder")
    if digest(content) != entry["sha256"]:
        raise InputError("was changed after it was written", file=folder / name, remedy="make the folder again")
    return content
