"""Rules over the bodies as they will be printed, the printers and the prediction; each returns findings."""

from pneutouch.printability.finding import Excess, Finding, refuse
from pneutouch.printability.rulebook import check
from pneutouch.printability.subject import Joint, PrintItem, PrintSubject
from pneutouch.printability.view import SensorContext

__all__ = ["Excess", "Finding", "Joint", "PrintItem", "PrintSubject", "SensorContext", "check", "refuse"]
