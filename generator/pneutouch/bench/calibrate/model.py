"""Values of the atlas at the measured travels and volumes, for many sets of parameters in one batch."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneutouch.arrays import Array, Flags, Index
from pneutouch.bench.calibrate.inject import injected
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
from pneutouch.mechanics.atlas.press import AtlasPress, SensorBatch
from pneutouch.mechanics.atlas.table import REST_VOLUME, AtlasSlices, shipped
from pneutouch.mechanics.atlas_states import outside_atlas
from pneutouch.mechanics.contact_correction import contact_ratio, plate_alone
from pneutouch.mechanics.sensor import Sensor

_GAP = 0.08
"""Longest step of the plate in R0; where points are further apart, the press goes by steps between them."""


@dataclass(frozen=True, slots=True)
class FittedContact:
    """Another contact than a plate without friction.

    Attributes:
        centre: The sensor that the solid's ratio is of.
        frictions: Coefficients that it is solved at, ascending.
    """

    centre: Sensor
    frictions: tuple[float, ...]

    @classmethod
    def of(cls, sensor: Sensor, chosen: CalibrationParameters, full: Array) -> "FittedContact | None":
        """Contact of a sensor with all parameters at their coordinates ``full``, (5,); None for the atlas's own
        plate."""
        if not chosen.frictions:
            return None
        modulus, wall = (float(np.exp(full[k])) for k in (MODULUS, WALL))
        centre = sensor.replace(shear_modulus=modulus, wall_thickness=wall, dead_volume=float(full[DEAD]))
        return cls(centre, chosen.frictions)

    def distance(self, other: "FittedContact") -> float:
        """Distance to another one's sensor: the greatest change of ln modulus, ln wall and ln gas volume."""
        pairs = [
            (
                one.wall.shear_modulus,
                one.dome.wall_thickness,
                one.gas.dead_volume + REST_VOLUME * one.dome.inner_radius**3,
            )
            for one in (self.centre, other.centre)
        ]
        return float(np.abs(np.diff(np.log(pairs), axis=0)).max())


class AtlasModel:
    """The atlas at ``points``. Parameter sets are (s, 5) coordinates, values (s, N) in the order of
    `ObservationPoints.values`.

    Under another contact than a plate without friction it is the atlas times the solid's ratio of both, of the sensor
    ``contact.centre``. Raises InputError if the atlas does not cover the sensor, ComputationError where the solid
    cannot press it.
    """

    def __init__(self, sensor: Sensor, points: ObservationPoints, contact: "FittedContact | None" = None) -> None:
        sensor = plate_alone(sensor)
        why = outside_atlas(sensor)
        if why is not None:
            raise InputError(f"calibrate: the atlas does not cover this sensor: {why}; no fit without it")
        self.sensor, self.points = sensor, points
        deep = float(points.travel.max(initial=0.0)) + OFFSET_BOUND
        self._ratio = None
        if contact is not None and points.travel.size:
            self._ratio = contact_ratio(contact.centre, contact.frictions, points.driving, deep)
        self._last: tuple[bytes, Array, Flags] | None = None
        size, depth = sensor.dome.inner_radius, points.travel / sensor.dome.inner_radius
        deepest = float(depth.max(initial=0.0))
        gaps = np.diff(depth, prepend=0.0, axis=1)
        wide = depth.size > 0 and float(gaps.max()) > _GAP
        self._between = np.linspace(0.0, deepest, int(np.ceil(deepest / _GAP)) + 1)[1:] * size if wide else np.zeros(0)

    def values(self, sets: Array) -> tuple[Array, Flags]:
        """Values and whether the model has them, (s, N) each. The last result is kept: fits begin where others end."""
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
        """Gauge pressures after the injections, (s, i n)."""
        volume, s = self.points.volume.ravel(), len(sets)
        if not volume.size:
            return np.zeros((s, 0)), np.zeros((s, 0), dtype=bool)
        size, mu = self.sensor.dome.inner_radius, np.exp(sets[:, MODULUS])
        ambient = self.sensor.gas.ambient_pressure / mu
        pressure, ok = injected(slices, k, ambient, sets[:, DEAD] / size**3, volume / size**3)
        return pressure * mu[:, None], ok
