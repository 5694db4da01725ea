"""Driving pressures against the limits of the sensor: limit point, break strain, gauge."""

from pneutouch.mechanics.limits import RATED_SHARE
from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.view import PrintView
from pneutouch.units import KPA

_SOURCES = {
    "limit point": "paper, section 4-A: the valid range ends at the maximum driving pressure",
    "break strain": "lower end of the material's elongation at break",
    "gauge range": "paper, Supplement C: SMC PSE543-R06, +-100 kPa",
}


def check(view: PrintView) -> list[Finding]:
    """Compare the highest driving pressure with the limit that binds."""
    if view.sensor is None:
        return []
    prediction = view.sensor.prediction
    limits = prediction.limits
    highest = prediction.states[-1].driving_pressure
    if highest <= RATED_SHARE * limits.lowest:
        return []
    apex = (0.0, 0.0, prediction.states[-1].apex_outer)
    rated_kPa = RATED_SHARE * limits.lowest / KPA
    text = f"{highest / KPA:g} kPa against the {limits.binding} at {limits.lowest / KPA:.1f} kPa"
    return [
        Finding(
            "driving",
            "error" if highest > limits.lowest else "warning",
            view.sensor.membrane,
            text,
            f"lower pneumatics.driving_pressures_kPa below {rated_kPa:.1f}",
            _SOURCES[limits.binding],
            apex,
            Excess(highest / KPA, rated_kPa, "kPa"),
        )
    ]
