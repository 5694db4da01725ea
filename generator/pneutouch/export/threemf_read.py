"""Read a 3MF back: bodies with their materials, metadata, and the recipe if there is one.

Any file may come: the parts of the zip are counted, inflated and checked here, and lib3mf gets a fresh, plain archive
of exactly the checked parts, so that it sees nothing else of the file. Nothing is extracted to disk.
"""

import ctypes
import io
import struct
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from pneutouch.arrays import Array, Indices
from pneutouch.body.solid import enclosed_volume
from pneutouch.errors import InputError
from pneutouch.export.threemf import NAMESPACE, metadata_of, read_strictly
from pneutouch.spec.files import read_bytes

MOST_BYTES = 256 * 2**20
"""Greatest size of a file, and of all its parts inflated: a sensor has less than 1 MB, a fine one some tens."""

MOST_PARTS = 1000
"""Greatest number of parts; a sensor has four, a slicer's project some hundreds."""

_DEEPEST = 64
"""Deepest nesting of XML elements; the specification needs a tenth of it."""

MOST_COMPONENTS = 10_000
"""Greatest number of objects that the components of a file amount to, each counted as often as it is referred to."""

_XML = (".model", ".rels", ".xml")
"""Endings of parts that must be well-formed XML."""

_END, _END_SIZE = b"PK\x05\x06", 22
_END_64, _END_64_SIZE = b"PK\x06\x06", 56
_LOCATOR_64, _LOCATOR_64_SIZE = b"PK\x06\x07", 20
_MOST_DIRECTORY = MOST_PARTS * 1024
_DAMAGE = (zipfile.BadZipFile, zlib.error, struct.error, EOFError, OSError, ValueError, OverflowError, RuntimeError)
"""Exceptions that zipfile raises for archives with wrong bytes in them, found by changing bytes at random."""

_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)


def checked_package(path: Path) -> bytes:
    """The package at ``path`` as a plain archive of checked parts.

    Raises InputError if it is missing, no file, no zip, damaged, larger than `MOST_BYTES` in the file or inflated, has
    more than `MOST_PARTS` parts, or holds XML with a document type, entities, deep nesting or too many components.
    """
    content = read_bytes(path, MOST_BYTES, "3MF file")
    _check_end(content, path)
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            parts = _parts(archive, path)
    except _DAMAGE as error:
        raise InputError(
            f"damaged zip archive ({error})", file=path, remedy="export or download the file again"
        ) from None
    components = Components(str(path))
    for name, part in parts.items():
        _check_xml(part, f"{path}: {name}", (components, name), must=name.lower().endswith(_XML))
    components.check()
    plain = io.BytesIO()
    with zipfile.ZipFile(plain, "w", zipfile.ZIP_STORED) as archive:
        for name, part in parts.items():
            archive.writestr(zipfile.ZipInfo(name), part)
    return plain.getvalue()


def _check_end(content: bytes, path: Path) -> None:
    """Check the number of parts in the archive's end record before a list of them, which could be long, is made."""
    at = content.rfind(_END, max(0, len(content) - _END_SIZE - 0xFFFF))
    end = content[at : at + _END_SIZE]
    comment = int.from_bytes(end[20:22], "little")
    if at < 0 or at + _END_SIZE + comment != len(content):
        what = "a zip archive cut short or damaged" if content.startswith(b"PK") else "not a zip archive"
        raise InputError(f"{what}; a 3MF is a zip archive, such as pneutouch build writes", file=path)
    count, size = end[10:12], end[12:16]
    locator = max(0, at - _LOCATOR_64_SIZE)
    if content[locator:at].startswith(_LOCATOR_64):
        # lib3mf always writes the long form; its record stands right before the locator.
        long = content[max(0, locator - _END_64_SIZE) : locator]
        if not long.startswith(_END_64):
            raise InputError(
                "damaged zip archive (no zip64 record)", file=path, remedy="export or download the file again"
            )
        count, size = long[32:40], long[40:48]
    if int.from_bytes(count, "little") > MOST_PARTS or int.from_bytes(size, "little") > _MOST_DIRECTORY:
        _too_many(path)


def _parts(archive: zipfile.ZipFile, path: Path) -> dict[str, bytes]:
    """Content by name. Sizes are checked before inflating; a part that inflates to another size is refused."""
    if not all(entry.filename for entry in archive.infolist()):
        raise InputError("a part without a name, which no 3MF has", file=path)
    entries = [entry for entry in archive.infolist() if not entry.is_dir()]
    if len(entries) > MOST_PARTS:
        _too_many(path)
    if sum(entry.file_size for entry in entries) > MOST_BYTES:
        raise InputError(f"inflates to more than {MOST_BYTES // 2**20} MiB, which no sensor needs", file=path)
    parts: dict[str, bytes] = {}
    seen: set[str] = set()
    for entry in entries:
        if entry.flag_bits & 1 or entry.compress_type not in _METHODS:
            raise InputError(f"{entry.filename}: encrypted or packed by a method that 3MF does not allow", file=path)
        if entry.filename.lower() in seen:
            raise InputError(f"{entry.filename}: there twice; a part may be there once only", file=path)
        seen.add(entry.filename.lower())
        with archive.open(entry) as stream:
            part = stream.read(entry.file_size + 1)
        if len(part) != entry.file_size:
            raise zipfile.BadZipFile(
                f"{entry.filename} inflates to {len(part)} bytes and not the {entry.file_size} declared"
            )
        parts[entry.filename] = part
    return parts


def _too_many(path: Path) -> NoReturn:
    raise InputError(f"more than {MOST_PARTS} parts, which no sensor needs", file=path)


Name = tuple[str, str]
"""An object: the part that it stands in, and its id there."""


class Components:
    """References between objects, over all parts: a few of them can stand for more objects than a reader can hold."""

    def __init__(self, where: str) -> None:
        self.where, self.object = where, ("", "")
        self.references: dict[Name, list[Name]] = {}

    def start(self, part: str, tag: str, attributes: dict[str, str]) -> None:
        """Take note of an object or a component as its element begins in a part."""
        local = tag.rsplit(":", 1)[-1]
        if local == "object":
            self.object = (part, attributes.get("id", ""))
            self.references.setdefault(self.object, [])
        elif local == "component":
            path = next((value for key, value in attributes.items() if key.rsplit(":", 1)[-1] == "path"), part)
            self.references.setdefault(self.object, []).append((path.lstrip("/"), attributes.get("objectid", "")))

    def check(self) -> None:
        """Raise InputError where objects refer to themselves, or amount to more than `MOST_COMPONENTS`."""
        counts: dict[Name, int] = {}
        for first in self.references:
            self._count(first, counts)

    def _count(self, first: Name, counts: dict[Name, int]) -> None:
        """Count objects, children before parents; without recursion, as the chain may be as long as the file."""
        stack, ancestors = [(first, False)], set()
        while stack:
            name, done = stack.pop()
            children = self.references.get(name, [])
            if done:
                ancestors.discard(name)
                counts[name] = 1 + sum(counts.get(child, 1) for child in children)
                if counts[name] > MOST_COMPONENTS:
                    raise InputError(
                        f"its components amount to more than {MOST_COMPONENTS} objects, which no sensor needs",
                        file=self.where,
                    )
            elif name not in counts:
                if name in ancestors:
                    raise InputError(f"object {name[1][:40]} is a component of itself", file=self.where)
                ancestors.add(name)
                stack.append((name, True))
                stack += [(child, False) for child in dict.fromkeys(children) if child not in counts]


def _check_xml(content: bytes, where: str, noted: tuple[Components, str], must: bool) -> None:
    """Refuse a document type, entities and deep nesting, in any encoding; with ``must`` also what is not XML.

    Parts with other endings are looked through as well: what is no XML fails at its first bytes. ``noted`` takes note
    of the components, under the name of the part.
    """
    depth = 0

    def refuse(*_: Any) -> NoReturn:
        raise InputError(
            "has a document type or entities, which 3MF does not allow", file=where, remedy="take them out"
        )

    def deeper(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        noted[0].start(noted[1], tag, attributes)
        if depth > _DEEPEST:
            raise InputError(f"XML nested deeper than {_DEEPEST} elements, which no 3MF needs", file=where)

    def back(*_: Any) -> None:
        nonlocal depth
        depth -= 1

    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = parser.ExternalEntityRefHandler = refuse
    parser.StartElementHandler, parser.EndElementHandler = deeper, back
    try:
        parser.Parse(content, True)
    except (expat.ExpatError, ValueError, LookupError) as error:
        if must:
            raise InputError(f"not well-formed XML: {error}", file=where) from None


RECIPE = "recipe"
"""Name of the metadata entry that holds the recipe."""

_MILLIMETRES = {"MicroMeter": 1e-3, "MilliMeter": 1.0, "CentiMeter": 10.0, "Inch": 25.4, "Foot": 304.8, "Meter": 1000.0}


@dataclass(frozen=True)
class StoredBody:
    """A mesh object of a 3MF in its own frame.

    Attributes:
        name: As stored; may be empty.
        material: Name of the material, of its base material, or its mix in words; None if there is none.
        colour: Display colour ``#RRGGBB``, or None.
        mix: Base material to fraction, where the material is a composite; else empty.
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
        """Volume in mm3 by the divergence theorem, true for a closed mesh; 0 without triangles."""
        return enclosed_volume(self.vertices, self.triangles) if len(self.triangles) else 0.0


@dataclass(frozen=True)
class Package:
    """Content of a 3MF; ``metadata`` names other namespaces as ``namespace:name``; ``recipe`` is JSON text or None."""

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
    """Name, display colour and mix of an object's material; None, None and {} without one that is known here."""
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
