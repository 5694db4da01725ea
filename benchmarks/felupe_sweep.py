"""The inflation sweep with FElupe (an optional peer, GPL: imported here alone, and only when asked for).

FElupe 11 has no cavity: the apex height is prescribed and the pressure is the unknown that goes with it, one more row and
column around FElupe's own stiffness and pressure matrices. The heights, their number and the guess ahead along the last
step are the best that were found for it. Both of its elements for nearly incompressible solids are run.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.sparse import bmat, csr_matrix
from scipy.sparse.linalg import splu

from pneutouch.arrays import Array
from pneutouch.mechanics import Sensor
from pneutouch.mechanics.solid.mesh import SolidMesh, dome

_TOP = 1.9
_COUNTS = (6, 8, 12, 18, 27, 40)
_MOST_ITERATIONS = 12
_RESIDUAL, _FIRST_STEPS = 1e-6, 1.5


class _DivergedError(Exception):
    pass


def _bodies(sensor: Sensor, mesh: SolidMesh, mixed: bool) -> tuple[Any, Any, Any, Any]:
    """Field, solid body, field on the inner wall and unit pressure on it; FElupe has the axis first, then the radius."""
    import felupe as fe

    nu, mu = sensor.wall.poisson_ratio, sensor.wall.shear_modulus
    bulk = 2 * mu * (1 + nu) / (3 * (1 - 2 * nu))
    grid = fe.Mesh(mesh.nodes[:, ::-1].copy(), mesh.cells, "quad9" if mixed else "quad")
    inner = np.zeros(len(mesh.nodes), bool)
    inner[np.unique(mesh.inner)] = True
    law = fe.NeoHooke(mu=mu)
    if mixed:
        edge = fe.RegionBiQuadraticQuadBoundary(grid, mask=inner, ensure_3d=True)
        field = fe.FieldsMixed(fe.RegionBiQuadraticQuad(grid), n=3, axisymmetric=True)
        body = fe.SolidBody(fe.NearlyIncompressible(law, bulk=bulk), field)
    else:
        edge = fe.RegionQuadBoundary(grid, mask=inner, ensure_3d=True)
        field = fe.FieldContainer([fe.FieldAxisymmetric(fe.RegionQuad(grid), dim=2)])
        body = fe.SolidBodyNearlyIncompressible(law, field, bulk=bulk)
    wall = fe.FieldContainer([fe.FieldAxisymmetric(edge, dim=2)])
    return field, body, wall, fe.SolidBodyPressure(wall, pressure=1.0)


class _Sweep:
    """One walk up the apex heights."""

    def __init__(self, sensor: Sensor, mesh: SolidMesh, mixed: bool) -> None:
        self.field, self.body, self.wall, self.load = _bodies(sensor, mesh, mixed)
        self.moved = 2 * len(mesh.nodes)
        self.size = sum(f.values.size for f in self.field.fields)
        free = np.ones(self.size, bool)
        free[2 * mesh.clamped] = free[2 * mesh.clamped + 1] = free[2 * mesh.axis + 1] = False
        self.act = np.flatnonzero(free)
        self.apex = 2 * int(mesh.inner_apex)
        self.pick = csr_matrix((self.act == self.apex).astype(float)[None, :])
        self.pressure = 0.0

    def values(self) -> Array:
        return np.concatenate([f.values.ravel() for f in self.field.fields])

    def add(self, step: Array) -> None:
        start = 0
        for f in self.field.fields:
            f.values += step[start : start + f.values.size].reshape(f.values.shape)
            start += f.values.size

    def reach(self, rise: float) -> None:
        """Newton to an apex displacement, mm."""
        for iteration in range(_MOST_ITERATIONS):
            inside = np.asarray(self.body.assemble.vector(self.field).todense()).ravel()
            self.wall[0].values[:] = self.field[0].values
            self.load.results.pressure = 1.0
            push = np.zeros(self.size)
            push[: self.moved] = np.asarray(self.load.assemble.vector(self.wall).todense()).ravel()[: self.moved]
            left = (inside - self.pressure * push)[self.act]
            size = np.linalg.norm(left)
            if not np.isfinite(size):
                raise _DivergedError
            if iteration and size < _RESIDUAL * np.linalg.norm(self.pressure * push):
                return
            self.load.results.pressure = self.pressure
            turn = self.load.assemble.matrix(self.wall).tocsr()
            turn.resize(self.size, self.size)
            k = (self.body.assemble.matrix(self.field).tocsr() - turn)[self.act][:, self.act]
            whole = bmat([[k, csr_matrix(-push[self.act][:, None])], [self.pick, None]], format="csc")
            gap = rise - self.field[0].values.ravel()[self.apex]
            step = splu(whole).solve(np.append(-left, gap))
            full = np.zeros(self.size)
            full[self.act] = step[:-1]
            self.add(full)
            self.pressure += step[-1]
        raise _DivergedError


def _climb(sensor: Sensor, mesh: SolidMesh, mixed: bool, count: int) -> float:
    """Pressures at ``count`` apex heights, and the greatest on the spline through them, MPa."""
    sweep, radius = _Sweep(sensor, mesh, mixed), sensor.dome.inner_radius
    rises = radius * (_TOP - 1) * np.linspace(0, 1, count + 1) ** _FIRST_STEPS
    pressures, before = [0.0], sweep.values()
    for k, rise in enumerate(rises[1:], start=1):
        here = sweep.values()
        if k > 1:
            share = (rise - rises[k - 1]) / (rises[k - 1] - rises[k - 2])
            sweep.add(share * (here - before))
            sweep.pressure += share * (pressures[-1] - pressures[-2])
        before = here
        sweep.reach(float(rise))
        pressures.append(sweep.pressure)
    fine = np.linspace(0, rises[-1], 4001)
    return float(CubicSpline(rises, pressures)(fine).max())


def felupe_limit(sensor: Sensor, arc: int, through: int, mixed: bool, count: int | None = None) -> tuple[float, int]:
    """Limit pressure (MPa), and the number of heights it took: ``count``, or the least that Newton follows."""
    mesh = dome(sensor.dome.shape, arc=arc, through=through, order=2 if mixed else 1)
    for n in (count,) if count else _COUNTS:
        try:
            with np.errstate(all="ignore"):
                return _climb(sensor, mesh, mixed, n), n
        except (_DivergedError, RuntimeError):  # RuntimeError: SuperLU met a singular matrix
            continue
    return float("nan"), 0
