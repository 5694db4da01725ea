"""Evaluation of measured data into the figures that predictions have."""
