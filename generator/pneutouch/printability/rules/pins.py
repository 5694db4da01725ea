"""Free-standing pins against the smallest that survives printing and cleaning. Measured on the mesh."""

from __future__ import annotations

from pneutouch.printability.finding import Finding
from pneutouch.printability.sizes import compare
from pneutouch.printability.view import PrintView


def check(view: PrintView) -> list[Finding]:
    """Compare every place that is thin two ways."""
    return compare(view, "pins", {"pin": "a pin"}, "pin", "make the pin thicker, or let it lean on a wall")
