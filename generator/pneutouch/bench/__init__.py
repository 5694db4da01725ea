"""Measured data in, the same figures out."""
