"""The mesh of the meridian that is printed: the dome on its flange, held where the connector holds it."""

import numpy as np

from pneutouch.arrays import Array, Index
from pneutouch.mechanics.solid.mesh import (
    SolidMesh,
    arc_cells,
    boundary,
    cells_across,
    graded,
    grid_cells,
    with_middles,
)

_CELLS_PER_WALL = 2
_COINCIDE = 1e-9
"""Nodes nearer than this share of the wall are one."""


def printed_dome(
    inner_radius: float,
    wall: float,
    flange_width: float,
    flange_thickness: float,
    arc: int | None = None,
    through: int | None = None,
) -> SolidMesh:
    """A dome whose rim goes on below z = 0 as a flange (mm), clamped on its inside, underside and outside.

    The flange's top stays free, as in the connector's groove, so the foot of the wall gives a little. Nine-node
    cells; ``arc`` and ``through`` as for ``dome``.
    """
    n, m = arc or arc_cells(wall / inner_radius), through or cells_across(wall / inner_radius)
    outer, rim = inner_radius + wall, inner_radius + wall + flange_width
    across = with_middles(np.linspace(inner_radius, outer, m + 1))
    angle = 0.5 * np.pi * with_middles(graded(n, 1.0))
    cap = np.stack([np.cos(angle)[:, None] * across, np.sin(angle)[:, None] * across], axis=-1)
    cap[-1, :, 0] = 0.0
    deep, wide = (max(2, round(_CELLS_PER_WALL * size / wall)) for size in (flange_thickness, flange_width))
    down = with_middles(np.linspace(-flange_thickness, 0.0, 1 + deep))
    out = with_middles(np.linspace(outer, rim, 1 + wide))
    blocks = [cap, _rectangle(across, down), _rectangle(out, down)]
    nodes, cells, first = _merge(blocks, _COINCIDE * wall)
    height = cap.shape[1]
    r, z = nodes.T
    high = np.flatnonzero((np.abs(z) <= _COINCIDE * wall) & (r >= outer - _COINCIDE * wall))
    high = high[np.argsort(r[high])]
    top = np.stack([high[:-2:2], high[2::2], high[1:-1:2]], axis=1).astype(np.intp)
    faces = (r <= inner_radius + _COINCIDE) | (z <= _COINCIDE - flange_thickness) | (r >= rim - _COINCIDE)
    return SolidMesh(
        nodes,
        cells,
        inner=first[boundary(n, height, 0)],
        outer=first[boundary(n, height, height - 1)],
        clamped=np.flatnonzero((z <= _COINCIDE) & faces).astype(np.intp),
        axis=first[np.arange(height) + 2 * n * height],
        sliding=np.zeros(0, np.intp),
        length=inner_radius,
        wall=wall,
        flange=top,
    )


def _rectangle(r: Array, z: Array) -> Array:
    """Points of a rectangular block, columns along z and rows along r as in the dome; (len(z), len(r), 2)."""
    return np.stack(np.broadcast_arrays(r[None, :], z[:, None]), axis=-1)


def _merge(blocks: list[Array], gap: float) -> tuple[Array, Index, Index]:
    """Join blocks whose points coincide within ``gap``: nodes (n, 2), cells (m, 9), and the first block's numbers."""
    points = np.concatenate([block.reshape(-1, 2) for block in blocks])
    _, kept, number = np.unique(np.round(points / gap), axis=0, return_index=True, return_inverse=True)
    number = number.reshape(-1)
    starts = np.cumsum([0, *(block.shape[0] * block.shape[1] for block in blocks)])
    cells = [
        number[start + grid_cells(block.shape[0] // 2, block.shape[1] // 2, 9)]
        for start, block in zip(starts, blocks, strict=False)
    ]
    return points[kept], np.concatenate(cells).astype(np.intp), number[: starts[1]].astype(np.intp)
