"""Walls against the smallest wall that the machine prints in the material. Measured on the mesh."""

from __future__ import annotations

from pneutouch.printability.finding import Finding
from pneutouch.printability.sizes import compare
from pneutouch.printability.view import PrintView


def check(view: PrintView) -> list[Finding]:
    """Compare every place that is thin one way."""
    return compare(view, "walls", {"wall": "a wall"}, "wall", "make the wall thicker, or take another printer")
