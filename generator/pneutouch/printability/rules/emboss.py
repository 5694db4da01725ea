"""Ridges and grooves on a face, their flanks lower than a millimetre, against the smallest that shows."""

from __future__ import annotations

from pneutouch.printability.finding import Finding
from pneutouch.printability.sizes import compare
from pneutouch.printability.view import PrintView


def check(view: PrintView) -> list[Finding]:
    """Compare the width and the height of raised and engraved detail, whichever is less."""
    fix = "make the detail wider and higher"
    return compare(view, "emboss", {"raised": "a raised detail", "engraved": "an engraved detail"}, "emboss", fix)
