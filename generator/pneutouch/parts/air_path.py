"""The air's path from the base plane to the end of the tube, as round ducts in series and volumes open to it.

Its volume is that of `gas.internal_volume` and the tube: what the sensor's dead volume is computed from.
"""

import math
from dataclasses import dataclass
from itertools import pairwise

from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts.gas import channel_volume, gap_volume
from pneutouch.parts.layout import Layout

_NOTHING = 1e-9
"""mm and mm3: below this a piece is rounding."""


@dataclass(frozen=True, slots=True)
class AirPiece:
    """A round piece of the path, mm: ``name`` is gap, channel, port or tube. A gap is open to the cavity."""

    name: str
    length: float
    radius: float

    @property
    def volume(self) -> float:
        """Volume, mm3."""
        return math.pi * self.radius**2 * self.length


def air_path(scene: ResolvedDesign, layout: Layout) -> tuple[AirPiece, ...]:
    """The pieces in order from the cavity; a cone is a cylinder of its length and volume.

    A channel that a side port crosses is as long as its axis to the crossing, and as wide as its exact volume makes it,
    its blind end included.
    """
    port = [*_bore(layout), *_port_pieces(layout)]
    whole = channel_volume(layout) - layout.port.filled_volume()
    channel = whole - sum(piece.volume for piece in port)
    pieces = [*_gap(scene, layout), *_cylinder("channel", _channel_length(layout), channel), *port]
    tube = scene.design.pneumatics.tube_length_mm
    pieces += _cylinder("tube", tube, math.pi * (0.5 * scene.tube.inner_diameter) ** 2 * tube)
    return tuple(pieces)


def _gap(scene: ResolvedDesign, layout: Layout) -> list[AirPiece]:
    """The gap of a seat as a cylinder of its volume as long as wide: only its volume is used."""
    volume = gap_volume(scene, layout)
    if volume < _NOTHING:
        return []
    radius = (volume / (2.0 * math.pi)) ** (1.0 / 3.0)
    return [AirPiece("gap", 2.0 * radius, radius)]


def _channel_length(layout: Layout) -> float:
    """Length of the channel from the base plane, or from the wall of a plug's opening, to where the port or its bore
    begins."""
    if layout.port_axis is None:
        return layout.port.hollow[-1][1] - layout.under
    if layout.opening_radius:
        return layout.port.hollow[-1][1] + layout.plate_radius - layout.opening_radius
    return -layout.port_axis


def _bore(layout: Layout) -> list[AirPiece]:
    """The bore of a side port from the wall of the channel to the port's hollow."""
    if layout.port_axis is None or layout.opening_radius:
        return []
    length = layout.port.hollow[-1][1] + layout.plate_radius - layout.channel_radius
    return _cylinder("port", length, math.pi * layout.port.passage**2 * length)


def _port_pieces(layout: Layout) -> list[AirPiece]:
    """The port's hollow from its inner end to the mouth, as far as the fitting or tube leaves it free."""
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
