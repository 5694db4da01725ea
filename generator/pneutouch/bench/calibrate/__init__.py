"""Calibrate: fit the model to the sensor in hand, and state its uncertainty."""
