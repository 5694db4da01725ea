"""The model of a fit: the atlas at measured travels and volumes, for many sets of parameters in one batch.

Also the unknowns that many values share: the model discrepancy, common to all runs, and the error of each run's first
contact. Both have a standard deviation and are estimated with the parameters. The model discrepancy is that of Kennedy
and O'Hagan (J. R. Stat. Soc. B 63, 2001, 425-464, DOI 10.1111/1467-9868.00294): without it a calibrated parameter has
too small an interval around a wrong value (Brynjarsdottir and O'Hagan, Inverse Problems 30, 2014, 114007).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneutouch.arrays import Array, Flags, Index
from pneutouch.bench.calibrate.fitted_solid import SolidExpansion
from pneutouch.bench.calibrate.observations import ObservationPoints
from pneutouch.bench.calibrate.parameters import (
    DEAD,
    FRICTION,
    MODULUS,
    OFFSET,
    OFFSET_BOUND,
    WALL,
    CalibrationParameters,
)
from pneutouch.errors import InputError
from pneutouch.mechanics.atlas.coverage import other_shape, outside_fit, stand_in
from pneutouch.mechanics.atlas.press import AtlasPress, SensorBatch
from pneutouch.mechanics.atlas.table import REST_VOLUME, AtlasSlices, shipped
from pneutouch.mechanics.corrected.curves import contact_ratio, injection_ratio
from pneutouch.mechanics.corrected.figures import GRIPS
from pneutouch.mechanics.sensor import Sensor

_NODES = 60
_NEWTON = 4
"""Numbers of nodes for a first guess of the volume, and of Newton steps from it: the last step is below 1e-9 of it."""


def injected(slices: AtlasSlices, k: Index, ambient: Array, dead: Array, volume: Array) -> tuple[Array, Flags]:
    """Pressures of s sensors after injected volumes (n,), and True where the atlas covers them, (s, n) each.

    Solves (p + pa)(V(p) + Vd) = pa (V0 + Vd + dV), V the free dome's volume, for V: the injected volume rises with V
    through the limit point, where a driven pressure would not. All nondimensional. ``k``, ``ambient`` and ``dead`` are
    (s,): each sensor's index in ``slices``, ambient pressure and dead volume.
    """
    s, n = k.size, volume.size
    content = ambient[:, None] * (REST_VOLUME + dead[:, None] + volume)
    nodes = np.linspace(0.0, shipped().recipe.highest_volume, _NODES)
    pressure, _ = free_pressure(slices, k[np.repeat(np.arange(s), _NODES)], np.tile(nodes, s))
    total = REST_VOLUME + np.outer(slices.reach(k), nodes) + dead[:, None]
    gas = (pressure.reshape(s, _NODES) + ambient[:, None]) * total
    nu = np.array([np.interp(content[j], gas[j], nodes) for j in range(s)]).ravel()
    each = np.repeat(np.arange(s), n)
    reach, outer, extra, target = slices.reach(k[each]), ambient[each], dead[each], content.ravel()
    for _ in range(_NEWTON):
        pressure, slope = free_pressure(slices, k[each], nu)
        total = REST_VOLUME + nu * reach + extra
        nu = nu - ((pressure + outer) * total - target) / (slope * total + (pressure + outer) * reach)
        nu = np.clip(nu, 0.0, nodes[-1])
    pressure, _ = free_pressure(slices, k[each], nu)
    return pressure.reshape(s, n), np.asarray(content <= gas[:, -1:])


def free_pressure(slices: AtlasSlices, k: Index, nu: Array) -> tuple[Array, Array]:
    """Pressure of the free dome and its slope by nu, (n,) each; nu is 0 at rest and 1 at the limit point."""
    apex = slices.free_apex(k, nu)
    point = slices.point(k, nu, apex[:, 0])
    # Along the free curve the plate rides on the apex.
    return point.pressure, point.by_volume * slices.reach(k) + point.by_height * apex[:, 1]


_GAP = 0.08
"""Longest plate step as a share of R0; where measured points are further apart, steps between them are added."""


@dataclass(frozen=True, slots=True)
class FittedContact:
    """Input of the solid's correction of the atlas, for a contact, wall or ring that the atlas does not cover.

    Attributes:
        centre: Sensor for which the solid's ratio is computed.
        frictions: Coefficients of friction at which the solid is solved, ascending.
        varied: Indices in `NAMES` of the parameters that are fitted or have a prior.
    """

    centre: Sensor
    frictions: tuple[float, ...]
    varied: tuple[int, ...]

    @classmethod
    def of(cls, sensor: Sensor, chosen: CalibrationParameters, full: Array) -> "FittedContact | None":
        """Correction of a sensor with all parameters at the coordinates ``full``, (5,); None where the atlas covers the
        sensor as it is, which gives no ``chosen.frictions``."""
        if not chosen.frictions:
            return None
        modulus, wall = (float(np.exp(full[k])) for k in (MODULUS, WALL))
        centre = sensor.of_modulus(modulus).replace(wall_thickness=wall, dead_volume=float(full[DEAD]))
        if other_shape(sensor):
            grip = float(full[FRICTION])
            centre = centre.replace(friction=np.inf if grip >= GRIPS else grip)
        return cls(centre, chosen.frictions, tuple(sorted((*chosen.fitted, *chosen.others))))

    @property
    def other_wall(self) -> bool:
        """True if the wall has a law or a grade: the solid then corrects injections too."""
        return self.centre.wall.law is not None or self.centre.wall.grade is not None

    def distance(self, other: "FittedContact") -> float:
        """Distance of two contacts' centres: the greatest change of ln modulus, ln wall and ln gas volume."""
        pairs = [
            (one.wall.shear_modulus, one.dome.wall_thickness, one.gas.dead_volume + one.dome.shape.cavity_volume)
            for one in (self.centre, other.centre)
        ]
        return float(np.abs(np.diff(np.log(pairs), axis=0)).max())


class AtlasModel:
    """The atlas at ``points``. Parameter sets are (s, 5) coordinates, values (s, N) in the order of
    `ObservationPoints.values`.

    With a ``contact``, the atlas's forces and rises are multiplied by the solid's ratio of the sensor
    ``contact.centre`` to the one that the atlas covers. Raises InputError if the atlas does not cover the sensor,
    ComputationError where the solid cannot press it.
    """

    def __init__(self, sensor: Sensor, points: ObservationPoints, contact: "FittedContact | None" = None) -> None:
        why = outside_fit(sensor)
        if why is not None:
            raise InputError(f"calibrate: the atlas does not cover this sensor: {why}; no fit without it")
        self.sensor, self.points = stand_in(sensor), points
        deep = float(points.travel.max(initial=0.0)) + OFFSET_BOUND
        self._ratio, self._blown = None, np.zeros(points.volume.size)
        if contact is not None and points.travel.size:
            self._ratio = contact_ratio(contact.centre, contact.frictions, points.driving, deep)
        if contact is not None and points.volume.size and contact.other_wall:
            self._blown = injection_ratio(contact.centre, points.volume.ravel())
        self._last: tuple[bytes, Array, Flags] | None = None
        size, depth = sensor.dome.inner_radius, points.travel / sensor.dome.inner_radius
        deepest = float(depth.max(initial=0.0))
        wide = depth.size > 0 and float(np.diff(depth, prepend=0.0, axis=1).max()) > _GAP
        self._between = np.linspace(0.0, deepest, int(np.ceil(deepest / _GAP)) + 1)[1:] * size if wide else np.zeros(0)

    def values(self, sets: Array) -> tuple[Array, Flags]:
        """Values, and True where the model has them, (s, N) each. The last result is kept for a repeated call."""
        key = sets.tobytes()
        if self._last is None or self._last[0] != key:
            self._last = key, *self._evaluated(sets)
        return self._last[1], self._last[2]

    def _evaluated(self, sets: Array) -> tuple[Array, Flags]:
        atlas, size = shipped(), self.sensor.dome.inner_radius
        walls, k = np.unique(np.exp(sets[:, WALL]) / size, return_inverse=True)
        slices = atlas.slices(walls, ("contact_radius",))
        force, rise, ok = self._curves(sets, slices, k)
        pressure, fine = self._injections(sets, slices, k)
        return np.hstack([force, rise, pressure]), np.hstack([ok, ok, fine])

    def _curves(self, sets: Array, slices: AtlasSlices, k: Index) -> tuple[Array, Array, Flags]:
        (c, m), s, size = self.points.travel.shape, len(sets), self.sensor.dome.inner_radius
        if not c:
            return np.zeros((s, 0)), np.zeros((s, 0)), np.zeros((s, 0), dtype=bool)
        each = np.repeat(np.arange(s), c)
        batch = self._batch(sets[each], np.tile(self.points.driving, s))
        press = AtlasPress(batch, slices, k[each])
        travels = np.maximum(self.points.travel[None] + sets[:, OFFSET, None, None], 0.0).reshape(s * c, m)
        rows = np.hstack([np.zeros((s * c, 1)), travels, np.broadcast_to(self._between, (s * c, self._between.size))])
        order = np.argsort(rows, axis=1, kind="stable")
        track = press.march(np.take_along_axis(rows, order, axis=1) / size)
        place = np.argsort(order, axis=1, kind="stable")[:, 1 : m + 1]

        def at(field: NDArray[Any]) -> NDArray[Any]:
            return np.take_along_axis(field, place, axis=1).reshape(s, c * m)

        mu = batch.shear_modulus[:, None]
        edge = press.field("contact_radius", track) < press.batch.flat_radius[:, None]
        ok = track.ok & edge & (press.pressure < press.limit)[:, None]
        force, rise = track.point.force * mu * size**2, (track.point.pressure - press.pressure[:, None]) * mu
        if self._ratio is not None:
            travel = np.take_along_axis(rows, order, axis=1)
            ok &= travel < np.interp(batch.driving_pressure, self._ratio.pressures, self._ratio.ends)[:, None]
            factors = np.exp(self._ratio.at(sets[each, FRICTION], np.tile(self.points.driving, s), travel))
            force, rise = factors[0] * force, factors[1] * rise
        return at(force), at(rise), at(ok)

    def _batch(self, sets: Array, driving: Array) -> SensorBatch:
        dome, gas, protocol = self.sensor.dome, self.sensor.gas, self.sensor.protocol
        alike = dome.inner_radius, gas.ambient_pressure, protocol.depth, protocol.plate_radius, np.inf
        size, ambient, depth, plate, unlimited = (np.full(len(sets), value) for value in alike)
        wall, modulus = np.exp(sets[:, WALL]), np.exp(sets[:, MODULUS])
        loads = ambient, sets[:, DEAD], driving, depth, plate
        return SensorBatch(size, wall, modulus, *loads, unlimited, unlimited)

    def _injections(self, sets: Array, slices: AtlasSlices, k: Index) -> tuple[Array, Flags]:
        """Gauge pressures after the injections, and True where the atlas covers them, (s, i n) each."""
        volume, s = self.points.volume.ravel(), len(sets)
        if not volume.size:
            return np.zeros((s, 0)), np.zeros((s, 0), dtype=bool)
        size, mu = self.sensor.dome.inner_radius, np.exp(sets[:, MODULUS])
        ambient = self.sensor.gas.ambient_pressure / mu
        pressure, ok = injected(slices, k, ambient, sets[:, DEAD] / size**3, volume / size**3)
        return pressure * mu[:, None] * np.exp(self._blown), ok


def model_of(sensor: Sensor, points: ObservationPoints, contact: FittedContact | None) -> AtlasModel | SolidExpansion:
    """The model of a fit at ``points``: the atlas, with a ``contact`` corrected, or for another shape the solid."""
    if contact is not None and other_shape(sensor):
        return SolidExpansion(contact.centre, points, contact.varied)
    return AtlasModel(sensor, points, contact)


FLOOR = np.array([0.01, 0.005, 0.005])
"""Least standard deviation of the model discrepancy, as a share of force, pressure rise and an injection's pressure.

A share that is the same everywhere looks like another modulus, so no residual shows it. Our choice: a wall that relaxes
carries more at the end of a 4 s hold than at rest; no Prony data of these resins are published, the paper's Fig. S1
calls relaxation low, and the air shows less of it than the plate does."""

OTHER_SHAPES = 3.0
"""Least discrepancy of other shapes, in `FLOOR`: our choice. The force of a clamped flat wall grows with the square
root of its modulus, so what a hold adds to the force counts twice in the modulus. With it at least nine in ten
intervals hold simulated specimens whose wall remembers (tests/bench/calibrate/test_fitted_solid.py)."""

LARGEST = 0.3
"""Greatest size of the discrepancy considered: our choice; beyond it the model does not describe the sensor."""

_LENGTH = 0.5
"""Length, as a share of a run's travel, over which the discrepancy stays correlated: our choice."""

_GAUSS_NODES = 4
"""Nodes of the discrepancy along a travel: two thirds of its correlation length apart."""

_GRID = 12
TRAVEL = 3
"""Kind of the columns of travel errors; the kinds before are the channels: force 0, rise 1, injection 2."""


@dataclass(frozen=True, slots=True)
class SharedUnknowns:
    """Unknowns that many values share: ``columns`` (N, q), change of the values (N, MPa) by each unknown of size 1;
    ``kind`` (q,), an index of `FLOOR`, or `TRAVEL`, whose columns already have their size."""

    columns: Array
    kind: Array

    def sized(self, sizes: Array) -> Array:
        """Columns (N, q) scaled by the sizes (3,) of their kinds."""
        return np.asarray(self.columns * np.append(sizes, 1.0)[self.kind])


def shared_of(points: ObservationPoints) -> SharedUnknowns:
    """Shared unknowns of the values of ``points``.

    Each channel has one error that is a constant share of all its readings, and for each driving pressure errors that
    are a smooth share along the travel. Each curve has one error of its travel, which moves force and rise together."""
    m, values, channels = points.travel.shape[1], points.values, points.channels
    travel = points.travel / points.travel.max(axis=1, initial=1e-9)[:, None]
    shape = _shape(
        np.concatenate([np.tile(travel.ravel(), 2), (points.volume / points.volume.max(initial=1e-9)).ravel()])
    )
    groups = np.concatenate([np.tile(np.repeat(points.group, m), 2), np.zeros(points.volume.size)])
    columns, kind = [np.zeros((values.size, 0))], np.zeros(0, dtype=int)
    for channel in np.unique(channels):
        read = np.where(channels == channel, values, 0.0)[:, None]
        parts = [
            read,
            *(np.where(groups == g, 1.0, 0.0)[:, None] * read * shape for g in np.unique(groups[channels == channel])),
        ]
        columns += parts
        kind = np.append(kind, np.full(sum(part.shape[1] for part in parts), channel))
    slopes = np.zeros(values.size)
    slopes[: 2 * points.travel.size] = np.concatenate([points.force_slope.ravel(), points.rise_slope.ravel()])
    for errors, owners in ((points.travel_error, points.clusters), (points.onset_error, groups)):
        slope = slopes.copy()
        slope[: 2 * points.travel.size] *= np.tile(np.repeat(errors, m), 2)
        for owner in np.unique(owners[slope != 0.0]):
            columns.append(np.where(owners == owner, slope, 0.0)[:, None])
            kind = np.append(kind, TRAVEL)
    return SharedUnknowns(np.hstack(columns), kind)


def sizes_of(
    shared: SharedUnknowns, jacobian: Array, residual: Array, prior_weight: Array, pull: Array, floor: Array
) -> Array:
    """Most likely sizes (3,) of the model discrepancy for these residuals, the parameters integrated out (restricted
    likelihood: Patterson and Thompson, Biometrika 58, 1971, 545-554); at least ``floor``.

    Rows are the values used, over their standard deviations: ``shared`` (n, q), ``jacobian`` (n, k), ``residual`` (n,);
    ``prior_weight`` (k,) are the prior weights of the parameters, ``pull`` (k,) their distances from the prior in
    standard deviations. The greatest likelihood is sought kind by kind on a grid, in two passes."""
    k, q = jacobian.shape[1], shared.kind.size
    rows = np.hstack([jacobian, shared.columns, residual[:, None]])
    gram = rows.T @ rows
    # The priors are data too, one row each.
    gram[:k, -1] += np.sqrt(prior_weight) * pull
    gram[-1, :k] = gram[:k, -1]
    gram[-1, -1] += float(pull @ pull)
    tiny = 1e-12 * np.maximum(np.diag(gram)[:k], 1e-30)
    sizes = np.maximum(floor, 1e-6)
    for _ in range(2):
        for kind in np.unique(shared.kind[shared.kind < TRAVEL]):
            tried = np.geomspace(max(floor[kind], 1e-4), LARGEST, _GRID)
            costs = []
            for size in tried:
                sizes[kind] = size
                scale = np.concatenate([np.ones(k), np.append(sizes, 1.0)[shared.kind], [1.0]])
                costs.append(
                    _unlikely(gram * np.outer(scale, scale), np.concatenate([prior_weight + tiny, np.ones(q)]))
                )
            sizes[kind] = tried[int(np.argmin(costs))]
    return np.maximum(sizes, floor)


def _unlikely(gram: Array, weight: Array) -> float:
    """Minus twice the restricted log likelihood plus a constant; the last row of ``gram`` belongs to the residuals."""
    normal = gram[:-1, :-1] + np.diag(weight)
    right = gram[:-1, -1]
    return float(np.linalg.slogdet(normal)[1] + gram[-1, -1] - right @ np.linalg.solve(normal, right))


def _shape(depth: Array) -> Array:
    """Weights (N, nodes) of independent unit unknowns whose sum varies smoothly over depths (N,) from 0 to 1."""
    nodes = np.linspace(0.0, 1.0, _GAUSS_NODES)

    def alike(a: Array, b: Array) -> Array:
        return np.asarray(np.exp(-0.5 * ((a[:, None] - b[None]) / _LENGTH) ** 2))

    root = np.linalg.cholesky(alike(nodes, nodes) + 1e-9 * np.eye(_GAUSS_NODES))
    return np.asarray(np.linalg.solve(root, alike(nodes, depth)).T)
