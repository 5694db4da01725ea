"""Ports: the lower end of the connector, drawn from the channel's end to the plate and back outside."""

from __future__ import annotations

from itertools import pairwise

from pneutouch.meridian import Line, Point
from pneutouch.spec.part import Barb

TIP_WALL = 0.3
"""Wall in mm left at the tip of a barb: a blunt edge that prints and does not cut the tube."""


def barb_tip(port: Barb) -> float:
    """Radius of the barb's tip: it must enter the tube, and keep a wall around the bore."""
    return max(0.5 * port.tube_inner_diameter, 0.5 * port.bore_diameter + TIP_WALL)


def port_length(port: Barb) -> float:
    """How far the port reaches below the plate, mm."""
    return port.stem_length + port.barb_length


def port_outside(port: Barb, plate_low: float) -> list[Line]:
    """The port's outer faces from the bore's mouth up to the underside of the plate."""
    stem, barb, bore = (0.5 * d for d in (port.stem_diameter, port.barb_diameter, port.bore_diameter))
    shoulder = plate_low - port.stem_length
    tip = shoulder - port.barb_length
    points: list[Point] = [
        (bore, tip), (barb_tip(port), tip), (barb, shoulder), (stem, shoulder), (stem, plate_low)
    ]  # fmt: skip
    tags = ["port mouth", "barb", "barb shoulder", "stem"]
    return [Line(a, b, tag) for (a, b), tag in zip(pairwise(points), tags, strict=True)]
