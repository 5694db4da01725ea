"""STEP: the exact solids as one assembly, with names and colours.

CadQuery, which brings the kernel, is an extra; `step_obstacle` says why there is no STEP file without it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from pneutouch.arrays import Array
from pneutouch.body import Solid
from pneutouch.errors import ComputationError
from pneutouch.export.brep import exact_solid, shifted
from pneutouch.export.step_text import canonical
from pneutouch.holding import temporary_folder, uninterrupted

if TYPE_CHECKING:
    from OCP.TDocStd import TDocStd_Document

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
    """``name.step`` with its content (see `step`); without CadQuery instead ``name.step`` with why it is left out."""
    file, obstacle = f"{name}.step", step_obstacle()
    return ({file: step(name, solids, offset)}, {}) if obstacle is None else ({}, {file: obstacle})


# The kernel crashes the process where an interrupt cuts it short.
@uninterrupted()
def step(name: str, solids: tuple[Solid, ...], offset: Array) -> bytes:
    """Write the solids, shifted by ``offset`` (3,) into the print frame, as one assembly called ``name``.

    Raises ComputationError if the kernel writes nothing.
    """
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
    """A document of the kernel: one part a solid, coloured as its material and named."""
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
