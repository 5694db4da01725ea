"""Solved states of one dome and the splines through them: a potential over volume and depth, and further fields."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_triangular

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError
from pneutouch.mechanics.atlas.recipe import (
    RECIPE,
    STORED,
    STRETCHES,
    AtlasAxes,
    AtlasRecipe,
    SplineAxis,
    axes,
    flattened,
)
from pneutouch.mechanics.events import SEPARATION
from pneutouch.mechanics.models.solid import solid_probe
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.solid.continuation import PathFollower, PlateState, descend
from pneutouch.mechanics.solid.elements import Gas
from pneutouch.mechanics.solid.indent import travel_to_rim
from pneutouch.mechanics.solid.inflate import FreeState, at_volume, between, inflate, pressure_between, state_at
from pneutouch.mechanics.solid.newton import NewtonFailure, SolverState
from pneutouch.mechanics.solid.object_contact import Plate
from pneutouch.mechanics.solid.stress import StrainProbe

_SMOOTH = 1.0e-5
"""Weight of the coefficients' roughness: decides only where no state supports them."""
_ALIKE = 1.0e-5
"""Weight of a coefficient's distance from the mean of its neighbours over the wall ratio, likewise."""
_FLOOR = 0.15
"""Pressures and forces below this share of the limit pressure are fitted to absolute, above it to relative error."""

_AT_CONTACT = 4.0
"""Weight of the free dome: its fields give the limits of driving, and no force is the force at first contact."""
_MORE_PRESSURE, _SWOLLEN, _NEAR_LIMIT = 1.5, 1.3, 0.9
"""A table goes to a multiple of the design's greatest driving pressure, at least to that at which the cavity is a
multiple of the unloaded one; beyond the last share of the limit point's pressure, to the limit point itself."""
_EMPTIED, _LEAST_LEFT, _BELOW = 0.25, 0.1, 2
"""Volume below rest to which presses begin, as a share of the inflation and at most of the cavity, and their number."""
_FLAT = 0.15
"""Least rise of a wall, R0, in which its heights are measured."""
INFLATED, _BEYOND, _FARTHEST = 90, 6, 1.04
"""Cells of the free inflation up to the limit point, those beyond it, and the end over the limit point's volume."""


@dataclass(frozen=True)
class Survey:
    """All states solved for one wall ratio.

    free_volume, free_apex: the free inflation curve from nu = 0 on, (n,). limit_volume, limit_pressure: limit point.
    volume, height, energy, pressure, force, stiffness (dp/dV at a fixed plate): (m,). fields: (len(STORED), m).
    """

    wall_ratio: float
    limit_volume: float
    limit_pressure: float
    free_volume: Array
    free_apex: Array
    volume: Array
    height: Array
    energy: Array
    pressure: Array
    force: Array
    stiffness: Array
    fields: Array
    fold_from: float
    fold_volume: Array


def stretch_by_zone(probe: StrainProbe, x: Array) -> Array:
    """Greatest principal stretch on each face and third of the arc, inner face first, from the base up; (6,)."""
    greatest = probe.principal(x)[0].max(axis=0)
    third = np.clip(np.arctan2(probe.places[:, 1], probe.places[:, 0]) / (np.pi / 6.0), 0, 2).astype(np.intp)
    zones = [(probe.outer == face) & (third == part) for face in (False, True) for part in range(3)]
    return np.array([greatest[zone].max(initial=0.0) for zone in zones])


def stored_fields(probe: StrainProbe, state: SolverState) -> list[float]:
    """The `STORED` fields of one state under the plate, in their order."""
    solid, x, touch = probe.solid, state.x, state.touch
    assert touch is not None
    peak = probe.peak(x)
    values = {
        **dict(zip(STRETCHES, stretch_by_zone(probe, x), strict=True)),
        "contact_radius": solid.contact.footprint(x, touch).radius,
        "von_mises": peak.von_mises,
        "fold": peak.fold,
        "inner_apex": float(x[solid.mesh.inner_apex, 1]),
    }
    return [values[name] for name in STORED]


def roughness(size: int, order: int) -> Array:
    """Differences of an order of neighbouring coefficients, (size - order, size)."""
    return np.diff(np.eye(size), n=order, axis=0)


@dataclass(frozen=True)
class NormalEquations:
    """Least squares by its triangular factor R'R and right side, (n, n) and (n, several)."""

    factor: Array
    right: Array

    def solve(self, near: Array | None = None) -> Array:
        """The coefficients, drawn to those of `near` where nothing else decides; (n, several)."""
        right = self.right if near is None else self.right + _ALIKE**2 * near
        solution: Array = solve_triangular(self.factor, solve_triangular(self.factor, right, trans="T"))
        return solution


@dataclass(frozen=True)
class WallCoefficients:
    """One wall ratio's coefficients: apex (volume,), and the systems for the potential in units of the limit pressure
    and for the fields, over (volume, depth) flat.

    support: cells with states in or next to them (volume cells, depth cells). fold_from, fold_volume: see `Survey`.
    """

    limit_volume: float
    limit_pressure: float
    apex: Array
    potential: NormalEquations
    fields: NormalEquations
    support: Array
    fold_from: float
    fold_volume: Array


def fit_sheet(survey: Survey, recipe: AtlasRecipe) -> WallCoefficients:
    """Least squares over all states of one survey; energy, pressure and force are met by one and the same potential."""
    grid = axes(recipe)
    rest, reach = survey.free_volume[0], survey.limit_volume - survey.free_volume[0]
    apex = fit_apex(survey, grid.volume, rest, reach)
    nu = (survey.volume - rest) / reach
    rise, slope = grid.volume.rows(nu) @ apex, grid.volume.rows(nu, 1) @ apex
    w = np.maximum(rise - survey.height, 0.0)

    def products(by_volume: int, by_depth: int) -> Array:
        a, b = grid.volume.rows(nu, by_volume), grid.depth.rows(w, by_depth)
        return (a[:, :, None] * b[:, None, :]).reshape(nu.size, -1)

    force = products(0, 1)
    pressure = (products(1, 0) + slope[:, None] * force) / reach
    value = products(0, 0)
    unit = survey.limit_pressure
    solution = [
        (value, survey.energy, 0.1 * _FLOOR),
        (pressure, survey.pressure, _FLOOR),
        (force, survey.force, _FLOOR),
    ]
    scales = [1.0 / (floor * unit + np.abs(target)) for _, target, floor in solution]
    scales[2] = scales[2] * np.where(w > 0.0, 1.0, _AT_CONTACT)
    smooth = _smoothness(grid)
    potential = _system(
        [rows * (unit * scale)[:, None] for (rows, _, _), scale in zip(solution, scales, strict=True)],
        [(target * scale)[:, None] for (_, target, _), scale in zip(solution, scales, strict=True)],
        smooth / _FLOOR,
    )
    weight = np.where(w > 0.0, 1.0, _AT_CONTACT)[:, None]
    target = np.stack([flattened(name, field) for name, field in zip(STORED, survey.fields, strict=True)], axis=1)
    support = np.zeros((grid.volume.cells, grid.depth.cells))
    support[grid.volume.basis(nu)[0], grid.depth.basis(w)[0]] = 1.0
    return WallCoefficients(
        survey.limit_volume,
        unit,
        apex,
        potential,
        _system([value * weight], [target * weight], smooth),
        grown(support),
        survey.fold_from,
        survey.fold_volume,
    )


def grown(support: Array) -> Array:
    """Cells with states and their neighbours: the states' spacing is no boundary, stability is."""
    wide = np.pad(support, 1)
    rows, columns = support.shape
    return np.asarray(np.maximum.reduce([wide[i : i + rows, k : k + columns] for i in range(3) for k in range(3)]))


def fit_apex(survey: Survey, axis: SplineAxis, rest: float, reach: float) -> Array:
    """The free apex over nu; below nu = 0, where it only gives w its meaning, as straight as smoothness allows."""
    nu = (survey.free_volume - rest) / reach
    stiff = roughness(axis.size, 2)
    stiff[axis.basis(np.zeros(1))[0][0] :] = 0.0
    left = np.concatenate([axis.rows(nu), 1e-3 * stiff, 1e-6 * roughness(axis.size, 4)])
    right = np.concatenate([survey.free_apex, np.zeros(left.shape[0] - nu.size)])
    solution: Array = np.linalg.lstsq(left, right, rcond=None)[0]
    return solution


def _smoothness(grid: AtlasAxes) -> Array:
    volume, depth = grid.volume.size, grid.depth.size
    rough = np.concatenate([np.kron(roughness(volume, 4), np.eye(depth)), np.kron(np.eye(volume), roughness(depth, 4))])
    return np.concatenate([_SMOOTH * rough, _ALIKE * np.eye(volume * depth)])


def _system(rows: list[Array], values: list[Array], smooth: Array) -> NormalEquations:
    left = np.concatenate(rows)
    factor = np.linalg.qr(np.concatenate([left, smooth]), mode="r")
    return NormalEquations(np.asarray(factor), left.T @ np.concatenate(values))


class SurveyPlan(NamedTuple):
    """Presses of a survey: numbers of volumes from which they start and of depths, ambient pressures (mu) and dead
    volume (R0^3) of their gas."""

    starts: int
    depths: int
    ambients: tuple[float, ...]
    dead: float


class SurveyedDome:
    """The solid of a sensor: its free inflation, and presses with trapped gas from many volumes; units of R0 and mu.

    ``cells``: number of cells along the arc.
    """

    def __init__(self, sensor: Sensor, cells: int, plan: SurveyPlan) -> None:
        self.plan = plan
        self.probe = solid_probe(sensor, cells)
        self.solid = self.probe.solid
        self.run = inflate(self.solid, past_limit=_FARTHEST)
        self.rest = self.run.states[0].unit.volume
        # Domes of other heights behave alike if heights and volumes are in units of their own; flat walls do not.
        foot, pole = self.solid.rest[self.solid.mesh.inner[[0, -1], [0, 1]], 1]
        rises = pole - foot > _FLAT
        self.unit = float(pole - foot) if rises else 1.0
        self.volume_unit = self.rest if rises else 1.0

    def swelling(self, pressure: float) -> float | None:
        """Inflation for `survey` of a dome that is driven to a pressure (mu); None: to the near limit point."""
        run, mu = self.run, self.solid.mu
        swollen = float(np.interp(_SWOLLEN * run.volume[0], run.volume, run.pressure)) / mu
        wanted = max(_MORE_PRESSURE * pressure, swollen)
        if run.limit is not None and wanted >= _NEAR_LIMIT * run.limit.pressure / mu:
            return None
        return (state_at(self.solid, wanted * mu, run).unit.volume - self.rest) / self.volume_unit

    def survey(self, swelling: float | None, deepest: float) -> Survey:
        """States of presses from volumes between rest and ``swelling`` units of volume more (None: the limit point).

        Heights are in the unit of height, as are ``lasts``, the depths that the presses reached (inf: all)."""
        run, rest, unit = self.run, self.rest, self.unit
        last = run.limit or run.states[-1]
        end = last.unit.volume if swelling is None else rest + swelling * self.volume_unit
        starts = [self._free(v) for v in np.linspace(rest, end, self.plan.starts)]
        starts += self._emptied(rest - min(_EMPTIED * (end - rest), _LEAST_LEFT * rest))
        presses = [self._pressed(free, gas, deepest) for free in starts for gas in self.plan.ambients]
        nodes = [node for press, _ in presses for node in press]
        self.lasts = np.array([last for _, last in presses[: self.plan.starts * len(self.plan.ambients)]]) / unit
        return Survey(
            self.solid.wall,
            end,
            starts[self.plan.starts - 1].unit.filling.pressure,
            np.array([free.unit.volume for free in starts]),
            np.array([self._touched(free) for free in starts]) / unit,
            np.array([node.state.volume for node in nodes]),
            np.array([node.height for node in nodes]) / unit,
            np.array([node.state.energy - node.state.filling.energy for node in nodes]),
            np.array([node.state.filling.pressure for node in nodes]),
            np.array([node.force for node in nodes]) * unit,
            np.zeros(len(nodes)),
            np.array([stored_fields(self.probe, node.state) for node in nodes]).T,
            np.inf,
            np.zeros(0),
        )

    def _free(self, volume: float) -> FreeState:
        below = [s for s in self.run.states if s.unit.volume <= volume * (1.0 + 1e-12)]
        if abs(below[-1].unit.volume - volume) <= 1e-12 * volume:
            return below[-1]
        solution = at_volume(self.solid, below[-1:], volume)
        if isinstance(solution, NewtonFailure):
            raise ComputationError(f"no free state at {volume:.4g} R0^3: {solution.why}")
        return solution

    def _emptied(self, volume: float) -> list[FreeState]:
        """Free states below rest, down to a volume, as far as they are stable.

        Presses from them are no part of the table's box. They have states beyond the edge of those without driving
        pressure, which lies elsewhere for every point."""
        path = [self.run.states[0]]
        for v in np.linspace(path[0].unit.volume, volume, _BELOW + 1)[1:]:
            state = at_volume(self.solid, path[-1:], float(v))
            if isinstance(state, NewtonFailure) or not state.stable:
                break
            path.append(state)
        return path[1:]

    def _touched(self, free: FreeState) -> float:
        """Height at which a plate first touches a free state."""
        return float(free.unit.x[self.solid.mesh.outer, 1].max())

    def _pressed(self, free: FreeState, ambient: float, deepest: float) -> tuple[list[PlateState], float]:
        """States of one press to a depth, or to its first event, with the gas of an ambient pressure; and the depth."""
        plan, solid = self.plan, self.solid
        plate = Plate(self._touched(free), np.inf, solid.contact.longest)
        supply = Gas.filled(free.unit.filling.pressure, free.unit.volume, ambient, plan.dead)
        follower = PathFollower(solid, supply, plate, free.unit.x)
        rim = travel_to_rim(solid, plate)
        for depth in SplineAxis(0.0, deepest, 1, 1, RECIPE.depth_stretch).even(plan.depths)[1:]:
            if depth > rim or descend(follower, plate.height - depth) is not None:
                return follower.path, plate.height - follower.here.height
            x, touch = follower.here.state.x, follower.here.state.touch
            if touch is not None and solid.contact.footprint(x, touch).inside_gap > SEPARATION * solid.wall:
                return follower.path[:-1], plate.height - follower.path[-2].height
        return follower.path, np.inf

    def inflation(self) -> Array:
        """Free inflation, (5, n): volume, heights of the inner and the outer apex, greatest stretch and pressure, at
        `INFLATED` + 1 volumes up to the limit point and some beyond."""
        run, solid = self.run, self.solid
        limit = run.limit or run.states[-1]
        rest = run.volume[0]
        share = np.concatenate([np.linspace(0.0, 1.0, INFLATED + 1), np.linspace(1.0, _FARTHEST, _BEYOND + 1)[1:]])
        columns = []
        for volume in np.minimum(rest + share * (limit.volume - rest), run.volume[-1]).tolist():
            j = int(np.clip(np.searchsorted(run.volume, volume), 1, run.volume.size - 1))
            a, b = run.states[j - 1], run.states[j]
            at, unit = (volume - a.volume) / (b.volume - a.volume), volume / solid.length**3
            x = between(a, b, unit)
            heights = x[solid.mesh.inner_apex, 1], x[solid.mesh.outer_apex, 1]
            columns.append([unit, *heights, self.probe.greatest_stretch(x), pressure_between(a, b, at) / solid.mu])
        return np.array(columns).T
