"""Rules over the bodies, the printers and the prediction; each returns findings."""

from pneutouch.printability.check import check
from pneutouch.printability.finding import Finding

__all__ = ["Finding", "check"]
