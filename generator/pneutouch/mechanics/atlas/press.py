"""Many sensors with trapped gas pressed at once by a plate, with states interpolated in the atlas.

`SensorBatch` holds the inputs of the sensors; ``nu`` is the volume coordinate of `recipe.AtlasRecipe`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np

from pneutouch.arrays import Array, Flags, Index
from pneutouch.mechanics.atlas.table import AtlasPoint, AtlasSlices
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.solid.mesh import arc_cells
from pneutouch.mechanics.solid.object_contact import flat_radius, rim_radius

_NEWTON = 8
_LONGEST = 0.05
_LAST_STEP = 1.0e-4
"""Longest Newton step in nu, and the step length at which a solution counts as converged."""
_CLOSE = 1.0e-9
_NO_TRAVEL = 1.0e-9
_INFLATING = 40
_BELOW_REST = 0.01
"""Lowest nu of an inflated state: below 0, because the table's pressure at rest is not exactly zero."""


@dataclass(frozen=True)
class SensorBatch:
    """Sensors to press, arrays of one length in mm, mm^3 and MPa. break_stretch and plate_radius may be infinite."""

    inner_radius: Array
    wall_thickness: Array
    shear_modulus: Array
    ambient_pressure: Array
    dead_volume: Array
    driving_pressure: Array
    depth: Array
    plate_radius: Array
    gauge_limit: Array
    break_stretch: Array

    def __len__(self) -> int:
        return self.inner_radius.size

    @classmethod
    def join(cls, batches: "Sequence[SensorBatch]") -> "SensorBatch":
        """One batch of the sensors of several, one after the other."""
        return cls(*(np.concatenate([getattr(batch, field.name) for batch in batches]) for field in fields(cls)))

    def take(self, rows: Index | Flags | slice) -> "SensorBatch":
        """Batch of the selected sensors, by index, mask or slice."""
        return SensorBatch(*(getattr(self, field.name)[rows] for field in fields(self)))

    @property
    def wall_ratio(self) -> Array:
        """Wall thickness over inner radius, t0/R0, (n,)."""
        return self.wall_thickness / self.inner_radius

    @property
    def flat_radius(self) -> Array:
        """Radius up to which the plate is flat, in R0, (n,)."""
        radius = self.plate_radius / self.inner_radius
        return flat_radius(radius, rim_radius(radius, longest_outer_edge(self.wall_ratio)))


def longest_outer_edge(wall_ratio: Array) -> Array:
    """Length (R0) of the outer edges of a hemisphere's default mesh, for wall ratios of any shape."""
    return np.asarray(2.0 * (1.0 + wall_ratio) * np.sin(0.25 * np.pi / arc_cells(0.5 * np.pi, wall_ratio)))


class PressTrack(NamedTuple):
    """States of n sensors along the plate's travel, (n, m) each; nondimensional. ok: this state and all before it are
    stable and covered by the atlas; margin: dp/dV of the wall minus that of the gas, positive while stable."""

    nu: Array
    height: Array
    point: AtlasPoint
    margin: Array
    ok: Flags

    def each(self, change: Callable[[Any], Any]) -> "PressTrack":
        """Track with the function ``change`` applied to every array."""
        return PressTrack(
            change(self.nu), change(self.height), self.point.each(change), change(self.margin), change(self.ok)
        )


class AtlasSolution(NamedTuple):
    """Solutions, (n,) each; fields as in `PressTrack`. ``converged`` can be True for unsupported or folded states."""

    nu: Array
    point: AtlasPoint
    margin: Array
    converged: Flags

    @property
    def ok(self) -> Flags:
        """True where the solution is a stable state, unbuckled and covered by the atlas."""
        return self.converged & self.point.supported & ~self.point.folded


class AtlasPress:
    """A batch with its gas and inflated states, nondimensional; sensor i has slice ``k[i]`` of the atlas, and ends its
    iterations by itself: its states are the same in any batch."""

    def __init__(self, batch: SensorBatch, slices: AtlasSlices, k: Index) -> None:
        self.batch, self.slices, self.k = batch, slices, k
        mu, radius = batch.shear_modulus, batch.inner_radius
        self.pressure = batch.driving_pressure / mu
        self.ambient = batch.ambient_pressure / mu
        self.dead = batch.dead_volume / radius**3
        self.reach, self.limit = slices.reach(k), slices.limit_pressure[k]
        self.free = _inflated(slices, k, self.pressure)
        self.apex = slices.free_apex(k, self.free)[:, 0]
        gas_volume = self.volume(self.free) + self.dead
        self.content = (self.pressure + self.ambient) * gas_volume

    def volume(self, nu: Array) -> Array:
        """Cavity volume (R0^3) at nu, (n,)."""
        return self.slices.rest_volume[self.k] + nu * self.reach

    def rows(self, rows: Index | Flags) -> "AtlasPress":
        """Press of the selected sensors, with their inflated states."""
        part = object.__new__(AtlasPress)
        part.batch, part.slices, part.k = self.batch.take(rows), self.slices, self.k[rows]
        for name in ("pressure", "ambient", "dead", "reach", "limit", "free", "apex", "content"):
            setattr(part, name, getattr(self, name)[rows])
        return part

    def solve(
        self,
        nu: Array,
        height: Array,
        stiffening: Array | float = 1.0,
        memory: Array | float = 0.0,
        iterations: int = _NEWTON,
    ) -> AtlasSolution:
        """Equilibria (n,) of wall and gas at plate heights (n,), by Newton's method from guesses ``nu`` of the volume.

        The wall's pressure is that of the atlas times ``stiffening``, plus ``memory``. Pressure and force are corrected
        along their tangents for the last step, which is small enough for that to be accurate to its square.
        """
        point = self.slices.point(self.k, nu, height, with_folded=False)
        gas_volume = self.volume(nu) + self.dead
        gas = self.content / gas_volume
        margin = stiffening * point.by_volume + gas / gas_volume
        excess = gas - self.ambient - stiffening * point.pressure - memory
        step = excess / np.where(margin > 0, margin, 1.0) / self.reach
        close, stable = np.abs(step) < _LAST_STEP, margin > 0
        last = np.where(close, step, 0.0)
        swell = last * self.reach
        point = point._replace(
            pressure=point.pressure + point.by_volume * swell,
            force=point.force - point.by_height * swell,
            folded=self.slices.folded(self.k, nu, height),
        )
        nu, reached, far = nu + last, close & stable, np.flatnonzero(~close & stable)
        if far.size and iterations > 1:
            # The others are done: most are after their first step.
            start = nu[far] + np.clip(step[far], -_LONGEST, _LONGEST)
            stiff, held = (x[far] if isinstance(x, np.ndarray) else x for x in (stiffening, memory))
            part = self.rows(far).solve(start, height[far], stiff, held, iterations - 1)
            solved = part.nu, *part.point, part.margin, part.converged
            for column, values in zip((nu, *point, margin, reached), solved, strict=True):
                column[far] = values
        return AtlasSolution(nu, point, margin, reached)

    def march(self, indentation: Array) -> PressTrack:
        """Equilibria at plate travels ``indentation`` (n, m) in R0, ascending along the last axis from 0."""
        nu = self.free
        ok = np.ones(nu.size, dtype=bool)
        rate, bend, before = np.zeros_like(nu), np.zeros_like(nu), indentation[:, 0]
        columns: list[tuple[Any, ...]] = []
        for column in indentation.T:
            travel = column - before
            height = self.apex - column
            solved = self.solve(nu + travel * (rate + 0.5 * travel * bend), height)
            ok = ok & solved.ok
            now = solved.point.by_height / np.where(solved.margin > 0, solved.margin, 1.0) / self.reach
            with np.errstate(invalid="ignore", divide="ignore"):
                bend = np.where(ok & (travel > 0) & (len(columns) > 1), (now - rate) / travel, 0.0)
            nu, rate, before = np.where(ok, solved.nu, nu), np.where(ok, now, 0.0), column
            # The plate at the free apex presses on nothing, whatever the table's error leaves there.
            point = solved.point._replace(force=np.where(column > _NO_TRAVEL, solved.point.force, 0.0))
            columns.append((solved.nu, height, *point, solved.margin, ok))
        stacked = [np.stack(part, axis=1) for part in zip(*columns, strict=True)]
        return PressTrack(stacked[0], stacked[1], AtlasPoint(*stacked[2:-2]), stacked[-2], stacked[-1])

    def field(self, name: str, track: PressTrack) -> Array:
        """The tabulated field ``name`` of `recipe.FIELDS` along a track, (n, m)."""
        return self.several((name,), track)[0]

    def several(self, names: Sequence[str], track: PressTrack) -> list[Array]:
        """Tabulated fields along a track, (n, m) each."""
        k = np.repeat(self.k, track.nu.shape[1])
        flat = self.slices.several(names, k, track.nu.ravel(), track.height.ravel())
        return [values.reshape(track.nu.shape) for values in flat]


def _inflated(slices: AtlasSlices, k: Index, pressure: Array) -> Array:
    """Volume nu of the free dome at a pressure on the rising branch; 1 at and beyond the limit point.

    Newton's method inside a bracket, with bisection where a step would leave it: the slope vanishes at the limit point.
    """
    low, high = np.full_like(pressure, -_BELOW_REST), np.ones_like(pressure)
    nu = np.clip(1.0 - np.sqrt(np.maximum(1.0 - pressure / slices.limit_pressure[k], 0.0)), 0.0, 1.0)
    moving = np.ones(nu.size, dtype=bool)
    for _ in range(_INFLATING):
        apex = slices.free_apex(k, nu)
        point = slices.point(k, nu, apex[:, 0])
        # Along the free curve the plate rides on the apex.
        slope = point.by_volume * slices.reach(k) + point.by_height * apex[:, 1]
        gap = point.pressure - pressure
        low, high = np.where(gap < 0, nu, low), np.where(gap < 0, high, nu)
        newton = nu - gap / np.where(slope > 0, slope, 1.0)
        # The ends count as inside: a zero step is then accepted at the root, which bisection would leave.
        inside = (newton >= low) & (newton <= high) & (slope > 0)
        step = np.where(inside, newton, 0.5 * (low + high)) - nu
        nu = nu + np.where(moving, step, 0.0)
        moving &= np.abs(step) >= _CLOSE
        if not moving.any():
            break
    return nu


def batch_of(sensor: Sensor, driving_pressures: Sequence[float] | Array) -> SensorBatch:
    """Batch of one sensor at n driving pressures (MPa).

    The sensor's own law, Poisson ratio and flange are ignored: the atlas is neo-Hookean, at 0.49, clamped at the base.
    """
    size = len(driving_pressures)
    facts = (
        sensor.dome.inner_radius,
        sensor.dome.wall_thickness,
        sensor.wall.shear_modulus,
        sensor.gas.ambient_pressure,
        sensor.gas.dead_volume,
        np.asarray(driving_pressures, dtype=float),
        sensor.protocol.depth,
        sensor.protocol.plate_radius,
        sensor.gas.gauge_limit,
        np.inf if sensor.wall.break_stretch is None else sensor.wall.break_stretch,
    )
    return SensorBatch(*(np.full(size, fact, float) for fact in facts))
