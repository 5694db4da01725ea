"""The press with friction by CalculiX (an optional peer, found on PATH): a deck of CAX8R cells written here.

CalculiX has no trapped gas: the inside pressure follows the solid's own curve over the depth, so that the force on the
plate is what is compared. Contact is face to face with a linear penalty. A plate that grips is beyond CalculiX's
friction.

It counts the slip of a point from the beginning of its computation, not from where the point first touches: a contact
element that is new has no slip stored (`springforc_f2f.f`, version 2.20), so that a point that touches later is pulled back
to its radius at rest. A plate that grips is therefore compared without its friction, as a sequence of steps: every node in
contact goes down with the plate, and from the step after it first touched keeps the radius that CalculiX itself found
(`*BOUNDARY,FIXED`). Which nodes touch at a depth, and the pressure inside, are the solid's.
"""

from __future__ import annotations

import numpy as np
from benchmarks.calculix_sweep import calculix_model, run_calculix

from pneutouch.arrays import Array, Index
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.indent import IndentationPath, PressSettings, indent
from pneutouch.mechanics.solid.inflate import state_at
from pneutouch.mechanics.solid.mesh import SolidMesh, dome
from pneutouch.mechanics.solid.model import SolidModel

_PENALTY = 2.0e3
"""Contact stiffness in mu/mm; along the surface a tenth of it."""
_INCREMENT = 0.125
"""Share of the depth in one increment."""
_PLATE_CELLS = 40
_WEDGE = 2.0
"""Degrees of the wedge into which CalculiX turns axisymmetric cells."""
_HALF_TURN = 180.0
"""Wedges of two degrees, into which CalculiX turns axisymmetric cells, in a turn."""


def solid_press(
    sensor: Sensor, friction: float, depth: float, cells: tuple[int, int], steps: int, driving: float = 0.0
) -> IndentationPath:
    """The solid on the same eight-node cells with reduced integration, its gas shut in at a gauge pressure (MPa)."""
    mesh = dome(sensor.dome.shape, *cells, order=8)
    solid = SolidModel(mesh, neo_hookean(sensor.wall.shear_modulus, sensor.wall.poisson_ratio))
    settings = PressSettings(depth, steps, 2 * sensor.protocol.plate_radius, friction=friction, gauge_range=np.inf)
    return indent(solid, state_at(solid, driving), settings)


def calculix_inflated(sensor: Sensor, pressure: float, cells: tuple[int, int]) -> tuple[float, float]:
    """Height of the apex inside (mm) and volume (mm3) at a gauge pressure (MPa)."""
    mesh = dome(sensor.dome.shape, *cells, order=8)
    step = ["*STEP,NLGEOM,INC=200", "*STATIC", "0.2,1.,1e-4,0.25", "*DLOAD", f"INNER,P4,{pressure:.12g}"]
    shown = ["*NODE PRINT,NSET=ALL,FREQUENCY=1000", "U", "*END STEP"]
    places = mesh.nodes.copy()
    for words in map(str.split, run_calculix([*calculix_model(sensor, *cells), *step, *shown]).prints):
        if len(words) == 4 and words[0].isdigit() and int(words[0]) <= len(places):
            places[int(words[0]) - 1] += np.array(words[1:3], dtype=np.float64)
    solid = SolidModel(mesh, neo_hookean(1.0, 0.49))
    return float(places[mesh.inner_apex, 1]), solid.cavity.volume(places / mesh.length) * mesh.length**3


def calculix_press(
    sensor: Sensor, friction: float, depths: Array, pressures: Array, cells: tuple[int, int], top: float | None = None
) -> Array:
    """Force on the plate (N) at depths (mm, rising, the first 0) with gauge pressures (MPa) given there; nan where
    CalculiX did not converge.

    ``top``: height (mm) at which the plate waits for the dome to be inflated; None: that of the dome at rest."""
    half = sensor.protocol.plate_radius
    top = sensor.dome.shape.outer_height if top is None else top
    begin = 1.0 if pressures[0] else 0.0
    times = (begin + depths / depths[-1]).tolist()
    arc, through = cells
    model = calculix_model(sensor, arc, through)
    outer = range(through, arc * through + 1, through)
    mu, stiff = sensor.wall.shear_modulus, _PENALTY * sensor.wall.shear_modulus
    radii, first = np.linspace(1e-3, half, _PLATE_CELLS + 1), 900001
    plate = [(r, top + rise) for r in radii for rise in (0.0, 1.0)]
    corners = [(2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1) for k in range(_PLATE_CELLS)]
    deck = [
        *model,
        "*NODE,NSET=PLATE",
        *(f"{first + k},{r:.12g},{z:.12g},0." for k, (r, z) in enumerate(plate)),
        "*ELEMENT,TYPE=CAX4,ELSET=STAMP",
        *(f"{first + k}," + ",".join(str(first + n) for n in corner) for k, corner in enumerate(corners)),
        "*MATERIAL,NAME=STEEL",
        "*ELASTIC",
        f"{1e3 * mu:.12g},0.3",
        "*SOLID SECTION,ELSET=STAMP,MATERIAL=STEEL",
        "*ELSET,ELSET=OUTER",
        *(f"{k}," for k in outer),
        "*SURFACE,NAME=SKIN",
        "OUTER,S2",
        "*SURFACE,NAME=UNDERSIDE",
        "STAMP,S1",
        "*SURFACE INTERACTION,NAME=DRY",
        "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR",
        f"{stiff:.12g},{1e-3 * mu:.12g},{1e-4:.12g}",
        *(["*FRICTION", f"{friction:.12g},{0.1 * stiff:.12g}"] if friction else []),
        "*CONTACT PAIR,INTERACTION=DRY,TYPE=SURFACE TO SURFACE",
        "SKIN,UNDERSIDE",
        "*AMPLITUDE,NAME=DOWN",
        *(["0.,0."] if begin else []),
        f"{begin:.12g},0.,{begin + 1:.12g},{-depths[-1]:.12g}",
        "*AMPLITUDE,NAME=GAS",
        *(["0.,0."] if begin else []),
        *(f"{t:.12g},{p:.12g}" for t, p in zip(times, pressures, strict=True)),
        "*TIME POINTS,NAME=SHOWN",
        *(f"{t:.12g}" for t in times[1:]),
        "*STEP,NLGEOM,INC=2000",
        "*STATIC",
        f"{_INCREMENT},{begin + 1:.12g},1e-5,{_INCREMENT}",
        "*BOUNDARY,AMPLITUDE=DOWN",
        "PLATE,2,2,1.",
        "*BOUNDARY",
        "PLATE,1,1,0.",
        "*DLOAD,AMPLITUDE=GAS",
        "INNER,P4,1.",
        "*CONTACT PRINT,MASTER=UNDERSIDE,SLAVE=SKIN,TIME POINTS=SHOWN",
        "CF",
        "*END STEP",
    ]
    return _forces(run_calculix(deck).prints, depths, begin)


def _forces(lines: list[str], depths: Array, begin: float) -> Array:
    """Vertical force of the whole turn at every depth, from the total contact forces printed for the wedge; the press
    begins at the time ``begin``."""
    out = np.full(depths.size, np.nan)
    out[0] = 0.0
    for k, line in enumerate(lines):
        if line.startswith(" statistics for slave set"):
            depth = depths[-1] * (float(line.split()[-1]) - begin)
            near = np.flatnonzero(np.abs(depths - depth) < 1e-6 * depths[-1])
            out[near] = -360.0 / _WEDGE * float(lines[k + 4].split()[1])
    return out


def calculix_held(sensor: Sensor, path: IndentationPath, cells: tuple[int, int], finer: int, grips: bool) -> Array:
    """Force on the plate (N) at the depths of a path of the solid on eight-node ``cells``, nan where CalculiX did not
    get to.

    ``finer`` steps go to one of the path; without ``grips`` the nodes in contact slide.
    """
    mesh = dome(sensor.dome.shape, *cells, order=8)
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
    return _held_forces(deck, count)[::finer]


def _touching(mesh: SolidMesh, path: IndentationPath, depths: Array) -> list[Index]:
    """Nodes of the outer wall inside the edge of the contact at depths (mm) on or between those of the path."""
    nodes = np.setdiff1d(mesh.outer, mesh.clamped)
    inside = np.array([s.contact_radius - s.positions[nodes, 0] for s in path.states])
    known = path.column("indentation")
    margin = np.stack([np.interp(depths, known, column) for column in inside.T], axis=1)
    return [nodes[row >= 0.0] for row in margin]


def _held_forces(deck: list[str], count: int) -> Array:
    """Vertical force of the whole turn at the ends of the steps of a deck, the first of none."""
    out = np.full(count + 1, np.nan)
    out[0] = 0.0
    lines = run_calculix(deck).prints
    for k, line in enumerate(lines):
        if line.startswith(" total force"):
            step = round(count * float(line.split()[-1]))
            out[step] = -_HALF_TURN * float(lines[k + 2].split()[1])
    return out
