"""Read a 3MF back: bodies with their materials, metadata, the recipe where there is one."""

import ctypes
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneutouch.arrays import Array, Indices
from pneutouch.body.triangles import enclosed_volume
from pneutouch.errors import InputError
from pneutouch.export.threemf import read_strictly
from pneutouch.export.threemf_metadata import NAMESPACE, metadata_of
from pneutouch.export.threemf_package import checked_package

RECIPE = "recipe"
"""Name of the metadata entry that holds the recipe."""

_MILLIMETRES = {"MicroMeter": 1e-3, "MilliMeter": 1.0, "CentiMeter": 10.0, "Inch": 25.4, "Foot": 304.8, "Meter": 1000.0}


@dataclass(frozen=True)
class StoredBody:
    """A mesh object of a 3MF in its own frame.

    Attributes:
        name: As stored; may be empty.
        material: Its name, or that of its base material; None if it has none.
        colour: Display colour ``#RRGGBB``, or None.
        mix: Base material to fraction, where the material is a composite.
        vertices: (n, 3), mm.
        triangles: (m, 3) indices.
    """

    name: str
    material: str | None
    colour: str | None
    mix: dict[str, float]
    vertices: Array
    triangles: Indices

    @property
    def size(self) -> Array:
        """Extent (3,) along x, y and z, mm."""
        return np.ptp(self.vertices, axis=0) if len(self.vertices) else np.zeros(3)

    @property
    def volume(self) -> float:
        """Volume in mm3 by the divergence theorem; of a closed mesh."""
        return enclosed_volume(self.vertices, self.triangles) if len(self.triangles) else 0.0


@dataclass(frozen=True)
class Package:
    """Content of a 3MF. ``metadata`` has our own entries by their bare names; ``recipe`` is JSON text, ours alone."""

    path: Path
    bodies: tuple[StoredBody, ...]
    metadata: dict[str, str]
    recipe: str | None
    thumbnail: bool
    warnings: tuple[str, ...]


def read_threemf(path: Path) -> Package:
    """Read a 3MF of any maker. Raises InputError for a file that is unsafe (see `checked_package`) or not valid."""
    import lib3mf

    content = checked_package(path)
    wrapper = lib3mf.get_wrapper()
    try:
        model, reader = read_strictly(wrapper, content)
        return _package(path, wrapper, model, reader)
    except lib3mf.ELib3MFException as error:
        raise InputError(f"not a valid 3MF: {error.get_error_message() or error}", file=path) from None
    except UnicodeDecodeError:
        raise InputError("not a valid 3MF: text in it is not UTF-8", file=path) from None


def _package(path: Path, wrapper: Any, model: Any, reader: Any) -> Package:
    metadata = metadata_of(model)
    scale = _MILLIMETRES[model.GetUnit().name]
    bodies = tuple(_body(wrapper, model, mesh, scale) for mesh in _mesh_objects(model))
    return Package(
        path=path,
        bodies=bodies,
        metadata={_shown(*key): value for key, value in metadata.items()},
        recipe=metadata.get((NAMESPACE, RECIPE)),
        thumbnail=bool(model.HasPackageThumbnailAttachment()),
        warnings=tuple(reader.GetWarning(k)[1] for k in range(reader.GetWarningCount())),
    )


def _shown(space: str, name: str) -> str:
    return name if space in ("", NAMESPACE) else f"{space}:{name}"


def _mesh_objects(model: Any) -> Iterator[Any]:
    iterator = model.GetMeshObjects()
    while iterator.MoveNext():
        yield iterator.GetCurrentMeshObject()


def _body(wrapper: Any, model: Any, mesh: Any, scale: float) -> StoredBody:
    metadata = metadata_of(mesh)
    material, colour, mix = _material(wrapper, model, mesh)
    positions = np.empty((mesh.GetVertexCount(), 3), np.float32)
    corners = np.empty((mesh.GetTriangleCount(), 3), np.uint32)
    _fill(wrapper, mesh, "getvertices", positions)
    _fill(wrapper, mesh, "gettriangleindices", corners)
    return StoredBody(
        name=mesh.GetName(),
        material=metadata.get((NAMESPACE, "material"), material),
        colour=colour,
        mix=mix,
        vertices=positions.astype(np.float64) * scale,
        triangles=corners.astype(np.int64),
    )


def _fill(wrapper: Any, mesh: Any, what: str, target: NDArray[Any]) -> None:
    """Let lib3mf write straight into an array: its lists of structures cost far more."""
    import lib3mf

    kind = lib3mf.Position if what == "getvertices" else lib3mf.Triangle
    needed, count = ctypes.c_uint64(0), ctypes.c_uint64(len(target))
    pointer = target.ctypes.data_as(ctypes.POINTER(kind))
    call = getattr(wrapper.lib, f"lib3mf_meshobject_{what}")
    wrapper.checkError(mesh, call(mesh._handle, count, needed, pointer))


def _material(wrapper: Any, model: Any, mesh: Any) -> tuple[str | None, str | None, dict[str, float]]:
    """Name, display colour and mix of an object's material; nothing where it has none, or a texture."""
    import lib3mf

    resource, index, given = mesh.GetObjectLevelProperty()
    kind = model.GetPropertyTypeByID(resource) if given else None
    if kind == lib3mf.PropertyType.BaseMaterial:
        group = model.GetBaseMaterialGroupByID(resource)
        return group.GetName(index), _hex(_rgb(wrapper, group.GetDisplayColor(index))), {}
    if kind == lib3mf.PropertyType.Colors:
        return None, _hex(_rgb(wrapper, model.GetColorGroupByID(resource).GetColor(index))), {}
    if kind != lib3mf.PropertyType.Composite:
        return None, None, {}
    composites = model.GetCompositeMaterialsByID(resource)
    group = composites.GetBaseMaterialGroup()
    parts = [(part.PropertyID, part.MixingRatio) for part in composites.GetComposite(index) if part.MixingRatio > 0]
    mix = {group.GetName(base): ratio for base, ratio in parts}
    colour = sum((ratio * _rgb(wrapper, group.GetDisplayColor(base)) for base, ratio in parts), np.zeros(3))
    return " + ".join(f"{ratio:.3g} {name}" for name, ratio in mix.items()), _hex(colour), mix


def _rgb(wrapper: Any, colour: Any) -> Array:
    return np.array(wrapper.ColorToRGBA(colour)[:3], float)


def _hex(colour: Array) -> str:
    red, green, blue = np.clip(np.round(colour), 0, 255).astype(int)
    return f"#{red:02X}{green:02X}{blue:02X}"
