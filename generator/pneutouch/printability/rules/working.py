"""Rules on the working of the sensor: its wall in layers, driving pressures, bond of its glue, freedom to move."""

import math
from typing import NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.events import NO_LINE, ON_FLANGE
from pneutouch.mechanics.rating import BUCKLING
from pneutouch.parts.glue import GLUES, glues_for, surface_of
from pneutouch.printability.view import PrintPart, PrintView, SensorContext
from pneutouch.results.printing import Excess, Finding
from pneutouch.spec.part import ORingStub
from pneutouch.units import KPA, UM
from pneutouch.wording import data_of, tenths_below

_SOURCES: dict[str, str] = data_of(__file__)
_OFF = 0.1
"""Share of a step by which a wall may differ from a whole number of steps."""


_FAR = 4.0
"""Greatest distance of the advised wall from the drawn one, in units of the coarser of both steps."""


class WallStep(NamedTuple):
    """The machine's step across the wall at one place: layers or pixels of ``size`` mm."""

    unit: str
    place: str
    size: float

    def off(self, wall: float) -> float:
        """Share of a step by which a wall differs from the nearest whole number of steps."""
        return abs(wall / self.size - round(wall / self.size))

    def printed(self, wall: float) -> tuple[float, float]:
        """Walls of whole steps next below and next above a wall, mm."""
        return self.size * math.floor(wall / self.size), self.size * math.ceil(wall / self.size)


def check_layers(view: PrintView) -> list[Finding]:
    """Finding on a wall that is no whole number of the machine's steps at the pole or at the rim.

    The wall of a calibrated sensor is printed already, and fitted: it has no finding. A cast wall has no steps, and one
    that varies is rounded to them somewhere else at each place.
    """
    context = view.sensor
    part = None if context is None else view.part(context.membrane)
    varies = context is not None and getattr(context.sensor.dome.shape, "wall_stations", None)
    if context is None or part is None or context.calibrated or part.item.printer.is_casting or varies:
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
        (0.0, 0.0, shape.inner_height + 0.5 * wall)
        if missed[0].place == "pole"
        else (shape.inner_radius + 0.5 * wall, 0.0, 0.0)
    )
    excess = Excess(missed[0].off(wall), _OFF, missed[0].unit)
    text = f"the wall is {', and '.join(clauses)}{read}"
    return [Finding("layers", "note", part.name, text, fix, _SOURCES["steps"], at, excess)]


def _advised(wall: float, layer: WallStep, pixel: WallStep) -> float:
    """The nearest wall, mm, of whole layers that is close to whole pixels; if there is none, the closest to them."""
    far = _FAR * max(layer.size, pixel.size)
    numbers = range(max(1, math.ceil((wall - far) / layer.size)), math.floor((wall + far) / layer.size) + 1)
    walls = [number * layer.size for number in numbers]
    return min(walls, key=lambda one: (max(pixel.off(one), _OFF), abs(one - wall)))


def _sensitivities(sensor: Sensor, pressure: float, low: float, high: float) -> str:
    """Words on the atlas's sensitivities with both walls, mm; empty if it does not cover the sensor."""
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


def check_driving(view: PrintView) -> list[Finding]:
    """Findings on a highest driving pressure above the rated pressure or the nominal limit, and on presses that pass
    the range of a gauge that the design names."""
    return (
        []
        if view.sensor is None
        else [*_driven(view.sensor), *_emptied(view.sensor), *_pressed(view.sensor), *_unlined(view.sensor)]
    )


def _unlined(context: SensorContext) -> list[Finding]:
    """Findings on the states whose curves give no sensitivity."""
    states = context.prediction.all_states
    lost = [(one, event) for one in states for event in one.warned if event.kind == NO_LINE]
    lined, source, found = [one.driving_pressure for one in states if one.figures], _SOURCES["no line"], []
    for state, event in lost:
        near = min(lined, key=lambda pressure: abs(pressure - state.driving_pressure), default=None)
        other = "another driving pressure" if near is None else f"{near / KPA:.4g} kPa as the driving pressure"
        fix = f"take {other} or a thicker wall"
        text, at = f"pressed from {state.driving_pressure / KPA:.4g} kPa: {event.message}", (0.0, 0.0, state.apex_outer)
        found.append(Finding("driving", "warning", context.membrane, text, fix, source, at, None))
    return [*found, *_blocked(context)]


def _blocked(context: SensorContext) -> list[Finding]:
    """Findings on the states at which the object comes down on the flange before the depth of the test."""
    states, depth, found = context.prediction.all_states, context.sensor.protocol.depth, []
    for state in states:
        end = next((event.indentation for event in state.events if event.kind == ON_FLANGE), depth)
        if end < depth and state.driving_pressure >= 0.0:
            text = f"pressed from {state.driving_pressure / KPA:.4g} kPa: the object comes down on the flange, or the "
            text += f"ring on it, at {end:.2f} mm of {depth:.2f} mm"
            fix = "take a smaller object, a higher driving pressure, a boss on the disc or less indentation.depth_mm"
            at = (0.0, 0.0, state.apex_outer)
            found.append(Finding("driving", "warning", context.membrane, text, fix, _SOURCES["flange"], at, None))
    return found


def _pressed(context: SensorContext) -> list[Finding]:
    """Finding on the states whose range ends at the range of the gauge."""
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


def _emptied(context: SensorContext) -> list[Finding]:
    """Finding on a vacuum beyond the least driving pressure."""
    rating, least = context.rating, min(state.driving_pressure for state in context.prediction.all_states)
    if least >= 0.0 or rating.severity(least) is None:
        return []
    place = (0.0, 0.0, context.sensor.dome.shape.outer_height)
    bound = -tenths_below(-rating.least / KPA)
    fix = f"raise the least of pneumatics.driving_pressures_kPa to {bound:.1f} or more, or thicken the wall"
    return [Finding("driving", "warning", context.membrane, rating.excess(least), fix, _SOURCES[BUCKLING], place, None)]


def _driven(context: SensorContext) -> list[Finding]:
    rating, last = context.rating, max(context.prediction.all_states, key=lambda state: state.driving_pressure)
    severity = rating.severity(last.driving_pressure)
    if severity is None:
        return []
    text, limit = rating.excess(last.driving_pressure), rating.nominal
    if severity == "warning":
        text, limit = f"{text}: {rating.basis}", rating.limit
    remedy = rating.remedy_for(last.driving_pressure)
    fix = f"lower pneumatics.driving_pressures_kPa to at most {rating.pressure_kPa:.1f}"
    if last.held is not None:
        fix = f"fill it less, to at most {rating.pressure_kPa:.1f} kPa: a lower volume or height in [pneumatics]"
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


_SEATS = "take connector.seat = clamped-flange-M2, which needs none"


def check_glue(view: PrintView) -> list[Finding]:
    """Finding on a glue that bonds its two surfaces weakly or not; none if no glue is named or chosen."""
    context = view.sensor
    if context is None or context.glued is None or context.calibrated:
        return []
    name, one, other = context.glued
    glue = GLUES[name]
    bond = glue.bond(one, other)
    if bond is not None and not bond.weak:
        return []
    pair = one if one == other else f"{one} and {other}"
    better = [each for each in glues_for(one, other) if each != name]
    named = f"take connector.glue = {' or '.join(better)}" if bond is None and better else ""
    fix = ", or ".join(part for part in (named, _SEATS) if part)
    if bond is None:
        text = f"{glue.title} does not bond {pair}: the flange comes off"
        return [Finding("glue", "error", context.membrane, text, fix, glue.source, None, None)]
    text = f"{glue.title} on {pair} carries small loads: the flange may peel off under pressure"
    return [Finding("glue", "warning", context.membrane, text, fix, glue.source, None, None)]


def check_inserts(view: PrintView) -> list[Finding]:
    """Findings on heat-set inserts of seat and mount in a connector that does not melt."""
    context = view.sensor
    scene = None if context is None or context.calibrated else context.scene
    if scene is None or surface_of(scene.connector_printer) == "thermoplastic":
        return []
    text = f"{scene.connector_material.title} does not melt: a heat-set insert finds no hold in it"
    fix = "take a connector.{} with tapped holes (inserts can be glued into them), or a connector of filament"
    named = {key: getattr(scene.design.connector, key) for key in ("seat", "mount")}
    source, with_inserts = _SOURCES["inserts"], [key for key in named if getattr(getattr(scene, key), "insert", None)]
    return [
        Finding("inserts", "error", "connector", f"{named[key]}: {text}", fix.format(key), source, None, None)
        for key in with_inserts
    ]


_SQUEEZE, _FILL, _STRETCH = (0.15, 0.30), 0.85, 0.05
"""Least and greatest squeeze of a static O-ring, greatest share of its groove that it fills, and greatest stretch."""


class Gland(NamedTuple):
    """Numbers of an O-ring in its groove: squeeze as drawn, and least and greatest by the tolerances; fill; stretch."""

    squeeze: float
    least: float
    most: float
    fill: float
    stretch: float


def gland(port: ORingStub, accuracy: float) -> Gland:
    """The gland of a stub whose printer makes a length within ``accuracy`` mm.

    A stretched ring is thinner by half the stretch. Tolerances of groove, bore and ring add up as independent ones.
    """
    nominal = np.array([port.groove_diameter, port.bore, port.section])
    off = np.diag([accuracy, port.bore_tolerance, port.section_tolerance])
    groove, bore, ring = np.vstack([nominal, nominal + off]).T
    stretch, depth = groove / port.ring_diameter - 1.0, 0.5 * (bore - groove)
    section = ring * (1.0 - 0.5 * stretch)
    squeeze = 1.0 - depth / section
    spread, exact = float(np.linalg.norm(squeeze[1:] - squeeze[0])), float(squeeze[0])
    fill = float(0.25 * math.pi * section[0] ** 2 / (depth[0] * port.groove_width))
    return Gland(exact, exact - spread, exact + spread, fill, float(stretch[0]))


def check_gland(view: PrintView) -> list[Finding]:
    """Findings on an O-ring whose squeeze, with the tolerances of print and ring, fill or stretch is out of bounds."""
    context = view.sensor
    if context is None or context.scene is None or context.calibrated or not isinstance(context.scene.port, ORingStub):
        return []
    made = gland(context.scene.port, context.scene.connector_printer.accuracy_mm.nominal)
    ranges = (
        ("is squeezed by", (made.least, made.most), _SQUEEZE),
        ("fills of its groove", (made.fill, made.fill), (0.0, _FILL)),
        ("is stretched by", (made.stretch, made.stretch), (0.0, _STRETCH)),
    )
    fix = "turn the groove to size after printing, or take another connector.port or print.connector_profile"
    found = []
    for words, ends, bounds in ranges:
        for sign, end, bound in zip((-1.0, 1.0), ends, bounds, strict=True):
            if sign * (end - bound) > 0.0:
                text = f"the O-ring {words} {end:.1%} with the tolerances of print and ring, {bound:.0%} is the bound"
                by = Excess(100 * end, 100 * bound, "%")
                found.append(Finding("gland", "warning", "connector", text, fix, _SOURCES["gland"], None, by))
    return found


_TOUCH = 0.05
"""Depth in mm up to which an overlap is within the errors of mesh and prediction."""


def check_freedom(view: PrintView) -> list[Finding]:
    """Findings on the deepest overlap of the inflated or pressed wall with each other body; none without shapes."""
    if view.sensor is None:
        return []
    others = [part for part in view.parts if part.name != view.sensor.membrane and part.sound]
    findings = []
    for part in others:
        worst: tuple[float, str, tuple[float, float, float]] | None = None
        for state in view.sensor.prediction.states:
            for shape in state.shapes:
                depth, where = _deepest(part, shape.cells.reshape(-1, 2))
                if depth > _TOUCH and (worst is None or depth > worst[0]):
                    pressed = "" if shape.indentation is None else f", pressed by {shape.indentation:.2f} mm"
                    worst = depth, f"at {state.driving_pressure / KPA:g} kPa{pressed}", where
        if worst is not None:
            text = f"the dome meets the {part.name} {worst[1]}: they would overlap by {worst[0]:.2f} mm"
            fix = "lower pneumatics.driving_pressures_kPa or indentation.depth_mm, or take another connector.seat"
            findings.append(
                Finding(
                    "freedom",
                    "warning",
                    view.sensor.membrane,
                    text,
                    fix,
                    _SOURCES["meeting"],
                    worst[2],
                    Excess(worst[0], 0.0, "mm"),
                )
            )
    return findings


def _deepest(part: PrintPart, plane: Array) -> tuple[float, tuple[float, float, float]]:
    """Greatest depth, mm, inside a body of points (n, 2), (r, z) in the half plane y = 0, and where; 0 outside."""
    low, high = part.item.body.bounds
    near = plane[(plane[:, 0] >= -1e-9) & (plane[:, 0] < high[0]) & (plane[:, 1] > low[2]) & (plane[:, 1] < high[2])]
    points = np.column_stack([near[:, 0], np.full(len(near), 1e-4), near[:, 1]])
    inside = [len(part.manifold.ray_cast(tuple(p), (p[0], p[1], high[2] + 1.0))) % 2 == 1 for p in points]
    points = points[np.array(inside, bool)]
    if not len(points):
        return 0.0, (0.0, 0.0, 0.0)
    solid = part.item.solid
    gaps = (
        solid.distance(points)
        if solid is not None
        else np.min(np.linalg.norm(part.item.body.vertices[None] - points[:, None], axis=2), axis=1)
    )
    k = int(np.argmax(gaps))
    x, y, z = (float(value) for value in points[k])
    return float(gaps[k]), (x, y, z)
