"""Driving pressures against the limits of the sensor: limit point, break strain, gauge."""

from __future__ import annotations

from pneutouch.mechanics import Prediction
from pneutouch.mechanics.limits import RATED_SHARE
from pneutouch.parts import Assembly
from pneutouch.printability.finding import Finding
from pneutouch.units import KPA

_SOURCES = {
    "limit point": "paper, section 4-A: the valid range ends at the maximum driving pressure",
    "break strain": "lower end of the material's elongation at break",
    "gauge range": "paper, Supplement C: SMC PSE543-R06, +-100 kPa",
}


def check(assembly: Assembly, prediction: Prediction) -> list[Finding]:
    """Compare the highest driving pressure with the limit that binds."""
    limits = prediction.limits
    highest = prediction.states[-1].driving_pressure
    apex = (0.0, 0.0, prediction.states[-1].apex_outer)
    fix = f"lower pneumatics.driving_pressures_kPa below {RATED_SHARE * limits.lowest / KPA:.1f}"
    source = _SOURCES[limits.binding]
    text = f"{highest / KPA:g} kPa against the {limits.binding} at {limits.lowest / KPA:.1f} kPa"
    if highest > limits.lowest:
        return [Finding("driving", "error", "membrane", text, fix, source, apex)]
    if highest > RATED_SHARE * limits.lowest:
        return [Finding("driving", "warning", "membrane", text, fix, source, apex)]
    return []
