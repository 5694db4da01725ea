"""A port in the side of the plate, along +x: its boss, and the bore from the channel or the opening to its mouth.

A port that points backwards, turned in one with the body that carries it.
"""

import math
from dataclasses import replace

from pneutouch.body import Feature, Frame, Turned, crossing
from pneutouch.parts.layout import Layout
from pneutouch.parts.port import CHANNEL
from pneutouch.shape.meridian import Point, TracedPath, trace

_PAST = 1.0
"""Distance in mm by which a shape reaches past a face that it opens, so that no two faces coincide."""


def side_boss(layout: Layout) -> list[Feature]:
    """The port's solid outside, from within the plate's edge, and its lugs."""
    port, radius = layout.port, layout.plate_radius
    inside = math.sqrt(radius**2 - port.root**2) - _PAST - radius
    faces = [("", (port.root, inside)), *((tag, point) for point, tag in reversed(_faces(layout)))]
    outline = trace((0.0, inside), [*faces, ("", (0.0, port.length))])
    beyond = outline.volume() + math.pi * port.root**2 * (radius + inside) - crossing(radius, port.root)
    boss = Feature(Turned(outline, _frame(layout)), beyond)
    lugs = [Feature(replace(lug, frame=_frame(layout)), port.lug_volume / len(port.lugs)) for lug in port.lugs]
    return [boss, *lugs]


def side_bore(layout: Layout, across: float) -> Feature:
    """The bore from a vertical hole of radius ``across`` to the mouth; ``net`` is the volume that it adds to that
    hole."""
    port = layout.port
    start = math.sqrt(across**2 - port.passage**2)
    low = 0.5 * start - layout.plate_radius
    mouth = (port.hollow[0][0], port.length + _PAST)
    faces = [("", (port.passage, low)), *(("", point) for point in reversed(port.hollow)), ("", mouth)]
    outline = trace((0.0, low), [*faces, ("", (0.0, mouth[1]))])
    return Feature(Turned(outline, _frame(layout)), side_volume(layout, across))


def side_volume(layout: Layout, across: float) -> float:
    """Volume in mm3 of bore and port's hollow from the wall of a vertical hole of radius ``across`` to the mouth."""
    port = layout.port
    return port.hollow_volume(-layout.plate_radius) - crossing(across, port.passage)


def _faces(layout: Layout) -> list[tuple[tuple[float, float], str]]:
    """End point and tag of the outside faces, each tag at the end that a walk from the root reaches."""
    port = layout.port
    points = [port.hollow[0], *(point for point, _ in port.outside)]
    return [(points[k], tag) for k, (_, tag) in enumerate(port.outside)] + [(points[-1], "")]


def _frame(layout: Layout) -> Frame:
    assert layout.port_axis is not None
    return Frame((layout.plate_radius, 0.0, layout.port_axis), axis=(1.0, 0.0, 0.0), across=(0.0, 0.0, 1.0))


def outward(layout: Layout) -> tuple[Point, TracedPath]:
    """The path from the inner edge of the port's mouth over its outside to the rear face."""
    port = layout.port
    return _at(layout, port.hollow[0]), [(tag, _at(layout, point)) for point, tag in port.outside]


def inward(layout: Layout) -> TracedPath:
    """The path from the upper end of the channel down to the inner edge of the port's mouth."""
    port = layout.port
    meeting = _at(layout, port.hollow[-1])[1]
    points = [(layout.channel_radius, meeting), *(_at(layout, point) for point in reversed(port.hollow))]
    return [(CHANNEL, point) for point in points]


def rear_lugs(layout: Layout) -> list[Feature]:
    """The lugs of a lock; none for most ports."""
    frame = Frame((0.0, 0.0, layout.under), axis=(0.0, 0.0, -1.0))
    lugs = layout.port.lugs
    return [Feature(replace(lug, frame=frame), layout.port.lug_volume / len(lugs)) for lug in lugs]


def _at(layout: Layout, point: Point) -> Point:
    return point[0], layout.under - point[1]
