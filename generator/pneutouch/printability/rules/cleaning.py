"""Whether support can be reached and washed out."""

from __future__ import annotations

from pneutouch.mechanics import Prediction
from pneutouch.parts import Assembly
from pneutouch.printability.finding import Finding

_SOURCE = "vendor, objet.com Tips and Tricks: a confined hollow is not cleanable"
_LEAST_OPENING = 0.5
"""Opening over the widest hollow behind it; below this a straight jet does not see all of the wall."""


def check(assembly: Assembly, prediction: Prediction) -> list[Finding]:
    """The membrane is open over its whole base; the channel must be straight and wide enough for its length."""
    layout, port = assembly.layout, assembly.scene.port
    found = []
    if assembly.scene.connector_printer.process == "polyjet":
        length = port.stem_length + port.barb_length
        if length > 10 * port.bore_diameter:
            text = f"the port's bore is {length / port.bore_diameter:.0f} times as long as wide"
            fix = "push a wire through and flush from both sides"
            where = (0.0, 0.0, layout.plate_low)
            found.append(Finding("cleaning", "warning", "connector", text, fix, _SOURCE, where))
    opening = layout.inner_radius / max(piece.bounds()[1] for piece in assembly.solids[0].meridian.tagged("inner wall"))
    if opening < _LEAST_OPENING:
        text = f"the opening is {opening:.0%} of the hollow's width"
        found.append(Finding("cleaning", "error", "membrane", text, "open the base", _SOURCE, (0.0, 0.0, 0.0)))
    return found
