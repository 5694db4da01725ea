"""The smallest force that a sensor with its gauge detects, and the limit behind it."""

import numpy as np

from pneutouch.catalogue import ResolvedDesign
from pneutouch.evaluation.evaluate import Evaluation
from pneutouch.mechanics import SensorPrediction, SensorState
from pneutouch.mechanics.gauge_reading import SIGMAS, GaugeReading, gauge_reading
from pneutouch.mechanics.line.elements import REFERENCE_TEMPERATURE
from pneutouch.results.behaviour import GaugeFigures, GaugeState
from pneutouch.units import KPA
from pneutouch.wording import rounded

_DIGITS = 6

CRITERION = f"{SIGMAS:g} standard deviations of the difference of two readings"


def reading_of(scene: ResolvedDesign) -> GaugeReading:
    """The gauge of a design at its ambient pressure; the gauge of the paper's rig if the design names none."""
    return gauge_reading(scene.gauge, scene.design.pneumatics.ambient_pressure_kPa * KPA)


def _smallest_force(threshold: float | None, drift_kPa_per_K: float, state: SensorState) -> GaugeState:
    """The smallest force by a ``threshold`` (MPa, None: unknown), and the force that a drift of the zero reads as."""
    at_kPa = state.driving_pressure / KPA
    if state.figures is None:
        return GaugeState(at_kPa, None, None, drift_kPa_per_K, None, None)
    slope = state.figures.sensitivity * KPA
    force = None if threshold is None else threshold / slope
    first = None if threshold is None else force_at_rise(state.force, state.pressure_rise, threshold)
    warming = None if threshold is None or drift_kPa_per_K <= 0 else threshold / (drift_kPa_per_K * KPA)
    return GaugeState(at_kPa, force, first, drift_kPa_per_K, drift_kPa_per_K * KPA / slope, warming)


def force_at_rise(force: np.ndarray, rise: np.ndarray, threshold: float) -> float | None:
    """Force (N) at which a curve, (n,) each and from 0, reaches the rise ``threshold``; None if it does not.

    Below the first loaded point the rise is a power of the force, through that point and the next: an inflated dome
    yields in proportion to the force, and the volume that it displaces grows with the square of the travel.
    """
    loaded = (force > 0) & (rise > 0)
    force, rise = force[loaded], rise[loaded]
    if rise.size < 2 or threshold > rise.max():
        return None
    if threshold >= rise[0]:
        above = int(np.argmax(rise >= threshold))
        return float(np.interp(threshold, rise[max(above - 1, 0) : above + 1], force[max(above - 1, 0) : above + 1]))
    power = np.log(rise[1] / rise[0]) / np.log(force[1] / force[0])
    return float(force[0] * (threshold / rise[0]) ** (1.0 / power)) if power > 0 else None


def zero_drift_kPa_per_K(scene: ResolvedDesign, prediction: SensorPrediction, state: SensorState) -> float:
    """Pressure change of the sealed gas with temperature, without contact, kPa/K.

    The dome yields as the gas warms: dp/dT = (p_abs/T) k/(k + p_abs/V), k = dp/dV of the dome and V the gas.
    """
    curve = prediction.inflation
    slope = float(np.interp(state.cavity_volume, curve.volume, np.gradient(curve.pressure, curve.volume)))
    absolute = scene.design.pneumatics.ambient_pressure_kPa * KPA + state.driving_pressure
    gas = absolute / (state.cavity_volume + prediction.dead_volume)
    return absolute / REFERENCE_TEMPERATURE * slope / (slope + gas) / KPA


def gauge_record(evaluation: Evaluation) -> GaugeFigures:
    """The gauge of a design and the smallest force at each driving pressure; ``name`` None: the paper's is assumed."""
    scene, reading, prediction = evaluation.scene, reading_of(evaluation.scene), evaluation.prediction
    record = GaugeFigures(
        name=scene.design.pneumatics.gauge,
        title=reading.title,
        reference="absolute" if reading.absolute else "gauge",
        reads_from_kPa=reading.low / KPA,
        reads_to_kPa=reading.limit / KPA,
        noise_kPa=_in_kPa(reading.noise),
        step_kPa=_in_kPa(reading.step),
        threshold_kPa=_in_kPa(reading.threshold),
        rate_Hz=reading.rate_Hz,
        bandwidth_Hz=None if reading.rate_Hz is None else reading.rate_Hz / 2,
        criterion=CRITERION,
        limited_by=reading.limited_by,
        inner_volume_counted_mL=evaluation.assembly.gauge_volume_mL,
        states=tuple(
            _smallest_force(reading.threshold, zero_drift_kPa_per_K(scene, prediction, s), s) for s in prediction.states
        ),
    )
    return rounded(record, _DIGITS)


def _in_kPa(pressure: float | None) -> float | None:
    return None if pressure is None else pressure / KPA
