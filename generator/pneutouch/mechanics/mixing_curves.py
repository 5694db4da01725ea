"""Predictions of a sensor in a mix of two resins, one for each mixing curve of the pair, to show how they differ."""

from pneutouch.errors import BeyondLimitError, ComputationError
from pneutouch.mechanics.paper_sensor import material_sensor
from pneutouch.mechanics.predict import predict
from pneutouch.mechanics.prediction import CurveOutcome, SensorPrediction
from pneutouch.mechanics.rating import Rating, ratings
from pneutouch.mechanics.sensor import ResponseCorrection, Sensor
from pneutouch.spec.material import Material, MixByCurve
from pneutouch.spec.printer import Printer


def curve_outcomes(
    sensor: Sensor, material: Material, printer: Printer, prediction: SensorPrediction, rated: Rating
) -> tuple[CurveOutcome, ...]:
    """Outcomes of the sensor for every mixing curve of its mix, the softest first.

    ``prediction`` and ``rated`` are those by the curve in use. For the other curves the same model predicts, without
    the search for waves, which changes no figure. Empty without several curves, and for (costly) contact off the axis.
    """
    if sensor.protocol.off_axis is not None:
        return ()
    outcomes = []
    for by_curve in material.curves:
        if by_curve.place == "in use":
            outcomes.append(CurveOutcome(by_curve, prediction.states, rated.pressure))
        else:
            outcomes.append(_outcome(by_curve, sensor, material.by_curve(by_curve), printer, prediction))
    return tuple(outcomes)


def _outcome(
    by_curve: MixByCurve, sensor: Sensor, material: Material, printer: Printer, prediction: SensorPrediction
) -> CurveOutcome:
    there = sensor.replace(wall=material_sensor(material).wall, correction=ResponseCorrection(), waves=0)
    pressures = [state.driving_pressure for state in prediction.states]
    answer = _predicted(there, pressures, prediction)
    if answer is None:
        return CurveOutcome(by_curve, (), None)
    error = abs(answer.error_estimate.limit_pressure_relative)
    return CurveOutcome(
        by_curve, answer.states, ratings([answer.limits], [there], material, printer, numerical=error)[0].pressure
    )


def _predicted(sensor: Sensor, pressures: list[float], like: SensorPrediction) -> SensorPrediction | None:
    """Prediction by the model of ``like`` at the pressures (MPa) up to the highest that can be solved; None if none."""
    for count in range(len(pressures), 0, -1):
        try:
            return predict("", sensor, pressures[:count], model=like.model, closure=like.closure or "variational")
        except (BeyondLimitError, ComputationError):
            continue
    return None
