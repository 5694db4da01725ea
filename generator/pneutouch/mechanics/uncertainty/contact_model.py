"""The uncertainty of a sensor under a contact other than the frictionless plate of the atlas.

The atlas gives the derivatives by wall, radius, gas and driving pressure. The solid gives those by friction and by the
modulus, by far the most uncertain input, under the contact itself (docs/background/contact.md).

Sources that the contact adds: unknown friction, the difference between the derivatives under the contact and those
under the plate, and an unknown place of contact.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.anywhere.reading import (
    FARTHEST,
    SMALLEST_BALL,
    STEEPEST_TILT,
    batch_conditions,
    place_uncertainty,
)
from pneutouch.mechanics.atlas.coverage import under_plate
from pneutouch.mechanics.atlas.figures import CONTACT_FIGURES, FIGURES, SENSITIVITY, log_figures
from pneutouch.mechanics.atlas.press import SensorBatch, batch_of
from pneutouch.mechanics.atlas.respond import AtlasResponse, respond
from pneutouch.mechanics.corrected.figures import GRIPS, CorrectedAtlas, between, pressed_logs
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.uncertainty.source import CORRECTION, FIGURE, FRICTION, PLACE, UncertaintySource, counting

SPREAD = 2.0
"""Greatest factor between a stated coefficient of friction and the true one, uniform in its logarithm: an assumption.
Dry rubber on plastic has a coefficient near 1; dust, speed and load change it by that much."""

LEAST_GRIP = 1.0
"""Least coefficient assumed for a surface that is stated to grip: that of dry rubber on plastic."""

_KURTOSIS = 1.8
"""Kurtosis of a rectangular distribution."""

_LEAST_STEP = 0.1
"""Least half step in ln modulus: smaller differences of figures are disturbed by noise in the range's end."""

_RANGE = CONTACT_FIGURES[-1]
_SAME_END = 1e-6
"""Difference of ln range end below which two range ends are the same."""


@dataclass(frozen=True)
class FrictionSpread:
    """Effect of an unknown coefficient of friction on n sensors.

    Attributes:
        standard: Standard uncertainties of the logarithm of the figures, (figures, n); NaN if no equilibrium was found
            at another coefficient.
        elasticities: d ln figure / d ln coefficient, (figures, n); None for a surface that grips.
        origin: Assumed or fitted distribution of the coefficient, in words.
    """

    standard: Array
    elasticities: Array | None
    origin: str


@dataclass(frozen=True)
class ContactShift:
    """Logarithms of the figures under a contact, by the solid, minus those under the plate, by the atlas.

    Attributes:
        half: Distance between the nodes in ln modulus.
        nodes: Values at the sensor's modulus times exp(-half), 1 and exp(half), (3, figures, n).
    """

    half: float
    nodes: Array

    def at(self, by: Array) -> Array:
        """Shift (figures, k, n) at ln of modulus ratios ``by`` (k, n): a parabola, constant beyond the nodes."""
        t = np.clip(by / self.half, -1.0, 1.0)
        less, here, more = self.nodes[:, :, None]
        return np.asarray(here + 0.5 * t * (more - less) + 0.5 * t**2 * (more - 2.0 * here + less))

    def row(self, row: int) -> "ContactShift":
        """Shift of the one sensor with the index ``row``."""
        return ContactShift(self.half, self.nodes[:, :, row : row + 1])


@dataclass(frozen=True)
class ContactModel(CorrectedAtlas):
    """Figures of one sensor under its contact, and their changes with another modulus or friction.

    The changes are solved at the lowest and the highest pressure and linear in between; at more if an event ends a
    range. ``fitted_spread`` is the standard uncertainty of a fitted coefficient of friction; None: not fitted.
    """

    fitted_spread: float | None = None

    def shift(self, half: float) -> ContactShift:
        """Shift with nodes at least ``half`` apart in ln modulus; one that cannot be solved has the middle's value."""
        half = max(half, _LEAST_STEP)
        here = self.logs - self.plate(self.pressures)
        modulus = self.sensor.wall.shear_modulus
        less, more = (self._change(self.sensor.replace(shear_modulus=f * modulus)) for f in np.exp([-half, half]))
        nodes = np.stack([here + less, here, here + more])
        # Neither the free state nor its limit point depends on the contact.
        nodes[:, [i for i in range(len(FIGURES)) if i not in CONTACT_FIGURES]] = 0.0
        return ContactShift(half, np.where(np.isnan(nodes), nodes[1], nodes))

    @cached_property
    def friction(self) -> FrictionSpread | None:
        """Effect of the uncertain coefficient of friction; None without friction."""
        stated = self.sensor.protocol.friction
        if self.fitted_spread is not None:
            return self._fitted(min(stated, GRIPS), self.fitted_spread)
        if stated == 0.0:
            return None
        if np.isinf(stated):
            change = self._change(self.sensor.replace(friction=LEAST_GRIP))
            # As likely anywhere from none of the change to the whole of it, about an end: mean square c^2 / 3.
            origin = f"assumed: a coefficient from {LEAST_GRIP:g} to grip; the solid at both ends"
            return FrictionSpread(np.abs(change) / np.sqrt(3.0), None, origin)
        u = np.log(SPREAD) / np.sqrt(3.0)
        far = np.sqrt(_KURTOSIS) * u
        down, up = (self._change(self.sensor.replace(friction=stated * float(np.exp(x)))) for x in (-far, far))
        half = 0.5 * (up - down)
        slope = np.where(np.isnan(half), np.where(np.isnan(up), -down, up), half)
        bend = np.nan_to_num(0.5 * (up + down))
        # Three-point rule with the moments of the rectangle: weights 1/(2 kurtosis) at both sides.
        weight = 1.0 / _KURTOSIS
        variance = weight * (slope**2 + bend**2) - (weight * bend) ** 2
        origin = (
            f"assumed: {stated:g}, even in its logarithm from 1/{SPREAD:g} to {SPREAD:g} times as much; the solid at "
            f"{stated * np.exp(-far):.2g} and {stated * np.exp(far):.2g}"
        )
        return FrictionSpread(np.sqrt(variance), slope / far, origin)

    def _fitted(self, value: float, spread: float) -> FrictionSpread:
        """Effect of a fitted coefficient, from the change over one standard uncertainty ``spread`` to each side."""
        ends = max(value - spread, 0.0), min(value + spread, GRIPS)
        down, up = (self._change(self.sensor.replace(friction=np.inf if x >= GRIPS else x)) for x in ends)
        slope = (up - down) / max(ends[1] - ends[0], 1e-9)
        origin = f"fitted: {value:.3g}, standard uncertainty {spread:.2g}; the solid at {ends[0]:.2g} and {ends[1]:.2g}"
        return FrictionSpread(np.abs(slope) * spread, value * slope, origin)

    def _change(self, sensor: Sensor) -> Array:
        """Change (figures, n) of the figures' logarithms under the contact from this sensor to ``sensor``, less that
        under the plate; NaN above the highest driving pressure that the solid can solve."""
        at, solved = self.solved
        for count in range(at.size, 0, -1):
            rows = np.unique([0, count - 1])
            changes = pressed_logs(sensor.replace(waves=0), tuple(at[rows].tolist())) - solved[:, rows]
            if not np.isnan(changes).all():
                break
        if count > rows.size and not self._to_the_depth(solved[:, :count], changes):
            inner = pressed_logs(sensor.replace(waves=0), tuple(at[1 : count - 1].tolist())) - solved[:, 1 : count - 1]
            rows, changes = np.arange(count), np.hstack([changes[:, :1], inner, changes[:, 1:]])
        if sensor.wall != self.sensor.wall:
            plates = [batch_of(under_plate(one), at[rows]) for one in (sensor, self.sensor)]
            there, here = np.split(log_figures(SensorBatch.join(plates)), 2, axis=1)
            changes = changes - (there - here)
        return between(np.array(self.pressures), at[rows], changes)

    def _to_the_depth(self, solved: Array, changes: Array) -> bool:
        """True if no range of the ``solved`` figures and of their ``changes`` ends before the test's depth."""
        ends = np.abs([*(solved[_RANGE] - np.log(self.sensor.protocol.depth)), *changes[_RANGE]])
        return bool((ends < _SAME_END).all())


WALL_GAP, OBJECT_WALL_GAP = 0.4, 0.7
"""Greatest difference found in d ln figure / d ln wall between the frictionless plate and a plate with friction, and
that between the frictionless plate and other objects (docs/background/contact.md)."""


def contact_sources(contact: ContactModel, others: list[UncertaintySource]) -> list[UncertaintySource]:
    """Sources for the contact at n driving pressures: friction, and the error of the derivative by the wall, which is
    that under the plate; the spread of the wall is that of the sources ``others``."""
    size, source_list = len(contact.pressures), []
    friction = contact.friction
    if friction is not None:
        for figure in CONTACT_FIGURES:
            known = np.isfinite(friction.standard[figure])
            source_list.append(
                UncertaintySource(
                    FRICTION,
                    FIGURE,
                    np.where(known, friction.standard[figure], 0.0),
                    "log-rectangular",
                    counting(size, only=(figure,)) & known,
                    friction.origin,
                    False,
                )
            )
    walls = np.zeros(size)
    for source in others:
        walls = np.hypot(walls, source.moves.get("wall_thickness", 0.0))
    return [*source_list, _of_wall(contact, walls)]


def _of_wall(contact: ContactModel, walls: Array) -> UncertaintySource:
    gap = WALL_GAP if contact.sensor.protocol.body is None else OBJECT_WALL_GAP
    return UncertaintySource(
        CORRECTION,
        FIGURE,
        gap * walls / np.sqrt(3.0),
        "rectangular",
        counting(walls.size, only=CONTACT_FIGURES[:-1]),
        f"the derivative by the wall is that of a plate without friction; greatest difference found {gap:g} "
        f"(d ln {FIGURES[0]} / d ln wall)",
        True,
    )


_ORIGIN = (
    f"assumed (Type B, JCGM 100, 4.3.7): a ball of {SMALLEST_BALL:g} R0 radius or more, its curvature even, its axis "
    f"even over the disc of {FARTHEST:g} R0; a plate tilted by up to {np.degrees(STEEPEST_TILT):.0f} degrees; root "
    "mean square of the logarithm of the force read over the true one"
)


def place_sources(batch: SensorBatch) -> list[UncertaintySource]:
    """Source for an unknown object and place of contact; it counts for those of n sensors that `anywhere` covers."""
    standard = place_uncertainties(batch, respond(batch))
    known = np.isfinite(standard)
    counts = counting(standard.size, only=(SENSITIVITY,)) & known
    return [UncertaintySource(PLACE, FIGURE, np.where(known, standard, 0.0), "lognormal", counts, _ORIGIN, False)]


def place_uncertainties(batch: SensorBatch, response: AtlasResponse) -> Array:
    """Relative standard uncertainties (n,) by an unknown place, from atlas responses; NaN outside the table."""
    domes = batch_conditions(batch, response.limit_pressure, response.cavity_volume)
    return place_uncertainty(domes, response.range_end / batch.inner_radius)
