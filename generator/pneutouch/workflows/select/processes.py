"""One target over several processes: the selection of each on a profile of it, one below the other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, get_args

from pneutouch.catalogue import Library
from pneutouch.catalogue.cached_library import CachedLibrary
from pneutouch.catalogue.runs import casting_missing, uncast
from pneutouch.errors import InputError
from pneutouch.spec.casting import CAST_SEAT
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer, Process
from pneutouch.spec.target import Target
from pneutouch.workflows.select.base import named_by_target, setting_changes, settled_base
from pneutouch.workflows.select.document import document
from pneutouch.workflows.select.gauged import select
from pneutouch.workflows.select.run import STEPS, SelectionRun


@dataclass(frozen=True)
class ProcessSelection:
    """The answers by process, with the profile of each; ``left_out`` says why a process was not searched."""

    runs: dict[str, SelectionRun]
    profiles: dict[str, str]
    left_out: dict[str, str]

    @property
    def best(self) -> list[tuple[str, SelectionRun]]:
        """Process and answer of each that has a design, in the order given."""
        return [(process, run) for process, run in self.runs.items() if run.answer.designs]

    def pick(self, row: int) -> SelectionRun:
        """The answer whose best design stands in a row of the table, from 1. Raises InputError if there is none."""
        if not 1 <= row <= len(self.best):
            raise InputError(f"must be from 1 to {len(self.best)}", key="pick", value=row)
        return self.best[row - 1][1]

    def document(self) -> dict[str, Any]:
        """The answers as a JSON document."""
        shown = {process: {"profile": self.profiles[process], **document(run)} for process, run in self.runs.items()}
        return {"met": bool(self.best), "processes": shown, "left_out": self.left_out}


def select_processes(
    target: Target,
    where: str,
    library: Library | None = None,
    *,
    progress: Callable[[int, int, str], None] = lambda done, total, step: None,
) -> ProcessSelection:
    """Answer a target once for each of its ``setting.processes``. Raises InputError as `gauged.select` does.

    A process takes the base's profile where that is one of it, else the first that makes an elastomer; resins that the
    target names count for the processes that make them.
    """
    library = CachedLibrary((library or Library.default()).folders)
    names = _named(target, library)
    with named_by_target(target, where):
        usual = settled_base(target, setting_changes(target, library), library).print.profile
    runs, profiles, left_out = {}, {}, {}
    for number, process in enumerate(names):
        offered = _profile(process, usual, target.given.materials, library)
        if offered is None:
            left_out[process] = _unmade(process, target.given.materials, library)
            continue
        profiles[process], resins = offered

        def report(step: str, process: str = process, before: int = number * len(STEPS)) -> None:
            progress(before + STEPS.index(step), len(names) * len(STEPS), f"{process}, {step}")

        one = _of(target, process, profiles[process], resins)
        runs[process] = select(one, where, library, written=1, progress=report)
    return ProcessSelection(runs, profiles, left_out)


def _named(target: Target, library: Library) -> list[str]:
    """The processes of a target once each; all that make an elastomer in place of any."""
    names = list(dict.fromkeys(target.setting.processes or ()))
    if names == ["any"]:
        return [process for process in get_args(Process) if _profile(process, "", None, library) is not None]
    return [str(process) for process in names]


_Offer = tuple[str, list[str] | None]


def _profile(process: str, usual: str, resins: list[str] | None, library: Library) -> _Offer | None:
    """A profile of a process, and those of the resins named that it makes; None if it makes none."""
    printers = library.all("printers", Printer)
    known = library.all("materials", Material)
    loaded = {name: library.load("materials", name, key="given.materials") for name in resins or known}
    for name in sorted(printers, key=lambda name: name != usual):
        makes = [each for each, one in loaded.items() if one.kind == "elastomer" and printers[name].mode_for(one)]
        if printers[name].process == process and makes:
            return name, makes if resins else None
    return None


def _unmade(process: str, resins: list[str] | None, library: Library) -> str:
    """Reason why no profile of a process makes the resins named, with the file that lacks their casting."""
    printers = [one for one in library.readable("printers", Printer).values() if one.process == process]
    for name in resins or ():
        material: Material = library.load("materials", name, key="given.materials")
        casts = next((one for one in printers if casting_missing(one, material)), None)
        if casts is not None:
            return str(uncast(casts, material, str(library.paths("materials")[name])))
    return f"no profile of it makes {' or '.join(resins or ['an elastomer'])}"


def _of(target: Target, process: str, profile: str, resins: list[str] | None) -> Target:
    """The target on one profile."""
    changes: dict[str, Any] = {"profile": profile, "processes": None}
    if process == "casting":
        # What the target sets comes after it.
        changes["assignments"] = [f"connector.seat={CAST_SEAT}", *target.setting.assignments]
    given = target.given.model_copy(update={"materials": resins})
    return target.model_copy(update={"setting": target.setting.model_copy(update=changes), "given": given})
