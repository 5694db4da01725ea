"""Rules on the resins of a job or voxel stack that its machine must run at once, and on mixes with mixing curves."""

from collections.abc import Sequence

from pneutouch.mechanics.prediction import CurveOutcome
from pneutouch.printability.view import PrintJob, PrintView
from pneutouch.results.printing import Excess, Finding
from pneutouch.spec.printer import Mode, Printer
from pneutouch.units import KPA
from pneutouch.wording import tenths_below

_FIX = "take resins that the machine runs together, or print the bodies one after the other"


def check_resins(view: PrintView) -> list[Finding]:
    """Findings on jobs whose materials need base resins, machines or modes that do not go together."""
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
    """Advice to print in another mode that fits, or the general advice if none does."""
    printer = job.parts[0].item.printer

    def fits(mode: Mode) -> bool:
        most = mode.resins_at_once or printer.resins_at_once
        return len(resins) <= most and (mode.digital_materials or not digital)

    if not set(resins) <= set(printer.resins):
        return _FIX
    return next((f"print in the mode {mode.name}" for mode in printer.mode if fits(mode)), _FIX)


_SOURCE = (
    "printprofiles/mixing, docs/background/mixing.md: the published characterizations differ, "
    "none is of these two resins"
)


def check_mixing_curve(view: PrintView) -> list[Finding]:
    """Finding on a mix, with its outcome by each mixing curve; a warning if it lies beyond one of them."""
    context = view.sensor
    if context is None or not context.curves:
        return []
    texts = [_outcome(outcome) for outcome in sorted(context.curves, key=lambda one: one.by_curve.place != "in use")]
    beyond = [outcome.by_curve.curve for outcome in context.curves if outcome.by_curve.beyond]
    more = f"; {', '.join(beyond)}: stiffer than any resin that it states, perhaps rigid there" if beyond else ""
    fix = "measure the mix on coupons (pneutouch coupons --mixing), or confirm that the design is useful by every curve"
    text = f"the modulus of the mix is assumed: {'; '.join(texts)}{more}"
    return [Finding("mixing curve", "warning" if beyond else "note", context.membrane, text, fix, _SOURCE, None, None)]


def _outcome(outcome: CurveOutcome) -> str:
    """Words on a mixing curve: the mean modulus, and the figures and rating at the highest driving pressure solved."""
    by_curve = outcome.by_curve
    head = f"by {by_curve.curve} ({by_curve.place}) {by_curve.shear_modulus_MPa.nominal:.2f} MPa"
    if not outcome.states or outcome.rated is None:
        return f"{head}, no equilibrium at the design's driving pressures"
    state = outcome.states[-1]
    figures = state.figures
    read = (
        "no straight part" if figures is None else f"{figures.sensitivity:.2f} kPa/N to {figures.force_range[1]:.1f} N"
    )
    rated_kPa = tenths_below(outcome.rated / KPA)
    return f"{head}, {read} at {state.driving_pressure / KPA:g} kPa, rated {rated_kPa:.1f} kPa"


VOXELS = "voxels"


def check_stack(
    printer: Printer, mode: Mode, resins: Sequence[str], layers: int, size: tuple[float, float, float], body: str
) -> list[Finding]:
    """Findings on a stack of ``layers`` slices, ``size`` mm (x, y, z) with its empty border, of base ``resins``.

    A stack cannot be turned on the tray: its pixels are not square.
    """
    findings: list[Finding] = []

    def broken(text: str, fix: str, source: str, excess: Excess | None = None) -> None:
        findings.append(Finding(VOXELS, "error", body, text, fix, source, None, excess))

    rules = printer.voxel_print
    if rules is None:
        text = f"the {printer.title} takes no voxel stacks (its profile has no voxel_print)"
        broken(text, "set print.profile to a printer that does, such as j735", "printer profile")
        return findings
    missing = sorted(set(resins) - set(printer.resins))
    if missing:
        text = f"{printer.title} does not run {', '.join(missing)}; it runs {', '.join(printer.resins)}"
        broken(text, "take resins that it runs", rules.source)
    most = min(rules.colours, printer.resins_at_once, mode.resins_at_once or rules.colours)
    if len(resins) > most:
        text = f"{len(resins)} resins ({', '.join(resins)}); a stack in the mode {mode.name} has {most} colours at most"
        broken(text, "take fewer resins", rules.source, Excess(len(resins), most, "colours"))
    if layers < rules.least_slices:
        text = f"{layers} slices of {mode.layer_um:g} um; the utility takes no fewer than {rules.least_slices}"
        fix = "take a mode of thinner layers, or make the part taller"
        broken(text, fix, rules.source, Excess(layers, rules.least_slices, "slices"))
    envelope = (printer.envelope.x, printer.envelope.y, printer.envelope.z)
    worst = max(zip(size, envelope, strict=True), key=lambda pair: pair[0] / pair[1])
    if worst[0] > worst[1]:
        stack, limits = (
            " x ".join(format(side, form) for side in box) for box, form in ((size, ".1f"), (envelope, "g"))
        )
        text = f"the stack is {stack} mm; the machine builds {limits} mm"
        broken(text, "make it smaller, or take a larger printer", printer.envelope.source, Excess(*worst, "mm"))
    return findings
