"""Rules over the bodies as they will be printed, the printers and the prediction; each returns findings."""

from pneutouch.printability.rulebook import check, refuse
from pneutouch.printability.subject import Joint, PrintItem, PrintSubject
from pneutouch.printability.view import SensorContext
from pneutouch.results.printing import Excess, Finding

__all__ = ["Excess", "Finding", "Joint", "PrintItem", "PrintSubject", "SensorContext", "check", "refuse"]
