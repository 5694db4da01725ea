"""Names and titles of all files that can be named, by kind, and the design that a campaign names."""

from pathlib import Path
from typing import Any

from pneutouch.catalogue.library import KINDS, Library, examples
from pneutouch.catalogue.scene import DesignSource
from pneutouch.errors import InputError, nearest
from pneutouch.spec.campaign import CAMPAIGN, Campaign, design_of
from pneutouch.spec.design import DesignFile
from pneutouch.spec.grade import MixingCurve
from pneutouch.spec.material import Material
from pneutouch.spec.pad import PadFile
from pneutouch.spec.printer import Printer
from pneutouch.spec.specimen import Specimen
from pneutouch.spec.values import name_of

_LISTED = (
    "designs",
    "pads",
    "specimens",
    "examples",
    "calibrations",
    "materials",
    "mixing",
    "printers",
    "gauges",
    "parts",
)
_GROUPS = {kind: [kind] for kind in _LISTED} | {"examples": [], "parts": ["ports", "seats", "mounts", "tubes"]}


_NAMED_BY_FILE = ("designs", "pads", "specimens", "calibrations")
"""Kinds whose names obey `plain_name`: users write files of these kinds."""


def listing(kind: str | None, library: Library | None = None) -> dict[str, list[dict[str, str]]]:
    """Names and titles of files by group; ``kind`` is one group, such as designs or materials, or None for all. Parts
    and examples have a ``kind`` too. A file that cannot be read has an empty title, its path as ``file`` and the
    problem as ``error``. Raises InputError for an unknown group."""
    if kind is not None and kind not in _GROUPS:
        group = next((group for group, kinds in _GROUPS.items() if kind in kinds), None)
        remedy = None if group is None else f"they are listed under {group}"
        hint = "" if group else nearest(kind, _GROUPS)
        raise InputError(f"unknown.{hint}" if hint else "unknown", key="kind", value=kind, remedy=remedy)
    library = library or Library.default()
    groups = _GROUPS if kind is None else {kind: _GROUPS[kind]}
    listed = {
        group: [
            {"name": name, **_read(library, each, name), **({"kind": each} if KINDS[each].part else {})}
            for each in kinds
            for name in library.paths(each)
        ]
        for group, kinds in groups.items()
    }
    if "examples" in listed:
        entries = [{"name": name, "title": one.title, "kind": one.kind} for name, one in examples().items()]
        listed["examples"] = entries
    return listed


def _read(library: Library, kind: str, name: str) -> dict[str, str]:
    """Title of a file; or, if it cannot be read, an empty title, its path as ``file`` and the ``error``."""
    path = library.paths(kind)[name]
    try:
        if kind in _NAMED_BY_FILE:
            name_of(path)
        return {"title": _title(library.load(kind, name))}
    except InputError as error:
        for one in (error, *error.others):
            one.file = None
        return {"title": "", "file": str(path), "error": str(error)}


def _title(thing: Any) -> str:
    if isinstance(thing, DesignFile | PadFile | Specimen):
        return thing.document.title
    if isinstance(thing, Material):
        return f"{thing.label}, {thing.kind_shown}"
    if isinstance(thing, MixingCurve):
        points, top = len(thing.points), 100 * thing.points[-1].fraction
        known = "fractions assumed" if thing.is_assumed else "measured"
        return f"{thing.title}: {points} points, 0 to {top:g} % {thing.stiff}, {known}"
    if isinstance(thing, Printer):
        return f"{thing.title}: {', '.join(thing.resins)}"
    return str(thing.title)


def known_design(campaign: Campaign, folder: Path, library: Library) -> str | None:
    """Design that a campaign names, as a command takes it; None without one. Raises InputError if it is unknown."""
    name = design_of(campaign, folder)
    if name is not None:
        try:
            DesignSource.of(name, library)
        except InputError as error:
            # An error on what is in the design's file names that file.
            if error.file is None:
                error.file, error.key, error.value = str(folder / CAMPAIGN), "design", campaign.design
            raise
    return name
