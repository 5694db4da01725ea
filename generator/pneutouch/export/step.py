"""STEP: the exact solids as one assembly, with names and colours.

CadQuery, which brings the kernel, is an extra; `step_obstacle` says why there is no STEP file without it.

The kernel is called through its own binding (OCP), which loads in half the time of CadQuery around it.

Open CASCADE writes the time into the header, numbers occurrences by a counter that runs on through the
process, and orders styles by memory address. Nothing of that is content, so it is taken out: entities are
renumbered by walking the file from its roots, the roots are sorted by a hash of all they refer to, and
numbers are rounded above the noise of floating-point sums.
"""

from __future__ import annotations

import hashlib
import itertools
import math
import re
from collections.abc import Iterable
from functools import cache
from typing import TYPE_CHECKING, Any

from pneutouch.arrays import Array
from pneutouch.body import Bore, Frame, Prism, Solid, Turned
from pneutouch.body.shapes import Shape, Vector
from pneutouch.errors import ComputationError
from pneutouch.shape.meridian import Arc, Meridian, Segment
from pneutouch.stopping import temporary_folder, uninterrupted

if TYPE_CHECKING:
    from OCP.BRepAlgoAPI import BRepAlgoAPI_BooleanOperation
    from OCP.TDocStd import TDocStd_Document
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Shape


_AT_AXIS = 1e-9
"""Radius below which a point of a meridian lies on the axis, mm."""


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
    """The result of a boolean operation on a body with several tools at once."""
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
    oriented = ShapeFix_Face(BRepBuilderAPI_MakeFace(TopoDS.Wire_s(sound.Shape()), True).Face())
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
    """The kernel's location that is shifted by ``by`` (x, y, z), mm."""
    from OCP.gp import gp_Trsf, gp_Vec
    from OCP.TopLoc import TopLoc_Location

    move = gp_Trsf()
    move.SetTranslationPart(gp_Vec(*by))
    return TopLoc_Location(move)


_TIMESTAMP = re.compile(r"(FILE_NAME\('[^']*',)'[^']*'")
_ENTITY = re.compile(r"#(\d+)\s*=\s*(.*?);\s*(?=#\d+\s*=|ENDSEC)", re.DOTALL)
_REFERENCE = re.compile(r"#(\d+)")
_REAL = re.compile(r"(?<![#\w.])-?\d+\.\d*(?:E[+-]?\d+)?")
_DECIMALS = 10
"""Decimals of lengths: 1e-10 mm. Open CASCADE's own tolerance is 1e-7, and smaller digits are noise of the run."""

_OCCURRENCE = re.compile(r"(NEXT_ASSEMBLY_USAGE_OCCURRENCE\()'\d+'")


def canonical(text: str) -> str:
    """Return the same STEP content with the header's time fixed and the entities in canonical order."""
    head, data, rest = text.partition("DATA;")
    body, end, tail = rest.partition("ENDSEC;")
    entities = {int(number): _tidy(content) for number, content in _ENTITY.findall(body + end)}
    order = _walk(entities)
    number = {old: new for new, old in enumerate(order, start=1)}

    def renamed(content: str) -> str:
        return _REFERENCE.sub(lambda match: f"#{number[int(match[1])]}", content)

    lines = [f"#{number[old]} = {renamed(entities[old])};" for old in order]
    header = _TIMESTAMP.sub(r"\1'1970-01-01T00:00:00'", head, count=1)
    return f"{header}{data}\n" + "\n".join(lines) + f"\n{end}{tail}"


def _tidy(content: str) -> str:
    """An entity on one line, its numbers rounded, without blanks, whose places depend on how long the numbers are."""
    texts = "".join(line.strip() for line in content.splitlines()).split("'")
    outside = [_REAL.sub(_rounded, "".join(text.split())) for text in texts[::2]]
    pieces = [piece for pair in itertools.zip_longest(outside, texts[1::2]) for piece in pair if piece is not None]
    return _OCCURRENCE.sub(r"\1'1'", "'".join(pieces))


def _rounded(match: re.Match[str]) -> str:
    return f"{round(float(match[0]), _DECIMALS) + 0.0:.{_DECIMALS}f}".rstrip("0")


def _walk(entities: dict[int, str]) -> list[int]:
    """Entities in depth-first order from the roots, referenced ones first."""
    references = {old: [int(n) for n in _REFERENCE.findall(text)] for old, text in entities.items()}

    @cache
    def digest(old: int) -> str:
        content = _REFERENCE.sub(lambda match: digest(int(match[1])), entities[old])
        return hashlib.sha256(content.encode()).hexdigest()

    referred = {n for numbers in references.values() for n in numbers}
    order: dict[int, None] = {}

    def visit(old: int) -> None:
        if old not in order:
            for other in references[old]:
                visit(other)
            order[old] = None

    for root in sorted((old for old in entities if old not in referred), key=digest):
        visit(root)
    return list(order)


_SETTINGS = {"xstep.cascade.unit": "MM", "write.step.unit": "MM"}
_SWITCHES = {"write.surfacecurve.mode": 1, "write.precision.mode": 0, "write.stepcaf.subshapes.name": 1}


@uninterrupted()
def step_obstacle() -> str | None:
    """Reason why no STEP file can be written, in words; None if CadQuery's kernel is there."""
    try:
        import OCP  # noqa: F401
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] == "OCP":
            return 'CadQuery is not installed; pip install "pneutouch[cad]" adds it'
        return f"CadQuery's kernel cannot be loaded: {error}"
    except ImportError as error:
        return f"CadQuery's kernel cannot be loaded: {error}"
    return None


def step_files(name: str, solids: tuple[Solid, ...], offset: Array) -> tuple[dict[str, bytes], dict[str, str]]:
    """Contents by name, and reasons by name for files left out; ``name.step`` is in the latter without CadQuery."""
    file, obstacle = f"{name}.step", step_obstacle()
    return ({file: step(name, solids, offset)}, {}) if obstacle is None else ({}, {file: obstacle})


# The kernel crashes the process where an interrupt cuts it short.
@uninterrupted()
def step(name: str, solids: tuple[Solid, ...], offset: Array) -> bytes:
    """The solids, shifted by ``offset`` (3,) mm, as one assembly. Raises ComputationError if the kernel fails."""
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.Interface import Interface_Static
    from OCP.Message import Message, Message_Gravity
    from OCP.STEPCAFControl import STEPCAFControl_Writer
    from OCP.STEPControl import STEPControl_StepModelType
    from OCP.XSControl import XSControl_WorkSession

    # Its reports of progress would mix with what the program prints.
    for printer in Message.DefaultMessenger_s().Printers():
        printer.SetTraceLevel(Message_Gravity.Message_Fail)
    document = _assembly(name, solids, offset)
    writer = STEPCAFControl_Writer(XSControl_WorkSession(), False)
    # The writer makes the settings known; they are read as it transfers.
    for key, value in _SETTINGS.items():
        Interface_Static.SetCVal_s(key, value)
    for key, switch in _SWITCHES.items():
        Interface_Static.SetIVal_s(key, switch)
    writer.SetColorMode(True)
    writer.SetLayerMode(True)
    writer.SetNameMode(True)
    writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs)
    with temporary_folder() as folder:
        path = folder / f"{name}.step"
        if writer.Write(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone:
            raise ComputationError(f"the CAD kernel wrote no {name}.step")
        text = path.read_text(encoding="utf-8")
    return canonical(text).encode()


def _assembly(name: str, solids: tuple[Solid, ...], offset: Array) -> TDocStd_Document:
    """A document of the kernel: one named part for each solid, in its material's colour."""
    from OCP.BinXCAFDrivers import BinXCAFDrivers
    from OCP.BRep import BRep_Builder
    from OCP.Quantity import Quantity_Color, Quantity_ColorRGBA, Quantity_TypeOfColor
    from OCP.TCollection import TCollection_ExtendedString as Text
    from OCP.TDataStd import TDataStd_Name
    from OCP.TDF import TDF_Label
    from OCP.TDocStd import TDocStd_Document
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS_Compound
    from OCP.XCAFApp import XCAFApp_Application
    from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool

    application = XCAFApp_Application.GetApplication_s()
    BinXCAFDrivers.DefineFormat_s(application)
    document = TDocStd_Document(Text("BinXCAF"))
    application.InitDocument(document)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    shapes.SetAutoNaming_s(False)
    colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    whole = shapes.NewShape()
    TDataStd_Name.Set_s(whole, Text(name))
    place = shifted((float(offset[0]), float(offset[1]), float(offset[2])))
    for solid in solids:
        compound, builder = TopoDS_Compound(), BRep_Builder()
        builder.MakeCompound(compound)
        builder.Add(compound, exact_solid(solid))
        part = shapes.NewShape()
        shapes.SetShape(part, compound)
        TDataStd_Name.Set_s(part, Text(solid.name))
        red, green, blue = (channel / 255 for channel in bytes.fromhex(solid.material.colour[1:]))
        colour = Quantity_ColorRGBA(Quantity_Color(red, green, blue, Quantity_TypeOfColor.Quantity_TOC_sRGB), 1.0)
        colours.SetColor(part, colour, XCAFDoc_ColorType.XCAFDoc_ColorSurf)
        TDataStd_Name.Set_s(shapes.AddComponent(whole, part, place), Text(solid.name))
    top = TDF_Label()
    shapes.SetLocation(whole, TopLoc_Location(), top)
    TDataStd_Name.Set_s(top, Text(name))
    shapes.UpdateAssemblies()
    return document
