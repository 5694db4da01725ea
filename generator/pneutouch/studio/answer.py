"""Answers to the page: figures and drawing at once by the atlas, a moment later by the model that ``predict`` takes."""

import base64
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, TypeVar

import numpy as np

from pneutouch.api.prediction import Prediction
from pneutouch.api.results import CheckResult
from pneutouch.arrays import Array
from pneutouch.body import Body, Solid
from pneutouch.body.section import section_outline
from pneutouch.body.solid import corner_normals
from pneutouch.catalogue import DesignSource, Library, load_scene
from pneutouch.catalogue.library import compared
from pneutouch.evaluation.charts import curve, resin_curves, tuning
from pneutouch.evaluation.evaluate import Evaluation, PredictionOptions, evaluate_scene, sensor_of
from pneutouch.evaluation.result import by_model, rating_record
from pneutouch.evaluation.uncertainty import unknown
from pneutouch.mechanics import SensorState
from pneutouch.mechanics.models.choice import USUAL, outside
from pneutouch.parts import Assembly, assemble
from pneutouch.results.record import plain
from pneutouch.shape import key_of, own_sizes
from pneutouch.shape.dome import DomeShape
from pneutouch.shape.meridian import Meridian
from pneutouch.studio.form import Question
from pneutouch.units import KPA
from pneutouch.wording import rounded

Named = TypeVar("Named")

_DIGITS = 6


@dataclass(frozen=True, slots=True)
class PageLine:
    """Sensitivity over driving pressure, (n,) each, with the ends of its interval; None if they are not known."""

    driving_pressure_kPa: tuple[float, ...]
    sensitivity_kPa_per_N: tuple[float, ...]
    model: str = field(kw_only=True)
    low_kPa_per_N: tuple[float, ...] | None = None
    high_kPa_per_N: tuple[float, ...] | None = None


@dataclass(frozen=True, slots=True)
class ResinLine(PageLine):
    """The line of a resin, with the resin's title."""

    title: str = field(kw_only=True)


@dataclass(frozen=True, slots=True)
class PageCurves:
    """The line of the design, None if there is none, and those of all resins, None in a quick answer."""

    design: PageLine | None
    resins: tuple[ResinLine, ...] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class PredictedDesign:
    """The prediction as ``predict`` has it in JSON, None outside the atlas, and lines to draw."""

    prediction: Mapping[str, Any] | None
    curves: PageCurves | None


@dataclass(frozen=True, slots=True, kw_only=True)
class NamedDesign(PredictedDesign):
    """A design by its name, with the values of its file; ``sizes``: those of its shape by ``table.key``."""

    name: str
    title: str
    values: Mapping[str, Any]
    depth_mm: float
    sizes: Mapping[str, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class QuickAnswer(NamedDesign):
    """The answer of the atlas, without intervals; ``outside``: why it has none; ``version``: of the base's file."""

    version: str
    drawing: "DrawnDesign"
    outside: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class FullAnswer(NamedDesign):
    """The answer of the model that ``predict`` takes, with what ``check`` finds and the estimates of the print."""

    check: Mapping[str, Any]
    jobs: list[Mapping[str, Any]]
    walls: "list[PressedWall | None]"


class Answers:
    """Answers of the atlas on designs from ``bases``; it keeps the last design, whose intervals are asked for next."""

    def __init__(self, bases: Mapping[str, str], library: Library) -> None:
        self._bases, self._library = bases, library
        self._last: tuple[Question, Evaluation] | None = None

    def quick(self, question: Question) -> QuickAnswer:
        """Drawing; where the atlas answers prediction and curve, no intervals. Raises InputError at the field."""
        source, version = question.read(self._bases, self._library)
        scene = load_scene(source, {}, self._library)
        assembly = assemble(scene)
        sucked = scene.design.pneumatics.driving_pressures_kPa[0] < 0.0
        why = "a driving pressure is below ambient" if sucked else outside("atlas", sensor_of(assembly))
        drawing = _drawn_design(assembly)
        answer = partial(_named(QuickAnswer, source), version=version, drawing=drawing)
        if why is not None:
            return answer(outside=why, prediction=None, curves=None)
        resins = partial(compared, self._library, scene.printer)
        evaluation = evaluate_scene(scene, resins, PredictionOptions("atlas"))
        self._last = replace(question, version=version), evaluation
        pressures = [state.driving_pressure for state in evaluation.prediction.states]
        rating = rating_record(evaluation.rating, pressures)
        prediction = plain(replace(by_model(evaluation.prediction), rating=rating))
        drawn = curve(evaluation.sensor, _highest(evaluation), "this design")
        design = None
        if drawn is not None:
            design = PageLine(on_page(drawn.driving_pressure_kPa), on_page(drawn.sensitivity), model="atlas")
        return answer(outside=None, prediction=prediction, curves=PageCurves(design))

    def intervals(self, question: Question) -> PredictedDesign:
        """Prediction by the atlas with intervals, curve and band, and all resins. Raises InputError at the field."""
        source, version = question.read(self._bases, self._library)
        question = replace(question, version=version)
        if self._last is None or self._last[0] != question:
            scene = load_scene(source, {}, self._library)
            resins = partial(compared, self._library, scene.printer)
            self._last = question, evaluate_scene(scene, resins, PredictionOptions("atlas"))
        evaluation = self._last[1]
        return PredictedDesign(prediction=Prediction(evaluation).to_dict(), curves=_curves(evaluation))

    def view(self, question: Question) -> "ViewedDesign":
        """The bodies as meshes to look at. Raises InputError that names the field."""
        assembly = assemble(load_scene(question.source(self._bases, self._library), {}, self._library))
        return ViewedDesign([_mesh(solid.mesh(_TOLERANCE)) for solid in assembly.solids])


def full_answer(question: Question, bases: Mapping[str, str], library: Library) -> FullAnswer:
    """The answer of the model that ``predict`` takes by default.

    Raises PneutouchError if the design cannot work or cannot be computed.
    """
    source = question.source(bases, library)
    scene = load_scene(source, {}, library)
    resins = partial(compared, library, scene.printer)
    evaluation = evaluate_scene(scene, resins, PredictionOptions(USUAL))
    return _named(FullAnswer, source)(
        prediction=Prediction(evaluation).to_dict(),
        curves=_curves(evaluation),
        check=CheckResult(source.name, tuple(evaluation.findings)).to_dict(),
        jobs=plain(evaluation.estimates),
        walls=[_pressed_wall(state) for state in evaluation.prediction.states],
    )


def _named(kind: Callable[..., Named], source: DesignSource) -> partial[Named]:
    """Maker of an answer of a ``kind``, with name, title, values and depth of its design."""
    file = source.changed({})
    values = file.model_dump(mode="json", by_alias=True)
    dome = file.membrane.dome
    found = {f"membrane.{key_of(size)}": getattr(dome, size) for size in own_sizes(dome)}
    sizes = {key: size for key, size in found.items() if isinstance(size, float | int)}
    return partial(
        kind, name=source.name, title=file.document.title, values=values, depth_mm=file.depth_mm, sizes=sizes
    )


def _curves(evaluation: Evaluation) -> PageCurves:
    """Sensitivity over driving pressure of the design and of every resin."""
    return PageCurves(_banded(evaluation), _resin_lines(evaluation))


def _highest(evaluation: Evaluation) -> float:
    """Driving pressure up to which curves are drawn, MPa."""
    return max(evaluation.rating.pressure, evaluation.prediction.states[-1].driving_pressure)


def _banded(evaluation: Evaluation) -> PageLine | None:
    """Sensitivity of the design over driving pressure with its interval; None if the uncertainty is not known."""
    if unknown(evaluation.sensor, evaluation.prediction.model) is not None:
        return None
    drawn = tuning(evaluation, _highest(evaluation))
    if drawn is None:
        return None
    low, high = (None if end is None else on_page(end) for end in (drawn.low_kPa_per_N, drawn.high_kPa_per_N))
    chosen = drawn.chosen
    line = on_page(chosen.driving_pressure_kPa), on_page(chosen.sensitivity)
    return PageLine(*line, low, high, model="atlas")


def _resin_lines(evaluation: Evaluation) -> tuple[ResinLine, ...]:
    """Sensitivity over driving pressure of every resin."""
    prediction = evaluation.prediction
    resins = resin_curves(
        evaluation.sensor,
        evaluation.alike,
        _highest(evaluation),
        prediction.model,
        prediction.closure,
        prediction.states,
    )
    return tuple(
        ResinLine(on_page(one.driving_pressure_kPa), on_page(one.sensitivity), model=one.model, title=title)
        for title, one in resins.items()
    )


def on_page(values: Array) -> tuple[float, ...]:
    """Values (n,) of a curve as the page shows them, to `_DIGITS` significant digits."""
    return tuple(rounded(values.tolist(), _DIGITS))


_TOLERANCE = 0.02
"""Greatest distance of the drawn section, and of the meshes, from the exact surface, mm."""

_DRAWN_DIGITS = 3


@dataclass(frozen=True, slots=True)
class DrawnBody:
    """Closed loops, each a list x, z, x, z and so on in mm, where the plane y = 0 cuts a body."""

    name: str
    role: str
    material: str
    loops: list[list[float]]


@dataclass(frozen=True, slots=True)
class DrawnDesign:
    """The section through the bodies, with lengths in mm: size in x, y, z; ends in z; diameter of the plate; points
    (r, z) of the inner face and of the middle of the wall at which their labels point."""

    bodies: list[DrawnBody]
    inner_radius_mm: float
    wall_thickness_mm: float
    diameter_mm: float
    size_mm: list[float]
    low_mm: float
    high_mm: float
    inner_at_mm: list[float]
    wall_at_mm: list[float]


@dataclass(frozen=True, slots=True)
class ViewedBody:
    """A body as triangles: corners (float32, mm) and normals (int8, times 127), little-endian in base 64."""

    name: str
    colour: str
    corners: str
    normals: str


@dataclass(frozen=True, slots=True)
class ViewedDesign:
    """The bodies of a design as meshes to look at."""

    bodies: list[ViewedBody]


@dataclass(frozen=True, slots=True)
class PressedWall:
    """At every solved indentation the outline of the pressed wall, and the object: r, z, r, z and so on, mm."""

    driving_pressure_kPa: float
    indentation_mm: list[float]
    walls: list[list[float]]
    objects: list[list[float]]


def _drawn_design(assembly: Assembly) -> DrawnDesign:
    """The section of an assembly with its dimensions."""
    bodies = [
        DrawnBody(
            solid.name,
            solid.role,
            solid.material.label,
            [_flat(loop, _DRAWN_DIGITS) for loop in section_outline(solid, _TOLERANCE)],
        )
        for solid in assembly.solids
    ]
    layout = assembly.layout
    bounds = [_bounds(solid) for solid in assembly.solids]
    low, high = np.min([each[0] for each in bounds], axis=0), np.max([each[1] for each in bounds], axis=0)
    return DrawnDesign(
        bodies=bodies,
        inner_radius_mm=layout.inner_radius,
        wall_thickness_mm=layout.wall,
        diameter_mm=2 * layout.plate_radius,
        size_mm=[round(float(value), _DRAWN_DIGITS) for value in high - low],
        low_mm=round(float(low[2]), _DRAWN_DIGITS),
        high_mm=round(float(high[2]), _DRAWN_DIGITS),
        inner_at_mm=_labelled(layout.shape, _INNER_AT),
        wall_at_mm=_labelled(layout.shape, _WALL_AT),
    )


_INNER_AT, _WALL_AT = (0.6, 0.0), (0.7, 0.5)
"""Places at which labels point: share of the wall from the rim, and depth in it."""


def _labelled(shape: DomeShape, place: tuple[float, float]) -> list[float]:
    share, depth = place
    return [round(float(value), _DRAWN_DIGITS) for value in shape.points(np.array([share]), np.array([depth]))[0, 0]]


def _bounds(solid: Solid) -> Array:
    """Smallest and largest corner, shape (2, 3), mm; of the exact surface if nothing sits on a turned body."""
    if not isinstance(solid.base, Meridian) or solid.adds or solid.cuts:
        return solid.mesh(_TOLERANCE).bounds
    radius, low, high = solid.base.bounds()
    return np.array([(-radius, -radius, low), (radius, radius, high)])


def _mesh(body: Body) -> ViewedBody:
    normals = np.rint(127 * corner_normals(body)).astype("<i1")
    corners = base64.b64encode(body.corners.astype("<f4").tobytes()).decode()
    return ViewedBody(body.name, body.material.colour, corners, base64.b64encode(normals.tobytes()).decode())


def _pressed_wall(state: SensorState) -> PressedWall | None:
    """The pressed wall of a state; None by a model without walls."""
    walls = state.walls
    if walls is None:
        return None
    loops = np.concatenate([walls.inner, walls.outer[:, ::-1]], axis=1)
    return PressedWall(
        state.driving_pressure / KPA,
        [round(float(depth), _DRAWN_DIGITS) for depth in walls.indentation],
        [_flat(loop, _DRAWN_DIGITS) for loop in loops],
        [_flat(section, _DRAWN_DIGITS) for section in walls.objects],
    )


def _flat(points: Array, digits: int) -> list[float]:
    return [float(value) + 0.0 for value in np.round(points, digits).reshape(-1)]
