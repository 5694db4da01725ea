"""STEP through CadQuery: the exact solids, revolved from their meridians, with names and colours.

CadQuery is an extra; `step_obstacle` states why there is no STEP file without it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from pneutouch.arrays import Array
from pneutouch.body import Bore, Frame, Prism, Solid, Turned
from pneutouch.body.shapes import Shape
from pneutouch.export.step_text import canonical
from pneutouch.holding import temporary_folder, uninterrupted
from pneutouch.meridian import Arc, Meridian, Segment

if TYPE_CHECKING:
    import cadquery as cq


@uninterrupted()
def step_obstacle() -> str | None:
    """Why no STEP file can be written, in words; None where CadQuery is there."""
    try:
        import cadquery  # noqa: F401
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] == "cadquery":
            return 'CadQuery is not installed; pip install "pneutouch[cad]" adds it'
        return f"CadQuery cannot be loaded: {error}"
    except ImportError as error:
        return f"CadQuery cannot be loaded: {error}"
    return None


def exact_solid(solid: Solid) -> cq.Solid:
    """The solid as a boundary representation, in the design frame, mm."""
    body = _turned(Turned(solid.base)) if isinstance(solid.base, Meridian) else _prism(solid.base)
    if solid.adds:
        body = body.fuse(*[_shape(feature.shape) for feature in solid.adds]).clean()
    tools = [*map(_drill, solid.bores), *(_shape(feature.shape) for feature in solid.cuts)]
    whole = body.cut(*tools) if tools else body
    return whole.Solids()[0] if hasattr(whole, "Solids") else whole


def step_files(name: str, solids: tuple[Solid, ...], offset: Array) -> tuple[dict[str, bytes], dict[str, str]]:
    """``name.step`` with its content (see `step`); without CadQuery instead ``name.step`` with why it is left out."""
    file, obstacle = f"{name}.step", step_obstacle()
    return ({file: step(name, solids, offset)}, {}) if obstacle is None else ({}, {file: obstacle})


# CadQuery's kernel crashes the process where an interrupt cuts it short.
@uninterrupted()
def step(name: str, solids: tuple[Solid, ...], offset: Array) -> bytes:
    """Write the solids, shifted by ``offset`` (3,) into the print frame, as one assembly called ``name``."""
    import cadquery as cq

    place = cq.Location(cq.Vector(*offset.tolist()))
    assembly = cq.Assembly(name=name)
    for solid in solids:
        red, green, blue = (channel / 255 for channel in bytes.fromhex(solid.material.colour[1:]))
        assembly.add(exact_solid(solid), name=solid.name, loc=place, color=cq.Color(red, green, blue, 1.0))
    with temporary_folder() as folder:
        path = folder / f"{name}.step"
        assembly.export(str(path))
        text = path.read_text(encoding="utf-8")
    return canonical(text).encode()


def _shape(shape: Shape) -> cq.Solid:
    if isinstance(shape, Turned):
        return _turned(shape)
    if isinstance(shape, Prism):
        return _prism(shape)
    assert isinstance(shape, Bore)
    return _drill(shape)


def _turned(shape: Turned) -> cq.Solid:
    import cadquery as cq

    meridian = shape.meridian
    edges = [_edge(piece) for piece in meridian.pieces]
    if not meridian.is_ring:
        edges.append(cq.Edge.makeLine(cq.Vector(0, 0, meridian.end[1]), cq.Vector(0, 0, meridian.start[1])))
    face = cq.Face.makeFromWires(cq.Wire.assembleEdges(edges))
    body = cq.Solid.revolve(face, 360.0, cq.Vector(0, 0, 0), cq.Vector(0, 0, 1))
    return body if shape.frame == Frame() else body.moved(_location(shape.frame))


def _prism(shape: Prism) -> cq.Solid:
    import cadquery as cq

    wire = cq.Wire.assembleEdges([_edge(piece, flat=True) for piece in shape.outline])
    body = cq.Solid.extrudeLinear(wire, [], cq.Vector(0, 0, shape.high - shape.low))
    return body.moved(_location(shape.frame) * cq.Location(cq.Vector(0, 0, shape.low)))


def _location(frame: Frame) -> cq.Location:
    import cadquery as cq

    return cq.Location(cq.Plane(origin=frame.origin, xDir=frame.across, normal=frame.axis))


def _edge(piece: Segment, flat: bool = False) -> cq.Edge:
    """An edge of a meridian in the (x, z) plane, or of an outline in the (x, y) plane."""
    import cadquery as cq

    def vector(point: tuple[float, float]) -> cq.Vector:
        if flat:
            return cq.Vector(point[0], point[1], 0.0)
        return cq.Vector(max(point[0], 0.0) if point[0] > 1e-9 else 0.0, 0.0, point[1])

    if isinstance(piece, Arc):
        return cq.Edge.makeThreePointArc(vector(piece.start), vector(piece.middle), vector(piece.end))
    return cq.Edge.makeLine(vector(piece.start), vector(piece.end))


def _drill(bore: Bore) -> cq.Solid:
    import cadquery as cq

    low = bore.low if bore.closed == "low" else bore.low - 1.0
    high = bore.high if bore.closed == "high" else bore.high + 1.0
    return cq.Solid.makeCylinder(bore.radius, high - low, cq.Vector(bore.x, bore.y, low), cq.Vector(0, 0, 1))
