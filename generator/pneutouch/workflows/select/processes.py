"""Selection over several processes: one for each process, on one of its printers.

Also a selection with its gauge: the one named, or the one that covers the range and detects the smallest force."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, get_args

from pneutouch.catalogue import Library, ResolvedDesign
from pneutouch.catalogue.library import CachedLibrary
from pneutouch.catalogue.printers import casting_missing, uncast
from pneutouch.errors import InputError
from pneutouch.mechanics.gauge_reading import GaugeReading, gauge_reading
from pneutouch.results.record import extended
from pneutouch.results.selection import GaugeTrial, ProcessesRecord, ProcessRecord
from pneutouch.spec.gauge import Gauge
from pneutouch.spec.material import CAST_SEAT, Material
from pneutouch.spec.printer import Printer, Process
from pneutouch.spec.target import Target
from pneutouch.units import KPA
from pneutouch.workflows.select.base import ANY, base_scene, named_by_target, setting_changes, settled_base
from pneutouch.workflows.select.document import NO_RELIEF, Relief, selected
from pneutouch.workflows.select.select import STEPS, SelectionRun
from pneutouch.workflows.select.select import select as select_by_target

_UNKNOWN = "its noise is not stated, so the smallest force is not known"


@dataclass(frozen=True, slots=True)
class _Part:
    """A gauge: its name, and its reading at the ambient pressure."""

    name: str
    reading: GaugeReading

    def trial(self, why: str, *, chosen: bool = False, force: float | None = None) -> GaugeTrial:
        return GaugeTrial(self.name, self.reading.title, chosen, why, force)

    @property
    def reach(self) -> str:
        return f"it reads to {self.reading.limit / KPA:.4g} kPa"


def select(
    target: Target,
    where: str,
    library: Library | None = None,
    *,
    written: int | None = None,
    progress: Callable[[str], None] = lambda step: None,
) -> SelectionRun:
    """Search a target as `select.select` does; with ``setting.gauge`` "any" choose the gauge too.

    Gauges are tried in the order of the smallest force that they detect, those without stated noise last; the first
    whose range no selected design leaves is taken. If there is none, the answer has no design.
    """
    library = CachedLibrary((library or Library.default()).folders)
    named = target.setting.gauge
    if named != ANY:
        if named is not None:
            library.load("gauges", named, file=where, key="setting.gauge")
        return select_by_target(target, where, library, written=written, progress=progress)
    trials: list[GaugeTrial] = []
    last: SelectionRun | None = None
    for part in (parts := _parts(target, where, library)):
        if (why := _below_driving(part, target)) is not None:
            trials.append(part.trial(why))
            continue
        last = select_by_target(_with(target, part.name), where, library, written=written, progress=progress)
        if (why := _not_covered(part, last, written)) is not None:
            trials.append(part.trial(why))
            continue
        slope = last.answer.designs[0].pool.figures.sensitivity * KPA
        trials += _judged(part, parts[len(trials) :], slope, target)
        return replace(last, gauges=tuple(trials))
    if last is None:
        raise InputError(
            "no gauge reads above the driving pressure",
            file=where,
            key="target.driving_pressure_kPa",
            remedy="lower it",
        )
    none = replace(last.answer, designs=[])
    return replace(last, answer=none, judged={}, confirmed=(), gauges=tuple(trials))


def _parts(target: Target, where: str, library: Library) -> list[_Part]:
    """Gauges that read above the ambient pressure: first those that detect the smallest change of pressure."""
    ambient_kPa = base_scene(_with(target, None), where, library).design.pneumatics.ambient_pressure_kPa
    gauges = {name: one for name, one in library.all("gauges", Gauge).items() if target.have.holds("gauges", name)}
    parts = [_Part(name, gauge_reading(gauge, ambient_kPa * KPA)) for name, gauge in gauges.items()]

    def order(part: _Part) -> tuple[bool, float, str]:
        threshold = part.reading.threshold
        return threshold is None, threshold or 0.0, part.name

    return sorted((part for part in parts if part.reading.limit > 0), key=order)


def _with(target: Target, gauge: str | None) -> Target:
    return target.model_copy(update={"setting": target.setting.model_copy(update={"gauge": gauge})})


def _below_driving(part: _Part, target: Target) -> str | None:
    """Reason why a gauge cannot read the required driving pressure; None if it can."""
    driving_kPa = target.target.driving_pressure_kPa or 0.0
    below = part.reading.limit <= driving_kPa * KPA
    return f"{part.reach}, not above the driving pressure of {driving_kPa:g} kPa" if below else None


def _not_covered(part: _Part, run: SelectionRun, written: int | None) -> str | None:
    """Reason why a gauge does not cover the designs selected with it; None if it does."""
    designs = run.answer.designs[: written or 1]
    if not designs:
        return f"{part.reach}, with which no design meets the target"
    ended = next((choice for choice in designs if "gauge" in choice.ends_with), None)
    if ended is None:
        return None
    return f"{part.reach}, where the range of the best design ends ({ended.pool.figures.reach:.3g} N)"


def _judged(chosen: _Part, parts: list[_Part], slope: float, target: Target) -> list[GaugeTrial]:
    """Records of the chosen gauge and of those not tried; ``slope`` is the best design's sensitivity, MPa/N."""
    threshold = chosen.reading.threshold
    force = None if threshold is None else threshold / slope
    detects = (
        "" if force is None else f"covers the range and detects {force:.2g} N, limited by {chosen.reading.limited_by}"
    )
    why = detects or f"covers the range; {_UNKNOWN}"
    trials = [chosen.trial(why, chosen=True, force=force)]
    for part in parts:
        if part is chosen:
            continue
        other = None if part.reading.threshold is None else part.reading.threshold / slope
        why = _below_driving(part, target) or (_UNKNOWN if other is None else f"detects no less than {other:.2g} N")
        trials.append(part.trial(why, force=other))
    return trials


@dataclass(frozen=True)
class ProcessSelection:
    """Selections by process, with the printer of each; ``left_out`` has the reasons for processes not searched.

    reliefs: for a target that no process meets, the changes that make a design possible, by process."""

    runs: dict[str, SelectionRun]
    profiles: dict[str, str]
    left_out: dict[str, str]
    reliefs: Mapping[str, Relief] = field(default_factory=dict)

    @property
    def best(self) -> list[tuple[str, SelectionRun]]:
        """Process and selection of each that has a design, in the order given."""
        return [(process, run) for process, run in self.runs.items() if run.answer.designs]

    @property
    def record(self) -> ProcessesRecord:
        """The selections as ``select`` prints them."""
        shown = {
            process: extended(
                ProcessRecord, selected(run, self.reliefs.get(process, NO_RELIEF)), profile=self.profiles[process]
            )
            for process, run in self.runs.items()
        }
        return ProcessesRecord(bool(self.best), shown, self.left_out)


def select_processes(
    target: Target,
    where: str,
    library: Library | None = None,
    *,
    progress: Callable[[int, int, str], None] = lambda done, total, step: None,
) -> ProcessSelection:
    """Search a target once for each of its ``setting.processes``. Raises InputError as `select` does.

    A process takes the base's printer if that is of the process, else its first that makes an elastomer; resins that
    the target names are searched only in the processes that make them.
    """
    library = CachedLibrary((library or Library.default()).folders)
    names = _named(target, library)
    with named_by_target(target, where):
        usual = settled_base(target, setting_changes(target, library), library).print.profile
    runs, profiles, left_out = {}, {}, {}
    for number, process in enumerate(names):
        offered = profile_of(process, target, library, usual)
        if offered is None:
            left_out[process] = _unmade(process, target, library)
            continue
        profiles[process], resins = offered

        def report(step: str, process: str = process, before: int = number * len(STEPS)) -> None:
            progress(before + STEPS.index(step), len(names) * len(STEPS), f"{process}, {step}")

        one = _of(target, process, profiles[process], resins)
        runs[process] = select(one, where, library, written=1, progress=report)
    return ProcessSelection(runs, profiles, left_out)


def _named(target: Target, library: Library) -> list[str]:
    """Processes of a target, each once; for "any" all processes that make an elastomer."""
    names = list(dict.fromkeys(target.setting.processes or ()))
    if names == ["any"]:
        free = target.model_copy(update={"given": target.given.model_copy(update={"materials": None})})
        return [process for process in get_args(Process) if profile_of(process, free, library) is not None]
    return [str(process) for process in names]


_Offer = tuple[str, list[str] | None]


def profile_of(process: str, target: Target, library: Library, usual: str = "") -> _Offer | None:
    """Printer of a process that is on the shelf and makes one of the resins (``usual`` if it does), and those of the
    named resins that it makes (None if none is named); None without such a printer."""
    resins, shelf = target.given.materials, target.have
    printers = {name: one for name, one in library.all("printers", Printer).items() if shelf.holds("printers", name)}
    names = resins or [name for name in library.all("materials", Material) if shelf.holds("materials", name)]
    loaded = {name: library.load("materials", name, key="given.materials") for name in names}
    for name in sorted(printers, key=lambda name: name != usual):
        makes = [each for each, one in loaded.items() if one.kind == "elastomer" and printers[name].mode_for(one)]
        if printers[name].process == process and makes:
            return name, makes if resins else None
    return None


def offers(base: ResolvedDesign, target: Target, library: Library, *, others: bool = False) -> list[str]:
    """Other printers of the base's process that make one of the resins named, or an elastomer if none is, but none that
    differs from one before it in tray and pace alone; with ``others`` the other processes that have such a printer."""
    here = base.printer.process
    if others:
        processes = (process for process in get_args(Process) if process != here)
        return [process for process in processes if profile_of(process, target, library) is not None]
    materials = library.all("materials", Material)
    offered = target.given.materials or [name for name in materials if target.have.holds("materials", name)]
    soft = [name for name in offered if materials[name].kind == "elastomer"]

    def made(printer: Printer) -> set[str]:
        return {name for name in soft if printer.mode_for(materials[name]) is not None}

    known = {base.design.print.profile: (made(base.printer), base.printer.smallest)}
    for name, printer in library.readable("printers", Printer).items():
        makes, fit = made(printer), printer.process == here and target.have.holds("printers", name)
        if fit and makes and not any(makes <= had and printer.smallest == sizes for had, sizes in known.values()):
            known[name] = makes, printer.smallest
    return list(known)[1:]


def on_process(target: Target, process: str, library: Library) -> Target:
    """The target on a printer that makes its resins by a process; unchanged if none does."""
    offered = profile_of(process, target, library)
    return target if offered is None else _of(target, process, *offered)


def _unmade(process: str, target: Target, library: Library) -> str:
    """Reason why no printer of a process makes the target's resins; one whose file lacks [casting] is named first."""
    every, shelf = library.readable("printers", Printer), target.have
    printers = {name: one for name, one in every.items() if one.process == process}
    on_shelf = [one for name, one in printers.items() if shelf.holds("printers", name)]
    if printers and not on_shelf:
        return f"{' or '.join(printers)} is not on the shelf, which has {', '.join(shelf.printers or ())}"
    resins = target.given.materials or shelf.materials or ()
    for name in resins:
        material: Material = library.load("materials", name, key="given.materials")
        casts = next((one for one in on_shelf if casting_missing(one, material)), None)
        if casts is not None:
            return str(uncast(casts, material, str(library.paths("materials")[name])))
    return f"no profile of it makes {' or '.join(resins or ['an elastomer'])}"


def _of(target: Target, process: str, profile: str, resins: list[str] | None) -> Target:
    """The target on one printer, with its resins."""
    changes: dict[str, Any] = {"profile": profile, "processes": None}
    if process == "casting":
        # What the target sets comes after it.
        changes["assignments"] = [f"connector.seat={CAST_SEAT}", *target.setting.assignments]
    given = target.given.model_copy(update={"materials": resins})
    return target.model_copy(update={"setting": target.setting.model_copy(update=changes), "given": given})
