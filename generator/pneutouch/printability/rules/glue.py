"""Bond of a flange's glue to membrane and connector."""

from pneutouch.parts.glue import GLUES, glues_for
from pneutouch.printability.finding import Finding
from pneutouch.printability.view import PrintView

_SEATS = "take connector.seat = clamped-flange-M2, which needs none"


def check(view: PrintView) -> list[Finding]:
    """Look up the pair of surfaces in the table of glues; nothing where no glue is named or chosen."""
    context = view.sensor
    if context is None or context.glued is None or context.calibrated:
        return []
    name, one, other = context.glued
    glue = GLUES[name]
    bond = glue.bond(one, other)
    if bond is not None and not bond.weak:
        return []
    pair = one if one == other else f"{one} and {other}"
    better = [each for each in glues_for(one, other) if each != name]
    named = f"take connector.glue = {' or '.join(better)}" if bond is None and better else ""
    fix = ", or ".join(part for part in (named, _SEATS) if part)
    if bond is None:
        text = f"{glue.title} does not bond {pair}: the flange comes off"
        return [Finding("glue", "error", context.membrane, text, fix, glue.source)]
    text = f"{glue.title} on {pair} carries small loads: the flange may peel off under pressure"
    return [Finding("glue", "warning", context.membrane, text, fix, glue.source)]
