"""A port that points backwards, turned in one with the body that carries it."""

from dataclasses import replace

from pneutouch.body import Feature, Frame
from pneutouch.meridian import Point
from pneutouch.parts.layout import Layout
from pneutouch.parts.port import CHANNEL
from pneutouch.parts.trace import TracedPath


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
