"""Answers to the page: at once by the atlas, a moment later by the model that ``predict`` takes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pneutouch.api.prediction import Prediction
from pneutouch.api.results import CheckResult
from pneutouch.catalogue import load_scene
from pneutouch.evaluation.charts import tuning
from pneutouch.evaluation.evaluate import PredictionOptions, elastomers, evaluate_scene, sensor_of
from pneutouch.evaluation.uncertainty import unknown
from pneutouch.evaluation.variants import resin_curves
from pneutouch.mechanics.atlas_states import outside_atlas
from pneutouch.mechanics.models import USUAL
from pneutouch.parts import assemble
from pneutouch.rounding import rounded
from pneutouch.studio.drawing import drawing_document, view_document

if TYPE_CHECKING:
    from collections.abc import Mapping

    from pneutouch.catalogue import DesignSource, Library
    from pneutouch.evaluation.evaluate import Evaluation
    from pneutouch.studio.question import Question

_DIGITS = 6


def quick_answer(question: Question, bases: Mapping[str, str], library: Library) -> dict[str, Any]:
    """Drawing, prediction and curves by the atlas; where it has no answer, ``outside`` states why.

    Raises InputError naming the field.
    """
    source = question.source(bases, library)
    scene = load_scene(source, {}, library)
    assembly = assemble(scene)
    answer = _head(source) | {"drawing": drawing_document(assembly)}
    outside = outside_atlas(sensor_of(assembly))
    if outside is not None:
        return {**answer, "outside": outside, "prediction": None, "curves": None}
    evaluation = evaluate_scene(scene, lambda: elastomers(library), PredictionOptions("atlas"))
    return {**answer, "outside": None, **_predicted(evaluation)}


def full_answer(question: Question, bases: Mapping[str, str], library: Library) -> dict[str, Any]:
    """The prediction by the model that ``predict`` takes, with the findings of ``check`` and what the print takes.

    Raises PneutouchError where the design cannot work or cannot be computed.
    """
    source = question.source(bases, library)
    evaluation = evaluate_scene(load_scene(source, {}, library), lambda: elastomers(library), PredictionOptions(USUAL))
    check = CheckResult(source.name, tuple(evaluation.findings))
    jobs = [job.document() for job in evaluation.estimates]
    return {**_head(source), **_predicted(evaluation), "check": check.to_dict(), "jobs": jobs}


def view_answer(question: Question, bases: Mapping[str, str], library: Library) -> dict[str, Any]:
    """The bodies as meshes to look at. Raises InputError naming the field."""
    return view_document(assemble(load_scene(question.source(bases, library), {}, library)))


def _head(source: DesignSource) -> dict[str, Any]:
    file = source.changed({})
    values = file.model_dump(mode="json", by_alias=True)
    return {"name": source.name, "title": file.document.title, "values": values, "depth_mm": file.depth_mm}


def _predicted(evaluation: Evaluation) -> dict[str, Any]:
    return {"prediction": Prediction(evaluation).to_dict(), "curves": _curves(evaluation)}


def _curves(evaluation: Evaluation) -> dict[str, Any]:
    """Sensitivity over driving pressure: of the design with its interval, and of every resin."""
    prediction, states = evaluation.prediction, evaluation.prediction.states
    highest = max(evaluation.rating.pressure, states[-1].driving_pressure)
    resins = resin_curves(evaluation.sensor, evaluation.resins, highest, prediction.model, prediction.closure, states)
    drawn = tuning(evaluation, highest) if unknown(evaluation.sensor, prediction.model) is None else None
    content: dict[str, Any] = {
        "resins": [{"title": title, **_line(*curve)} for title, curve in resins.items()],
        "design": None,
    }
    if drawn is not None:
        ends = {"low_kPa_per_N": drawn.low_kPa_per_N, "high_kPa_per_N": drawn.high_kPa_per_N}
        known = {key: end.tolist() for key, end in ends.items() if end is not None}
        content["design"] = _line(drawn.chosen.driving_pressure_kPa, drawn.chosen.sensitivity_kPa_per_N) | known
    result: dict[str, Any] = rounded(content, _DIGITS)
    return result


def _line(pressure_kPa: Any, sensitivity_kPa_per_N: Any, model: str = "atlas") -> dict[str, Any]:
    return {
        "driving_pressure_kPa": pressure_kPa.tolist(),
        "sensitivity_kPa_per_N": sensitivity_kPa_per_N.tolist(),
        "model": model,
    }
