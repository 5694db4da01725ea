"""3MF of a tray through lib3mf: every part an object of its own with its material, one build item each, placed.

Materials sit on mesh objects, never on components objects (3MF core 1.4). Bodies that grow in one print are the
components of one object: tray software rejects separate objects whose bounding boxes overlap.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from pneutouch.arrays import Array
from pneutouch.body import Body
from pneutouch.export.threemf import content_of, mesh_object, name_uuid
from pneutouch.export.threemf_materials import Materials
from pneutouch.export.threemf_metadata import add_metadata

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
    """The mesh object of a part, or a components object over those of its bodies."""
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
