"""Driving pressures against the rating of the sensor: limit point, break strain, gauge, and how well they are known."""

from pneutouch.printability.view import PrintView, SensorContext
from pneutouch.results.printing import Excess, Finding
from pneutouch.units import KPA

_SOURCES = {
    "limit point": "paper, section 4-A: the valid range ends at the maximum driving pressure",
    "break strain": "lower end of the material's elongation at break",
    "law range": "the stretch up to which the material's law was fitted (its file), against that of the inflated wall",
    "gauge range": "paper, Supplement C: SMC PSE543-R06, +-100 kPa",
}


def check_driving(view: PrintView) -> list[Finding]:
    """Compare the highest driving pressure with the rated pressure and with the nominal limit; and with a gauge that
    the design names the pressure while pressed."""
    return [] if view.sensor is None else [*_driven(view.sensor), *_pressed(view.sensor)]


def _pressed(context: SensorContext) -> list[Finding]:
    """The states whose range ends at that of the gauge."""
    gauge, limit = context.gauge, context.sensor.gas.gauge_limit / KPA
    if gauge is None:
        return []
    ended = [
        (state, event)
        for state in context.prediction.states
        for event in state.events
        if event.kind == "gauge range" and event.ends_range
    ]
    if not ended:
        return []
    state, event = ended[-1]
    return [
        Finding(
            "driving",
            "warning",
            context.membrane,
            f"pressed from {state.driving_pressure / KPA:g} kPa, the cavity passes the {limit:g} kPa that the "
            f"{gauge.title} reads at {event.indentation:.2f} mm of the {context.sensor.protocol.depth:.2f} mm",
            "take a pneumatics.gauge that reads further, lower pneumatics.driving_pressures_kPa or press less",
            gauge.range_kPa.source,
            (0.0, 0.0, state.apex_outer),
            None,
        )
    ]


def _driven(context: SensorContext) -> list[Finding]:
    rating, last = context.rating, context.prediction.states[-1]
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
            context.membrane,
            text,
            fix if remedy is None else f"{fix}, or {remedy}",
            context.gauge.range_kPa.source
            if context.gauge is not None and limit.name == "gauge range"
            else _SOURCES[limit.name],
            (0.0, 0.0, last.apex_outer),
            Excess(last.driving_pressure / KPA, rating.pressure / KPA, "kPa"),
        )
    ]
