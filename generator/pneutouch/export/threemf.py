"""3MF through lib3mf: one object per body, its material, one component assembly in one frame.

Follows the 3MF core specification 1.4 and its materials extension 1.2: materials sit on mesh objects, never on the
components object; a material's name gives the intent and its display colour is for rendering only. There is one base
material a resin (spec_core issue 53), whatever bodies are of it. A digital material whose mix is known is a composite
of its base resins, any other material a base material. Bodies lie in one assembly because tray software rejects
separate objects whose bounding boxes overlap.

lib3mf 2.5 cannot read a model back whose XML has a text of 65536 bytes or more, nor one in which an escape such as
``&quot;`` lies across a multiple of 65536 bytes (both measured; tests/export/test_threemf_read.py). Our own values that
XML would escape are therefore of the type xs:base64Binary, all others xs:string; they are continued in further entries
where they are long, and the longest stand last.

On a tray every part is an object of its own, placed by one build item; bodies that grow in one print are the components
of one object.
"""

import base64
import contextlib
import ctypes
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pneutouch.arrays import Array
from pneutouch.body import Body
from pneutouch.errors import ComputationError
from pneutouch.spec.material import Material


class Materials:
    """The material resources of one model, made as bodies need them.

    Args:
        wrapper: lib3mf.
        model: The model that takes the resources.
        materials: Materials of its bodies: a group is made only where a body needs it.
    """

    def __init__(self, wrapper: Any, model: Any, materials: list[Material]) -> None:
        self._wrapper = wrapper
        self._group = model.AddBaseMaterialGroup()
        composed = any(is_composite(material) for material in materials)
        self._composites: Any = model.AddCompositeMaterials(self._group) if composed else None
        self._bases: dict[str, int] = {}

    def property_of(self, body: Body) -> tuple[int, int]:
        """Resource and property of a body's material, as an object-level property takes them."""
        material = body.material
        if not is_composite(material):
            return self._group.GetResourceID(), self._base(material.label, material.colour)
        return self._composites.GetResourceID(), self._composite(material)

    def _base(self, name: str, colour: str) -> int:
        """A base material, once for each name; it shows the colour of the first body that needs it."""
        if name not in self._bases:
            shown = self._wrapper.RGBAToColor(*bytes.fromhex(colour[1:]), 255)
            self._bases[name] = self._group.AddMaterial(name, shown)
        return self._bases[name]

    def _composite(self, material: Material) -> int:
        """A composite of base resins that show the digital material's colour: a viewer mixes the colours too."""
        import lib3mf

        assert material.mix is not None
        parts = []
        for resin in material.base_resins:
            part = lib3mf.CompositeConstituent()
            part.PropertyID = self._base(resin, material.colour)
            part.MixingRatio = material.mix.fractions[resin]
            parts.append(part)
        return int(self._composites.AddComposite(parts))


def is_composite(material: Material) -> bool:
    """True if a material is written as a composite: mixed from several resins in known fractions."""
    return material.is_digital and material.mix is not None


NAMESPACE = "https://pneutouch.org/3mf/2026"

WELL_KNOWN = frozenset({"Title", "Designer", "Description", "Copyright", "LicenseTerms", "Application"})
"""Names of metadata that the specification defines; they have no namespace."""

_LONGEST = 60_000
"""Greatest number of bytes of one metadata entry."""

_BINARY = "xs:base64Binary"
"""Type of the entries whose text XML would escape."""


def add_metadata(owner: Any, metadata: dict[str, str]) -> None:
    """Add entries to a model or an object; a text too long for one is continued in ``key-2``, ``key-3`` ..."""
    group = owner.GetMetaDataGroup()
    for key in sorted(metadata, key=lambda key: (len(metadata[key]), key)):
        if key in WELL_KNOWN:
            group.AddMetaData("", key, metadata[key], "xs:string", True)
            continue
        text, kind = metadata[key], "xs:string"
        if set(text) & set("&<>\"'"):
            text, kind = base64.b64encode(text.encode()).decode(), _BINARY
        step = _LONGEST if text.isascii() else _LONGEST // 4
        for k in range(0, max(len(text), 1), step):
            name = f"{key}-{k // step + 1}" if k else key
            group.AddMetaData(NAMESPACE, name, text[k : k + step], kind, True)


def metadata_of(owner: Any) -> dict[tuple[str, str], str]:
    """Values by namespace and name of a model or an object; ours decoded, and continued ones joined."""
    group = owner.GetMetaDataGroup()
    entries = [group.GetMetaData(k) for k in range(group.GetMetaDataCount())]
    values = {(entry.GetNameSpace(), entry.GetName()): entry.GetValue() for entry in entries}
    binary = {entry.GetName() for entry in entries if (entry.GetNameSpace(), entry.GetType()) == (NAMESPACE, _BINARY)}
    local = {name: value for (space, name), value in values.items() if space == NAMESPACE}
    foreign = {key: value for key, value in values.items() if key[0] != NAMESPACE}
    for name in list(local):
        k = 2
        while name in local and f"{name}-{k}" in local:
            local[name] += local.pop(f"{name}-{k}")
            k += 1
    for name in binary & local.keys():
        with contextlib.suppress(ValueError):
            local[name] = base64.b64decode(local[name]).decode()
    return {**foreign, **{(NAMESPACE, name): value for name, value in local.items()}}


DECIMALS = 6
_UUIDS = uuid.UUID("6d0f1d2e-6f5c-5d0b-9d3a-3f1c7b0f7a11")
"""Root of the name-based UUIDs: lib3mf's random ones would change the bytes of every run."""


def threemf(name: str, bodies: tuple[Body, ...], metadata: dict[str, str], thumbnail: bytes | None = None) -> bytes:
    """Write bodies (in the print frame, mm) as one assembly called ``name``; ``thumbnail`` is a PNG of the package.

    ``metadata`` keys that the specification defines (Title, Application ...) are written as they are, all others in our
    own namespace (see `add_metadata`). Raises ComputationError for a body that is not closed, and where the file cannot
    be read back strictly.
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
    """A body as a mesh object, UUID ``identity``, with material and metadata. ComputationError if it is not closed."""
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
    """The file of a model as bytes, read back once. Raises ComputationError if it cannot be read."""
    writer = model.QueryWriter("3mf")
    writer.SetDecimalPrecision(DECIMALS)
    content = bytes(writer.WriteToBuffer())
    check_readable(wrapper, content)
    return content


def check_readable(wrapper: Any, content: bytes) -> None:
    """Read the written file strictly. Raises ComputationError for a file that readers refuse."""
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
    """Hand vertices and triangles to lib3mf as C buffers: lists of structures cost eight times as much."""
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
    """Metadata of a body: role, material, source of the mix; a composite has no name that would carry them."""
    mix = body.material.mix
    return {"role": body.role, "material": body.material.label, **({} if mix is None else {"mix-source": mix.source})}


TRAY_RECIPE = "tray-recipe"
"""Metadata entry of a tray's 3MF that holds its order."""


@dataclass(frozen=True)
class TrayItem:
    """One part of a tray.

    Attributes:
        label: Part number of the build item, unique on the tray.
        shape: Name of its object: items of one shape share it, and the bodies of the first are taken.
        bodies: In the part's own frame, mm; their names are unique among all shapes.
        transform: Rows (4, 3): the images of the x, y and z axes, and the shift in mm, from that frame to the tray's.
    """

    label: str
    shape: str
    bodies: tuple[Body, ...]
    transform: Array


def threemf_tray(name: str, items: Sequence[TrayItem], metadata: dict[str, str]) -> bytes:
    """Write a tray called ``name``; the same input gives the same bytes.

    ``metadata`` is as for `export.threemf.threemf`. Raises ComputationError for a body that is not
    closed, and where the file cannot be read back strictly.
    """
    import lib3mf

    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    model.SetUnit(lib3mf.ModelUnit.MilliMeter)
    materials = Materials(wrapper, model, [body.material for item in items for body in item.bodies])
    objects: dict[str, Any] = {}
    for item in items:
        if item.shape not in objects:
            objects[item.shape] = _object(wrapper, model, name, item, materials)
    for item in items:
        built = model.AddBuildItem(objects[item.shape], _transform(lib3mf, item.transform))
        built.SetPartNumber(item.label)
        built.SetUUID(name_uuid(name, "tray item", item.label))
    model.SetBuildUUID(name_uuid(name, "tray"))
    add_metadata(model, metadata)
    return content_of(wrapper, model)


def _object(wrapper: Any, model: Any, name: str, item: TrayItem, materials: Materials) -> Any:
    """The mesh object of a part, or a components object over the mesh objects of its bodies."""
    meshes = [
        mesh_object(wrapper, model, materials, body, name_uuid(name, "tray object", body.name)) for body in item.bodies
    ]
    if len(meshes) == 1:
        return meshes[0]
    whole = model.AddComponentsObject()
    whole.SetName(item.shape)
    whole.SetUUID(name_uuid(name, "tray assembly", item.shape))
    for mesh, body in zip(meshes, item.bodies, strict=True):
        component = whole.AddComponent(mesh, wrapper.GetIdentityTransform())
        component.SetUUID(name_uuid(name, "tray component", body.name))
    return whole


def _transform(lib3mf: Any, rows: Array) -> Any:
    placed = lib3mf.Transform()
    for i, row in enumerate(rows):
        for j, value in enumerate(row):
            placed.Fields[i][j] = float(value)
    return placed
