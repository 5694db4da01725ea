"""Each job, as it stands, against the build envelope of its machine."""

from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.view import PrintJob, PrintView


def check(view: PrintView) -> list[Finding]:
    """Compare the bounds along the build direction and across it, in either orientation on the tray.

    What is cast has no machine to fit in.
    """
    jobs = (job for job in view.jobs if not job.printer.is_casting)
    return [finding for job in jobs if (finding := _check(job)) is not None]


def _check(job: PrintJob) -> Finding | None:
    envelope = job.printer.envelope
    x, y, z = (float(length) for length in job.bounds[1] - job.bounds[0])
    if z <= envelope.z and ((x <= envelope.x and y <= envelope.y) or (x <= envelope.y and y <= envelope.x)):
        return None
    excesses = [
        Excess(z, envelope.z),
        Excess(max(x, y), max(envelope.x, envelope.y)),
        Excess(min(x, y), min(envelope.x, envelope.y)),
    ]
    worst = max(excesses, key=lambda excess: excess.measured / excess.limit)
    part = job.parts[0]
    limits = f"{envelope.x:g} x {envelope.y:g} x {envelope.z:g} mm"
    text = f"{x:.1f} x {y:.1f} x {z:.1f} mm as it stands; the machine builds {limits}"
    fix = part.item.hints.get("envelope", "make it smaller, lay it down, or take a larger printer")
    return Finding("envelope", "error", part.name, text, fix, envelope.source, None, worst)
