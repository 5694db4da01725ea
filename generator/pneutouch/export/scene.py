"""GLB and binary STL through trimesh, and bodies cut open for pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pneutouch.body import Body
from pneutouch.export.view import ShadedBody

if TYPE_CHECKING:
    import trimesh

_GLTF_FROM_PRINT = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1.0]])
"""glTF is in metres with y up; the vertex data stay in mm with z up, and the node carries this matrix."""


def stl(body: Body) -> bytes:
    """Binary STL of one body in mm."""
    return bytes(_mesh(body).export(file_type="stl"))


def glb(bodies: tuple[Body, ...]) -> bytes:
    """GLB with one named, coloured mesh a body; vertex data in mm, placed by a node matrix in metres."""
    return bytes(_scene(bodies).export(file_type="glb"))


def shaded_glb(bodies: Sequence[ShadedBody]) -> bytes:
    """GLB of bodies with a normal and a colour at every vertex, placed as in `glb`.

    glTF takes the colours of vertices as linear in light: those of a picture (sRGB) are converted (IEC 61966-2-1).
    """
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


def _mesh(body: Body) -> trimesh.Trimesh:
    import trimesh

    return trimesh.Trimesh(body.vertices, body.triangles, process=False)


def _scene(bodies: tuple[Body, ...]) -> trimesh.Scene:
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
    """The body without the quarter towards the viewer."""
    from manifold3d import Manifold

    low, high = body.bounds
    middle = 0.5 * (low + high)
    knife = Manifold.cube((high - low + 1).tolist()).translate(
        (middle[0], low[1] - 1 - (high - middle)[1], low[2] - 0.5)
    )
    rest = (body.manifold() - knife).to_mesh64()
    return replace(
        body, vertices=np.array(rest.vert_properties[:, :3], order="C"), triangles=rest.tri_verts.astype(np.int64)
    )
