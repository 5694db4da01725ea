"""The atlas corrected by the solid: figures of a sensor under another contact than the frictionless plate.

The solid is solved at as few driving pressures as suffice. The logarithm of the ratio of its figures to those of the
atlas under the plate is interpolated linearly between them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError
from pneutouch.mechanics.atlas.figures import CONTACT_FIGURES, FIGURES, log_figures, softer_walls
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.models.choice import outside
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.sensor import ResponseCorrection, Sensor
from pneutouch.mechanics.solid.indenter import RigidBase

GRIPS = 2.0
"""Coefficient of friction from which the contact is treated as gripping: above it the sensitivity of the paper's sensor
in its resins changes by less than 0.5 % (`tests/mechanics/test_corrected_curves.py`)."""

SAME = 1e-6
"""Driving pressures closer to each other than this, MPa, count as the same."""


@lru_cache(maxsize=128)
def pressed_logs(sensor: Sensor, pressures: tuple[float, ...]) -> Array:
    """Logarithms of the figures at ascending driving pressures, MPa, (figures, n), read-only; all NaN if the solid
    cannot solve the highest. Cached, because chart, budget and curves of a datasheet need the same figures."""
    from pneutouch.mechanics.models.solid import solid_states

    try:
        logs = state_logs(solid_states(sensor, np.array(pressures)))
    except ComputationError:
        logs = np.full((len(FIGURES), len(pressures)), np.nan)
    logs.setflags(write=False)
    return logs


def state_logs(states: Sequence[SensorState], correction: ResponseCorrection | None = None) -> Array:
    """Logarithms of the figures of solved states, (figures, n); NaN for a missing figure. A ``correction`` that the
    states contain is divided out."""
    rows = np.full((len(FIGURES), len(states)), np.nan)
    for k, state in enumerate(states):
        if state.figures is not None:
            force, rise = (1.0, 1.0) if correction is None else correction.at(state.driving_pressure)
            fitted = state.figures.scaled(1.0 / force, 1.0 / rise)
            rows[CONTACT_FIGURES, k] = (fitted.sensitivity, fitted.stiffness, fitted.force_range[1], state.range_end)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.log(rows))


def solved_at(
    sensor: Sensor, pressures: Sequence[float], states: Sequence[SensorState], least: int = 3
) -> tuple[Array, Array]:
    """Driving pressures (k,) to interpolate to ``pressures``, and the logarithms of the figures there (figures, k).

    The given ``states`` of the sensor are used. Of the pressures outside their range the first and the last are solved,
    without the highest ones that fail; then the middle of the range, if fewer than ``least`` are known.
    """
    given, bare = state_logs(states, sensor.correction), sensor.replace(waves=0)
    known = {state.driving_pressure: given[:, k] for k, state in enumerate(states)}
    outside = [p for p in pressures if not known or not min(known) - SAME <= p <= max(known) + SAME]
    for count in range(len(outside), 0, -1):
        some = tuple(dict.fromkeys((outside[0], outside[count - 1])))
        solved = pressed_logs(bare, some)
        if not np.isnan(solved).all():
            known.update(zip(some, solved.T, strict=True))
            break
    between_them = any(not _among(p, known) for p in pressures)
    if between_them and 2 <= len(known) < least:
        middle = 0.5 * (min(known) + max(known))
        known[middle] = pressed_logs(bare, (middle,))[:, 0]
    if not known:
        return np.array(pressures), np.full((len(FIGURES), len(pressures)), np.nan)
    at = sorted(known)
    return np.array(at), np.stack([known[p] for p in at], axis=1)


def _among(pressure: float, others: dict[float, Array]) -> bool:
    return any(abs(pressure - other) <= SAME for other in others)


def between(where: Array, at: Array, values: Array) -> Array:
    """Values (figures, k) at driving pressures ``at`` (k,), interpolated linearly to ``where`` (n,); NaN outside the
    range of the finite values."""
    rows = np.full((len(values), where.size), np.nan)
    for row, line in zip(rows, values, strict=True):
        good = np.isfinite(line)
        if good.any():
            inside = (where >= at[good][0] - SAME) & (where <= at[good][-1] + SAME)
            row[inside] = np.interp(where[inside], at[good], line[good])
    return rows


def under_plate(sensor: Sensor) -> Sensor:
    """The sensor under a frictionless plate; a sufficiently wide plate takes the place of another object.

    An offset, tilt or shear and an object that lies across the dome are kept: the correction is axisymmetric.
    """
    protocol = sensor.protocol
    if protocol.other_contact is None or (protocol.body is not None and protocol.body.lying):
        return sensor
    plate = protocol.plate_radius if protocol.body is None else max(protocol.plate_radius, 2 * sensor.dome.inner_radius)
    return sensor.replace(body=None, plate_rim=None, friction=0.0, plate_radius=plate)


def stand_in(sensor: Sensor) -> Sensor:
    """The sensor that a fit corrects: under a plate without friction, its wall neo-Hookean and of one modulus, its base
    a plane without the ring that clamps the flange: presses that meet it end there."""
    if sensor.dome.base is not None:
        sensor = sensor.replace(base=RigidBase())
    if sensor.wall.law is not None and sensor.wall.largest_stretch is not None:
        sensor = sensor.replace(law=None, largest_stretch=None)
    return under_plate(sensor.replace(grade=None))


_DEPTH = 0.75
"""Greatest depth in R0 that a fit uses, that of the sensitivity test (paper, section 3-B)."""


def outside_corrected(sensor: Sensor) -> str | None:
    """Reason why the atlas does not cover a sensor even under a frictionless plate, or None if it does."""
    return outside("atlas", under_plate(sensor))


def outside_fit(sensor: Sensor) -> str | None:
    """Reason why a sensor cannot be fitted to measured runs, or None if it can: a fit uses the atlas, at depths that it
    covers, times the solid's ratio to it where it does not cover law, grade, softness or contact."""
    from pneutouch.mechanics.models.atlas import outside_atlas

    return outside_atlas(stand_in(_shallow(sensor)), softer_walls())


def is_corrected(sensor: Sensor) -> bool:
    """True if a fit uses the atlas times the solid's ratio to it: the atlas does not cover the sensor, or leaves out
    the ring that its wall meets."""
    from pneutouch.mechanics.models.atlas import meets_ring

    return outside("atlas", _shallow(sensor)) is not None or meets_ring(_shallow(sensor))


def _shallow(sensor: Sensor) -> Sensor:
    return sensor.replace(depth=min(sensor.protocol.depth, _DEPTH * sensor.dome.inner_radius))


@dataclass(frozen=True)
class CorrectedAtlas:
    """Figures of one sensor under its contact at n ascending driving pressures, MPa.

    ``states`` are solutions of the solid that are available already, at these or other pressures; more are solved, up
    to ``least`` in total. Between them the logarithm of the figures over those under the plate is linear.
    """

    sensor: Sensor
    pressures: tuple[float, ...]
    states: Sequence[SensorState] = ()
    least: int = 3

    @cached_property
    def logs(self) -> Array:
        """Logarithms of the figures under the contact, (figures, n)."""
        at, solved = self.solved
        if at.size == len(self.pressures) and np.abs(at - np.array(self.pressures)).max() <= SAME:
            return solved
        return self.ratio + self.plate(self.pressures)

    @cached_property
    def ratio(self) -> Array:
        """Logarithms of the figures under the contact over those under the plate, (figures, n)."""
        at, solved = self.solved
        return between(np.array(self.pressures), at, solved - self.plate(at))

    @cached_property
    def solved(self) -> tuple[Array, Array]:
        """Driving pressures (k,) at which the sensor is solved, and the logarithms of its figures (figures, k)."""
        return solved_at(self.sensor, self.pressures, self.states, self.least)

    def plate(self, pressures: Sequence[float] | Array) -> Array:
        """Logarithms of the figures under the plate, by the atlas, (figures, k)."""
        return log_figures(batch_of(under_plate(self.sensor), pressures))
