"""The documents of a prediction: with its uncertainty, with relaxation and ageing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NotRequired, TypedDict, cast

from pneutouch.evaluation.anywhere import contact_anywhere_document
from pneutouch.evaluation.contact_object import contact_document
from pneutouch.evaluation.dynamics import dynamics_document
from pneutouch.evaluation.gauge import gauge_document
from pneutouch.evaluation.uncertainty import documents
from pneutouch.mechanics.prediction import SensorRecord, StateRecord
from pneutouch.mechanics.viscous.prony import AGED, ageing_ratio
from pneutouch.rounding import rounded

if TYPE_CHECKING:
    from pneutouch.evaluation.evaluate import Evaluation
    from pneutouch.mechanics.rating import RatingRecord
    from pneutouch.mechanics.uncertainty.record import UncertaintyRecord

_DIGITS = 6
"""Significant digits: more than the figures have, fewer than differ between processors."""


class UncertainStateRecord(StateRecord):
    """A state with its uncertainty."""

    uncertainty: UncertaintyRecord


class AgedRecord(TypedDict):
    """The modulus after a year over the fresh one, and the assumption behind it."""

    modulus_ratio: float
    assumes: str


class PredictionRecord(SensorRecord):
    """A prediction as ``predict`` prints it; ``prediction.json`` holds it up to ``states``."""

    contact: NotRequired[dict[str, Any]]
    contact_anywhere: NotRequired[dict[str, Any]]
    dead_volume_note: NotRequired[str]
    rating: RatingRecord
    states: list[UncertainStateRecord]
    gauge: NotRequired[dict[str, Any]]
    viscous: NotRequired[dict[str, Any]]
    dynamics: NotRequired[dict[str, Any]]
    calibration: NotRequired[dict[str, Any]]
    aged: NotRequired[AgedRecord]
    mixing_curves: NotRequired[list[dict[str, Any]]]


def viscous(evaluation: Evaluation) -> dict[str, Any]:
    """Relaxation and hysteresis of every state, see `mechanics.viscous.describe`; or ``{"unknown": why}``."""
    runs = evaluation.viscous_runs
    return {"unknown": runs} if isinstance(runs, str) else rounded(runs.document(), _DIGITS)


def rating_document(evaluation: Evaluation) -> RatingRecord:
    """The rated pressure, its basis and advice that would raise it; driving pressures above it are findings."""
    return evaluation.rating.document([state.driving_pressure for state in evaluation.prediction.states])


def curves_document(evaluation: Evaluation) -> list[dict[str, Any]]:
    """The sensor by every mixing curve of its mix, the softest first."""
    content: list[dict[str, Any]] = rounded([outcome.document() for outcome in evaluation.curves], _DIGITS)
    return content


def prediction_document(evaluation: Evaluation, samples: int = 0) -> PredictionRecord:
    """The prediction as ``predict`` prints it, with its ``rating``, every state with its ``uncertainty``.

    ``contact`` stands there where something else than a plate presses the sensor, ``contact_anywhere`` where the design
    requests it, ``dead_volume_note`` where the stated
    dead volume is an idealisation.
    """
    content = evaluation.prediction.document()
    uncertainty = evaluation.uncertainty
    if samples:
        uncertainty = documents(
            evaluation.prediction, evaluation.sensor, evaluation.scene, lambda: evaluation.resins, samples
        )
    states = [{**state, "uncertainty": entry} for state, entry in zip(content["states"], uncertainty, strict=True)]
    record = cast(
        "PredictionRecord",
        {**content, **contact_document(evaluation.scene), "rating": rating_document(evaluation), "states": states},
    )
    if evaluation.assembly.dead_volume_note:
        record["dead_volume_note"] = evaluation.assembly.dead_volume_note
    if evaluation.scene.design.contact.anywhere:
        record["contact_anywhere"] = contact_anywhere_document(evaluation.prediction, evaluation.sensor)
    return record


def full_document(evaluation: Evaluation, samples: int = 0) -> PredictionRecord:
    """`prediction_document` with ``viscous`` and ``dynamics``; with ``gauge`` where the design names one, ``aged``
    where the prediction is of an aged sensor, and ``mixing_curves`` where its mix has several."""
    content = prediction_document(evaluation, samples)
    content["viscous"] = viscous(evaluation)
    content["dynamics"] = rounded(dynamics_document(evaluation.bandwidth), _DIGITS)
    if evaluation.scene.gauge is not None:
        content["gauge"] = gauge_document(evaluation)
    if evaluation.curves:
        content["mixing_curves"] = curves_document(evaluation)
    calibration = evaluation.scene.calibration
    if calibration is not None:
        content["calibration"] = {
            "name": evaluation.scene.design.calibration,
            "title": calibration.title,
            **calibration.source.model_dump(mode="json"),
        }
    if evaluation.options.aged:
        remaining = 1.0 if calibration is None else calibration.remaining_year
        ratio = ageing_ratio(evaluation.scene.membrane_material) ** remaining
        content["aged"] = {"modulus_ratio": rounded(ratio, _DIGITS), "assumes": AGED}
    return content
