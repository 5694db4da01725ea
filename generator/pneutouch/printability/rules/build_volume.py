"""Each job, as it stands, against the build envelope of its machine.

The dome's wall in whole layers and pixels, and what rounding it does to the sensitivity.
"""

import math
from typing import NamedTuple

import numpy as np

from pneutouch.mechanics import Sensor
from pneutouch.printability.view import PrintJob, PrintView
from pneutouch.results.printing import Excess, Finding
from pneutouch.units import KPA, UM


def check_envelope(view: PrintView) -> list[Finding]:
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
        Excess(z, envelope.z, "mm"),
        Excess(max(x, y), max(envelope.x, envelope.y), "mm"),
        Excess(min(x, y), min(envelope.x, envelope.y), "mm"),
    ]
    worst = max(excesses, key=lambda excess: excess.measured / excess.limit)
    part = job.parts[0]
    limits = f"{envelope.x:g} x {envelope.y:g} x {envelope.z:g} mm"
    text = f"{x:.1f} x {y:.1f} x {z:.1f} mm as it stands; the machine builds {limits}"
    fix = part.item.hints.get("envelope", "make it smaller, lay it down, or take a larger printer")
    return Finding("envelope", "error", part.name, text, fix, envelope.source, None, worst)


_SOURCE = "layer height and pixel as the printer's profile states them; a tenth of a step: own, unverified"
_OFF = 0.1
"""Share of a step by which a wall may miss a whole number of them."""


_FAR = 4.0
"""The advised wall is at most this many of the coarser steps from the one drawn."""


class WallStep(NamedTuple):
    """The machine's step across the wall at one place: layers or pixels, mm."""

    unit: str
    place: str
    size: float

    def off(self, wall: float) -> float:
        """Share of a step by which a wall misses a whole number of them."""
        return abs(wall / self.size - round(wall / self.size))

    def printed(self, wall: float) -> tuple[float, float]:
        """The walls that it prints as, mm."""
        return self.size * math.floor(wall / self.size), self.size * math.ceil(wall / self.size)


def check_layers(view: PrintView) -> list[Finding]:
    """Compare the wall with the steps of the machine at the pole and at the rim: one finding a wall.

    The wall of a calibrated sensor is printed already, and fitted: nothing is found of it. A cast one has no steps.
    """
    context = view.sensor
    part = None if context is None else view.part(context.membrane)
    if context is None or part is None or context.calibrated or part.item.printer.is_casting:
        return []
    printer, wall = part.item.printer, context.sensor.dome.wall_thickness
    upright = abs(part.item.up[2]) / float(np.linalg.norm(part.item.up)) > 0.7
    along, across = ("pole", "rim") if upright else ("rim", "pole")
    layer = WallStep("layers", along, UM * part.item.mode.layer_um)
    pixel = WallStep("pixels", across, UM * max(printer.pixel.x_um, printer.pixel.y_um))
    missed = [step for step in (layer, pixel) if step.off(wall) > _OFF]
    if not missed:
        return []
    clauses = [
        f"{wall / step.size:.1f} {step.unit} of {step.size / UM:g} um at the {step.place}, where it prints as "
        f"{low:.3f} or {high:.3f} mm"
        for step in missed
        for low, high in [step.printed(wall)]
    ]
    ends = [end for step in missed for end in step.printed(wall)]
    read = _sensitivities(context.sensor, context.prediction.states[-1].driving_pressure, min(ends), max(ends))
    best, shape = _advised(wall, layer, pixel), context.sensor.dome.shape
    counts = f"{best / layer.size:.0f} layers and {best / pixel.size:.1f} pixels"
    fix = part.item.hints.get("layers", f"draw the wall {best:.3f} mm thick: {counts}")
    at = (
        (0.0, 0.0, shape.height + 0.5 * wall)
        if missed[0].place == "pole"
        else (shape.inner_radius + 0.5 * wall, 0.0, 0.0)
    )
    excess = Excess(missed[0].off(wall), _OFF, missed[0].unit)
    text = f"the wall is {', and '.join(clauses)}{read}"
    return [Finding("layers", "note", part.name, text, fix, _SOURCE, at, excess)]


def _advised(wall: float, layer: WallStep, pixel: WallStep) -> float:
    """The nearest wall, mm, of whole layers that is close to whole pixels; if there is none, the closest to them."""
    far = _FAR * max(layer.size, pixel.size)
    numbers = range(max(1, math.ceil((wall - far) / layer.size)), math.floor((wall + far) / layer.size) + 1)
    walls = [number * layer.size for number in numbers]
    return min(walls, key=lambda one: (max(pixel.off(one), _OFF), abs(one - wall)))


def _sensitivities(sensor: Sensor, pressure: float, low: float, high: float) -> str:
    """The atlas's sensitivities between both walls; nothing where it does not cover the sensor."""
    from pneutouch.mechanics.atlas.press import batch_of
    from pneutouch.mechanics.atlas.respond import OUTSIDE, respond
    from pneutouch.mechanics.models.choice import outside

    sensitivities = []
    for wall in (low, high):
        other = sensor.replace(wall_thickness=wall)
        if outside("atlas", other) is not None:
            return ""
        response = respond(batch_of(other, [pressure]), sensor.protocol.steps)
        value = float(response.lines.sensitivity[0])
        if response.ends[0] == OUTSIDE or not np.isfinite(value):
            return ""
        sensitivities.append(value)
    least, most = sorted(sensitivities)
    return f"; it reads {least:.3f} to {most:.3f} kPa/N at {pressure / KPA:g} kPa"
