"""Computation of a sweep: a chunk of points in, a list of records out; in this process, in others, or on a cluster."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from pneutouch import __version__
from pneutouch.arrays import Index
from pneutouch.catalogue import KINDS, DesignSource, Library, load_scene
from pneutouch.catalogue.library import CachedLibrary, compared
from pneutouch.errors import InputError, PneutouchError, StatedPressureError
from pneutouch.evaluation.evaluate import DrawnScene, Evaluation, PredictionOptions, drawn, evaluate_drawn
from pneutouch.evaluation.result import MODEL_DIGITS, NOTHING, by_model, rating_record
from pneutouch.mechanics.models.choice import USUAL, model_named
from pneutouch.mechanics.models.interface import Answered
from pneutouch.mechanics.rating import Rating, ratings
from pneutouch.output.files import digest, json_bytes
from pneutouch.spec.contact import LYING
from pneutouch.spec.design import CALIBRATION, NO_CALIBRATION, DesignFile
from pneutouch.spec.fields import declaration, table_of
from pneutouch.spec.toml_text import toml_text
from pneutouch.units import KPA
from pneutouch.wording import rounded
from pneutouch.workflows.sweep.grid import FILLINGS, PRESSURES, Settings, SweepPlan
from pneutouch.workflows.sweep.variables import Interval, point_values, sensitivity_intervals, state_values


@dataclass(frozen=True, slots=True)
class SweepPoint:
    """One design of a sweep: its number, the fields that it changes, and its driving pressures (kPa, ascending)."""

    index: int
    settings: Settings
    driving_pressures_kPa: tuple[float, ...]


@dataclass(frozen=True)
class SweepStudy:
    """A checked plan. ``base`` is the design file alone; ``files`` (text by path) is a library of all files that points
    name.

    Points are computed from ``files`` and not from the library: a material that is edited during a sweep changes
    nothing, and a machine of a cluster needs no copy of the user's folder. ``fingerprint`` is the SHA-256 of all
    inputs.
    """

    plan: SweepPlan
    name: str
    base: DesignFile
    files: dict[str, str]
    fingerprint: str

    @cached_property
    def pressures_kPa(self) -> list[float]:
        """Driving pressures that any point has, ascending."""
        # Those of a grid are alike: they are no axis of it.
        points = range(self.plan.count) if self.plan.points else range(1)
        return sorted({pressure_kPa for i in points for pressure_kPa in self.point(i).driving_pressures_kPa})

    def point(self, index: int) -> SweepPoint:
        """The point with number ``index``."""
        settings = self.plan.overrides(index)
        given = settings.pop(PRESSURES, self.base.pneumatics.driving_pressures_kPa)
        assert isinstance(given, list)
        return SweepPoint(index, settings, tuple(sorted(float(p) for p in given)))


def study(plan: SweepPlan, library: Library, *, tried: bool = True) -> SweepStudy:
    """Resolve and check a plan. Raises InputError that names file, key and value.

    A value that is impossible at every point is an error, if points are ``tried``. An impossible combination, such as
    a thick wall on a small radius in one corner of a grid, is a result: the dataset records it as refused.
    """
    library = CachedLibrary(library.folders)
    source = DesignSource.of(plan.design, library)
    base = source.changed({})
    _check_fillings(plan, base)
    if tried:
        _check(plan, library)
    plan = replace(plan, model=_model(plan, base))
    files, things = {f"designs/{source.name}.toml": toml_text(source.content)}, {}
    names = _names(plan, base)
    # A design that names no tube takes one of its port's.
    names |= {("tubes", tube) for kind, name in names if kind == "ports" for tube in library.load(kind, name).tubes}
    if plan.model != "membrane":
        # The uncertainty takes the model's error from every resin that was measured.
        printers = [library.load(kind, name) for kind, name in names if kind == "printers"]
        names |= {("materials", name) for printer in printers for name in compared(library, printer)}
    for kind, name in sorted(names):
        # Loading refuses what is no plain file.
        things[f"{kind}/{name}"] = library.load(kind, name).model_dump(mode="json")
        files[f"{KINDS[kind].folder}/{name}.toml"] = library.paths(kind)[name].read_text(encoding="utf-8-sig")
    facts = {
        "version": __version__,
        "model": plan.model,
        "closure": plan.closure,
        "clamp": plan.clamp,
        "name": source.name,
        "design": base.model_dump(mode="json"),
        "things": things,
        "settings": plan.settings,
        "axes": [[axis.key, axis.values] for axis in plan.axes],
        "points": plan.points,
    }
    return SweepStudy(plan, source.name, base, files, digest(json_bytes(facts)))


def _check_fillings(plan: SweepPlan, base: DesignFile) -> None:
    """Raise InputError for a plan with several states by filling a point: the dataset holds one."""
    problem = "a point of a sweep has one state by injected gas or apex height"
    for index in range(plan.count) if plan.points else range(1):
        settings = plan.overrides(index)
        stated = {key: settings.get(key, getattr(base.pneumatics, key.partition(".")[2])) for key in FILLINGS}
        given = {key: values for key, values in stated.items() if values}
        if len(given) > 1:
            first, second = given
            raise InputError(problem, file=plan.where, key=second, remedy=f"give either it or {first}")
        for key, values in given.items():
            if isinstance(values, list) and len(values) > 1:
                over = f"{key}={','.join(map(str, values))}"
                raise InputError(
                    problem, file=plan.where, key=key, value=values, remedy=f"vary it, as by `over` {over}"
                )


def _model(plan: SweepPlan, base: DesignFile) -> str:
    """Model of a plan; if it names none, the usual one of all points, or USUAL if the points differ in that."""
    if plan.model != USUAL:
        return plan.model
    contact = base.contact
    keys: dict[str, Any] = {f"contact.{key}": getattr(contact, key) for key in ("offset_mm", "tilt_deg", "shear_mm")}
    keys |= {"contact.object": contact.object}
    if not any(_off_axis(v) for key, usual in keys.items() for v in _chosen(plan, key, plan.settings.get(key, usual))):
        return "solid"
    points = (plan.overrides(index) for index in range(plan.count))
    off_axis = (any(_off_axis(point.get(key, usual)) for key, usual in keys.items()) for point in points)
    return "harmonic" if all(off_axis) else USUAL


def _off_axis(value: Any) -> bool:
    """True if an offset, a tilt, a shear or an object puts the contact off the axis."""
    return value in LYING if isinstance(value, str) else bool(value)


def _names(plan: SweepPlan, base: DesignFile) -> set[tuple[str, str]]:
    """Kind and name of every profile that a point of the sweep may name."""
    names: set[tuple[str, str]] = set()
    for table_name in DesignFile.model_fields:
        table = table_of(DesignFile, table_name)
        if table is None:
            continue
        for name in table.model_fields:
            kind, key = declaration(table, name).registry, f"{table_name}.{name}"
            if kind is not None:
                given = plan.settings.get(key, getattr(getattr(base, table_name), name))
                names |= {(kind, word) for word in _chosen(plan, key, given) if word is not None}
    calibration = plan.settings.get(CALIBRATION, base.calibration_name)
    return names if calibration in (None, NO_CALIBRATION) else names | {("calibrations", str(calibration))}


def _chosen(plan: SweepPlan, key: str, default: Any) -> list[Any]:
    """Values that a field has at any point; ``default`` for points that do not set it."""
    for axis in plan.axes:
        if axis.key == key:
            return list(axis.values)
    return [point.get(key, default) for point in plan.points] or [default]


def _check(plan: SweepPlan, library: Library) -> None:
    """Raise InputError if a value fits no point: tried first on a diagonal through all values, then by value."""
    if plan.points:
        for index, point in enumerate(plan.points):
            fault = _fault(plan, index, library)
            if fault:
                raise InputError(f"point[{index}] = {point}: {fault}", file=plan.where)
        return
    strides = [math.prod(plan.shape[k + 1 :]) for k in range(len(plan.axes))]
    fits: set[tuple[int, int]] = set()
    for step in range(max(plan.shape)):
        place = [step % length for length in plan.shape]
        if _fault(plan, sum(p * s for p, s in zip(place, strides, strict=True)), library) is None:
            fits |= set(enumerate(place))
    for k, axis in enumerate(plan.axes):
        for position, value in enumerate(axis.values):
            if (k, position) not in fits:
                indices = (i for i in range(plan.count) if i // strides[k] % plan.shape[k] == position)
                fault = _common_fault(plan, indices, library)
                if fault:
                    same = fault.key == axis.key
                    problem = f"no point of the sweep can have it: {fault.problem if same else fault}"
                    remedy = fault.remedy if same else None
                    raise InputError(problem, file=plan.where, key=axis.key, value=value, remedy=remedy)


def _common_fault(plan: SweepPlan, indices: Iterable[int], library: Library) -> InputError | None:
    """First error of these points; None if one of them is possible."""
    first = None
    for index in indices:
        fault = _fault(plan, index, library)
        if fault is None:
            return None
        first = first or fault
    return first


def _fault(plan: SweepPlan, index: int, library: Library) -> InputError | None:
    """Error of a point that is no possible design; None if it is one."""
    try:
        load_scene(plan.design, plan.overrides(index), library)
    except InputError as error:
        return error
    return None


CHUNK_POINTS = {"membrane": 32, "atlas": 128, "auto": 32, "solid": 8}
"""Number of points in a chunk by model (others: 1): a second or two of work, so that a stop or a slow machine costs
little. The atlas answers them together; in the solid the paths of one point guide those of the next."""


Record = dict[str, Any]
"""A finished point as plain data: ``point`` (its number), ``states`` by ascending driving pressure, ``values``."""


@dataclass(frozen=True, slots=True)
class SweepChunk:
    """Points that are computed together, with the name of their design and the options."""

    points: tuple[SweepPoint, ...]
    design: str
    options: PredictionOptions


def chunks(study: SweepStudy, indices: Index | Sequence[int]) -> Iterator[SweepChunk]:
    """Chunks that hold one of these numbers: cut alike whatever is missing, so that the bytes stay the same."""
    plan, size = study.plan, CHUNK_POINTS.get(study.plan.model, 1)
    options = PredictionOptions(plan.model, plan.closure, plan.clamp)
    for part in np.unique(np.asarray(indices) // size):
        numbers = range(int(part) * size, min((int(part) + 1) * size, plan.count))
        yield SweepChunk(tuple(map(study.point, numbers)), study.name, options)


def unpack(files: dict[str, str], folder: Path) -> None:
    """Write a study's files into a folder, where `compute` reads them."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def compute(chunk: SweepChunk, folder: Path) -> list[Record]:
    """Predict every point of a chunk from the files in ``folder``; a point that cannot be predicted has a record too.

    Driving pressures beyond the limit are refused one by one, and the others are predicted.
    """
    library = CachedLibrary((folder,))
    source = DesignSource.of(chunk.design, library)
    works = [_PointWork(point, point) for point in chunk.points]
    left = works
    while left:
        drawn_scenes = [_tried(partial(_drawn, source, work.left, chunk.options, library)) for work in left]
        for work, scene, answers in zip(left, drawn_scenes, _answers(drawn_scenes, chunk.options.model), strict=True):
            work.take(scene if isinstance(scene, Exception) else _tried(partial(_evaluated, scene, answers, library)))
        left = [work for work in left if work.result is None and work.left.driving_pressures_kPa]
    values = iter(_values([work.result for work in works if isinstance(work.result, Evaluation)]))
    return [
        work.record(next(values) if isinstance(work.result, Evaluation) else work.result, library) for work in works
    ]


@dataclass
class _PointWork:
    """A point in progress: the part left to compute, the limits met, each for a number of pressures, and the result."""

    point: SweepPoint
    left: SweepPoint
    beyond: list[tuple[StatedPressureError, int]] = field(default_factory=list)
    result: Evaluation | Exception | None = None

    def take(self, outcome: Evaluation | Exception) -> None:
        """Keep an outcome; for driving pressures beyond the limit, the others are left to be computed again."""
        if not isinstance(outcome, StatedPressureError):
            self.result = outcome
            return
        pressures_kPa = self.left.driving_pressures_kPa
        if outcome.pressure < 0.0:
            kept_kPa = [p for p in pressures_kPa[1:] if p * KPA > outcome.limit]
        else:
            kept_kPa = [p for p in pressures_kPa[:-1] if p * KPA < min(outcome.limit, outcome.pressure)]
        self.beyond.append((outcome, len(pressures_kPa) - len(kept_kPa)))
        self.left = replace(self.left, driving_pressures_kPa=tuple(kept_kPa))

    def record(self, outcome: "_Values | Exception | None", library: Library) -> Record:
        """Record of the point, as plain data."""
        states: list[dict[str, Any]] = []
        values: dict[str, Any] = {}
        refused: list[dict[str, Any]] = []
        buckled: list[dict[str, Any]] = []
        for error, count in self.beyond:
            if error.limit < 0.0:
                text = f"the dome buckles in the vacuum: at least {error.limit / KPA:.2f} kPa"
                buckled += _stopped("refused", text, count, library)
                continue
            text = f"driving pressure beyond the limit point, where the dome snaps: at most {error.limit / KPA:.2f} kPa"
            refused += _stopped("refused", text, count, library)
            values = {"limit_point_kPa": float(f"{error.limit / KPA:.12g}")}
        if isinstance(outcome, Exception):
            states = _failure(outcome, len(self.left.driving_pressures_kPa), library)
        elif outcome is not None:
            states, values = outcome
        return {"point": self.point.index, "states": buckled + states + refused, "values": values}


_Values = tuple[list[dict[str, Any]], dict[str, Any]]
"""Values of a point's states, and of the point."""

_T = TypeVar("_T")


def _tried(work: Callable[[], _T]) -> _T | Exception:
    """Result of ``work`` or its error, as a point that fails must not cost the others, perhaps hours of work."""
    try:
        return work()
    except (MemoryError, OSError):
        raise
    except Exception as error:
        return error


def _drawn(source: DesignSource, point: SweepPoint, options: PredictionOptions, library: Library) -> DrawnScene:
    changes = {**point.settings, PRESSURES: list(point.driving_pressures_kPa)}
    return drawn(load_scene(source, changes, library), options)


def _answers(scenes: Sequence[DrawnScene | Exception], model: str) -> list[dict[str, Answered]]:
    """Answers of atlas or solid, under its name, for the scenes that it covers, computed together; empty for others."""
    found: list[dict[str, Answered]] = [{} for _ in scenes]
    if model not in ("atlas", "auto", "solid"):
        return found
    together = model_named("solid" if model == "solid" else "atlas")
    covered = {
        row: one for row, one in enumerate(scenes) if isinstance(one, DrawnScene) and not together.covers(one.sensor)
    }
    sensors = [one.sensor for one in covered.values()]
    pressures = [np.array(one.scene.design.pneumatics.driving_pressures_kPa) * KPA for one in covered.values()]
    for row, answer in zip(covered, together.answer(sensors, pressures), strict=True):
        found[row] = {together.name: answer}
    return found


def _evaluated(scene: DrawnScene, answers: dict[str, Answered], library: Library) -> Evaluation:
    return evaluate_drawn(scene, partial(compared, library, scene.scene.printer), answers)


def _values(evaluations: Sequence[Evaluation]) -> list[_Values | Exception]:
    """Values of every evaluation, or its error; intervals are computed in one pass, and one by one if that fails."""
    every = _tried(lambda: [*zip(evaluations, sensitivity_intervals(evaluations), _ratings(evaluations), strict=True)])
    if not isinstance(every, Exception):
        return [_tried(partial(_of_evaluation, *known)) for known in every]
    return [every] if len(evaluations) == 1 else [one for each in evaluations for one in _values([each])]


def _ratings(evaluations: Sequence[Evaluation]) -> list[Rating]:
    """Rated pressures by the limits of each prediction's model, in one pass for all of one resin and printer."""
    alike: dict[tuple[Any, ...], list[int]] = {}
    for k, one in enumerate(evaluations):
        known = id(one.scene.membrane_material), id(one.scene.printer), id(one.scene.calibration)
        alike.setdefault((abs(one.prediction.error_estimate.limit_pressure_relative), *known), []).append(k)
    found: dict[int, Rating] = {}
    for (error, *_), rows in alike.items():
        some = [evaluations[k] for k in rows]
        scene = some[0].scene
        pairs = [one.prediction.limits for one in some], [one.sensor for one in some]
        rated = ratings(*pairs, scene.membrane_material, scene.printer, scene.calibration, error)
        found.update(zip(rows, rated, strict=True))
    return [found[k] for k in range(len(evaluations))]


def _of_evaluation(evaluation: Evaluation, intervals: list[Interval], rating: Rating) -> _Values:
    record = by_model(evaluation.prediction, curves=False)
    states = [state_values(*pair) for pair in zip(record.states, intervals, strict=True)]
    point = point_values(replace(record, rating=rating_record(rating, [])))
    return rounded((states, point), MODEL_DIGITS, NOTHING)


def _failure(error: Exception, count: int, library: Library) -> list[dict[str, Any]]:
    if isinstance(error, PneutouchError):
        return _stopped("refused" if isinstance(error, InputError) else "failed", str(error), count, library)
    text = f"internal fault ({type(error).__name__}: {error}); please report it with the design"
    return _stopped("failed", text, count, library)


def _stopped(status: str, message: str, count: int, library: Library) -> list[dict[str, Any]]:
    """States without figures. Messages name files without their folder, which is a temporary one."""
    folder = f"{library.folders[0]}/"
    return [{"status": status, "message": message.replace(folder, "")} for _ in range(count)]
