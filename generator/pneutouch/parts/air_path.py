"""The air's path from the base plane to the gauge, as round ducts in series with volumes connected to them.

Its volume is `internal_volume` plus the tube; the dead volume as drawn follows from it.
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts.layout import Layout, plug_neck, plug_radius
from pneutouch.shape.meridian import Line
from pneutouch.spec.part import ClampedFlange, OnePiece

UNKNOWN_END = 150.0
"""Greatest gas volume, mm3, taken for a gauge whose maker states none: dead-ended tubes of 1.37 mm bore and 0.2 to 2 m
resonate 6 to 25 % below a line with a stated 4.7 mm3, mostly explained by 150 mm3 (curves read off a figure)."""


def internal_volume(scene: ResolvedDesign, layout: Layout) -> float:
    """Volume in mm3 between the base plane and the mouth of the port, with the fitting or tube in place."""
    return channel_volume(layout) + gap_volume(scene, layout) - layout.port.filled_volume()


def side_volume(layout: Layout, across: float) -> float:
    """Volume in mm3 of a side port's bore and hollow, mouth to wall of a vertical hole of radius ``across`` mm."""
    port = layout.port
    return port.hollow_volume(-layout.plate_radius) - crossing(across, port.passage)


def channel_volume(layout: Layout) -> float:
    """Volume in mm3 of channel, side bore and port's hollow, without a fitting; a plug's opening replaces a channel."""
    port, radius = layout.port, layout.channel_radius
    if layout.port_axis is None:
        meeting = layout.under - port.hollow[-1][1]
        return port.hollow_volume(port.hollow[-1][1]) + math.pi * radius**2 * (layout.floor - meeting)
    if layout.opening_radius:
        return side_volume(layout, layout.opening_radius)
    return side_volume(layout, radius) + math.pi * radius**2 * (layout.floor - layout.channel_low)


def gap_volume(scene: ResolvedDesign, layout: Layout) -> float:
    """Volume in mm3 of the gap inside a clamped flange or around a plug; other gaps are filled with glue."""
    seat = scene.seat
    if isinstance(seat, ClampedFlange):
        return inside_flange(layout)
    if isinstance(seat, OnePiece):
        bottom, body = layout.under + seat.shoulder_thickness, plug_radius(scene, layout)
        if layout.port_axis is None:
            return annulus(body, layout.opening_radius, layout.floor - bottom)
        neck, step = plug_neck(scene, layout)
        beside = annulus(neck, layout.opening_radius, layout.floor - step)
        return annulus(body, layout.opening_radius, step - bottom) + beside
    return 0.0


def inside_flange(layout: Layout) -> float:
    """Volume in mm3 of the gap between spigot and flange, and inside a gasket, which begins where the flange does."""
    inside = Line(
        (layout.inner_radius + layout.flange_draft, -layout.flange_thickness), layout.shape.inner[0].start, ""
    )
    spigot = annulus(0.0, layout.groove_inner, layout.flange_thickness + layout.floor)
    gasket = annulus(layout.groove_inner, layout.inner_radius + layout.flange_draft, layout.gasket)
    return inside.swept() - spigot - layout.shape.pocket + gasket


def draft(radius: float, draft: float, layout: Layout) -> float:
    """Volume in mm3 between an upright side of the flange and one that leans by ``draft`` mm over its height."""
    return math.pi * layout.flange_thickness * abs(draft) * (radius + draft / 3)


def annulus(inner: float, outer: float, height: float) -> float:
    """Volume in mm3 between two cylinders about one axis."""
    return math.pi * (outer**2 - inner**2) * height


_NOTHING = 1e-9
"""Length or volume, mm or mm3, below which a piece is due to rounding."""


@dataclass(frozen=True, slots=True)
class AirPiece:
    """A round piece of the path, mm: ``name`` is gap (a volume open to the cavity), channel, port, tube or adaptor."""

    name: str
    length: float
    radius: float

    @property
    def volume(self) -> float:
        """Volume, mm3."""
        return math.pi * self.radius**2 * self.length


def air_path(scene: ResolvedDesign, layout: Layout) -> tuple[AirPiece, ...]:
    """Pieces in order from the cavity; a cone is replaced by a cylinder of its length and volume.

    A channel crossed by a side port has the length of its axis to the crossing, and a radius that gives it its exact
    volume with the blind end included.
    """
    port = _port_pieces(layout)
    if layout.port_axis is not None and not layout.opening_radius:
        # The bore of a side port from the wall of the channel to the port's hollow.
        length = layout.port.hollow[-1][1] + layout.plate_radius - layout.channel_radius
        port = [*_cylinder("port", length, math.pi * layout.port.passage**2 * length), *port]
    whole = channel_volume(layout) - layout.port.filled_volume()
    channel = whole - sum(piece.volume for piece in port)
    pieces = [*_gap(scene, layout), *_cylinder("channel", _channel_length(layout), channel), *port]
    tube = scene.design.pneumatics.tube_length_mm
    pieces += _cylinder("tube", tube, math.pi * (0.5 * scene.tube.inner_diameter) ** 2 * tube)
    for length, bore in scene.design.pneumatics.adaptors_mm or ():
        pieces += _cylinder("adaptor", length, math.pi * (0.5 * bore) ** 2 * length)
    return tuple(pieces)


def _gap(scene: ResolvedDesign, layout: Layout) -> list[AirPiece]:
    """Gap of a seat, if it has one, as a cylinder with its volume, as long as wide: only the volume is used."""
    volume = gap_volume(scene, layout)
    if volume < _NOTHING:
        return []
    radius = (volume / (2.0 * math.pi)) ** (1.0 / 3.0)
    return [AirPiece("gap", 2.0 * radius, radius)]


def _channel_length(layout: Layout) -> float:
    """Length of the channel from the base plane, or the wall of a plug's opening, to the port or its bore."""
    if layout.port_axis is None:
        return layout.port.hollow[-1][1] - layout.under + layout.floor
    if layout.opening_radius:
        return layout.port.hollow[-1][1] + layout.plate_radius - layout.opening_radius
    return layout.floor - layout.port_axis


def _port_pieces(layout: Layout) -> list[AirPiece]:
    """Pieces of the port's hollow from its inner end to the mouth, without the part taken by the fitting or tube."""
    port = layout.port
    end = port.length - port.engaged
    pieces = []
    for (outer, high), (inner, low) in pairwise(port.hollow):
        top = min(high, end)
        if top - low > _NOTHING:
            share = (top - low) / (high - low)
            wide = inner + share * (outer - inner)
            volume = math.pi / 3.0 * (wide**2 + wide * inner + inner**2) * (top - low)
            pieces += _cylinder("port", top - low, volume)
    pieces.reverse()
    return [*pieces, *_cylinder("port", port.engaged, math.pi * port.fitting_bore**2 * port.engaged)]


def _cylinder(name: str, length: float, volume: float) -> list[AirPiece]:
    if volume < _NOTHING:
        return []
    length = max(length, _NOTHING)
    return [AirPiece(name, length, math.sqrt(volume / (math.pi * length)))]


def crossing(radius: float, bore: float) -> float:
    """Volume in mm3 of a round bore between axis and wall of a cylinder that it crosses centrally at right angles.

    Integral of sqrt(R^2 - y^2) over the disc of radius ``bore`` <= R, by Gauss-Chebyshev quadrature of the second kind
    with 64 nodes, accurate to 1e-12 up to bore = 0.95 R. Raises ValueError for a wider bore.
    """
    if bore > radius:
        raise ValueError("the bore must not be wider than the cylinder it crosses")
    n = 64
    angle = np.pi * np.arange(1, n + 1) / (n + 1)
    weight = np.pi / (n + 1) * np.sin(angle) ** 2
    return float(2 * bore**2 * np.sum(weight * np.sqrt(radius**2 - (bore * np.cos(angle)) ** 2)))
