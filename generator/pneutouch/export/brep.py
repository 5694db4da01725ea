"""Exact solids as boundary representations of Open CASCADE, CadQuery's kernel: revolved, extruded, joined and cut.

The kernel is called through its own binding (OCP), which loads in half the time of CadQuery around it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from pneutouch.body import Bore, Frame, Prism, Solid, Turned
from pneutouch.body.shapes import Shape, Vector
from pneutouch.errors import ComputationError
from pneutouch.meridian import Arc, Meridian, Segment

if TYPE_CHECKING:
    from OCP.BRepAlgoAPI import BRepAlgoAPI_BooleanOperation
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Shape

_AT_AXIS = 1e-9
"""Radii below which a point of a meridian lies on the axis, mm."""


def exact_solid(solid: Solid) -> TopoDS_Shape:
    """The solid as a boundary representation, in the design frame, mm.

    Raises ComputationError if the kernel closes no solid.
    """
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
    from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer

    body = _turned(Turned(solid.base)) if isinstance(solid.base, Meridian) else _prism(solid.base)
    if solid.adds:
        joined = _combined(BRepAlgoAPI_Fuse(), body, [_shape(feature.shape) for feature in solid.adds])
        merger = ShapeUpgrade_UnifySameDomain(joined, True, True, True)
        merger.AllowInternalEdges(False)
        merger.Build()
        body = merger.Shape()
    tools = [*map(_drill, solid.bores), *(_shape(feature.shape) for feature in solid.cuts)]
    if tools:
        body = _combined(BRepAlgoAPI_Cut(), body, tools)
    explorer = TopExp_Explorer(body, TopAbs_ShapeEnum.TopAbs_SOLID)
    if not explorer.More():
        raise ComputationError(f"the exact solid of the {solid.name} cannot be drawn")
    return explorer.Current()


def _combined(operation: BRepAlgoAPI_BooleanOperation, body: TopoDS_Shape, tools: list[TopoDS_Shape]) -> TopoDS_Shape:
    """A boolean operation on a body by several tools at once."""
    operation.SetArguments(_listed([body]))
    operation.SetTools(_listed(tools))
    operation.SetRunParallel(True)
    operation.Build()
    return operation.Shape()


def _listed(shapes: Iterable[TopoDS_Shape]) -> Any:
    from OCP.TopTools import TopTools_ListOfShape

    listed = TopTools_ListOfShape()
    for shape in shapes:
        listed.Append(shape)
    return listed


def _shape(shape: Shape) -> TopoDS_Shape:
    if isinstance(shape, Turned):
        return _turned(shape)
    if isinstance(shape, Prism):
        return _prism(shape)
    assert isinstance(shape, Bore)
    return _drill(shape)


def _turned(shape: Turned) -> TopoDS_Shape:
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol
    from OCP.gp import gp

    meridian = shape.meridian
    edges = [_edge(piece) for piece in meridian.pieces]
    if not meridian.is_ring:
        edges.append(_line((0.0, 0.0, meridian.end[1]), (0.0, 0.0, meridian.start[1])))
    body = BRepPrimAPI_MakeRevol(_face(edges), gp.OZ_s(), 2 * math.pi, True).Shape()
    return body if shape.frame == Frame() else body.Moved(_place(shape.frame))


def _prism(shape: Prism) -> TopoDS_Shape:
    from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
    from OCP.gp import gp_Vec

    face = _face([_edge(piece, flat=True) for piece in shape.outline])
    body = BRepPrimAPI_MakePrism(face, gp_Vec(0.0, 0.0, shape.high - shape.low), True).Shape()
    return body.Moved(_place(shape.frame) * shifted((0.0, 0.0, shape.low)))


def _drill(bore: Bore) -> TopoDS_Shape:
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

    low = bore.low if bore.closed == "low" else bore.low - 1.0
    high = bore.high if bore.closed == "high" else bore.high + 1.0
    axis = gp_Ax2(gp_Pnt(bore.x, bore.y, low), gp_Dir(0.0, 0.0, 1.0))
    return BRepPrimAPI_MakeCylinder(axis, bore.radius, high - low, 2 * math.pi).Shape()


def _face(edges: list[TopoDS_Edge]) -> TopoDS_Face:
    """The plane face inside a closed chain of edges."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
    from OCP.ShapeFix import ShapeFix_Face, ShapeFix_Shape
    from OCP.TopoDS import TopoDS

    chain = BRepBuilderAPI_MakeWire()
    chain.Add(_listed(edges))
    chain.Build()
    sound = ShapeFix_Shape(chain.Wire())
    sound.Perform()
    face = BRepBuilderAPI_MakeFace(TopoDS.Wire_s(sound.Shape()), True).Face()
    oriented = ShapeFix_Face(face)
    oriented.FixOrientation()
    oriented.Perform()
    return oriented.Result()


def _edge(piece: Segment, flat: bool = False) -> TopoDS_Edge:
    """An edge of a meridian in the (x, z) plane, or of an outline in the (x, y) plane."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.GC import GC_MakeArcOfCircle
    from OCP.gp import gp_Pnt

    def placed(point: tuple[float, float]) -> Vector:
        if flat:
            return (point[0], point[1], 0.0)
        return (point[0] if point[0] > _AT_AXIS else 0.0, 0.0, point[1])

    if isinstance(piece, Arc):
        three = (gp_Pnt(*placed(point)) for point in (piece.start, piece.middle, piece.end))
        return BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(*three).Value()).Edge()
    return _line(placed(piece.start), placed(piece.end))


def _line(start: Vector, end: Vector) -> TopoDS_Edge:
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.gp import gp_Pnt

    return BRepBuilderAPI_MakeEdge(gp_Pnt(*start), gp_Pnt(*end)).Edge()


def _place(frame: Frame) -> TopLoc_Location:
    """Position of a frame in the design frame."""
    from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt, gp_Trsf
    from OCP.TopLoc import TopLoc_Location

    move = gp_Trsf()
    move.SetTransformation(gp_Ax3(gp_Pnt(*frame.origin), gp_Dir(*frame.axis), gp_Dir(*frame.across)))
    move.Invert()
    return TopLoc_Location(move)


def shifted(by: Vector) -> TopLoc_Location:
    """A shift, mm."""
    from OCP.gp import gp_Trsf, gp_Vec
    from OCP.TopLoc import TopLoc_Location

    move = gp_Trsf()
    move.SetTranslationPart(gp_Vec(*by))
    return TopLoc_Location(move)
