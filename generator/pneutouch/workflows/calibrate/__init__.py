"""Calibration: the model of a design fitted to measured runs of a sensor."""
