"""Calibrate: fit the model to the sensor in hand, and say how sure the fit is."""

from pneutouch.bench.calibrate.fit import Fit, fit
from pneutouch.bench.calibrate.held_out import HeldOut, predict_held_out
from pneutouch.bench.calibrate.observations import Injection, Observations
from pneutouch.bench.calibrate.parameters import NAMES, Parameters, parameters

__all__ = [
    "NAMES", "Fit", "HeldOut", "Injection", "Observations", "Parameters", "fit", "parameters", "predict_held_out",
]  # fmt: skip
