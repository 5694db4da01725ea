"""The rated pressure: the greatest driving pressure of a sensor, with the uncertainty of its limits included."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from pneutouch.arrays import Array
from pneutouch.mechanics.atlas.coverage import outside_fit
from pneutouch.mechanics.atlas.press import SensorBatch, batch_of
from pneutouch.mechanics.models.accuracy import LIMIT_DISCRETISATION
from pneutouch.mechanics.prediction import Limits
from pneutouch.mechanics.sensor import Sensor
from pneutouch.mechanics.uncertainty.propagate import COUPON, COVERAGE, limit_spread
from pneutouch.spec.material import Material
from pneutouch.spec.printer import Printer
from pneutouch.units import KPA
from pneutouch.wording import tenths_below

if TYPE_CHECKING:
    from pneutouch.spec.calibration import SensorCalibration

RATED_SHARE = 0.9
"""Rated pressure over the lower end of the lowest limit: the dome grows fast near the limit point."""

LIMIT_ERROR = LIMIT_DISCRETISATION
"""Greatest relative numerical error of the limit pressure in the models solid and atlas."""

_WORTH = 1.05
"""Least gain in rated pressure, as a factor, for which a measurement of the modulus is advised: a choice."""


BUCKLING = "buckling under vacuum"
BUCKLING_SLOPE = 3.0
"""d ln of the pressure at which an emptied dome buckles / d ln wall ratio, at most: 2 for a thin sphere (Zoelly, 1915);
the solid has 2.0 to 2.8 for walls of 0.06 to 0.28 R0 and less above (`tests/mechanics/solid/test_filling.py`)."""


class UncertainLimit(NamedTuple):
    """A limit of the driving pressure: its name, its nominal value and the ends of its k = 2 interval, MPa."""

    name: str
    nominal: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Rating:
    """The rated pressure of a sensor and its basis.

    Attributes:
        pressure: The rated pressure, MPa.
        limits: The limits that are met, ordered by the lower ends of their intervals.
        measured: Rated pressure if the modulus is measured on coupons and confirmed, MPa.
        is_fitted: True if the sensor, once built, can be calibrated with measured runs.
        vacuum: Pressure at which the emptied dome buckles; None where that was not looked for, or none is found.
    """

    pressure: float
    limits: tuple[UncertainLimit, ...]
    measured: float
    is_fitted: bool = True
    vacuum: UncertainLimit | None = None

    @property
    def least(self) -> float:
        """Least driving pressure, MPa: `RATED_SHARE` of the weaker end of buckling; -inf without that limit."""
        return -np.inf if self.vacuum is None else RATED_SHARE * self.vacuum.high

    @property
    def limit(self) -> UncertainLimit:
        """Limit from which the rated pressure is derived: the one with the lowest lower end."""
        return self.limits[0]

    @property
    def nominal(self) -> UncertainLimit:
        """Limit with the lowest nominal value; a driving pressure above this value is an error."""
        return min(self.limits, key=lambda limit: limit.nominal)

    @property
    def pressure_kPa(self) -> float:
        """Rated pressure as it is displayed, kPa: rounded down to a tenth."""
        return tenths_below(self.pressure / KPA)

    def severity(self, pressure: float) -> Literal["error", "warning"] | None:
        """Severity of a driving pressure (MPa): an error above the lowest nominal limit, a warning above the rated
        pressure, else None."""
        if pressure > self.nominal.nominal:
            return "error"
        return "warning" if pressure > self.pressure or pressure < self.least else None

    def excess(self, pressure: float) -> str:
        """Text for a driving pressure (MPa) outside the rated ones: the limit or rating that it exceeds."""
        if pressure < 0.0:
            return f"{pressure / KPA:.5g} kPa is below the least driving pressure: {self.vacuum_basis}"
        if self.severity(pressure) == "error":
            least = self.nominal
            return f"{pressure / KPA:.5g} kPa is above the {least.name}, {least.nominal / KPA:.1f} kPa as designed"
        return f"{pressure / KPA:.5g} kPa is above the rated pressure of {self.pressure_kPa:.1f} kPa"

    @property
    def basis(self) -> str:
        """Basis of the rated pressure, in words."""
        limit = self.limit
        if limit.low == limit.nominal:
            return f"{RATED_SHARE:.0%} of the {limit.name}, {limit.nominal / KPA:.1f} kPa"
        return (
            f"{RATED_SHARE:.0%} of the lower end of the {limit.name}, {limit.nominal / KPA:.1f} kPa nominal, "
            f"{limit.low / KPA:.1f} to {limit.high / KPA:.1f} at k = {COVERAGE:g}"
        )

    @property
    def vacuum_basis(self) -> str:
        """Least driving pressure with its basis, in words; empty without a limit below ambient pressure."""
        if self.vacuum is None:
            return ""
        least_kPa, (name, nominal, low, high) = -tenths_below(-self.least / KPA), self.vacuum
        ends = f"{nominal / KPA:.1f} kPa nominal, {low / KPA:.1f} to {high / KPA:.1f} at k = {COVERAGE:g}"
        return f"{least_kPa:.1f} kPa, {RATED_SHARE:.0%} of the weaker end of {name}, {ends}"

    @property
    def summary(self) -> str:
        """Basis of the rated pressure, in fewer words than `basis`."""
        limit = self.limit
        if limit.low == limit.nominal:
            return f"{RATED_SHARE:.0%} of the {limit.name}, {limit.nominal / KPA:.1f} kPa"
        low, nominal = f"{limit.low / KPA:.1f} kPa", f"{limit.nominal / KPA:.1f} nominal"
        return f"{RATED_SHARE:.0%} of the lower end (k = {COVERAGE:g}) of the {limit.name}, {low} ({nominal})"

    @property
    def remedy(self) -> str | None:
        """Advice that would raise the rated pressure; None if a measured modulus raises it by less than 5 %."""
        if self.measured < _WORTH * self.pressure:
            return None
        measured_kPa = tenths_below(self.measured / KPA)
        return (
            f"measure the modulus on coupons (to {COUPON:.0%}), which makes it {measured_kPa:.1f} kPa if they confirm "
            f"the nominal modulus{', or calibrate a built sensor' if self.is_fitted else ''}"
        )

    def remedy_for(self, pressure: float) -> str | None:
        """`remedy` if it would permit a driving pressure (MPa); None if only a lower pressure helps."""
        return self.remedy if self.measured >= pressure else None


def rated_pressure(limit: Array, spread: Array, gauge: Array | float) -> Array:
    """Rated pressures of n sensors, MPa: `RATED_SHARE` of the lower end of the lowest limit.

    Args:
        limit: Pressure of the limit point, or of the break strain if that is lower, MPa (n,).
        spread: Relative standard uncertainty of the limit (n,), see `limit_spread`.
        gauge: Range of the pressure gauge, MPa; taken as exact, because the driving pressure is set by its reading.
    """
    return np.asarray(RATED_SHARE * np.fmin(limit * np.exp(-COVERAGE * spread), gauge))


def ratings(
    limits: Sequence[Limits],
    sensors: Sequence[Sensor],
    material: Material,
    printer: Printer,
    calibration: "SensorCalibration | None" = None,
    numerical: float = LIMIT_ERROR,
) -> list[Rating]:
    """Ratings of n sensors of ``material`` from ``printer``, from a model's nominal ``limits``, in one pass.

    All limits but the gauge range are met at pressures proportional to the modulus, so all have the uncertainty of the
    limit pressure. The scatter of the break strain is covered by using the least elongation at break instead.
    ``calibration`` is that of the built sensor, None without one. ``numerical`` is the model's greatest relative error
    of the limit pressure.
    """
    batch = SensorBatch.join([batch_of(s, [0.0]) for s in sensors])
    spread = limit_spread(batch, material, printer, numerical, calibration)
    empty = any(one.vacuum is not None for one in limits)
    buckling = limit_spread(batch, material, printer, numerical, calibration, BUCKLING_SLOPE) if empty else spread
    named = [one.named() for one in limits]
    lowest = np.array([min((v for name, v in each if name != "gauge range"), default=np.inf) for each in named])
    gauge = np.array([one.gauge for one in limits])
    rated, measured = (rated_pressure(lowest, some, gauge).tolist() for some in (spread.standard, spread.measured))
    found = []
    for k, factor in enumerate(np.exp(COVERAGE * spread.standard).tolist()):
        # A gauge's range is exact: its own reading sets the driving pressure.
        factors = [1.0 if name == "gauge range" else factor for name, _ in named[k]]
        intervals = [UncertainLimit(n, v, v / f, v * f) for (n, v), f in zip(named[k], factors, strict=True)]
        ordered = tuple(sorted(intervals, key=lambda limit: limit.low))
        least, weaker = limits[k].vacuum, float(np.exp(COVERAGE * buckling.standard[k]))
        absolute = RATED_SHARE * (least or 0.0) / weaker > -sensors[k].gas.ambient_pressure
        vacuum = UncertainLimit(BUCKLING, least, least * weaker, least / weaker) if least and absolute else None
        found.append(Rating(rated[k], ordered, measured[k], outside_fit(sensors[k]) is None, vacuum))
    return found
