"""The solid against exact results, CalculiX and the paper's table: ``python -m benchmarks.validation``.

Writes docs/background/validation.json. Friction and contact off the axis in three dimensions have modules of their own
(`calculix_friction_half`, `off_axis_calculix`); with ``stored`` only what all of them come to is reduced anew, and with names of `PARTS` these are measured anew.
"""

from __future__ import annotations

import shutil
import statistics
import sys
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from benchmarks import calculix_friction_half, off_axis_calculix
from benchmarks.calculix_sweep import calculix_limit
from benchmarks.contact_references import balls
from benchmarks.methods import solid_limit
from benchmarks.paper import OTHER_SOURCE, Cell, table_s1
from benchmarks.scenes import PAPER, Scene
from benchmarks.shape_calculix import shapes_calculix
from benchmarks.shape_references import shapes
from benchmarks.store import LIBRARY, store, stored
from pneutouch.catalogue import Library
from pneutouch.mechanics.laws import neo_hookean
from pneutouch.mechanics.solid.indent import PressSettings, indent
from pneutouch.mechanics.solid.inflate import inflate, state_at
from pneutouch.mechanics.solid.mesh import dome
from pneutouch.mechanics.solid.model import SolidModel
from pneutouch.shape.hemisphere import Hemisphere

SPHERES = ((1.0, 2.0), (10.0, 11.0), (9.25, 10.75), (8.5, 10.0))
"""Inner and outer radii of the thick spheres."""

FRICTION_FIGURES = ("force_N", "rise_kPa")
DEAD_VOLUMES_ML = (0.0, 0.1, 0.2, 0.5, 1.0, 2.0)

PRINTED_FLANGE = (2.25, 2.25)
"""Width and thickness of the flange of designs/paper-dome.toml, mm."""

PRESSED_MEMBRANE = {
    22: {
        1.0: (23.06473, 0.51684, 2.6707),
        2.0: (25.37169, 1.46845, 4.2922),
        3.0: (29.39562, 2.98762, 5.6878),
        4.0: (36.03323, 5.43614, 6.9298),
        5.0: (46.71956, 9.48173, 8.0375),
    },
    35: {
        1.0: (36.38451, 0.68769, 2.4528),
        2.0: (38.90945, 1.87926, 3.9209),
        3.0: (42.77793, 3.65116, 5.2123),
        4.0: (48.47384, 6.23693, 6.3997),
        5.0: (56.72326, 10.02554, 7.5006),
    },
}
"""The exact membrane (R0 9.25 mm, mu t0 0.255 N/mm, no dead volume) pressed by a plate: cavity pressure kPa, force N,
contact radius mm by indentation, at driving pressures in kPa. Shooting and an energy method, which agree to 5e-5."""


def sphere_limit(inner: float, outer: float) -> tuple[float, float]:
    """Exact p/mu and inner stretch at the limit point of an incompressible neo-Hookean sphere."""

    def pressure(stretch: float) -> float:
        at_outer = (1 + (stretch**3 - 1) * (inner / outer) ** 3) ** (1 / 3)
        return 0.5 * ((4 / at_outer + at_outer**-4) - (4 / stretch + stretch**-4))

    best = minimize_scalar(lambda s: -pressure(s), bounds=(1.1, 3.0), method="bounded", options={"xatol": 1e-12})
    return -float(best.fun), float(best.x)


def sphere_found(inner: float, outer: float) -> tuple[float, float]:
    """The solid's, on a hemisphere whose base slides, extrapolated to an incompressible wall."""
    found = []
    for nu in (0.4999, 0.49995):
        solid = SolidModel(dome(Hemisphere(inner, outer - inner), arc=24, through=4, slides=True), neo_hookean(1.0, nu))
        limit = inflate(solid, past_limit=1.0).limit
        assert limit is not None
        found.append((limit.pressure, limit.inner_apex / inner))
    pressure, stretch = 2 * np.array(found[1]) - np.array(found[0])
    return float(pressure), float(stretch)


def limit_of(ratio: float, arc: int | None = None, through: int | None = None, nu: float = 0.49) -> tuple[float, float]:
    """P R0/(mu t0) and h/R0 at the limit point of a dome of a wall ratio."""
    limit = inflate(
        SolidModel(dome(Hemisphere(1.0, ratio), arc=arc, through=through), neo_hookean(1.0, nu)), past_limit=1.0
    ).limit
    assert limit is not None
    return limit.pressure / ratio, limit.inner_apex


def spheres() -> list[list[float]]:
    """Thick spheres: radii, and p/mu and stretch at the limit point, exact and by the solid."""
    rows = []
    for inner, outer in SPHERES:
        exact, found = sphere_limit(inner, outer), sphere_found(inner, outer)
        rows.append([inner, outer, exact[0], found[0], exact[1], found[1]])
    return rows


def thin_walls() -> dict[str, Any]:
    """Limit points p R0/(mu t0), h/R0 by wall ratio, and those extrapolated to no wall."""
    ratios = (0.08, 0.04, 0.02, 0.01)
    found = [limit_of(ratio, arc=64, through=1, nu=0.4999) for ratio in ratios]
    return {
        "rows": [[ratio, *point] for ratio, point in zip(ratios, found, strict=True)],
        "extrapolated": list(2 * np.array(found[-1]) - np.array(found[-2])),
    }


def pressed_membrane() -> list[list[float]]:
    """State II of the exact membrane: driving pressure (kPa), indentation (mm); then cavity pressure (kPa), force (N) and contact
    radius (mm), each with the relative deviation of the solid."""
    wall = 0.0925
    solid = SolidModel(dome(Hemisphere(9.25, wall), arc=96, through=1), neo_hookean(0.255 / wall, 0.4999))
    rows = []
    for driving, table in PRESSED_MEMBRANE.items():
        run = indent(solid, state_at(solid, 1e-3 * driving), PressSettings(5.0, steps=5))
        for state in run.states[1:]:
            exact = table[round(state.indentation, 6)]
            found = (1e3 * state.pressure, state.force, state.contact_radius)
            pairs = [(known, value / known - 1) for known, value in zip(exact, found, strict=True)]
            rows.append([driving, state.indentation, *(part for pair in pairs for part in pair)])
    return rows


def refinement() -> dict[str, Any]:
    """Order of convergence of the clamped dome's limit pressure, and p R0/(mu t0) with its error by cells."""
    ratio = 1.5 / 9.25
    meshes = ((8, 1), (16, 2), (32, 4), (64, 8))
    found = [limit_of(ratio, arc, through)[0] for arc, through in meshes]
    (last, before), (coarse, fine) = (found[-1] - found[-2], found[-2] - found[-3]), (found[-2], found[-1])
    order = float(np.log2(abs(before / last)))
    best = fine + (fine - coarse) / (2**order - 1)
    return {"order": order, "rows": [[f"{a} x {t}", p, p / best - 1] for (a, t), p in zip(meshes, found, strict=True)]}


def invariances() -> dict[str, Any]:
    """Change of p/mu by radius (mm) and modulus (MPa), and stored energy against work."""
    base = inflate(SolidModel(dome(Hemisphere(9.25, 1.5)), neo_hookean(0.17)))
    rows = []
    for radius, mu in ((0.1, 0.17), (1000.0, 0.17), (9.25, 1e-3), (9.25, 1e3)):
        run = inflate(SolidModel(dome(Hemisphere(radius, radius * 1.5 / 9.25)), neo_hookean(mu)))
        assert run.limit is not None and base.limit is not None
        rows.append([radius, mu, (run.limit.pressure / mu) / (base.limit.pressure / 0.17) - 1])
    energy = np.array([s.unit.local.energy for s in base.states]) * 0.17 * 9.25**3
    v, p, k = base.volume, base.pressure, np.array([s.stiffness for s in base.states])
    work = 0.5 * np.diff(v) * (p[1:] + p[:-1]) - np.diff(v) ** 2 / 12 * np.diff(k)
    return {"rows": rows, "energy_error": float(abs(work.sum() / (energy[-1] - energy[0]) - 1))}


def calculix() -> dict[str, float] | None:
    """Limit pressures (kPa) by CalculiX and by the solid; None where CalculiX is not installed."""
    if shutil.which("ccx") is None:
        return None
    ours = solid_limit(Scene("", PAPER, 0.0), 24, 2)
    return {"calculix_kPa": 1e3 * calculix_limit(PAPER, 24, 2)[0], "solid_kPa": 1e3 * ours}


def incompressibility() -> list[list[float]]:
    """Poisson's ratio up to 0.4999 without locking: p R0/(mu t0) and its difference from a refined mesh."""
    ratio = 1.5 / 9.25
    rows = []
    for nu in (0.49, 0.495, 0.499, 0.4995, 0.4999):
        default, fine = limit_of(ratio, nu=nu)[0], limit_of(ratio, 72, 4, nu)[0]
        rows.append([nu, default, default / fine - 1])
    return rows


def dead_volumes(library: Library = LIBRARY) -> dict[str, Any]:
    """Table S1 with the one unknown, the dead volume, varied: relative errors of the solid by column."""
    runs: dict[str, list[Cell]] = {f"{v:g} mL": table_s1(library, v) for v in DEAD_VOLUMES_ML}
    runs["as printed"] = table_s1(library, flange=PRINTED_FLANGE)
    rows = [
        {
            "resin": cell.material,
            "driving_pressure_kPa": cell.pressure,
            "measured_kPa_per_N": cell.measured,
            "errors": [cells[k].errors["solid"] for cells in runs.values()],
        }
        for k, cell in enumerate(runs["0 mL"])
    ]
    return {"columns": list(runs), "rows": rows}


_WORK = spheres, thin_walls, pressed_membrane, balls, refinement, incompressibility, invariances, calculix
PARTS = {work.__name__: work for work in (*_WORK, dead_volumes, shapes, shapes_calculix)}
"""All numbers of the page but those of CalculiX in three dimensions."""


def greatest(rows: list[list[float]]) -> list[float]:
    """Greatest absolute value of each column."""
    return [max(map(abs, column)) for column in zip(*rows, strict=True)]


def references(data: dict[str, Any]) -> list[dict[str, Any]]:
    """Every comparison: kind of reference, what is compared, and the greatest relative difference of each figure."""
    pressure, height = data["thin_walls"]["extrapolated"]
    spheres = [[row[3] / row[2] - 1, row[5] / row[4] - 1] for row in data["spheres"]]
    pressed = [row[3::2] for row in data["pressed_membrane"]]
    off_axis, friction = stored("off-axis-calculix"), stored("friction-calculix")
    three = [greatest([[x] for x in calculix_friction_half.differences(friction, key)])[0] for key in FRICTION_FIGURES]
    aside = [
        greatest([[x] for x in off_axis_calculix.differences(off_axis, key)])[0] for key in off_axis_calculix.FIGURES
    ]
    balls, limit = data["balls"], data["calculix"]
    inflation = [abs(limit["calculix_kPa"] / limit["solid_kPa"] - 1)] if limit else []
    membrane = [abs(pressure / 1.57537 - 1), abs(height / 1.69 - 1)]
    shell = [max(map(abs, balls["shell"][-1]["sheared"]))]
    forms = data["shapes"]
    plates = [row[3] for row in forms["plates"] if row[1] <= 0.02]
    bent = [[row[-1]] for row in forms["far_bent"]], [[row[-1]] for row in forms["hencky"]]
    caps = [[one[key][1] / one[key][0] - 1.0 for key in ("limit", "first")] for one in forms["snaps"]]
    other = [[*row["free"], max(abs(one[2]) for one in row["press"])] for row in data["shapes_calculix"]]
    rows = [
        ("thick spheres", "exact", "limit pressure, stretch", greatest(spheres)),
        ("thin membrane, inflated", "exact", "limit pressure, height (both extrapolated to no wall)", membrane),
        ("thin membrane, pressed by a plate", "exact", "cavity pressure, force, contact radius", greatest(pressed)),
        ("Hertz, smallest contact", "exact", "force", [abs(balls["hertz"][-1][1])]),
        ("pressurised shell with shear, wall of 0.0025 R", "exact", "first stiffness under a ball", shell),
        ("clamped plates of 0.02 and 0.01 a", "exact", "small deflection, with shear", greatest([[x] for x in plates])),
        ("plate bent far; Hencky's membrane", "exact", "deflection of each", [greatest(one)[0] for one in bent]),
        ("flat membrane of 0.005 a", "exact", "limit pressure, height", list(map(abs, forms["flat"][-1]["limit"]))),
        ("shallow cap of 0.0025 R", "exact", "first stiffness under a ball", [abs(forms["cap_ball"][-1][2])]),
        ("seven shallow caps, emptied", "exact", "limit pressure, first loss of stability", greatest(caps)),
        ("CalculiX, inflation", "program", "limit pressure", inflation),
        ("CalculiX, ellipsoid and thimble", "program", "height, volume, force", greatest(other) if other else []),
        ("CalculiX in 3D, friction", "program", "force, pressure rise", three),
        ("CalculiX in 3D, off the axis", "program", "force, sideways force, pressure rise", aside),
        ("Table S1 of the paper, twelve cells", "measured", "sensitivity", data["dead_volumes"]["medians"][:1]),
    ]
    return [dict(zip(("name", "kind", "figures", "differences"), row, strict=True)) for row in rows if row[-1]]


def main(*words: str) -> None:
    data = stored("validation") if words else {}
    data.update({name: work() for name, work in PARTS.items() if name in words or not words})
    cells = [row["errors"] for row in data["dead_volumes"]["rows"] if row["resin"] != OTHER_SOURCE]
    data["dead_volumes"]["medians"] = [statistics.median(map(abs, column)) for column in zip(*cells, strict=True)]
    data["references"] = references(data)
    store("validation", data)


if __name__ == "__main__":
    main(*sys.argv[1:])
