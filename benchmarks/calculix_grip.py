"""A plate that grips, by CalculiX (an optional peer, found on PATH) without its friction: nodes held where they touch.

CalculiX counts the slip of a point from the beginning of its computation, not from where the point first touches: a
contact element that is new has no slip stored (`springforc_f2f.f`, version 2.20), so that a point that touches later
is pulled back to its radius at rest. Its friction therefore cannot judge a plate that grips. Here the plate is a
sequence of steps: every node in contact goes down with it, and from the step after it first touched keeps the radius
that CalculiX itself found (`*BOUNDARY,FIXED`). Which nodes touch at a depth, and the pressure inside, are the solid's.
"""

from __future__ import annotations

import numpy as np

from benchmarks.calculix_sweep import calculix_model, calculix_prints
from pneutouch.arrays import Array, Index
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.solid.indent import IndentationPath
from pneutouch.mechanics.solid.mesh import SolidMesh, dome

_HALF_TURN = 180.0
"""Wedges of two degrees, into which CalculiX turns axisymmetric cells, in a turn."""


def calculix_held(sensor: Sensor, path: IndentationPath, cells: tuple[int, int], finer: int, grips: bool) -> Array:
    """Force on the plate (N) at the depths of a path of the solid on eight-node ``cells``, nan where CalculiX did not
    get to.

    ``finer`` steps go to one of the path; without ``grips`` the nodes in contact slide.
    """
    mesh = dome(sensor.dome.inner_radius, sensor.dome.wall_thickness, *cells, order=8)
    count = finer * (len(path.states) - 1)
    depths = np.interp(np.arange(count + 1) / finer, np.arange(len(path.states)), path.column("indentation"))
    touching = _touching(mesh, path, depths)
    skin = np.setdiff1d(mesh.outer, mesh.clamped)
    gas = zip(path.column("indentation") / depths[-1], path.column("pressure"), strict=True)
    deck = [
        *calculix_model(sensor, *cells),
        "*NSET,NSET=SKIN",
        *(f"{n + 1}," for n in skin),
        "*AMPLITUDE,NAME=GAS,TIME=TOTAL TIME",
        *(f"{share:.12g},{pressure:.12g}" for share, pressure in gas),
    ]
    top = sensor.dome.inner_radius + sensor.dome.wall_thickness
    for k in range(1, count + 1):
        # The apex stays on the axis by the model's own support.
        held = np.setdiff1d(touching[k - 1], mesh.axis) if grips else np.zeros(0, np.intp)
        deck += ["*STEP,NLGEOM,INC=100", "*STATIC", f"{1 / count:.12g},{1 / count:.12g},1e-8"]
        deck += ["*BOUNDARY,FIXED", *(f"{n + 1},1,1" for n in held)] if held.size else []
        deck += ["*BOUNDARY", *(f"{n + 1},2,2,{top - depths[k] - mesh.nodes[n, 1]:.12g}" for n in touching[k])]
        deck += ["*DLOAD,AMPLITUDE=GAS", "INNER,P4,1.", "*NODE PRINT,NSET=SKIN,TOTALS=ONLY", "RF", "*END STEP"]
    return _forces(deck, count)[::finer]


def _touching(mesh: SolidMesh, path: IndentationPath, depths: Array) -> list[Index]:
    """Nodes of the outer wall inside the edge of the contact at depths (mm) on or between those of the path."""
    nodes = np.setdiff1d(mesh.outer, mesh.clamped)
    inside = np.array([s.contact_radius - s.positions[nodes, 0] for s in path.states])
    known = path.column("indentation")
    margin = np.stack([np.interp(depths, known, column) for column in inside.T], axis=1)
    return [nodes[row >= 0.0] for row in margin]


def _forces(deck: list[str], count: int) -> Array:
    """Vertical force of the whole turn at the ends of the steps of a deck, the first of none."""
    out = np.full(count + 1, np.nan)
    out[0] = 0.0
    lines = calculix_prints(deck)
    for k, line in enumerate(lines):
        if line.startswith(" total force"):
            step = round(count * float(line.split()[-1]))
            out[step] = -_HALF_TURN * float(lines[k + 2].split()[1])
    return out
