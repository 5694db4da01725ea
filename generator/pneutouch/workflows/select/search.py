"""Answer to a target of any kind: ranked designs, with a gauge chosen if it is left open, a grade, or the best of each
process or shape.

For a target that no design meets: changes of one thing outside its requirements, each of which alone is enough."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

from pneutouch.catalogue import Library, ResolvedDesign
from pneutouch.catalogue.library import CachedLibrary
from pneutouch.errors import InputError, PneutouchError
from pneutouch.mechanics.gauge_reading import gauge_reading
from pneutouch.results.selection import GradedRecord, ProcessesRecord, SelectionRecord, ShapesRecord
from pneutouch.selection import Candidate
from pneutouch.spec.fields import declaration
from pneutouch.spec.gauge import Gauge
from pneutouch.spec.target import Setting, Target
from pneutouch.workflows.select.base import base_scene
from pneutouch.workflows.select.checks import base_sensor, connector_fit, dead_volume, other_contact, write_assigned
from pneutouch.workflows.select.document import Relief, WorkingChange, graded, relaxed, selected
from pneutouch.workflows.select.graded import GradedSelectionRun, select_graded
from pneutouch.workflows.select.processes import ProcessSelection, offers, on_process, select, select_processes
from pneutouch.workflows.select.select import STEPS, SelectionRun, found, passing
from pneutouch.workflows.select.shapes import ShapeSelection, select_shapes

SelectedRecord = SelectionRecord | GradedRecord | ProcessesRecord | ShapesRecord
"""Record that ``select`` prints, by the kind of its target."""


@dataclass(frozen=True)
class FoundChoice:
    """A design that meets a target: its rank, process or shape, its base, and the changes that make the base it."""

    label: str
    base: ResolvedDesign
    assignments: list[str]

    def write(self, name: str, folder: Path, *, overwrite: bool = False) -> Path:
        """Write the design as ``folder/name.toml`` for ``build``; replace a file only if ``overwrite``."""
        return write_assigned(self.base.design, self.assignments, name, folder, overwrite=overwrite)


@dataclass(frozen=True)
class TargetAnswer:
    """An answer: its record; the designs that meet the target, best first; why ``check`` rejects a grade that meets it;
    without designs of a single process, what makes one possible."""

    run: SelectionRun | GradedSelectionRun | ProcessSelection | ShapeSelection
    record: SelectedRecord
    choices: tuple[FoundChoice, ...]
    rejected: str | None = None
    relief: Relief = Relief()  # noqa: RUF009 (a tuple)

    def pick(self, rank: int) -> FoundChoice:
        """Design of a rank, or of a row over processes, counted from 1. Raises InputError if there is none."""
        if not 1 <= rank <= len(self.choices):
            raise InputError(f"must be from 1 to {len(self.choices)}", key="pick", value=rank)
        return self.choices[rank - 1]


def search(
    target: Target,
    where: str,
    library: Library | None = None,
    *,
    written: int | None = None,
    progress: Callable[[int, int, str], None] = lambda done, total, step: None,
) -> TargetAnswer:
    """Answer a target. Raises InputError if it names something unknown; ``where`` names the file in messages.

    The best design and that of rank ``written``, which is to be saved, pass the whole ``check``.
    """
    known = CachedLibrary((library or Library.default()).folders)
    if target.setting.processes is not None:
        over = select_processes(target, where, library, progress=progress)
        if not over.best:
            over = replace(over, reliefs={name: relief_of(run, target, known) for name, run in over.runs.items()})
        rows = tuple(FoundChoice(name, run.base, run.assignments(run.answer.designs[0])) for name, run in over.best)
        return TargetAnswer(over, over.record, rows)
    if target.setting.shapes is not None:
        shaped = select_shapes(target, where, library, progress=progress)
        best_of = tuple(FoundChoice(one.trial.shape, shaped.base, one.assignments) for one in shaped.designs)
        return TargetAnswer(shaped, shaped.record, best_of)
    if target.given.graded:
        grade = select_graded(
            target, where, library, lambda trial, done, most: progress(done, most, "searching grades")
        )
        best = (FoundChoice("1", grade.base, grade.assignments()),) if grade.passes else ()
        return TargetAnswer(grade, graded(grade), best, grade.rejected)
    steps = len(STEPS)
    run = select(target, where, library, written=written, progress=lambda s: progress(STEPS.index(s), steps, s))
    ranked = enumerate(run.answer.designs, start=1)
    choices = tuple(FoundChoice(str(rank), run.base, run.assignments(choice)) for rank, choice in ranked)
    if choices:
        return TargetAnswer(run, selected(run), choices)
    enough = relief_of(run, target, known, lambda what: progress(steps - 1, steps, what))
    return TargetAnswer(run, selected(run, enough), (), relief=enough)


class Change(NamedTuple):
    """A change of a field of the target, ``table.key``, to a value; for ``setting.assignments`` one more assignment."""

    field: str
    value: Any

    def of(self, target: Target, library: Library) -> Target:
        """The target with this change; another process comes with a printer that makes the target's resins by it."""
        table, _, key = self.field.partition(".")
        if key == "processes":
            return on_process(target, self.value[0], library)
        section = getattr(target, table)
        value = [*section.assignments, self.value] if key == "assignments" else self.value
        update = {key: value, **({"dead_volume_mL": None} if key == "tube_length_mm" else {})}
        return target.model_copy(update={table: section.model_copy(update=update)})


def relief_of(
    run: SelectionRun, asked: Target, library: Library, trying: Callable[[str], None] = lambda what: None
) -> Relief:
    """Changes that make a design possible for the target ``asked``; ``run`` is its search, by one process, without one.

    Each change and value was searched, and its best design passes ``check``; of tubes and dead volumes the value
    nearest to the target's own is given. None is tried if the solid searches another contact (minutes for each), or the
    gauge is open.
    """
    if run.gauges or (run.by_solid is not None and other_contact(run.sensor) is not None):
        return Relief()
    options, changes = {}, []
    near = [*filter(None, [run.answer.nearest]), *(each.best for each in run.answer.dropped)]
    for dropped in run.answer.dropped:
        # The best design of a coarse scan may lose a margin at round sizes.
        name, value = relaxed(run, dropped)
        if name is None or value is None:
            continue
        if _tried(Change(name, value).of(run.target, library), library, [dropped.best], thorough=True):
            options[dropped.requirement] = name, value
    for what, trials in _trials(run, asked, library):
        trying(f"another {what}")
        for change in trials:
            target = change.of(asked, library)
            if target.setting.processes is not None:
                target = on_process(target, run.base.printer.process, library)
            tried = _tried(target, library, near if change.field in _BEHIND_THE_CAVITY else [])
            if tried is None:
                continue
            best = tried.answer.designs[0]
            settled = {"wall_thickness_mm": float(best.pool.wall[0]), "inner_radius_mm": float(best.pool.radius[0])}
            found_value = {**settled, "materials": [best.resin.name]}.get(change.field.partition(".")[2], change.value)
            changes.append(WorkingChange(change.field, found_value, tried))
            break
    return Relief(changes, options)


_BEHIND_THE_CAVITY = ("setting.tube_length_mm", "setting.dead_volume_mL", "setting.assignments", "setting.gauge")
"""Fields whose changes are tried only with the resins of the nearest designs, in a fraction of the time."""


def _tried(target: Target, library: Library, near: Sequence[Candidate], thorough: bool = False) -> SelectionRun | None:
    """Selection for a changed target, only with the resins of ``near`` if there are some; None if no design meets the
    target and passes ``check``. Without ``thorough`` only the scan is searched."""
    names = sorted({choice.resin.name for choice in near if choice.resin.grade is None})
    if names:
        target = target.model_copy(update={"given": target.given.model_copy(update={"materials": names})})
    try:
        tried = passing(found(target, "a change", library, thorough=thorough), 1, library)
    except PneutouchError:
        return None  # The base cannot be drawn so.
    return tried if tried.answer.designs else None


def _trials(run: SelectionRun, asked: Target, library: Library) -> Iterator[tuple[str, list[Change]]]:
    """Things to change, each with its changes in the order in which they are tried; none without a nearest design."""
    given, searched = run.target.given, asked.setting.processes
    if run.rejected or run.answer.nearest is None:
        return
    yield _volumes(run)
    yield "port", [Change("setting.assignments", f"connector.port={name}") for name in _ports(run, library)]
    yield "gauge", [Change("setting.gauge", name) for name in _wider(run, library)]
    for key in ("wall_thickness_mm", "inner_radius_mm", "materials"):
        if getattr(given, key) is not None:
            what = "resin" if key == "materials" else key.removesuffix("_mm").replace("_", " ")
            yield what, [Change(f"given.{key}", None)]
    # With a process a profile contradicts the target, and with a profile a process.
    if searched is None:
        yield "printer", [Change("setting.profile", name) for name in offers(run.base, asked, library)]
    for process in offers(run.base, asked, library, others=True):
        if asked.setting.profile is not None:
            yield "process", [Change("setting.profile", on_process(asked, process, library).setting.profile)]
        elif process not in (searched or ()):
            yield "process", [Change("setting.processes", [process])]


_SHORTEST_MM = 20.0
"""Shortest tube that is tried, mm: a gauge right behind the connector."""
_SHARES = (0.5, 0.25, 0.1)
_MULTIPLES = (2.0, 4.0, 8.0)


def _volumes(run: SelectionRun) -> tuple[str, list[Change]]:
    """Less gas behind the cavity for a sensitivity that is not reached, more for one exceeded; with its name."""
    assert run.answer.nearest is not None
    wanted, pneumatics = run.problem.sensitivity, run.base.design.pneumatics
    more = wanted is not None and run.answer.nearest.pool.figures.sensitivity > wanted
    shares = _MULTIPLES if more else (*_SHARES, 0.0)
    what, key = ("tube", "tube_length_mm") if pneumatics.dead_volume_mL is None else ("dead volume", "dead_volume_mL")
    base, least = getattr(pneumatics, key), _SHORTEST_MM if what == "tube" else 0.0
    most = declaration(Setting, key).high or math.inf
    values = dict.fromkeys(min(max(float(f"{base * share:.2g}"), least), most) for share in shares)
    kept = [value for value in values if (value > base) == more and value != base]
    return what, [Change(f"setting.{key}", value) for value in kept]


def _wider(run: SelectionRun, library: Library) -> list[str]:
    """Name of the gauge that reads furthest, if that is further than the base's; else none."""
    ambient = run.sensor.gas.ambient_pressure
    gauges, have = library.all("gauges", Gauge), run.target.have
    limits = {name: gauge_reading(one, ambient).limit for name, one in gauges.items() if have.holds("gauges", name)}
    widest = max(limits, key=limits.__getitem__, default="")
    return [widest] if widest and limits[widest] > run.problem.gauge_limit else []


_PORTS = 3
"""Greatest number of ports that are tried."""


def _ports(run: SelectionRun, library: Library) -> list[str]:
    """Other ports, least gas first; or least diameter first, if footprint or space is exceeded."""
    nearest = run.answer.nearest
    assert nearest is not None
    radius, wall = nearest.pool.radius, nearest.pool.wall
    by_size = nearest.margins.get("footprint", 0.0) < 0.0 or nearest.margins.get("connector", 0.0) < 0.0
    keys: dict[str, float] = {}
    for name in library.paths("ports"):
        if name == run.base.design.connector.port or not run.target.have.holds("ports", name):
            continue
        change = Change("setting.assignments", f"connector.port={name}").of(run.target, library)
        try:
            scene = base_scene(change, run.base.where, library)
            volume = dead_volume(scene, base_sensor(scene))(radius)
            size = connector_fit(scene)(radius, wall).diameter
        except PneutouchError:
            continue
        keys[name] = float((size if by_size else volume)[0])
    return sorted(keys, key=keys.__getitem__)[:_PORTS]
