"""Channels, holes longer than three widths, against the narrowest that comes out open. Measured on the mesh."""

from __future__ import annotations

from pneutouch.printability.finding import Finding
from pneutouch.printability.sizes import compare
from pneutouch.printability.view import PrintView


def check(view: PrintView) -> list[Finding]:
    """Compare every channel."""
    fix = "make the channel wider or shorter, or drill it through after printing"
    return compare(view, "channels", {"channel": "a channel"}, "channel", fix)
