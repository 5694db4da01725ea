"""Calibration: fit of the model's parameters to measurements of one sensor, with intervals."""
