"""The wall and hole gauge and the step block, which show the printer's small features and its accuracy of length.

The gauge is a plate with four rows of walls, pins, holes and slots, each in ascending order away from the cut corner.
The block is a staircase: four lengths along x, four along z and one along y, each measured between flat faces. The
sizes run from half of the least size that vendors state to above the size that they recommend; they are our own choice.
"""

from dataclasses import dataclass
from itertools import accumulate, pairwise

from pneutouch.body import Bore, Feature, Frame, Prism, Solid, Turned
from pneutouch.parts.coupons.coupon import CALIPER, GAUGE_PINS, ROLE, Coupon, CouponContext, Nominal, instructions
from pneutouch.shape.meridian import Point, cylinder, lines_around

WALLS = (0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.2, 1.6, 2.0)
PINS = HOLES = (0.4, 0.5, 0.6, 0.8, 1.0, 1.5, 2.0, 2.5, 3.0)
SLOTS = (0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.5, 2.0)
STEPS = (5.0, 10.0, 15.0, 20.0)
"""Sizes in mm: thickness of walls and slots, diameter of pins and holes, steps of the block along x and z."""

BLOCK = 20.0
PLATE, WALL_HEIGHT, PIN_HEIGHT, LENGTH = 3.0, 5.0, 4.0, 10.0
"""Sizes in mm: thickness of the plate, height of the walls and pins on it, and length of walls and slots."""

_GAP, _MARGIN, _ROOT, _CORNER = 4.0, 4.0, 1.0, 4.0
"""Sizes in mm: distance between features, margin around them, depth of their root in the plate, and the cut corner."""


@dataclass(frozen=True, slots=True)
class GaugeRow:
    """One row of the gauge: its feature, the sizes, and the position of its middle along y, mm."""

    feature: str
    sizes: tuple[float, ...]
    middle: float

    def places(self) -> list[tuple[float, float]]:
        """Position of the middle along x, and size, of every feature, mm."""
        steps = [_MARGIN + 0.5 * self.sizes[0], *(0.5 * (a + b) + _GAP for a, b in pairwise(self.sizes))]
        return list(zip(accumulate(steps), self.sizes, strict=True))

    @property
    def end(self) -> float:
        """Position along x of the end of the last feature, mm."""
        place, size = self.places()[-1]
        return place + 0.5 * size


def rows() -> tuple[GaugeRow, ...]:
    """The rows from the cut corner upwards."""
    rows: list[GaugeRow] = []
    here = _MARGIN
    for feature, sizes, depth in (
        ("wall", WALLS, LENGTH),
        ("pin", PINS, max(PINS)),
        ("hole", HOLES, max(HOLES)),
        ("slot", SLOTS, LENGTH),
    ):
        rows.append(GaugeRow(feature, sizes, here + 0.5 * depth))
        here += depth + _GAP
    return tuple(rows)


def draw(context: CouponContext) -> tuple[Solid, ...]:
    """The gauge plate and the step block, both standing on z = 0 with their least x and y at 0."""
    walls, pins, holes, slots = rows()
    wide, deep = max(row.end for row in rows()) + _MARGIN, slots.middle + 0.5 * LENGTH + _MARGIN
    corners = [(_CORNER, 0.0), (wide, 0.0), (wide, deep), (0.0, deep), (0.0, _CORNER)]
    adds = [_wall(x, size, walls.middle) for x, size in walls.places()]
    adds += [_pin(x, size, pins.middle) for x, size in pins.places()]
    bores = tuple(Bore(x, holes.middle, 0.5 * size, 0.0, PLATE) for x, size in holes.places())
    cuts = tuple(
        Feature(_strip(x, size, slots.middle, -1.0, PLATE + 1.0), size * LENGTH * PLATE) for x, size in slots.places()
    )
    plate = Solid("gauge", ROLE, context.material, Prism(lines_around(corners), 0.0, PLATE), bores, tuple(adds), cuts)
    return plate, Solid("block", ROLE, context.material, block())


def block() -> Prism:
    """Staircase with its steps rising against x."""
    rise = list(zip(STEPS, reversed(STEPS), strict=True))
    corners: list[Point] = [(0.0, 0.0), (STEPS[-1], 0.0)]
    for x, z in reversed(rise):
        corners += [(x, z), (x - STEPS[0], z)]
    upright = Frame(axis=(0.0, -1.0, 0.0), across=(1.0, 0.0, 0.0))
    return Prism(lines_around(corners), -BLOCK, 0.0, upright)


def nominals(context: CouponContext) -> tuple[Nominal, ...]:
    """Sizes to measure: the lengths of the block, then the rows of the gauge."""
    lengths = [("x", STEPS), ("y", (BLOCK,)), ("z", STEPS)]
    instruments = {"wall": CALIPER, "pin": CALIPER, "hole": GAUGE_PINS, "slot": "feeler gauge, or a microscope"}
    return (
        *(Nominal(axis, size, "mm", CALIPER) for axis, sizes in lengths for size in sizes),
        *(Nominal(row.feature, size, "mm", instruments[row.feature]) for row in rows() for size in row.sizes),
    )


def _strip(x: float, thickness: float, middle: float, low: float, high: float) -> Prism:
    left, right, near, far = x - 0.5 * thickness, x + 0.5 * thickness, middle - 0.5 * LENGTH, middle + 0.5 * LENGTH
    return Prism(lines_around([(left, near), (right, near), (right, far), (left, far)]), low, high)


def _wall(x: float, thickness: float, middle: float) -> Feature:
    return Feature(_strip(x, thickness, middle, PLATE - _ROOT, PLATE + WALL_HEIGHT), thickness * LENGTH * WALL_HEIGHT)


def _pin(x: float, diameter: float, middle: float) -> Feature:
    radius = 0.5 * diameter
    rod = Turned(cylinder(radius, PLATE - _ROOT, PLATE + PIN_HEIGHT), Frame((x, middle, 0.0)))
    return Feature(rod, cylinder(radius, PLATE, PLATE + PIN_HEIGHT).volume())


GAUGE = Coupon("gauge", "wall and hole gauge with a step block", "printer", 1, draw, nominals, **instructions(__file__))
