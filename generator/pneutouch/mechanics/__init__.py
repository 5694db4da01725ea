"""Mechanics of a sensor: laws, gas, the membrane theory, and curves turned into figures."""

from pneutouch.mechanics.models.choice import MODEL_CHOICES
from pneutouch.mechanics.predict import predict
from pneutouch.mechanics.prediction import SensorPrediction, SensorState
from pneutouch.mechanics.sensor import Sensor

__all__ = ["MODEL_CHOICES", "Sensor", "SensorPrediction", "SensorState", "predict"]
