"""A sensor under another contact than the atlas's plate without friction: what the solid has of it.

The atlas gives the derivatives by wall, radius, gas and driving pressure. The derivative by the modulus, which is
uncertain by far the most, and that by the friction are the solid's, with the contact itself (docs/contact.md).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import ComputationError
from pneutouch.mechanics.atlas.batches import batch_of
from pneutouch.mechanics.contact_correction import GRIPS, plate_alone
from pneutouch.mechanics.prediction import SensorState
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.uncertainty.neighbours import joined, log_figures
from pneutouch.mechanics.uncertainty.source import CONTACT_FIGURES, FIGURES

SPREAD = 2.0
"""A stated coefficient may be this factor off in either direction, even in its logarithm: an assumption. Dry rubber on
plastic has a coefficient near 1, which dust, speed and load move by as much."""

LEAST_GRIP = 1.0
"""A surface stated to grip may have any coefficient from this on: an assumption, that of dry rubber on plastic."""

_KURTOSIS = 1.8
"""Of a rectangular distribution."""

_LEAST_STEP = 0.1
"""Least half step in ln modulus: below it the noise of the ends of ranges shows in a difference."""


@dataclass(frozen=True)
class FrictionSpread:
    """What an unknown coefficient does to n sensors.

    Attributes:
        standard: Standard uncertainties of the logarithm of the figures, (figures, n); NaN where no equilibrium was
            found at another coefficient.
        elasticities: d ln figure / d ln coefficient, (figures, n); None for a surface that grips.
        origin: How the coefficient is assumed to be distributed.
    """

    standard: Array
    elasticities: Array | None
    origin: str


@dataclass(frozen=True)
class ContactShift:
    """Logarithms of the figures under the contact, by the solid, less those under the plate, by the atlas.

    Attributes:
        half: Distance of the nodes in ln modulus.
        nodes: At moduli exp(-half), 1 and exp(half) times that of the sensor, (3, figures, n).
    """

    half: float
    nodes: Array

    def at(self, by: Array) -> Array:
        """At ln modulus over that of the sensor (k, n), (figures, k, n): a parabola, constant beyond its nodes."""
        t = np.clip(by / self.half, -1.0, 1.0)
        less, here, more = self.nodes[:, :, None]
        return np.asarray(here + 0.5 * t * (more - less) + 0.5 * t**2 * (more - 2.0 * here + less))

    def row(self, row: int) -> "ContactShift":
        """That of one sensor."""
        return ContactShift(self.half, self.nodes[:, :, row : row + 1])


@dataclass(frozen=True)
class ContactModel:
    """One sensor under its contact at n ascending driving pressures, MPa.

    ``states`` are those of the solid where it has been solved already. ``fitted_spread`` is the standard uncertainty of
    the coefficient where a calibration fitted it.
    """

    sensor: Sensor
    pressures: tuple[float, ...]
    states: Sequence[SensorState] | None = None
    fitted_spread: float | None = None

    @cached_property
    def logs(self) -> Array:
        """Logarithms of the figures under the contact, (figures, n)."""
        return self._solved(self.sensor) if self.states is None else _logs(self.states, len(self.pressures))

    def shift(self, half: float) -> ContactShift:
        """The shift over a spread of the modulus; a side that the solid cannot solve is as the middle."""
        half = max(half, _LEAST_STEP)
        sides = [self.sensor.replace(shear_modulus=f * self.sensor.wall.shear_modulus) for f in np.exp([-half, half])]
        plates = [batch_of(plate_alone(one), self.pressures) for one in (sides[0], self.sensor, sides[1])]
        plate = log_figures(joined(plates)).reshape(len(FIGURES), 3, -1).transpose(1, 0, 2)
        nodes = np.stack([self._solved(sides[0]), self.logs, self._solved(sides[1])]) - plate
        # Neither the free state nor its limit point depends on the contact.
        nodes[:, [i for i in range(len(FIGURES)) if i not in CONTACT_FIGURES]] = 0.0
        return ContactShift(half, np.where(np.isnan(nodes), nodes[1], nodes))

    @cached_property
    def friction(self) -> FrictionSpread | None:
        """What the unknown coefficient does; None without friction."""
        stated = self.sensor.protocol.friction
        if self.fitted_spread is not None:
            return self._fitted(min(stated, GRIPS), self.fitted_spread)
        if stated == 0.0:
            return None
        if np.isinf(stated):
            change = self._solved(self.sensor.replace(friction=LEAST_GRIP)) - self.logs
            # As likely anywhere from none of the change to the whole of it, about an end: mean square c^2 / 3.
            origin = f"assumed: a coefficient from {LEAST_GRIP:g} to grip; the solid at both ends"
            return FrictionSpread(np.abs(change) / np.sqrt(3.0), None, origin)
        u = np.log(SPREAD) / np.sqrt(3.0)
        far = np.sqrt(_KURTOSIS) * u
        down, up = (self._solved(self.sensor.replace(friction=stated * float(np.exp(x)))) for x in (-far, far))
        half = 0.5 * (up - down)
        one_sided = np.where(np.isnan(up), self.logs - down, up - self.logs)
        slope = np.where(np.isnan(half), one_sided, half)
        bend = np.nan_to_num(0.5 * (up + down) - self.logs)
        # Three-point rule with the moments of the rectangle: weights 1/(2 kurtosis) at both sides.
        weight = 1.0 / _KURTOSIS
        variance = weight * (slope**2 + bend**2) - (weight * bend) ** 2
        origin = (
            f"assumed: {stated:g}, even in its logarithm from 1/{SPREAD:g} to {SPREAD:g} times as much; the solid at "
            f"{stated * np.exp(-far):.2g} and {stated * np.exp(far):.2g}"
        )
        return FrictionSpread(np.sqrt(variance), slope / far, origin)

    def _fitted(self, value: float, spread: float) -> FrictionSpread:
        """That of a fitted coefficient: the difference over its standard uncertainty, within 0 and grip."""
        ends = max(value - spread, 0.0), min(value + spread, GRIPS)
        down, up = (self._solved(self.sensor.replace(friction=np.inf if x >= GRIPS else x)) for x in ends)
        slope = (up - down) / max(ends[1] - ends[0], 1e-9)
        origin = f"fitted: {value:.3g}, standard uncertainty {spread:.2g}; the solid at {ends[0]:.2g} and {ends[1]:.2g}"
        return FrictionSpread(np.abs(slope) * spread, value * slope, origin)

    def _solved(self, sensor: Sensor) -> Array:
        """Figures of the solid, (figures, n); NaN from the first driving pressure on that it cannot solve."""
        from pneutouch.mechanics.solid_states import solid_states

        for count in range(len(self.pressures), 0, -1):
            try:
                return _logs(solid_states(sensor, np.array(self.pressures[:count])), len(self.pressures))
            except ComputationError:
                continue
        return np.full((len(FIGURES), len(self.pressures)), np.nan)


def _logs(states: Sequence[SensorState], size: int) -> Array:
    """Logarithms of the figures of solved states, (figures, size); NaN for what is none."""
    rows = np.full((len(FIGURES), size), np.nan)
    for k, state in enumerate(states):
        if state.figures is not None:
            fitted = state.figures
            rows[CONTACT_FIGURES, k] = (
                fitted.sensitivity_kPa_per_N,
                fitted.stiffness,
                fitted.force_range[1],
                state.range_end,
            )
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.log(rows))
