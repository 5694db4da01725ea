"""Mechanics of a sensor: the records of a sensor and of its prediction, and `predict`, which computes one."""

from pneutouch.mechanics.models.choice import MODEL_CHOICES
from pneutouch.mechanics.predict import predict
from pneutouch.mechanics.prediction import SensorPrediction, SensorState
from pneutouch.mechanics.sensor import Sensor

__all__ = ["MODEL_CHOICES", "Sensor", "SensorPrediction", "SensorState", "predict"]
