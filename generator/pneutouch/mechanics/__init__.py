"""How a sensor behaves: laws, gas, the membrane theory, and curves turned into figures."""

from pneutouch.mechanics.ladder import MODELS
from pneutouch.mechanics.predict import predict
from pneutouch.mechanics.prediction import SensorPrediction, SensorState
from pneutouch.mechanics.sensor import Sensor

__all__ = ["MODELS", "Sensor", "SensorPrediction", "SensorState", "predict"]
