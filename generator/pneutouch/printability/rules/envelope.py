"""Each job, as it stands, against the build envelope of its machine."""

from __future__ import annotations

from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.view import PrintJob, PrintView


def check(view: PrintView) -> list[Finding]:
    """Compare the bounds along the build direction and across it, either way round on the tray."""
    return [finding for job in view.jobs if (finding := _check(job)) is not None]


def _check(job: PrintJob) -> Finding | None:
    room = job.printer.envelope_mm
    x, y, z = (float(length) for length in job.bounds[1] - job.bounds[0])
    if z <= room.z and ((x <= room.x and y <= room.y) or (x <= room.y and y <= room.x)):
        return None
    excesses = [Excess(z, room.z), Excess(max(x, y), max(room.x, room.y)), Excess(min(x, y), min(room.x, room.y))]
    worst = max(excesses, key=lambda excess: excess.measured / excess.limit)
    part = job.parts[0]
    text = f"{x:.1f} x {y:.1f} x {z:.1f} mm as it stands; the machine builds {room.x:g} x {room.y:g} x {room.z:g} mm"
    fix = part.item.hints.get("envelope", "make it smaller, lay it down, or take a larger printer")
    return Finding("envelope", "error", part.name, text, fix, room.source, None, worst)
