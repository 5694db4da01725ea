"""The atlas corrected by the solid: figures of a sensor under a contact other than the frictionless plate.

The solid is solved at a few driving pressures. The logarithm of the ratio of its figures to those of the atlas under
the plate is interpolated linearly between these pressures.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError
from pneutouch.mechanics.atlas.coverage import under_plate
from pneutouch.mechanics.atlas.figures import CONTACT_FIGURES, FIGURES, log_figures
from pneutouch.mechanics.atlas.press import batch_of
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.sensor import ResponseCorrection, Sensor

GRIPS = 2.0
"""Coefficient of friction from which the contact counts as gripping: above it the sensitivity of the paper's sensor in
its resins changes by less than 0.5 % (`tests/mechanics/test_corrected_curves.py`)."""

SAME = 1e-6
"""Driving pressures closer to each other than this, MPa, count as the same."""


@lru_cache(maxsize=128)
def pressed_logs(sensor: Sensor, pressures: tuple[float, ...]) -> Array:
    """Logarithms (figures, n) of the `FIGURES` by the solid at ascending driving pressures (MPa), read-only; all NaN if
    it cannot solve one of them. Cached, because chart, budget and curves of a datasheet need the same figures."""
    from pneutouch.mechanics.models.solid import solid_states

    try:
        logs = state_logs(solid_states(sensor, np.array(pressures)))
    except ComputationError:
        logs = np.full((len(FIGURES), len(pressures)), np.nan)
    logs.setflags(write=False)
    return logs


def state_logs(states: Sequence[SensorState], correction: ResponseCorrection | None = None) -> Array:
    """Logarithms (figures, n) of the `FIGURES` of solved states; NaN for those that do not depend on the contact or are
    missing. A ``correction`` that the states contain is divided out; None: they contain none."""
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
    """Driving pressures (k,; MPa) from which ``pressures`` are interpolated, and the figures' logarithms (figures, k).

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
    between_them = any(all(abs(p - other) > SAME for other in known) for p in pressures)
    if between_them and 2 <= len(known) < least:
        middle = 0.5 * (min(known) + max(known))
        known[middle] = pressed_logs(bare, (middle,))[:, 0]
    if not known:
        return np.array(pressures), np.full((len(FIGURES), len(pressures)), np.nan)
    at = sorted(known)
    return np.array(at), np.stack([known[p] for p in at], axis=1)


def between(where: Array, at: Array, values: Array) -> Array:
    """Values (figures, n) at driving pressures ``where`` (n,), linear between ``values`` (figures, k) at ``at`` (k,);
    NaN outside the range of the finite values."""
    rows = np.full((len(values), where.size), np.nan)
    for row, line in zip(rows, values, strict=True):
        good = np.isfinite(line)
        if good.any():
            inside = (where >= at[good][0] - SAME) & (where <= at[good][-1] + SAME)
            row[inside] = np.interp(where[inside], at[good], line[good])
    return rows


@dataclass(frozen=True)
class CorrectedAtlas:
    """Figures of one sensor under its contact at n ascending driving pressures, MPa.

    ``states`` are solutions of the solid that are available already, at these or other pressures; more are solved as in
    `solved_at`. Between them the logarithm of the figures over those under the plate is linear.
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
