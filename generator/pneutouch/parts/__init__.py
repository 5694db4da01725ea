"""The bodies of a sensor: one file per part family, all drawn from one layout."""

from pneutouch.parts.assembly import Assembly, assemble

__all__ = ["Assembly", "assemble"]
