"""A step or a sine of force or of travel through a sensor: wall, gas, line and gauge."""
