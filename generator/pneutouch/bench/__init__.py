"""Measured data: curves and figures of runs, calibration, coupons, tensile tests, and simulated records."""
