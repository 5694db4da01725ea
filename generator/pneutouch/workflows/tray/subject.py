"""A part of a tray as the print rules look at it, its mark included."""

from __future__ import annotations

from pneutouch.printability.subject import Item, Subject
from pneutouch.spec.printer import Mode, Printer
from pneutouch.workflows.tray.lay import Part


def subject(part: Part, printer: Printer, mode: Mode) -> Subject:
    """The bodies of a part in its own frame, marked, in the mode of the tray's job.

    They carry no exact shape: that stands in the design frame and knows nothing of marks.
    """
    items = (Item(body, printer, mode, job=part.label if len(part.bodies) > 1 else "") for body in part.bodies)
    return Subject(tuple(items), name=part.name)
