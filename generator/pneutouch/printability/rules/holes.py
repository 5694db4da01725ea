"""Holes against the smallest hole that the machine keeps open. Measured on the mesh."""

from __future__ import annotations

from pneutouch.printability.finding import Finding
from pneutouch.printability.sizes import compare
from pneutouch.printability.view import PrintView


def check(view: PrintView) -> list[Finding]:
    """Compare every hole that is short for its width."""
    return compare(view, "holes", {"hole": "a hole"}, "hole", "make the hole wider, or drill it through after printing")
