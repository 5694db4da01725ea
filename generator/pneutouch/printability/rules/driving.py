"""Driving pressures against the rating of the sensor: limit point, break strain, gauge, and how well they are known."""

from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.view import PrintView
from pneutouch.units import KPA

_SOURCES = {
    "limit point": "paper, section 4-A: the valid range ends at the maximum driving pressure",
    "break strain": "lower end of the material's elongation at break",
    "gauge range": "paper, Supplement C: SMC PSE543-R06, +-100 kPa",
}


def check(view: PrintView) -> list[Finding]:
    """Compare the highest driving pressure with the rated pressure and with the nominal limit."""
    if view.sensor is None:
        return []
    rating, last = view.sensor.rating, view.sensor.prediction.states[-1]
    severity = rating.severity(last.driving_pressure)
    if severity is None:
        return []
    text, limit = rating.excess(last.driving_pressure), rating.nominal
    if severity == "warning":
        text, limit = f"{text}: {rating.basis}", rating.limit
    remedy = rating.remedy_for(last.driving_pressure)
    fix = f"lower pneumatics.driving_pressures_kPa to at most {rating.pressure_kPa:.1f}"
    return [
        Finding(
            "driving",
            severity,
            view.sensor.membrane,
            text,
            fix if remedy is None else f"{fix}, or {remedy}",
            _SOURCES[limit.name],
            (0.0, 0.0, last.apex_outer),
            Excess(last.driving_pressure / KPA, rating.pressure / KPA, "kPa"),
        )
    ]
