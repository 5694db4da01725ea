"""The resins of each job against what its machine runs at once, in one mode."""

from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.view import PrintJob, PrintView
from pneutouch.spec.printer import Mode

_FIX = "take resins that the machine runs together, or print the bodies one after the other"


def check(view: PrintView) -> list[Finding]:
    """Compare the base resins of all materials of a job with the machine and its mode."""
    return [finding for job in view.jobs if (finding := _check(job)) is not None]


def _check(job: PrintJob) -> Finding | None:
    items = [part.item for part in job.parts]
    printer, mode = items[0].printer, items[0].mode
    source, name = mode.source, job.parts[0].name
    resins = sorted({resin for item in items for resin in item.body.material.base_resins})
    digital = [item for item in items if item.body.material.is_digital]
    most = printer.resins_at_once if mode.resins_at_once is None else mode.resins_at_once
    missing = [resin for resin in resins if resin not in printer.resins]
    machines = sorted({item.printer.title for item in items})
    modes = sorted({item.mode.name for item in items})
    excess = None
    if len(machines) > 1:
        text = f"one job on two machines: {', '.join(machines)}"
    elif missing:
        text = f"{printer.title} does not run {', '.join(missing)}"
        name = next(item.body.name for item in items if set(missing) & set(item.body.material.base_resins))
    elif len(modes) > 1:
        text = f"one job in two modes: {', '.join(modes)}"
    elif digital and not mode.digital_materials:
        text = f"{digital[0].body.material.label} is mixed, which the mode {mode.name} does not do"
        name = digital[0].body.name
    elif len(resins) > most:
        text = f"{len(resins)} resins at once ({', '.join(resins)}); the machine runs {most} in the mode {mode.name}"
        excess = Excess(len(resins), most, "resins")
    else:
        return None
    fix = items[0].hints.get("resins", _other(job, resins, bool(digital)))
    return Finding("resins", "error", name, text, fix, source, None, excess)


def _other(job: PrintJob, resins: list[str], digital: bool) -> str:
    """A mode that would do, else the plain advice."""
    printer = job.parts[0].item.printer

    def fits(mode: Mode) -> bool:
        most = printer.resins_at_once if mode.resins_at_once is None else mode.resins_at_once
        return len(resins) <= most and (mode.digital_materials or not digital)

    if not set(resins) <= set(printer.resins):
        return _FIX
    return next((f"print in the mode {mode.name}" for mode in printer.mode if fits(mode)), _FIX)
