"""Prints that measure a machine, a resin and a leak."""

from pneutouch.workflows.coupons.profile import Profile, write_profiles

__all__ = ["Profile", "write_profiles"]
