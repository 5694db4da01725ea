"""STEP through CadQuery: the exact solids, revolved from their meridians, with names and colours."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from pneutouch.body import Bore, Solid
from pneutouch.export.step_text import canonical
from pneutouch.meridian import Arc, Segment
from pneutouch.meridian.segments import Array

if TYPE_CHECKING:
    import cadquery as cq


def exact_solid(solid: Solid) -> cq.Solid:
    """The solid as a boundary representation, in the design frame, mm."""
    import cadquery as cq

    edges = [_edge(piece) for piece in solid.meridian.pieces]
    first, last = solid.meridian.start, solid.meridian.end
    if not solid.meridian.is_ring:
        edges.append(cq.Edge.makeLine(cq.Vector(0, 0, last[1]), cq.Vector(0, 0, first[1])))
    face = cq.Face.makeFromWires(cq.Wire.assembleEdges(edges))
    body = cq.Solid.revolve(face, 360.0, cq.Vector(0, 0, 0), cq.Vector(0, 0, 1))
    cut = body.cut(*[_drill(bore) for bore in solid.bores]) if solid.bores else body
    return cut.Solids()[0] if hasattr(cut, "Solids") else cut


def step(name: str, solids: tuple[Solid, ...], offset: Array) -> bytes:
    """Write the solids, shifted by ``offset`` (3,) into the print frame, as one assembly called ``name``."""
    import cadquery as cq

    place = cq.Location(cq.Vector(*offset.tolist()))
    assembly = cq.Assembly(name=name)
    for solid in solids:
        red, green, blue = (channel / 255 for channel in bytes.fromhex(solid.material.colour[1:]))
        assembly.add(exact_solid(solid), name=solid.name, loc=place, color=cq.Color(red, green, blue, 1.0))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{name}.step"
        assembly.export(str(path))
        text = path.read_text(encoding="utf-8")
    return canonical(text).encode()


def _edge(piece: Segment) -> cq.Edge:
    import cadquery as cq

    def vector(point: tuple[float, float]) -> cq.Vector:
        return cq.Vector(max(point[0], 0.0) if point[0] > 1e-9 else 0.0, 0.0, point[1])

    if isinstance(piece, Arc):
        return cq.Edge.makeThreePointArc(vector(piece.start), vector(piece.middle), vector(piece.end))
    return cq.Edge.makeLine(vector(piece.start), vector(piece.end))


def _drill(bore: Bore) -> cq.Solid:
    import cadquery as cq

    past = 0.0 if bore.blind else 1.0
    return cq.Solid.makeCylinder(
        bore.radius, bore.high - bore.low + 1.0 + past, cq.Vector(bore.x, bore.y, bore.low - 1.0), cq.Vector(0, 0, 1)
    )
