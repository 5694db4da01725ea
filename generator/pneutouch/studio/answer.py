"""Answers to the page: at once by the atlas, a moment later by the model that ``predict`` takes."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from pneutouch.api.prediction import Prediction
from pneutouch.api.results import CheckResult
from pneutouch.catalogue import load_scene
from pneutouch.evaluation.charts import tuning
from pneutouch.evaluation.document import rating_document
from pneutouch.evaluation.elastomers import elastomers
from pneutouch.evaluation.evaluate import PredictionOptions, evaluate_scene, sensor_of
from pneutouch.evaluation.tuning import curve
from pneutouch.evaluation.uncertainty import unknown
from pneutouch.evaluation.variants import resin_curves
from pneutouch.mechanics.atlas_states import outside_atlas
from pneutouch.mechanics.models import USUAL
from pneutouch.parts import assemble
from pneutouch.rounding import rounded
from pneutouch.studio.drawing import drawing_document, view_document, walls_document

if TYPE_CHECKING:
    from collections.abc import Mapping

    from pneutouch.catalogue import DesignSource, Library
    from pneutouch.evaluation.evaluate import Evaluation
    from pneutouch.studio.question import Question

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
        prediction = {**evaluation.prediction.document(), "rating": rating_document(evaluation)}
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
