"""Answers to the page: at once by the atlas, a moment later by the model that ``predict`` takes.

Drawing of a design on the page: the section through its bodies, its dimensions, and meshes for the view.
"""

from __future__ import annotations

import base64
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from pneutouch.api.prediction import Prediction
from pneutouch.api.results import CheckResult
from pneutouch.arrays import Array
from pneutouch.body import Body, Solid
from pneutouch.body.mesh import corner_normals
from pneutouch.body.section import section_outline
from pneutouch.catalogue import load_scene
from pneutouch.catalogue.library import elastomers
from pneutouch.evaluation.charts import curve, resin_curves, tuning
from pneutouch.evaluation.evaluate import PredictionOptions, evaluate_scene, sensor_of
from pneutouch.evaluation.result import by_model, rating_record
from pneutouch.evaluation.uncertainty import unknown
from pneutouch.mechanics import SensorState
from pneutouch.mechanics.atlas_states import outside_atlas
from pneutouch.mechanics.models import USUAL
from pneutouch.parts import Assembly, assemble
from pneutouch.results.record import plain
from pneutouch.rounding import rounded
from pneutouch.shape.meridian import Meridian
from pneutouch.units import KPA

if TYPE_CHECKING:
    from collections.abc import Mapping

    from pneutouch.catalogue import DesignSource, Library
    from pneutouch.evaluation.evaluate import Evaluation
    from pneutouch.studio.question import Question


_TOLERANCE = 0.02
"""Greatest distance of the drawn section, and of a mesh that is looked at, from the exact surface, mm."""

_DRAWN_DIGITS = 3


def drawing_document(assembly: Assembly) -> dict[str, Any]:
    """Loops (x, z) in mm where the plane y = 0 cuts each body, and the lengths that the dimensions state, mm."""
    bodies = [
        {
            "name": solid.name,
            "role": solid.role,
            "material": solid.material.label,
            "loops": [_flat(loop, _DRAWN_DIGITS) for loop in section_outline(solid, _TOLERANCE)],
        }
        for solid in assembly.solids
    ]
    layout = assembly.layout
    bounds = [_bounds(solid) for solid in assembly.solids]
    low, high = np.min([each[0] for each in bounds], axis=0), np.max([each[1] for each in bounds], axis=0)
    return {
        "bodies": bodies,
        "inner_radius_mm": layout.inner_radius,
        "wall_thickness_mm": layout.wall,
        "flange_diameter_mm": 2 * layout.flange_radius,
        "size_mm": [round(float(value), _DRAWN_DIGITS) for value in high - low],
        "low_mm": round(float(low[2]), _DRAWN_DIGITS),
        "high_mm": round(float(high[2]), _DRAWN_DIGITS),
    }


def _bounds(solid: Solid) -> Array:
    """Smallest and largest corner, shape (2, 3), mm; those of the exact surface where nothing sits on a turned body."""
    if not isinstance(solid.base, Meridian) or solid.adds or solid.cuts:
        return solid.mesh(_TOLERANCE).bounds
    radius, low, high = solid.base.bounds()
    return np.array([(-radius, -radius, low), (radius, radius, high)])


def view_document(assembly: Assembly) -> dict[str, Any]:
    """Each body as triangle corners (float32, mm) with normals (int8, in 1/127), both little-endian in base 64."""
    bodies = [_mesh(solid.mesh(_TOLERANCE)) for solid in assembly.solids]
    return {"bodies": bodies}


def _mesh(body: Body) -> dict[str, Any]:
    normals = np.rint(127 * corner_normals(body)).astype("<i1")
    return {
        "name": body.name,
        "colour": body.material.colour,
        "corners": base64.b64encode(body.corners.astype("<f4").tobytes()).decode(),
        "normals": base64.b64encode(normals.tobytes()).decode(),
    }


def walls_document(state: SensorState) -> dict[str, Any] | None:
    """The faces of the pressed wall at every solved indentation, (r, z) in mm; None by a model without them."""
    walls = state.walls
    if walls is None:
        return None
    loops = np.concatenate([walls.inner, walls.outer[:, ::-1]], axis=1)
    return {
        "driving_pressure_kPa": state.driving_pressure / KPA,
        "indentation_mm": [round(float(depth), _DRAWN_DIGITS) for depth in walls.indentation],
        "walls": [_flat(loop, _DRAWN_DIGITS) for loop in loops],
        "objects": [_flat(section, _DRAWN_DIGITS) for section in walls.objects],
    }


def _flat(points: Array, digits: int) -> list[float]:
    return [float(value) + 0.0 for value in np.round(points, digits).reshape(-1)]


_DIGITS = 6


class Answers:
    """Answers of the atlas, given at once for the designs ``bases``. The last design is kept: its intervals are asked
    for next."""

    def __init__(self, bases: Mapping[str, str], library: Library) -> None:
        self._bases, self._library = bases, library
        self._last: tuple[Question, Evaluation] | None = None

    def quick(self, question: Question) -> dict[str, Any]:
        """Drawing, prediction and the design's curve without intervals; where the atlas has no answer, ``outside`` has
        the reason.

        Raises InputError naming the field.
        """
        source = question.source(self._bases, self._library)
        scene = load_scene(source, {}, self._library)
        assembly = assemble(scene)
        answer = _head(source) | {"drawing": drawing_document(assembly)}
        outside = outside_atlas(sensor_of(assembly))
        if outside is not None:
            return {**answer, "outside": outside, "prediction": None, "curves": None}
        resins = partial(elastomers, self._library, scene.printer.is_casting)
        evaluation = evaluate_scene(scene, resins, PredictionOptions("atlas"))
        self._last = question, evaluation
        pressures = [state.driving_pressure for state in evaluation.prediction.states]
        rating = rating_record(evaluation.rating, pressures)
        prediction = plain(replace(by_model(evaluation.prediction), rating=rating))
        drawn = curve(evaluation.sensor, _highest(evaluation), "this design")
        design = None if drawn is None else _line(drawn.driving_pressure_kPa, drawn.sensitivity_kPa_per_N)
        return {**answer, "outside": None, "prediction": prediction, "curves": {"design": rounded(design, _DIGITS)}}

    def intervals(self, question: Question) -> dict[str, Any]:
        """The prediction with the intervals of its figures, the design's curve with its band, and the other resins'.

        Raises InputError naming the field.
        """
        if self._last is None or self._last[0] != question:
            scene = load_scene(question.source(self._bases, self._library), {}, self._library)
            resins = partial(elastomers, self._library, scene.printer.is_casting)
            self._last = question, evaluate_scene(scene, resins, PredictionOptions("atlas"))
        return _predicted(self._last[1])

    def view(self, question: Question) -> dict[str, Any]:
        """The bodies as meshes to look at. Raises InputError naming the field."""
        return view_document(assemble(load_scene(question.source(self._bases, self._library), {}, self._library)))


def full_answer(question: Question, bases: Mapping[str, str], library: Library) -> dict[str, Any]:
    """The prediction by the model that ``predict`` takes, with the findings of ``check`` and the estimates of the
    print.

    Raises PneutouchError if the design cannot work or cannot be computed.
    """
    source = question.source(bases, library)
    scene = load_scene(source, {}, library)
    resins = partial(elastomers, library, scene.printer.is_casting)
    evaluation = evaluate_scene(scene, resins, PredictionOptions(USUAL))
    check = CheckResult(source.name, tuple(evaluation.findings))
    jobs = [job.document() for job in evaluation.estimates]
    walls = [walls_document(state) for state in evaluation.prediction.states]
    return {**_head(source), **_predicted(evaluation), "check": check.to_dict(), "jobs": jobs, "walls": walls}


def _head(source: DesignSource) -> dict[str, Any]:
    file = source.changed({})
    values = file.model_dump(mode="json", by_alias=True)
    return {"name": source.name, "title": file.document.title, "values": values, "depth_mm": file.depth_mm}


def _predicted(evaluation: Evaluation) -> dict[str, Any]:
    """The prediction as ``predict`` prints it; sensitivity over driving pressure of the design and of every resin."""
    curves = {"resins": _resin_curves(evaluation), "design": _banded(evaluation)}
    return {"prediction": Prediction(evaluation).to_dict(), "curves": rounded(curves, _DIGITS)}


def _highest(evaluation: Evaluation) -> float:
    """Driving pressure up to which curves are drawn, MPa."""
    return max(evaluation.rating.pressure, evaluation.prediction.states[-1].driving_pressure)


def _banded(evaluation: Evaluation) -> dict[str, Any] | None:
    """Sensitivity of the design over driving pressure with its interval; None if that is not known."""
    if unknown(evaluation.sensor, evaluation.prediction.model) is not None:
        return None
    drawn = tuning(evaluation, _highest(evaluation))
    if drawn is None:
        return None
    ends = {"low_kPa_per_N": drawn.low_kPa_per_N, "high_kPa_per_N": drawn.high_kPa_per_N}
    known = {key: end.tolist() for key, end in ends.items() if end is not None}
    return _line(drawn.chosen.driving_pressure_kPa, drawn.chosen.sensitivity_kPa_per_N) | known


def _resin_curves(evaluation: Evaluation) -> list[dict[str, Any]]:
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
    return [{"title": title, **_line(*each)} for title, each in resins.items()]


def _line(pressure_kPa: Any, sensitivity_kPa_per_N: Any, model: str = "atlas") -> dict[str, Any]:
    return {
        "driving_pressure_kPa": pressure_kPa.tolist(),
        "sensitivity_kPa_per_N": sensitivity_kPa_per_N.tolist(),
        "model": model,
    }
