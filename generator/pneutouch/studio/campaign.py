"""A campaign's folder made of the files that the page was given."""

import os
import shutil
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import Any

from pneutouch.errors import InputError
from pneutouch.spec.campaign_file import CAMPAIGN
from pneutouch.spec.read import read_toml
from pneutouch.spec.toml_text import toml_text

UNNAMED = "campaign"
"""Folder of files that came without one."""

_DEEPEST, _LONGEST = 8, 200
"""Folders above a file, and bytes of a name in its path."""


def placed(files: Sequence[Mapping[str, str]], paths: Sequence[str], place: Path) -> tuple[Path, list[str]]:
    """Put files (name, path) at their relative ``paths`` below ``place``.

    Returns the campaign's folder, relative to ``place``, and the paths of its files, relative to that folder. It is the
    one that holds the campaign file; else the one that holds all. Raises InputError for a path that is none, for two
    files at one place and for two campaigns.
    """
    if len(files) != len(paths):
        raise InputError("each file has one path", key="paths")
    if not files:
        raise InputError("no files", remedy="give the files of the runs, or the folder of a campaign")
    checked = [_checked(path) for path in paths]
    twice = [path for path, count in Counter(checked).items() if count > 1]
    if twice:
        raise InputError("two files of this name", key="file", value=str(twice[0]), remedy="give one of them")
    folders = {parent for path in checked for parent in path.parents}
    both = next((path for path in checked if path in folders), None)
    if both is not None:
        raise InputError("a file and a folder of this name", key="file", value=str(both), remedy="rename the file")
    plans = [path for path in checked if path.name == CAMPAIGN]
    if len(plans) > 1:
        raise InputError(
            f"{len(plans)} campaign files: {', '.join(map(str, plans[:4]))}", remedy="give one campaign at a time"
        )
    top = plans[0].parent if plans else PurePosixPath(os.path.commonpath([path.parent for path in checked]))
    prefix = PurePosixPath() if top.parts else PurePosixPath(UNNAMED)
    inside = []
    for file, path in zip(files, checked, strict=True):
        if not path.is_relative_to(top):
            continue
        _link(Path(file["path"]), place / prefix / path)
        inside.append(path.relative_to(top).as_posix())
    folder = Path(prefix / top)
    if plans:
        _bring_named(place / folder, inside)
    return folder, inside


def write_runs(folder: Path, runs: Sequence[Mapping[str, Any]]) -> Path:
    """Write the campaign file of runs that the page gives. Raises InputError for values that TOML has no form for."""
    path = folder / CAMPAIGN
    try:
        text = toml_text({"runs": [dict(run) for run in runs]})
    except (TypeError, RecursionError):
        remedy = "its values are texts, numbers, true or false, and lists of these"
        raise InputError("not a run of a campaign file", key="runs", remedy=remedy) from None
    path.write_text(text)
    return path


def _checked(text: Any) -> PurePosixPath:
    """A path below a folder, without a step out of it. Raises InputError."""
    parts = text.split("/") if isinstance(text, str) else [""]
    plain = all(
        part not in ("", ".", "..") and part.isprintable() and "\\" not in part and len(part.encode()) <= _LONGEST
        for part in parts
    )
    if not plain or len(parts) > _DEEPEST:
        raise InputError("not a path of a file in a folder", key="paths", value=text, remedy="rename the file")
    return PurePosixPath(*parts)


def _link(source: Path, target: Path) -> None:
    """The same file at another place, without a copy where the file system can."""
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        target.hardlink_to(source)
    except OSError:
        shutil.copyfile(source, target)


def _bring_named(folder: Path, inside: list[str]) -> None:
    """Files that were chosen one by one lie in one folder: those that the campaign names in another go there.

    What is wrong with the campaign file is reported when it is read.
    """
    try:
        runs = read_toml(folder / CAMPAIGN).get("runs", [])
    except InputError:
        return
    named = [run.get("file") for run in runs if isinstance(run, dict)] if isinstance(runs, list) else []
    for text in named:
        try:
            path = _checked(text)
        except InputError:
            continue
        there = folder / path
        if path.name in inside and len(path.parts) > 1 and not there.exists():
            try:
                _link(folder / path.name, there)
            except OSError:
                # A folder cannot be where a file is: the run is reported as missing.
                continue
            inside[inside.index(path.name)] = path.as_posix()
            if path.name not in named:
                (folder / path.name).unlink()
