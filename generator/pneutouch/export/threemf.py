"""3MF through lib3mf: one object per body, base materials, one component assembly in one frame.

Follows the 3MF core specification 1.4: materials sit on mesh objects, never on the components object; a
material's name states the intent and its display colour is for rendering only. Bodies lie in one assembly
because tray software rejects separate objects whose bounding boxes overlap.
"""

from __future__ import annotations

import ctypes
import uuid
from typing import Any

import numpy as np

from pneutouch.body import Body
from pneutouch.errors import ComputationError

NAMESPACE = "https://pneutouch.org/3mf/2026"
_DECIMALS = 6
_UUIDS = uuid.UUID("6d0f1d2e-6f5c-5d0b-9d3a-3f1c7b0f7a11")
"""Root of the name-based UUIDs: lib3mf's random ones would change the bytes of every run."""


def threemf(name: str, bodies: tuple[Body, ...], metadata: dict[str, str]) -> bytes:
    """Write bodies (in the print frame, mm) as one assembly called ``name``.

    ``metadata`` keys without a prefix must be well-known names of the specification (Title, Application
    ...); others are written as ``pneutouch:key`` in a declared namespace.
    """
    import lib3mf

    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    model.SetUnit(lib3mf.ModelUnit.MilliMeter)
    group = model.AddBaseMaterialGroup()
    assembly = model.AddComponentsObject()
    assembly.SetName(name)
    assembly.SetUUID(_uuid(name, "assembly"))
    for body in bodies:
        colour = wrapper.RGBAToColor(*bytes.fromhex(body.material.colour[1:]), 255)
        material = group.AddMaterial(f"{body.role}: {body.material.label}", colour)
        mesh = model.AddMeshObject()
        mesh.SetName(body.name)
        mesh.SetUUID(_uuid(name, "object", body.name))
        _set_geometry(wrapper, mesh, body)
        mesh.SetObjectLevelProperty(group.GetResourceID(), material)
        if not mesh.IsManifoldAndOriented():
            raise ComputationError(f"3MF: {body.name} is not a closed, oriented mesh; please report the design")
        component = assembly.AddComponent(mesh, wrapper.GetIdentityTransform())
        component.SetUUID(_uuid(name, "component", body.name))
    item = model.AddBuildItem(assembly, wrapper.GetIdentityTransform())
    item.SetUUID(_uuid(name, "item"))
    model.SetBuildUUID(_uuid(name, "build"))
    _add_metadata(model, metadata)
    writer = model.QueryWriter("3mf")
    writer.SetDecimalPrecision(_DECIMALS)
    return bytes(writer.WriteToBuffer())


def _uuid(*path: str) -> str:
    return str(uuid.uuid5(_UUIDS, "/".join(path)))


def _set_geometry(wrapper: Any, mesh: Any, body: Body) -> None:
    """Hand the arrays over as C buffers: lists of structures cost eight times as much."""
    import lib3mf

    vertices = np.ascontiguousarray(body.vertices, np.float32)
    triangles = np.ascontiguousarray(body.triangles, np.uint32)
    positions = (lib3mf.Position * len(vertices)).from_buffer_copy(vertices)
    corners = (lib3mf.Triangle * len(triangles)).from_buffer_copy(triangles)
    status = wrapper.lib.lib3mf_meshobject_setgeometry(
        mesh._handle, ctypes.c_uint64(len(vertices)), positions, ctypes.c_uint64(len(triangles)), corners
    )
    wrapper.checkError(mesh, status)


def _add_metadata(model: Any, metadata: dict[str, str]) -> None:
    known = {"Title", "Designer", "Description", "Copyright", "LicenseTerms", "Application"}
    group = model.GetMetaDataGroup()
    for key in sorted(metadata):
        space = "" if key in known else NAMESPACE
        group.AddMetaData(space, key, metadata[key], "xs:string", True)
