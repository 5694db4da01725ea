"""A part of a tray as the print rules look at it, its mark included."""

from pneutouch.printability.subject import PrintItem, PrintSubject
from pneutouch.spec.printer import Mode, Printer
from pneutouch.workflows.tray.lay import TrayPart


def subject(part: TrayPart, printer: Printer, mode: Mode) -> PrintSubject:
    """The bodies of a part in its own frame, marked, in the mode of the tray's job.

    They carry no exact shape: that stands in the design frame and has no marks.
    """
    items = (PrintItem(body, printer, mode, job=part.label if len(part.bodies) > 1 else "") for body in part.bodies)
    return PrintSubject(tuple(items), name=part.name)
