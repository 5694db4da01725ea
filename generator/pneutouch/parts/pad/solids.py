"""The two bodies of a pad: one membrane with all domes, and the manifold with a channel and a port for each."""

import math
from dataclasses import replace

from pneutouch.body import Bore, Feature, Frame, Prism, Solid, Turned
from pneutouch.catalogue import ResolvedDesign
from pneutouch.parts.pad.layout import PadLayout
from pneutouch.shape.meridian import Line, Meridian, Point, cylinder, trace
from pneutouch.spec.part import BoltCircle

_PAST = 1.0
"""Distance in mm by which a shape extends past a face that it opens or into a body that it joins."""


def pad_solids(scene: ResolvedDesign, pad: PadLayout) -> tuple[Solid, Solid]:
    """Membrane and manifold of a pad."""
    return _membrane(scene, pad), _manifold(scene, pad)


def _membrane(scene: ResolvedDesign, pad: PadLayout) -> Solid:
    low = -pad.cell.flange_thickness
    adds, cuts = [], []
    inside, under = 0.5 * low, low - _PAST
    for (x, y), dome in zip(pad.places, pad.domes, strict=True):
        shape, inner, frame = dome.shape, dome.inner_radius, Frame((x, y, 0.0))
        rim, root = shape.outer[0].start, shape.inner[0].start
        outer = Meridian((Line((0.0, inside), (rim[0], inside), ""), Line((rim[0], inside), rim, ""), *shape.outer))
        over = outer.volume() + math.pi * rim[0] ** 2 * inside
        hollow = Meridian((Line((0.0, under), (inner, under), ""), Line((inner, under), root, ""), *shape.inner))
        if over > 0.0:
            adds.append(Feature(Turned(outer, frame), over))
        cuts.append(Feature(Turned(hollow, frame), hollow.volume() - math.pi * inner**2 * _PAST))
    base = Prism(pad.membrane_outline, low, 0.0)
    return Solid("membrane", "membrane", scene.membrane_material, base, (), tuple(adds), tuple(cuts))


def _manifold(scene: ResolvedDesign, pad: PadLayout) -> Solid:
    high, adds = pad.cell.plate_high, []
    for (x, y), dome in zip(pad.places, pad.domes, strict=True):
        radius = dome.groove_inner
        spigot = cylinder(radius, high - 0.5 * (high - pad.low), dome.floor)
        adds.append(Feature(Turned(spigot, Frame((x, y, 0.0))), math.pi * radius**2 * (dome.floor - high)))
    adds += [boss for at in pad.ports for boss in _port(pad, at)]
    cuts = [cut for number in range(len(pad.places)) for cut in _channel(pad, number)]
    base, mount = Prism(pad.outline, pad.low, high), scene.mount
    bores: tuple[Bore, ...] = ()
    if isinstance(mount, BoltCircle):
        thick = min(mount.plate_thickness, high - pad.low)
        disc = cylinder(pad.plate, pad.low, pad.low + thick)
        adds.insert(0, Feature(Turned(disc, Frame((*pad.centre, 0.0))), (math.pi * pad.plate**2 - base.area()) * thick))
        bores = _bolts(mount, scene.hole_undersize, pad, pad.low + thick)
    return Solid("manifold", "connector", scene.connector_material, base, bores, tuple(adds), tuple(cuts))


def _port(pad: PadLayout, at: Point) -> list[Feature]:
    """Body of the port at a place of the underside, with its lugs."""
    port = pad.cell.port
    frame = _down(pad, at)
    faces: list[tuple[str, Point]] = [("", (port.root, -_PAST)), *(("", point) for point, _ in reversed(port.outside))]
    outline = trace((0.0, -_PAST), [*faces, ("", (0.0, port.length))])
    boss = Feature(Turned(outline, frame), outline.volume() - math.pi * port.root**2 * _PAST)
    return [boss, *(Feature(replace(lug, frame=frame), port.lug_volume / len(port.lugs)) for lug in port.lugs)]


def _channel(pad: PadLayout, number: int) -> list[Feature]:
    """Passage of the port of a cell up to the meeting, and the straight channel from there into the cell."""
    port, at = pad.cell.port, pad.ports[number]
    bottom, mouth = pad.low - pad.meeting, (port.hollow[0][0], port.length + _PAST)
    faces: list[tuple[str, Point]] = [("", (port.passage, bottom)), *(("", point) for point in reversed(port.hollow))]
    hollow = trace((0.0, bottom), [*faces, ("", mouth), ("", (0.0, mouth[1]))])
    passage = Feature(Turned(hollow, _down(pad, at)), port.hollow_volume(bottom))
    x, y = pad.lean(number)
    slope = math.hypot(x, y)
    length = channel_length(pad, number)
    # Its ends are square to its axis: they lie beyond the planes that they cross.
    drill = cylinder(pad.channel, -pad.channel * slope - 1e-3, length + pad.channel * slope + _PAST)
    way = math.hypot(1.0, slope)
    across = (1.0, 0.0, 0.0) if slope == 0.0 else (-y / slope, x / slope, 0.0)
    frame = Frame((at[0], at[1], pad.meeting), (-x / way, -y / way, 1.0 / way), across)
    return [passage, Feature(Turned(drill, frame), math.pi * pad.channel**2 * length)]


def channel_length(pad: PadLayout, number: int) -> float:
    """Length in mm of the channel of a cell, from the cavity to the passage of its port."""
    return (pad.domes[number].floor - pad.meeting) * math.hypot(1.0, *pad.lean(number))


def line_volume(pad: PadLayout, number: int) -> float:
    """Gas volume in mm3 of the way of a cell, from its cavity to the mouth of its port, the fitting in place."""
    port = pad.cell.port
    hollow = port.hollow_volume(pad.low - pad.meeting) - port.filled_volume()
    return math.pi * pad.channel**2 * channel_length(pad, number) + hollow


def _down(pad: PadLayout, at: Point) -> Frame:
    return Frame((at[0], at[1], pad.low), axis=(0.0, 0.0, -1.0))


def _bolts(mount: BoltCircle, undersize: float, pad: PadLayout, high: float) -> tuple[Bore, ...]:
    """Through holes on the circle of the mount, the first half a spacing off the x axis."""
    u, v = pad.centre
    turns = [2.0 * math.pi * (k + 0.5) / mount.count for k in range(mount.count)]
    radius = 0.5 * (mount.hole_diameter + undersize)
    return tuple(
        Bore(u + pad.bolts * math.cos(turn), v + pad.bolts * math.sin(turn), radius, pad.low, high) for turn in turns
    )
