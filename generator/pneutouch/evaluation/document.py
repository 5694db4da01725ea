"""What relaxation does to a predicted sensor, and what a prediction says with it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pneutouch.evaluation.uncertainty import documents
from pneutouch.mechanics.viscous.known import AGED, ageing_ratio, unknown
from pneutouch.rounding import rounded

if TYPE_CHECKING:
    from pneutouch.evaluation.evaluate import Evaluation

_DIGITS = 6
"""Significant digits: more than the figures have, fewer than differ between processors."""


def viscous(evaluation: Evaluation) -> dict[str, Any]:
    """Relaxation and hysteresis of every state, see `mechanics.viscous.describe`; or ``{"unknown": why}``."""
    sensor, material, prediction = evaluation.sensor, evaluation.scene.membrane_material, evaluation.prediction
    why = unknown(sensor, material, prediction.model)
    if why is not None:
        return {"unknown": why}
    # Through the atlas this loads scipy, which a prediction by the membrane must not pay for.
    from pneutouch.mechanics.viscous.describe import chosen_depth, describe

    depth = chosen_depth(sensor, [state.range_end for state in prediction.states])
    if not depth > 0:
        return {"unknown": "a state has no range"}
    found = describe(sensor, material, [state.driving_pressure for state in prediction.states], depth)
    return rounded(found.document(), _DIGITS)  # type: ignore[no-any-return]


def prediction_document(evaluation: Evaluation, samples: int = 0) -> dict[str, Any]:
    """The prediction as ``predict`` prints it, every state with its ``uncertainty``."""
    content = evaluation.prediction.document()
    found = evaluation.uncertainty
    if samples:
        found = documents(
            evaluation.prediction, evaluation.sensor, evaluation.scene, lambda: evaluation.resins, samples
        )
    return {
        **content,
        "states": [{**state, "uncertainty": own} for state, own in zip(content["states"], found, strict=True)],
    }


def full_document(evaluation: Evaluation, samples: int = 0) -> dict[str, Any]:
    """`prediction_document` with ``viscous``, and ``aged`` where the prediction is of an aged sensor."""
    content = {**prediction_document(evaluation, samples), "viscous": viscous(evaluation)}
    if evaluation.options.aged:
        ratio = ageing_ratio(evaluation.scene.membrane_material)
        content["aged"] = {"modulus_ratio": rounded(ratio, _DIGITS), "assumes": AGED}
    return content
