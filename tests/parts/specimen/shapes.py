"""The paper's block and printer as the context of patterns, and a body of a mesh."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from pneutouch.body import Body
from pneutouch.catalogue import Library
from pneutouch.parts.specimen import FAMILIES, Box, Mesh, PatternContext, PatternGeometry
from pneutouch.spec.specimen import LAYERS

LIBRARY = Library((Path(__file__).resolve().parents[3],))
AGILUS = LIBRARY.load("materials", "Agilus30")
VERO = LIBRARY.load("materials", "VeroClear")
J735 = LIBRARY.load("printers", "j735")
STEP = 0.014


def context(
    length: float = 20.0, width: float = 10.0, height: float = 8.0, speed: float = 4.0, step: float = STEP
) -> PatternContext:
    return PatternContext(Box((0.0, 0.0, 0.0), (length, width, height)), J735, AGILUS, VERO, speed, step, "test.toml")


def drawn(at: PatternContext, kind: str, **keys) -> PatternGeometry:
    return FAMILIES[kind].draw(LAYERS[kind].model_validate({"kind": kind, **keys}), at, 0)


def body(mesh: Mesh, name: str = "inclusion") -> Body:
    return Body(name, name, VERO if name == "inclusion" else AGILUS, mesh.vertices, mesh.triangles)


def bars_by_hand(count: int, pitch: float, width: float, box: Box) -> Mesh:
    """Bars across a box, eight corners and twelve triangles each, made another way than the family's."""
    from manifold3d import Manifold

    unit = Manifold.cube((width, box.high[1] - box.low[1], box.high[2] - box.low[2])).to_mesh64()
    corners = np.array(unit.vert_properties[:, :3]) + np.array(box.low)
    shift = pitch * np.arange(count)[:, None, None] * np.array([1.0, 0.0, 0.0])
    triangles = unit.tri_verts.astype(np.int64) + len(corners) * np.arange(count)[:, None, None]
    return Mesh((corners + shift).reshape(-1, 3), triangles.reshape(-1, 3))
