"""Calibrate: fit the model to the sensor in hand, and state its uncertainty."""

from pneutouch.bench.calibrate.fit import CalibrationFit, fit
from pneutouch.bench.calibrate.notes import predict_held_out
from pneutouch.bench.calibrate.observations import Injection, Observations
from pneutouch.bench.calibrate.parameters import NAMES, USUAL, CalibrationParameters, parameters

__all__ = [
    "NAMES",
    "USUAL",
    "CalibrationFit",
    "CalibrationParameters",
    "Injection",
    "Observations",
    "fit",
    "parameters",
    "predict_held_out",
]
