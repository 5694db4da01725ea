"""A voxel stack before it is made: whether the machine takes one, and one of this size and so many colours."""

from collections.abc import Sequence

from pneutouch.results.printing import Excess, Finding
from pneutouch.spec.printer import Mode, Printer

RULE = "voxels"


def check_stack(
    printer: Printer, mode: Mode, resins: Sequence[str], layers: int, size: tuple[float, float, float], body: str
) -> list[Finding]:
    """Findings on a stack of ``layers`` slices, ``size`` mm (x, y, z) with its empty border, of base ``resins``.

    A stack cannot be turned on the tray: its pixels are not square.
    """
    rules = printer.voxel_print
    if rules is None:
        text = f"the {printer.title} takes no voxel stacks (its profile has no voxel_print)"
        fix = "set print.profile to a printer that does, such as j735"
        return [Finding(RULE, "error", body, text, fix, "printer profile", None, None)]
    findings = []
    missing = sorted(set(resins) - set(printer.resins))
    if missing:
        text = f"{printer.title} does not run {', '.join(missing)}; it runs {', '.join(printer.resins)}"
        findings.append(Finding(RULE, "error", body, text, "take resins that it runs", rules.source, None, None))
    most = min(rules.colours, printer.resins_at_once, mode.resins_at_once or rules.colours)
    if len(resins) > most:
        text = f"{len(resins)} resins ({', '.join(resins)}); a stack in the mode {mode.name} has {most} colours at most"
        findings.append(
            Finding(
                RULE, "error", body, text, "take fewer resins", rules.source, None, Excess(len(resins), most, "colours")
            )
        )
    if layers < rules.least_slices:
        text = f"{layers} slices of {mode.layer_um:g} um; the utility takes no fewer than {rules.least_slices}"
        fix = "take a mode of thinner layers, or make the part taller"
        findings.append(
            Finding(RULE, "error", body, text, fix, rules.source, None, Excess(layers, rules.least_slices, "slices"))
        )
    envelope = (printer.envelope.x, printer.envelope.y, printer.envelope.z)
    worst = max(zip(size, envelope, strict=True), key=lambda pair: pair[0] / pair[1])
    if worst[0] > worst[1]:
        stack, limits = (
            " x ".join(format(side, form) for side in box) for box, form in ((size, ".1f"), (envelope, "g"))
        )
        text = f"the stack is {stack} mm; the machine builds {limits} mm"
        fix = "make it smaller, or take a larger printer"
        findings.append(Finding(RULE, "error", body, text, fix, printer.envelope.source, None, Excess(*worst, "mm")))
    return findings
