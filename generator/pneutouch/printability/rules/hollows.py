"""Closed hollows: support cannot be removed from them, and they cannot be inspected."""

from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.view import PrintView

_SOURCE = "vendor, objet.com Tips and Tricks: a confined hollow is not cleanable"
_FILAMENT = "our choice, unverified: a closed hollow cannot be inspected, and loose support stays in it"


def check(view: PrintView) -> list[Finding]:
    """Look for shells that face inwards, in each body and in the bodies that a job joins to one."""
    findings = []
    for job in view.jobs:
        source = _SOURCE if job.printer.process == "polyjet" else _FILAMENT
        for hollow in job.hollows if job.sound else []:
            text = f"a closed hollow of {hollow.volume:.3g} mm3"
            part = job.nearest(hollow.where)
            fix = part.item.hints.get("hollows", "open it with a hole to clean through, or fill it")
            excess = Excess(hollow.volume, 0.0, "mm3")
            findings.append(Finding("hollows", "error", hollow.body, text, fix, source, hollow.where, excess))
    return findings
