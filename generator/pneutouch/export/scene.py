"""GLB and binary STL through trimesh, bodies cut open for pictures, and the meshes of the 3D view of a page."""

import base64
import json
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pneutouch.arrays import Array
from pneutouch.body import Body
from pneutouch.body.solid import corner_normals, mesh_of

if TYPE_CHECKING:
    import trimesh


_STEPS = 32767
"""Steps from the middle of the view to its end in each direction: whole numbers of two bytes hold them."""


TILT_DEG = 26.0
"""Angle above the horizon from which a body is seen."""

_MOST = 65535 // 3
"""Greatest number of triangles of one part: their vertices are counted in two bytes."""


class ShadedBody(NamedTuple):
    """Triangles as a picture needs them: corners in mm, unit normals and colours (0 to 1), (m, 3, 3) each.

    ``relief`` is the share of light and shadow in the colours: 1 for the look of a body, 0 for the colours themselves.
    ``columns`` is that of a grid that closes around an axis, with rows up to a pole; else 0. Its first triangles, row
    by row, join the corner of a cell, the next one around, and the one above that.
    """

    name: str
    corners: Array
    normals: Array
    colours: Array
    relief: float = 1.0
    columns: int = 0


def shaded(body: Body, colours: Array | None = None) -> ShadedBody:
    """A body with smooth normals, in ``colours`` (n, 3) of its vertices, or (None) in its material's colour."""
    if colours is None:
        colours = np.tile(np.array(list(bytes.fromhex(body.material.colour[1:]))) / 255, (len(body.vertices), 1))
    return ShadedBody(body.name, body.corners, corner_normals(body), colours[body.triangles])


def view_data(bodies: Sequence[ShadedBody], tilt_deg: float = TILT_DEG) -> str:
    """The bodies as JSON, z up, first seen from ``tilt_deg`` above the horizon.

    ``middle`` and ``reach`` in mm place the positions: position = middle + reach * value / 32767. Each of ``bodies``
    has, in base64 and little-endian, ``positions`` (int16), ``normals`` (int8, 127 is one), ``colours`` (uint8), three
    per vertex, ``triangles`` (uint16) and ``relief``. A body of more than 65,535 vertices is split. A grid has its
    ``columns`` in place of triangles.
    """
    corners = np.concatenate([body.corners.reshape(-1, 3) for body in bodies])
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle, reach = 0.5 * (low + high), 0.5 * float((high - low).max())
    parts = [part for body in bodies for part in _parts(body, middle, reach)]
    content = {"middle": [round(float(x), 4) for x in middle], "reach": round(reach, 4), "bodies": parts}
    content["tilt_deg"] = tilt_deg
    return json.dumps(content, separators=(",", ":"))


def _parts(body: ShadedBody, middle: Array, reach: float) -> list[dict[str, Any]]:
    """The body in pieces of as many triangles as two-byte indices can number."""
    rows = np.concatenate(
        [
            np.rint((body.corners - middle) / reach * _STEPS),
            np.rint(body.normals * 127),
            np.rint(np.clip(body.colours, 0, 1) * 255),
        ],
        axis=2,
    ).astype(np.int16)
    if body.columns:
        count = len(rows) // (2 * body.columns) + 1
        lowest = rows[: count * body.columns]
        vertices = np.concatenate([lowest[:, 0], lowest[-body.columns :, 2]])
        return [{"name": body.name, "relief": body.relief, "columns": body.columns, **_vertices(vertices)}]
    pieces = [rows[start : start + _MOST] for start in range(0, len(rows), _MOST)]
    return [{"name": body.name, "relief": body.relief, **_packed(piece)} for piece in pieces]


def _packed(rows: NDArray[np.int16]) -> dict[str, str]:
    vertices, triangles = np.unique(rows.reshape(-1, 9), axis=0, return_inverse=True)
    index = triangles.reshape(-1, 3)
    # Triangles that have no area in these steps would only cost bytes.
    index = index[(index[:, 0] != index[:, 1]) & (index[:, 1] != index[:, 2]) & (index[:, 0] != index[:, 2])]
    return {**_vertices(vertices), "triangles": _base64(index.astype("<u2"))}


def _vertices(vertices: NDArray[np.int16]) -> dict[str, str]:
    return {
        "positions": _base64(vertices[:, :3].astype("<i2")),
        "normals": _base64(vertices[:, 3:6].astype("i1")),
        "colours": _base64(vertices[:, 6:].astype("u1")),
    }


def _base64(values: NDArray[Any]) -> str:
    return base64.b64encode(values.tobytes()).decode()


_GLTF_FROM_PRINT = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1.0]])
"""glTF is in metres with y up; the vertex data stay in mm with z up, and the node carries this matrix."""


def stl(body: Body) -> bytes:
    """Binary STL of one body in mm."""
    return bytes(_mesh(body).export(file_type="stl"))


def glb(bodies: tuple[Body, ...]) -> bytes:
    """GLB with one named, coloured mesh per body; vertex data in mm, placed by a node matrix in metres."""
    return bytes(_scene(bodies).export(file_type="glb"))


def shaded_glb(bodies: Sequence[ShadedBody]) -> bytes:
    """GLB of bodies with a normal and a colour at every vertex, placed as in `glb`.

    glTF takes the colours of vertices as linear in light: the colours of a picture (sRGB) are converted (IEC
    61966-2-1)."""
    import trimesh

    scene = trimesh.Scene()
    for body in bodies:
        rows = np.concatenate([body.corners, body.normals, body.colours], axis=2).reshape(-1, 9)
        vertices, triangles = np.unique(np.round(rows, 6), axis=0, return_inverse=True)
        colours = vertices[:, 6:]
        linear = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
        mesh = trimesh.Trimesh(
            vertices[:, :3], triangles.reshape(-1, 3), vertex_normals=vertices[:, 3:6], process=False
        )
        opaque = np.append(np.rint(255 * linear), np.full((len(linear), 1), 255), axis=1).astype(np.uint8)
        mesh.visual = trimesh.visual.ColorVisuals(vertex_colors=opaque)
        scene.add_geometry(mesh, node_name=body.name, geom_name=body.name, transform=_GLTF_FROM_PRINT)
    return bytes(scene.export(file_type="glb", include_normals=True))


def _mesh(body: Body) -> "trimesh.Trimesh":
    import trimesh

    return trimesh.Trimesh(body.vertices, body.triangles, process=False)


def _scene(bodies: tuple[Body, ...]) -> "trimesh.Scene":
    import trimesh
    from trimesh.visual.material import PBRMaterial

    scene = trimesh.Scene()
    for body in bodies:
        mesh = _mesh(body)
        colour = [*bytes.fromhex(body.material.colour[1:]), 255]
        look = PBRMaterial(name=body.material.label, baseColorFactor=colour, metallicFactor=0.0, roughnessFactor=0.6)
        mesh.visual = trimesh.visual.TextureVisuals(material=look)
        scene.add_geometry(mesh, node_name=body.name, geom_name=body.name, transform=_GLTF_FROM_PRINT)
    return scene


def cut_open(body: Body) -> Body:
    """The body without the quarter that faces the viewer, at x above and y below its middle."""
    from manifold3d import Manifold

    low, high = body.bounds
    middle = 0.5 * (low + high)
    knife = Manifold.cube((high - low + 1).tolist()).translate(
        (middle[0], low[1] - 1 - (high - middle)[1], low[2] - 0.5)
    )
    vertices, triangles = mesh_of(body.manifold() - knife)
    return replace(body, vertices=vertices, triangles=triangles)
