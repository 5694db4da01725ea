"""The dome's wall in whole layers and pixels, and what rounding it does to the sensitivity."""

import numpy as np

from pneutouch.mechanics import Sensor
from pneutouch.printability.finding import Excess, Finding
from pneutouch.printability.view import PrintPart, PrintView, SensorContext
from pneutouch.units import KPA, UM

_SOURCE = "layer height and pixel as the printer's profile states them; a tenth of a step: own, unverified"
_OFF = 0.1
"""Share of a step by which a wall may miss a whole number of them."""


def check(view: PrintView) -> list[Finding]:
    """Compare the wall with the steps of the machine at the pole and at the rim."""
    context = view.sensor
    part = None if context is None else view.part(context.membrane)
    if context is None or part is None:
        return []
    printer, wall = part.item.printer, context.sensor.dome.wall_thickness
    layer = UM * part.item.mode.layer_height_um
    pixel = UM * max(printer.resolution.x_um, printer.resolution.y_um)
    upright = abs(part.item.up[2]) / float(np.linalg.norm(part.item.up)) > 0.7
    steps = {"layers": ("pole" if upright else "rim", layer), "pixels": ("rim" if upright else "pole", pixel)}
    findings = [_check(context, part, where, unit, step, wall) for unit, (where, step) in steps.items()]
    return [finding for finding in findings if finding is not None]


def _check(context: SensorContext, part: PrintPart, where: str, unit: str, step: float, wall: float) -> Finding | None:
    count = wall / step
    off = abs(count - round(count))
    if off <= _OFF:
        return None
    low, high = step * np.floor(count), step * np.ceil(count)
    text = (
        f"the wall at the {where} is {count:.1f} {unit} of {step / UM:g} um: it prints as {low:.3f} or {high:.3f} mm"
        f"{_sensitivities(context.sensor, context.prediction.states[-1].driving_pressure, low, high)}"
    )
    radius = context.sensor.dome.inner_radius + 0.5 * wall
    at = (0.0, 0.0, radius) if where == "pole" else (radius, 0.0, 0.0)
    fix = part.item.hints.get("layers", f"draw the wall {round(count) * step:.3f} mm thick")
    return Finding("layers", "note", part.name, text, fix, _SOURCE, at, Excess(off, _OFF, unit))


def _sensitivities(sensor: Sensor, pressure: float, low: float, high: float) -> str:
    """The atlas's sensitivities for both walls; nothing where it does not cover the sensor."""
    from pneutouch.mechanics.atlas.batches import batch_of
    from pneutouch.mechanics.atlas.respond import OUTSIDE, respond
    from pneutouch.mechanics.atlas_states import outside_atlas

    sensitivities = []
    for wall in (low, high):
        other = sensor.replace(wall_thickness=wall)
        if outside_atlas(other) is not None:
            return ""
        response = respond(batch_of(other, [pressure]), sensor.protocol.steps)
        value = float(response.lines.sensitivity_kPa_per_N[0])
        if response.ends[0] == OUTSIDE or not np.isfinite(value):
            return ""
        sensitivities.append(value)
    return f", and reads {sensitivities[0]:.3f} or {sensitivities[1]:.3f} kPa/N at {pressure / KPA:g} kPa"
