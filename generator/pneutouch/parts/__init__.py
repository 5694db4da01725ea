"""The bodies of a sensor: one file per part family, all drawn from one layout."""

from pneutouch.parts.assembly import Assembly, assemble
from pneutouch.parts.layout import Layout

__all__ = ["Assembly", "Layout", "assemble"]
