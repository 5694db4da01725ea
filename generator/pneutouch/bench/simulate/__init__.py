"""Simulator: records of known sensors, like those of a rig, always labelled as simulated."""
