"""The prediction for each group of runs, and the plausibility of the files against it."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from pneutouch.arrays import Array
from pneutouch.bench.figure import line_figures
from pneutouch.bench.plausible import ExpectedRun
from pneutouch.bench.summary import RunGroup
from pneutouch.catalogue import DesignSource, Library
from pneutouch.errors import PneutouchError
from pneutouch.evaluation.evaluate import Evaluation, evaluate
from pneutouch.evaluation.read_at import figures_at
from pneutouch.evaluation.table_s1 import published_sensitivities
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.uncertainty.record import UncertaintyRecord
from pneutouch.report.measured import GroupComparison
from pneutouch.spec.campaign import AS_DESIGNED
from pneutouch.spec.read import Changes
from pneutouch.units import KPA

_OF_STATE = ("sensitivity_kPa_per_N", "stiffness_N_per_mm")
"""Figures whose uncertainty goes by the same name; the force at the greatest depth is the range's end's."""


@dataclass(frozen=True)
class StatePrediction:
    """The model's state for a resin at a driving pressure (kPa); ``why`` if there is none."""

    evaluation: Evaluation | None
    place: int
    why: str = ""

    @property
    def state(self) -> SensorState | None:
        """The predicted state."""
        return None if self.evaluation is None else self.evaluation.prediction.states[self.place]

    def expected(self) -> ExpectedRun | None:
        """Readings that the files should show at the end of the range; None if nothing is known of them."""
        state = self.state
        if state is None or state.figures is None:
            return None
        state_figures, kept = state.figures, state.indentation <= state.range_end * (1 + 1e-12)
        return ExpectedRun(
            depth=float(state.indentation[kept][-1]),
            force=state_figures.force_range[1],
            rise=float(state.pressure_rise[kept][-1]),
            curve=(state.indentation[kept], state.force[kept], state.pressure_rise[kept]),
        )


def answers(
    design: str | DesignSource, changes: Changes, pairs_of: Iterable[tuple[str, float]], model: str, library: Library
) -> dict[tuple[str, float], StatePrediction]:
    """Predict the design in every (resin, driving pressure in kPa) given, resin by resin.

    Where a resin's pressures cannot be predicted together each is tried alone; one beyond the limit has a reason in the
    place of a state.
    """
    predictions: dict[tuple[str, float], StatePrediction] = {}
    pairs = sorted(set(pairs_of))
    for resin in dict.fromkeys(resin for resin, _ in pairs):
        pressures_kPa = [p for name, p in pairs if name == resin]
        try:
            evaluation = _evaluated(design, changes, resin, pressures_kPa, model, library)
            predictions |= {(resin, p): StatePrediction(evaluation, k) for k, p in enumerate(pressures_kPa)}
        except PneutouchError:
            predictions |= {(resin, p): _alone(design, changes, resin, p, model, library) for p in pressures_kPa}
    return predictions


def _alone(
    design: str | DesignSource, changes: Changes, resin: str, pressure_kPa: float, model: str, library: Library
) -> StatePrediction:
    try:
        return StatePrediction(_evaluated(design, changes, resin, [pressure_kPa], model, library), 0)
    except PneutouchError as error:
        return StatePrediction(None, 0, str(error))


def _evaluated(
    design: str | DesignSource, changes: Changes, resin: str, pressures_kPa: list[float], model: str, library: Library
) -> Evaluation:
    material = {} if resin == AS_DESIGNED else {"membrane.material": resin}
    pressed = {"pneumatics.driving_pressures_kPa": pressures_kPa}
    return evaluate(design, {**changes, **material, **pressed}, model=model, library=library)


def compared(group: RunGroup, answer: StatePrediction) -> GroupComparison:
    """A group compared with its prediction, which is of a fresh print."""
    state = answer.state
    if state is None or answer.evaluation is None:
        return GroupComparison(group, group.key.resin, None, {}, {}, answer.why)
    label = answer.evaluation.scene.membrane_material.title
    if group.key.age_days > 0:
        return GroupComparison(group, label, None, {}, {}, "predictions are of fresh prints; see aged predictions")
    uncertainty = answer.evaluation.uncertainty[answer.place]
    predicted = _figures(state, uncertainty, depths_of(group))
    return GroupComparison(group, label, state, uncertainty, predicted, published=_published(answer.evaluation, group))


def _published(evaluation: Evaluation, group: RunGroup) -> dict[str, float]:
    """The sensitivity in Table S1, kPa/N, where the sensor is the paper's and was measured at this driving pressure."""
    known = published_sensitivities(evaluation.sensor, evaluation.scene.membrane_material)
    at = [value for pressure, value in known.items() if math.isclose(pressure, group.key.driving_pressure_kPa)]
    return {"sensitivity_kPa_per_N": at[0]} if at else {}


def depths_of(group: RunGroup) -> list[list[Array]]:
    """The depths of each steps run of each specimen of a group, mm."""
    by_specimen: dict[str, list[Array]] = {}
    for curve in group.of_kind("steps"):
        if curve.indentation.size > 1:
            by_specimen.setdefault(curve.run.sensor, []).append(curve.indentation)
    return list(by_specimen.values())


def _figures(
    state: SensorState, uncertainty: UncertaintyRecord, depths: list[list[Array]]
) -> dict[str, tuple[float, float | None, float | None]]:
    known = uncertainty.get("figures", {})
    if state.figures is None:
        return {}
    curve = state.indentation, state.force, state.pressure_rise / KPA
    plain = figures_at(*curve, state.range_end, depths) if depths else line_figures(state.figures)
    names = {**{name: name for name in _OF_STATE}, "force_range_N": "force_at_range_end_N"}
    predictions: dict[str, tuple[float, float | None, float | None]] = {}
    for key, value in plain.items():
        ends = known.get(names.get(key, ""))
        # The relative uncertainty is that of the whole range.
        scale = 0.0 if ends is None else value / ends["value"]
        predictions[key] = (value, None, None) if ends is None else (value, scale * ends["low"], scale * ends["high"])
    return predictions
