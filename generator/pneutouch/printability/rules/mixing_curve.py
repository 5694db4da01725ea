"""Behaviour of a mix if another mixing curve of its pair is true: its fraction is exact, its modulus assumed."""

from pneutouch.mechanics.curve_outcome import CurveOutcome
from pneutouch.printability.finding import Finding
from pneutouch.printability.view import PrintView
from pneutouch.rounding import tenths_below
from pneutouch.units import KPA

_SOURCE = (
    "printprofiles/mixing, docs/background/mixing.md: the published characterizations differ, "
    "none is of these two resins"
)


def check(view: PrintView) -> list[Finding]:
    """One finding for a mix whose pair has several mixing curves; a warning where one of them has no modulus for it."""
    context = view.sensor
    if context is None or not context.curves:
        return []
    texts = [_outcome(outcome) for outcome in sorted(context.curves, key=lambda one: one.by_curve.place != "in use")]
    beyond = [outcome.by_curve.curve for outcome in context.curves if outcome.by_curve.beyond]
    more = f"; {', '.join(beyond)}: stiffer than any resin that it states, perhaps rigid there" if beyond else ""
    fix = "measure the mix on coupons (pneutouch coupons --mixing), or confirm that the design is useful by every curve"
    text = f"the modulus of the mix is assumed: {'; '.join(texts)}{more}"
    return [Finding("mixing curve", "warning" if beyond else "note", context.membrane, text, fix, _SOURCE)]


def _outcome(outcome: CurveOutcome) -> str:
    """A curve with the mean modulus, and sensitivity, range and rating at the highest pressure that was solved."""
    by_curve = outcome.by_curve
    head = f"by {by_curve.curve} ({by_curve.place}) {by_curve.shear_modulus_MPa.nominal:.2f} MPa"
    if not outcome.states or outcome.rated is None:
        return f"{head}, no equilibrium at the design's driving pressures"
    state = outcome.states[-1]
    figures = state.figures
    read = (
        "no straight part"
        if figures is None
        else f"{figures.sensitivity_kPa_per_N:.2f} kPa/N to {figures.force_range[1]:.1f} N"
    )
    rated_kPa = tenths_below(outcome.rated / KPA)
    return f"{head}, {read} at {state.driving_pressure / KPA:g} kPa, rated {rated_kPa:.1f} kPa"
