"""Layout of a pad: where its cells, channels and ports lie, and the outline around them.

Channels are straight, so that a wire cleans them, and run from each cell to its port. The ports are the cells' places
enlarged by one factor; between two heights the axes are their places enlarged by a factor in between. So axes are
nowhere nearer than the cells, and no two channels cross, whatever the pattern.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations, pairwise

from pneutouch.catalogue import ResolvedDesign
from pneutouch.errors import InputError
from pneutouch.parts.layout import Layout, lay_out
from pneutouch.shape.meridian import Arc, Line, Point, Segment
from pneutouch.spec.pad import PadTable
from pneutouch.spec.part import BoltCircle, GluedFlange, PlainPlate

_BETWEEN_PORTS = 1.5
"""Space in mm between two ports or the tubes on them, for fingers: own choice."""
_BETWEEN_DOMES = 0.5
"""Least space in mm between two unloaded domes, for support to come out: own choice."""
_SLOPES = (0.3, 0.2, 0.1, 0.05)
"""Slopes of channels against the vertical that are tried, the thinnest manifold first: own choice."""
_NARROWEST = 0.4
"""Least radius in mm of a channel that a wire of 0.5 mm cleans: own choice."""
_FOOT = 0.5
"""Length in mm of the port's passage above the meeting with a channel: own choice."""


@dataclass(frozen=True, slots=True)
class PadLayout:
    """Sizes of a pad, mm; heights as in `Layout`. ``cell`` is one in no group, ``domes`` are by place. ``ports`` are
    the places enlarged by ``fan``.

    ``meeting`` is the height at which the channels, of radius ``channel``, meet the passages of the ports, ``low`` the
    manifold's underside. ``plate`` and ``bolts`` are the radii of a round plate and of its circle of screw holes, both
    about the centre and 0 without one.
    """

    cell: Layout
    domes: tuple[Layout, ...]
    places: tuple[Point, ...]
    fan: float
    channel: float
    low: float
    meeting: float
    plate: float = 0.0
    bolts: float = 0.0

    @property
    def centre(self) -> Point:
        """Middle of the extent of the cells."""
        return middle_of(self.places)

    def spread(self, share: float) -> tuple[Point, ...]:
        """The places enlarged about the centre by a share."""
        u, v = self.centre
        return tuple((u + share * (x - u), v + share * (y - v)) for x, y in self.places)

    @property
    def ports(self) -> tuple[Point, ...]:
        """Axes of the ports in the order of the cells."""
        return self.spread(self.fan)

    @property
    def middle(self) -> float:
        """Height at which a channel passes under, or over, the axis of its cell: half way up the lowest spigot."""
        return 0.5 * (min(dome.floor for dome in self.domes) + self.cell.plate_high)

    def lean(self, cell: int) -> Point:
        """Shift (x, y) of the channel of a cell, by the way down."""
        (x, y), (u, v), down = self.places[cell], self.ports[cell], self.middle - self.meeting
        return (u - x) / down, (v - y) / down

    @property
    def membrane_outline(self) -> tuple[Segment, ...]:
        """Outline of the membrane: as far around its cells as the widest flange of one."""
        return rounded_hull(self.places, self.flange_radius)

    @property
    def outline(self) -> tuple[Segment, ...]:
        """Outline of the manifold: that of the membrane, wider where ports need it."""
        return rounded_hull(self.places, max(self.flange_radius, self.port_side))

    @property
    def flange_radius(self) -> float:
        """Greatest radius of a flange about the axis of its cell."""
        return max(dome.flange_radius for dome in self.domes)

    @property
    def port_side(self) -> float:
        """Distance from the hull of the cells within which all ports lie."""
        return self.cell.port.reach + _FOOT + (self.fan - 1.0) * self.farthest

    @property
    def farthest(self) -> float:
        """Distance of the farthest cell from the centre."""
        return max(math.dist(at, self.centre) for at in self.places)


def lay_out_pad(scene: ResolvedDesign, table: PadTable, where: str, groups: Sequence[ResolvedDesign] = ()) -> PadLayout:
    """The layout of a pad of cells as in ``scene``, or in that of their group. Raises InputError for parts that a pad
    cannot have or have space for, naming what would fit."""
    for each in (scene, *groups):
        _check_parts(each, where)
    cell, *others = _on_one_flange([lay_out(each) for each in (scene, *groups)])
    domes, places = tuple((cell, *others)[group] for group in table.group_of), table.places
    pitch = min(math.dist(one, other) for one, other in combinations(places, 2))
    crowded = 1.0
    for (one, dome), (other, beside) in combinations(zip(places, domes, strict=True), 2):
        least = sum(max(each.outer_radius, each.inner_radius) for each in (dome, beside)) + _BETWEEN_DOMES
        crowded = max(crowded, least / (math.dist(one, other) + 1e-9))
    if crowded > 1.0:
        least = crowded * pitch
        raise _closer(table, where, pitch, f"the domes need {least:.4g} mm from axis to axis", least)
    tube = 0.5 * scene.tube.outer_diameter
    fan = max(1.0, (2.0 * max(cell.port.reach, tube) + _BETWEEN_PORTS) / pitch)
    farthest = max(math.dist(at, middle_of(places)) for at in places)
    wall, floors = scene.connector_printer.smallest.wall("rigid").recommended, [dome.floor for dome in domes]
    spigot, narrow = min(floors) - cell.plate_high, min(dome.groove_inner for dome in domes)
    found = _channel(scene, cell, narrow, spigot + 2.0 * (max(floors) - min(floors)), leans=fan > 1.0)
    if found is None:
        problem = f"a leaning channel leaves no wall of {wall:g} mm in a spigot {2 * narrow:.3g} mm wide"
        raise _closer(table, where, pitch, problem, fan * pitch)
    channel, slope = found
    inside = max(-cell.port.hollow[-1][1], 0.0)
    foot = inside + _FOOT + 2.0 * channel
    fans = (fan - 1.0) * farthest / slope - 0.5 * spigot + foot if fan > 1.0 else 0.0
    needs = max(scene.mount.plate_thickness, foot + wall, fans)
    given = table.thickness_mm
    if given is not None and given < needs - 1e-9:
        remedy = f"give at least {math.ceil(100 * needs) / 100:g}, a wider pitch_mm, or a narrower port to the cell"
        problem = f"the channels to ports {fan * pitch:.3g} mm apart need a manifold of {needs:.4g} mm"
        raise InputError(problem, file=where, key="pad.thickness_mm", value=given, remedy=remedy)
    low = cell.plate_high - (needs if given is None else given)
    made = PadLayout(cell, domes, places, fan, channel, low, low + foot)
    return _with_plate(scene, made)


def _on_one_flange(cells: Sequence[Layout]) -> list[Layout]:
    """Layouts of cells with the flange of the thickest, as one membrane has."""
    thick = max(cell.flange_thickness for cell in cells)
    return [replace(cell, flange_thickness=thick, plate_high=-thick - cell.gasket) for cell in cells]


def _channel(
    scene: ResolvedDesign, cell: Layout, narrow: float, high: float, *, leans: bool
) -> tuple[float, float] | None:
    """Radius of the channels and greatest slope with which they stay within spigots of radius ``narrow``, about the
    middle of whose height they lean; None if there is no space."""
    wall = scene.connector_printer.smallest.wall("rigid").recommended
    wide = min(0.5 * scene.seat.channel_diameter_mm, 0.85 * cell.port.passage)
    for slope in _SLOPES if leans else (0.0,):
        radius = min(wide, (narrow - wall - 0.5 * slope * high) / math.hypot(1.0, slope))
        if radius >= min(wide, _NARROWEST):
            return radius, slope
    return None


def _check_parts(scene: ResolvedDesign, where: str) -> None:
    """Raise InputError for a seat, a mount, a process or a dome that a pad cannot have."""
    if not isinstance(scene.seat, GluedFlange):
        raise InputError(
            "cells of a pad are glued to the manifold",
            file=scene.where,
            key="connector.seat",
            value=scene.design.connector.seat,
            remedy="take glued-flange",
        )
    if scene.printer.is_casting:
        problem = "the membrane of a pad is printed, and this printer's profile casts"
        value = scene.design.print.profile
        raise InputError(problem, file=scene.where, key="print.profile", value=value, remedy="take another profile")
    if not isinstance(scene.mount, PlainPlate | BoltCircle) or scene.mount.port_side != "rear":
        problem = "the ports of a pad point backwards, and it has screw holes around it or none"
        value, remedy = scene.design.connector.mount, "take plain, or a bolt circle with its port at the rear"
        raise InputError(problem, file=scene.where, key="connector.mount", value=value, remedy=remedy)
    if min(piece.bounds()[2] for piece in scene.design.membrane.dome.outer) < -1e-9:
        problem = "this shape dips below its flange, which a pad does not"
        value = scene.design.membrane.shape
        raise InputError(problem, file=scene.where, key="membrane.shape", value=value, remedy="take another shape")


def _closer(table: PadTable, where: str, pitch: float, problem: str, least: float) -> InputError:
    key, value = ("pad.pitch_mm", table.pitch_mm) if table.points_mm is None else ("pad.points_mm", pitch)
    remedy = f"give at least {math.ceil(100 * least) / 100:g} mm, or a smaller cell"
    return InputError(problem, file=where, key=key, value=value, remedy=remedy)


def _with_plate(scene: ResolvedDesign, pad: PadLayout) -> PadLayout:
    """The layout with a round plate for the screws of a bolt circle, whose heads pass beside the outline."""
    mount = scene.mount
    if not isinstance(mount, BoltCircle):
        return pad
    least = scene.connector_printer.smallest.wall("rigid").recommended
    hole = 0.5 * (mount.hole_diameter + scene.hole_undersize)
    head = max(0.5 * mount.head_diameter + 0.5, hole + least)
    around = max(math.dist(piece.centre, pad.centre) + piece.radius for piece in pad.outline if isinstance(piece, Arc))
    bolts = 0.5 * math.ceil(2.0 * (around + head))
    return replace(pad, plate=bolts + head, bolts=bolts)


def middle_of(places: Sequence[Point]) -> Point:
    """Middle of the extent of places along x and y."""
    (low, high), (near, far) = ((min(row), max(row)) for row in zip(*places, strict=True))
    return 0.5 * (low + high), 0.5 * (near + far)


def rounded_hull(places: Sequence[Point], reach: float) -> tuple[Segment, ...]:
    """Outline, counter-clockwise, of all points within ``reach`` of the convex hull of places: arcs and lines."""
    corners = _hull(places)
    edges = [*pairwise(corners), (corners[-1], corners[0])]
    angles = [math.atan2(b[1] - a[1], b[0] - a[0]) - 0.5 * math.pi for a, b in edges]
    arcs = []
    for corner, first, last in zip(corners, [angles[-1], *angles[:-1]], angles, strict=True):
        turn = (last - first) % (2.0 * math.pi)
        arcs.append(Arc(corner, reach, first, first + turn, "side"))
    pieces: list[Segment] = []
    for one, other in zip(arcs, [*arcs[1:], arcs[0]], strict=True):
        pieces += [one, Line(one.end, other.start, "side")]
    return tuple(pieces)


def _hull(places: Sequence[Point]) -> list[Point]:
    """Corners of the convex hull, counter-clockwise (Andrew's monotone chain); the two ends of places on a line.

    SciPy's refuses places on a line, and importing it takes longer than a whole layout.
    """
    order = sorted(set(places))

    def chain(points: Sequence[Point]) -> list[Point]:
        kept: list[Point] = []
        for at in points:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], at) <= 1e-9:
                kept.pop()
            kept.append(at)
        return kept[:-1]

    return [*chain(order), *chain(order[::-1])]


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
