"""3MF through lib3mf: one object per body, its material, one component assembly in one frame.

Follows the 3MF core specification 1.4 and its materials extension 1.2: materials sit on mesh objects, never on the
components object; a material's name gives the intent and its display colour is for rendering only. A digital material
whose mix is known is a composite of its base resins, any other material a base material. Bodies lie in one assembly
because tray software rejects separate objects whose bounding boxes overlap.
"""

import ctypes
import uuid
from typing import Any

import numpy as np

from pneutouch.body import Body
from pneutouch.errors import ComputationError
from pneutouch.export.threemf_materials import Materials
from pneutouch.export.threemf_metadata import add_metadata

DECIMALS = 6
_UUIDS = uuid.UUID("6d0f1d2e-6f5c-5d0b-9d3a-3f1c7b0f7a11")
"""Root of the name-based UUIDs: lib3mf's random ones would change the bytes of every run."""


def threemf(name: str, bodies: tuple[Body, ...], metadata: dict[str, str], thumbnail: bytes | None = None) -> bytes:
    """Write bodies (in the print frame, mm) as one assembly called ``name``; ``thumbnail`` is a PNG of the package.

    ``metadata`` keys that the specification defines (Title, Application ...) are written as they are, all others in our
    own namespace (see `threemf_metadata`). Raises ComputationError for a body that is
    not closed, and where the file cannot be read back strictly.
    """
    import lib3mf

    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    model.SetUnit(lib3mf.ModelUnit.MilliMeter)
    materials = Materials(wrapper, model, [body.material for body in bodies])
    assembly = model.AddComponentsObject()
    assembly.SetName(name)
    assembly.SetUUID(name_uuid(name, "assembly"))
    for body in bodies:
        mesh = mesh_object(wrapper, model, materials, body, name_uuid(name, "object", body.name))
        component = assembly.AddComponent(mesh, wrapper.GetIdentityTransform())
        component.SetUUID(name_uuid(name, "component", body.name))
    item = model.AddBuildItem(assembly, wrapper.GetIdentityTransform())
    item.SetUUID(name_uuid(name, "item"))
    model.SetBuildUUID(name_uuid(name, "build"))
    add_metadata(model, metadata)
    if thumbnail is not None:
        model.CreatePackageThumbnailAttachment().ReadFromBuffer(thumbnail)
    return content_of(wrapper, model)


def mesh_object(wrapper: Any, model: Any, materials: Materials, body: Body, identity: str) -> Any:
    """A body as a mesh object with its material and metadata. Raises ComputationError if it is not closed."""
    mesh = model.AddMeshObject()
    mesh.SetName(body.name)
    mesh.SetUUID(identity)
    set_geometry(wrapper, mesh, body)
    mesh.SetObjectLevelProperty(*materials.property_of(body))
    add_metadata(mesh, facts_of(body))
    if not mesh.IsManifoldAndOriented():
        raise ComputationError(f"3MF: {body.name} is not a closed, oriented mesh; please report the design")
    return mesh


def content_of(wrapper: Any, model: Any) -> bytes:
    """The file of a model, read back once. Raises ComputationError if it cannot be."""
    writer = model.QueryWriter("3mf")
    writer.SetDecimalPrecision(DECIMALS)
    content = bytes(writer.WriteToBuffer())
    check_readable(wrapper, content)
    return content


def check_readable(wrapper: Any, content: bytes) -> None:
    """Read the written file strictly: a file that readers refuse must not leave."""
    import lib3mf

    try:
        read_strictly(wrapper, content)
    except lib3mf.ELib3MFException as error:
        raise ComputationError(
            f"3MF: lib3mf cannot read back what it wrote ({error.get_error_message()}); take a name and a title "
            "without quotes, &, < and >, or report the design"
        ) from None


def read_strictly(wrapper: Any, content: bytes) -> tuple[Any, Any]:
    """lib3mf's model and reader of a 3MF. Raises lib3mf's error for one that is not valid."""
    model = wrapper.CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    buffer = (ctypes.c_uint8 * len(content)).from_buffer_copy(content)
    status = wrapper.lib.lib3mf_reader_readfrombuffer(reader._handle, ctypes.c_uint64(len(content)), buffer)
    wrapper.checkError(reader, status)
    return model, reader


def name_uuid(*path: str) -> str:
    """A UUID that follows from a path of names, for the same bytes each time."""
    return str(uuid.uuid5(_UUIDS, "/".join(path)))


def set_geometry(wrapper: Any, mesh: Any, body: Body) -> None:
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


def facts_of(body: Body) -> dict[str, str]:
    """Metadata of a body: a composite has no name of its own that would carry the intent."""
    mix = body.material.mix
    return {"role": body.role, "material": body.material.label, **({} if mix is None else {"mix-source": mix.source})}
