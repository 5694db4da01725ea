"""The inflation sweep with CalculiX (an optional peer, found on PATH): a deck of CAX8R cells written here.

CalculiX 2.20 has no arc length and no cavity, so the pressure rises until no increment converges any more; the last one that
did is its limit pressure. CAX8R is expanded to a wedge of three-dimensional elements inside the program.
"""

from __future__ import annotations

import os
import resource
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

from pneutouch.mechanics import Sensor
from pneutouch.mechanics.membrane import RISING_BRANCH
from pneutouch.mechanics.solid.mesh import dome

_INCREMENTS = "0.2,1.,0.002,0.3"
"""First, total, least and greatest increment, as shares of the thin membrane's limit pressure."""


def calculix_model(sensor: Sensor, arc: int, through: int) -> list[str]:
    """Mesh, material and supports as lines of a deck: nodes ALL, cells WALL, those inside INNER, BASE, AXIS."""
    mesh = dome(sensor.dome.shape, arc=arc, through=through, order=8)
    nu, mu = sensor.wall.poisson_ratio, sensor.wall.shear_modulus
    bulk = 2 * mu * (1 + nu) / (3 * (1 - 2 * nu))
    other_way = [0, 3, 2, 1, 7, 6, 5, 4]  # CalculiX wants its axisymmetric cells counter-clockwise in (r, z)
    inside = range(1, len(mesh.cells) + 1, through)
    return [
        "*NODE,NSET=ALL",
        *(f"{k},{r:.12g},{z:.12g},0." for k, (r, z) in enumerate(mesh.nodes, start=1)),
        "*ELEMENT,TYPE=CAX8R,ELSET=WALL",
        *(f"{k}," + ",".join(str(n + 1) for n in cell[other_way]) for k, cell in enumerate(mesh.cells, start=1)),
        "*ELSET,ELSET=INNER",
        *(f"{k}," for k in inside),
        "*NSET,NSET=BASE",
        *(f"{n + 1}," for n in mesh.clamped),
        "*NSET,NSET=AXIS",
        *(f"{n + 1}," for n in mesh.axis),
        "*MATERIAL,NAME=RUBBER",
        "*HYPERELASTIC,NEO HOOKE",
        f"{0.5 * mu:.12g},{2 / bulk:.12g}",
        "*SOLID SECTION,ELSET=WALL,MATERIAL=RUBBER",
        "*BOUNDARY",
        "BASE,1,2",
        "AXIS,1,1",
    ]


class CalculixRun(NamedTuple):
    """Lines that CalculiX prints (.dat) and on its increments (.sta), and processor time of the whole process, s."""

    prints: list[str]
    status: list[str]
    seconds: float


def run_calculix(deck: list[str]) -> CalculixRun:
    """CalculiX on a deck, in one thread."""
    with tempfile.TemporaryDirectory() as name:
        job, alone = Path(name) / "dome", {**os.environ, "OMP_NUM_THREADS": "1"}
        job.with_suffix(".inp").write_text("\n".join([*deck, ""]), encoding="ascii")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(["ccx", job.name], cwd=name, capture_output=True, check=False, env=alone)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        files = (job.with_suffix(end) for end in (".dat", ".sta"))
        lines = [path.read_text(encoding="ascii").splitlines() if path.exists() else [] for path in files]
    return CalculixRun(*lines, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def calculix_limit(sensor: Sensor, arc: int, through: int) -> tuple[float, int, float, float]:
    """Limit pressure (MPa), increments, and processor time of the whole process and without reading the deck (s)."""
    full = RISING_BRANCH[-1, 0] * sensor.wall.shear_modulus * sensor.dome.wall_thickness / sensor.dome.inner_radius
    step = ["*STEP,NLGEOM,INC=200", "*STATIC", _INCREMENTS, "*DLOAD", f"INNER,P4,{full:.12g}", "*END STEP"]
    model = calculix_model(sensor, arc, through)
    reading, whole = run_calculix(model), run_calculix([*model, *step])
    rows = [line.split() for line in whole.status[2:]]
    reached = [float(row[4]) for row in rows if "U" not in row[2]]
    return full * max(reached, default=float("nan")), len(reached), whole.seconds, whole.seconds - reading.seconds
