"""Coupons: small prints that measure a machine, a resin and a leak."""

from pneutouch.workflows.coupons.results import MeasuredProfile, write_profiles

__all__ = ["MeasuredProfile", "write_profiles"]
