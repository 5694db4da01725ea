"""The work itself: a chunk of points in, a list of records out. Runs in this process, in others, or on a cluster.

A model that takes many points at once has its place in ``compute``.

A plan with every name in it resolved: checked before any work starts, and carrying all that the work reads.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pneutouch import __version__
from pneutouch.catalogue import KINDS, DesignSource, Library, load_scene
from pneutouch.catalogue.library import CachedLibrary, elastomers
from pneutouch.errors import InputError, PneutouchError, StatedPressureError
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.evaluation.result import predicted
from pneutouch.mechanics.models.choice import USUAL
from pneutouch.output.files import digest, json_bytes
from pneutouch.results.record import plain
from pneutouch.spec.contact import LYING
from pneutouch.spec.design import CALIBRATION, NO_CALIBRATION, DesignFile
from pneutouch.spec.fields import declaration, table_of
from pneutouch.spec.toml_text import toml_text
from pneutouch.units import KPA
from pneutouch.workflows.sweep.grid import PRESSURES, Settings, SweepPlan
from pneutouch.workflows.sweep.variables import point_values, state_values


@dataclass(frozen=True, slots=True)
class SweepPoint:
    """One design of a sweep: its number, the fields that it changes, and its driving pressures in kPa."""

    index: int
    settings: Settings
    driving_pressures_kPa: tuple[float, ...]


@dataclass(frozen=True)
class SweepStudy:
    """A checked plan. ``base`` is the design file alone; ``files`` (path to text) is a library of the files that it
    names.

    The work reads ``files`` and not the library: a sweep does not notice when a user edits a material while it
    runs, and a machine of a cluster needs no copy of the user's folder. ``fingerprint`` is the SHA-256 of all that
    the figures follow from.
    """

    plan: SweepPlan
    name: str
    base: DesignFile
    files: dict[str, str]
    fingerprint: str

    def point(self, index: int) -> SweepPoint:
        """The point of a number."""
        settings = self.plan.overrides(index)
        given = settings.pop(PRESSURES, self.base.pneumatics.driving_pressures_kPa)
        assert isinstance(given, list)
        return SweepPoint(index, settings, tuple(sorted(float(p) for p in given)))


def study(plan: SweepPlan, library: Library) -> SweepStudy:
    """Resolve and check a plan; raises InputError naming file, key and value.

    A value that fits no point at all is a mistake. A combination that does not fit, such as a thick wall on a
    small radius in one corner of a grid, is a result: the dataset records it as refused.
    """
    library = CachedLibrary(library.folders)
    source = DesignSource.of(plan.design, library)
    base = source.changed({})
    _check(plan, library)
    plan = replace(plan, model=_model(plan, base))
    files, things = {f"designs/{source.name}.toml": toml_text(source.content)}, {}
    names = _names(plan, base)
    # A design that names no tube takes one of its port's.
    names |= {("tubes", tube) for kind, name in names if kind == "ports" for tube in library.load(kind, name).tubes}
    if plan.model != "membrane":
        # The uncertainty takes the model's error from every resin that was measured.
        casting = any(library.load("printers", name).is_casting for kind, name in names if kind == "printers")
        names |= {("materials", name) for name in elastomers(library, casting)}
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


def _model(plan: SweepPlan, base: DesignFile) -> str:
    """The model of a plan; where it names none, the usual one of all points, or USUAL where the points differ."""
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
    """True if an offset, a tilt or an object puts the contact off the axis."""
    return value in LYING if isinstance(value, str) else bool(value)


def _names(plan: SweepPlan, base: DesignFile) -> set[tuple[str, str]]:
    """Kind and name of everything that a point of the sweep may name."""
    names: set[tuple[str, str]] = set()
    for table_name in DesignFile.model_fields:
        table = table_of(DesignFile, table_name)
        if table is None:
            continue
        for field in table.model_fields:
            kind, key = declaration(table, field).registry, f"{table_name}.{field}"
            if kind is not None:
                given = plan.settings.get(key, getattr(getattr(base, table_name), field))
                names |= {(kind, name) for name in _chosen(plan, key, given) if name is not None}
    calibration = plan.settings.get(CALIBRATION, base.calibration_name)
    return names if calibration in (None, NO_CALIBRATION) else names | {("calibrations", str(calibration))}


def _chosen(plan: SweepPlan, key: str, default: Any) -> list[Any]:
    """The values that a field has at any point; ``default`` where a point does not set it."""
    for axis in plan.axes:
        if axis.key == key:
            return list(axis.values)
    return [point.get(key, default) for point in plan.points] or [default]


def _check(plan: SweepPlan, library: Library) -> None:
    """Raise InputError where a value fits no point: first down a diagonal that passes every value, then by value."""
    if plan.points:
        for index, point in enumerate(plan.points):
            fault = _fault(plan, index, library)
            if fault:
                raise InputError(f"point[{index}] = {point}: {fault}", file=plan.where)
        return
    strides = [_stride(plan.shape, k) for k in range(len(plan.axes))]
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


def _stride(shape: tuple[int, ...], k: int) -> int:
    stride = 1
    for length in shape[k + 1 :]:
        stride *= length
    return stride


def _common_fault(plan: SweepPlan, indices: Iterable[int], library: Library) -> InputError | None:
    """Reason why none of the points is possible: the first error, or None if one point is possible."""
    first = None
    for index in indices:
        fault = _fault(plan, index, library)
        if fault is None:
            return None
        first = first or fault
    return first


def _fault(plan: SweepPlan, index: int, library: Library) -> InputError | None:
    """Reason why a point is not a design, or None."""
    try:
        load_scene(plan.design, plan.overrides(index), library)
    except InputError as error:
        return error
    return None


CHUNK_POINTS = {"membrane": 32}
"""Points handed out at once: about half a second of work, so that a stop loses and a slow machine delays little."""

Record = dict[str, Any]
"""A finished point as plain data: ``point`` (its number), ``states`` in order of driving pressure, ``values``."""


@dataclass(frozen=True, slots=True)
class SweepChunk:
    """Points to compute alike: which design and model."""

    points: tuple[SweepPoint, ...]
    design: str
    model: str
    closure: str
    clamp: str


def chunks(study: SweepStudy, indices: list[int]) -> list[SweepChunk]:
    """The points of these numbers, cut into chunks."""
    plan, size = study.plan, CHUNK_POINTS.get(study.plan.model, 1)
    return [
        SweepChunk(
            tuple(study.point(i) for i in indices[start : start + size]),
            study.name,
            plan.model,
            plan.closure,
            plan.clamp,
        )
        for start in range(0, len(indices), size)
    ]


def unpack(files: dict[str, str], folder: Path) -> None:
    """Write a study's files where ``compute`` finds them."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def compute(chunk: SweepChunk, folder: Path) -> list[Record]:
    """Predict every point of a chunk from the files in ``folder``; a point that cannot be is a record too."""
    library = CachedLibrary((folder,))
    return [_record(chunk, point, library) for point in chunk.points]


def _record(chunk: SweepChunk, point: SweepPoint, library: Library) -> Record:
    """One point. Driving pressures beyond the limit are refused one by one, and the rest is predicted."""
    left = point
    states: list[dict[str, Any]] = []
    refused: list[dict[str, Any]] = []
    values: dict[str, Any] = {}
    while left.driving_pressures_kPa:
        try:
            states, values = _predicted(chunk, left, library)
            break
        except StatedPressureError as beyond:
            kept_kPa = [p for p in left.driving_pressures_kPa[:-1] if p * KPA < min(beyond.limit, beyond.pressure)]
            text = (
                f"driving pressure beyond the limit point, where the dome snaps: at most {beyond.limit / KPA:.2f} kPa"
            )
            refused += _stopped("refused", text, len(left.driving_pressures_kPa) - len(kept_kPa), library)
            values = {"limit_point_kPa": float(f"{beyond.limit / KPA:.12g}")}
            left = replace(left, driving_pressures_kPa=tuple(kept_kPa))
        except PneutouchError as error:
            status = "refused" if isinstance(error, InputError) else "failed"
            states = _stopped(status, str(error), len(left.driving_pressures_kPa), library)
            break
        except (MemoryError, OSError):
            raise
        except Exception as error:
            # One point that meets a fault of ours must not cost the others, which may be hours of work.
            text = f"internal fault ({type(error).__name__}: {error}); please report it with the design"
            states = _stopped("failed", text, len(left.driving_pressures_kPa), library)
            break
    return {"point": point.index, "states": states + refused, "values": values}


def _predicted(chunk: SweepChunk, point: SweepPoint, library: Library) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    changes = {**point.settings, PRESSURES: list(point.driving_pressures_kPa)}
    evaluation = evaluate(
        chunk.design, changes, model=chunk.model, closure=chunk.closure, clamp=chunk.clamp, library=library
    )
    prediction = plain(predicted(evaluation))
    return [state_values(state) for state in prediction["states"]], point_values(prediction)


def _stopped(status: str, message: str, count: int, library: Library) -> list[dict[str, Any]]:
    """States without figures. The folder of the files is a temporary one, so messages name the file alone."""
    folder = f"{library.folders[0]}/"
    return [{"status": status, "message": message.replace(folder, "")} for _ in range(count)]
