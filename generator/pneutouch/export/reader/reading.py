"""Contact force from the gauge pressure of one sensor, by its table. Standard library alone.

Pressures are kPa, gauge pressures unless absolute is stated; temperatures are those of the gas, degrees Celsius.
"""

import math
from bisect import bisect_right
from enum import IntEnum
from typing import Any, NamedTuple

CELSIUS = 273.15


class Status(IntEnum):
    """What a reading is worth. With OK and ABOVE_RATING it has a force; with any other the force is NaN."""

    OK = 0
    ABOVE_RATING = 1
    NOT_TARED = 2
    NOT_A_NUMBER = 3
    GAUGE_SATURATED = 4
    CONDITIONS = 5
    DRIVING_PRESSURE = 6
    BELOW_ZERO = 7
    BEYOND_RANGE = 8


class Reading(NamedTuple):
    """Status, contact force and its standard uncertainty (N), and pressure rise (kPa)."""

    status: Status
    force_N: float
    uncertainty_N: float
    rise_kPa: float


class ForceReader:
    """The force of one sensor. ``table`` is the content of its ``reader.json``; tare it before the first reading."""

    def __init__(self, table: dict[str, Any]) -> None:
        grid, box = table["grid"], table["box"]
        self._rows: list[float] = grid["driving_pressure_kPa"]
        self._rise: list[list[float]] = grid["pressure_rise_kPa"]
        self._force: list[list[float]] = grid["contact_force_N"]
        self._factor: list[float] = grid["pressure_factor"]
        self._relative: list[list[float]] | None = grid["force_uncertainty_relative"]
        self._gas: list[float] = table["gas"]["volume_mL"]
        self._gas_rows: list[float] = table["gas"]["driving_pressure_kPa"]
        self._box: dict[str, Any] = box
        self._margin: float = box["driving_pressure_margin_kPa"]
        self._rated: float = table["rating"]["driving_pressure_kPa"]
        self._gauge: list[float] = table["gauge"]["range_kPa"]
        self._nominal: float = table["conditions"]["ambient_pressure_kPa"]
        self.driving_pressure_kPa = math.nan
        self.noise_kPa = 0.0
        self._zero_variance = 0.0
        self._kelvin = self._ambient = math.nan

    def tare(
        self, gauge_kPa: list[float], temperature_C: float = 20.0, ambient_pressure_kPa: float | None = None
    ) -> Status:
        """Take readings without contact as the driving pressure, and their scatter as the gauge's noise."""
        ambient = self._nominal if ambient_pressure_kPa is None else ambient_pressure_kPa
        count = len(gauge_kPa)
        self.driving_pressure_kPa = math.nan
        if not count or not all(map(math.isfinite, [*gauge_kPa, temperature_C, ambient])):
            return Status.NOT_A_NUMBER
        mean = math.fsum(gauge_kPa) / count
        if not self._gauge[0] < min(gauge_kPa) <= max(gauge_kPa) < self._gauge[1]:
            return Status.GAUGE_SATURATED
        low, high = self._box["ambient_pressure_kPa"]
        if not (low <= ambient <= high and temperature_C > -CELSIUS):
            return Status.CONDITIONS
        low, high = self._box["driving_pressure_kPa"]
        if not low - self._margin <= mean <= high:
            return Status.DRIVING_PRESSURE
        variance = math.fsum((one - mean) ** 2 for one in gauge_kPa) / max(count - 1, 1)
        self.noise_kPa, self._zero_variance = math.sqrt(variance), variance / count
        self._kelvin, self._ambient, self.driving_pressure_kPa = temperature_C + CELSIUS, ambient, mean
        return Status.ABOVE_RATING if mean > self._rated else Status.OK

    def read(
        self, gauge_kPa: float, temperature_C: float | None = None, ambient_pressure_kPa: float | None = None
    ) -> Reading:
        """The force at a gauge pressure. Temperature and ambient pressure left out: those of the tare."""
        kelvin = self._kelvin if temperature_C is None else temperature_C + CELSIUS
        ambient = self._ambient if ambient_pressure_kPa is None else ambient_pressure_kPa
        if math.isnan(self.driving_pressure_kPa):
            return _nothing(Status.NOT_TARED)
        if not (math.isfinite(gauge_kPa) and math.isfinite(kelvin) and math.isfinite(ambient)):
            return _nothing(Status.NOT_A_NUMBER)
        if not self._gauge[0] < gauge_kPa < self._gauge[1]:
            return _nothing(Status.GAUGE_SATURATED)
        low, high = self._box["ambient_pressure_kPa"]
        if not (low <= ambient <= high and abs(kelvin - self._kelvin) <= self._box["temperature_change_K"]):
            return _nothing(Status.CONDITIONS)
        content = self._content(self.driving_pressure_kPa, self._ambient) * (kelvin / self._kelvin)
        free = self.driving_pressure_kPa
        if kelvin != self._kelvin or ambient != self._ambient:
            free = self._pressure(content, ambient)
        low, high = self._box["driving_pressure_kPa"]
        if not low - self._margin <= free <= high:
            return _nothing(Status.DRIVING_PRESSURE)
        rise = gauge_kPa - free
        row, part = self._row(free)
        true = free + rise / _between(self._factor, row, part)
        same = free
        if ambient != self._nominal:
            # The same wall, cavity and gauge pressure at the ambient pressure of the table.
            same = self._pressure(content * (true + self._nominal) / (true + ambient), self._nominal)
            if not self._rows[0] <= same <= self._rows[-1]:
                return _nothing(Status.CONDITIONS)
        row, part = self._row(same)
        return self._looked_up(row, part, (true - same) * _between(self._factor, row, part), rise, free)

    def _looked_up(self, row: int, part: float, at: float, rise: float, free: float) -> Reading:
        """The reading at a rise ``at`` of the table and a measured ``rise``, both kPa."""
        rises = [a + part * (b - a) for a, b in zip(self._rise[row], self._rise[row + 1], strict=True)]
        forces = [a + part * (b - a) for a, b in zip(self._force[row], self._force[row + 1], strict=True)]
        slope = forces[1] / rises[1]
        if rise <= 0.0:
            far = rise < -self._below * max(self.noise_kPa, 0.001 * rises[-1])
            status = Status.BELOW_ZERO if far else self._rating_status(free)
            return _nothing(status) if far else Reading(status, 0.0, slope * self._noise, rise)
        if at > rises[-1]:
            return _nothing(Status.BEYOND_RANGE)
        k = min(bisect_right(rises, at), len(rises) - 1) - 1
        slope = (forces[k + 1] - forces[k]) / (rises[k + 1] - rises[k])
        beyond = (at - rises[k]) / (rises[k + 1] - rises[k])
        force = forces[k] + beyond * (forces[k + 1] - forces[k])
        uncertainty = math.hypot(self._share(row, part, k + beyond) * force, slope * self._noise)
        return Reading(self._rating_status(free), force, uncertainty, rise)

    _below = 5.0
    """Noises below zero at which a reading cannot be one without contact."""

    @property
    def _noise(self) -> float:
        """Standard uncertainty of a pressure rise by the gauge's noise, that of the zero included, kPa."""
        return math.sqrt(self.noise_kPa**2 + self._zero_variance)

    def _share(self, row: int, part: float, column: float) -> float:
        """Relative standard uncertainty of the force at a column of the grid; NaN where it is unknown."""
        if self._relative is None:
            return math.nan
        place = column * (len(self._relative[0]) - 1) / (len(self._rise[0]) - 1)
        k = min(int(place), len(self._relative[0]) - 2)
        low, high = (_between(self._relative[row + i], k, place - k) for i in (0, 1))
        return low + part * (high - low)

    def _rating_status(self, driving_pressure_kPa: float) -> Status:
        return Status.ABOVE_RATING if driving_pressure_kPa > self._rated else Status.OK

    def _row(self, driving_pressure_kPa: float) -> tuple[int, float]:
        """Row of the grid below a driving pressure, and the share of the step beyond it."""
        first, step = self._rows[0], self._rows[1] - self._rows[0]
        place = min(max((driving_pressure_kPa - first) / step, 0.0), len(self._rows) - 1.0)
        row = min(int(place), len(self._rows) - 2)
        return row, place - row

    def _content(self, driving_pressure_kPa: float, ambient_kPa: float) -> float:
        """Absolute pressure times volume of the gas without contact, linear between the rows of the gas."""
        first, step = self._gas_rows[0], self._gas_rows[1] - self._gas_rows[0]
        place = min(max((driving_pressure_kPa - first) / step, 0.0), len(self._gas) - 1.0)
        row = min(int(place), len(self._gas) - 2)
        low, high = (self._gas[k] * (self._gas_rows[k] + ambient_kPa) for k in (row, row + 1))
        return low + (place - row) * (high - low)

    def _pressure(self, content: float, ambient_kPa: float) -> float:
        """The driving pressure with that content, at an ambient pressure; beyond the ends by the last step."""
        contents = [v * (p + ambient_kPa) for p, v in zip(self._gas_rows, self._gas, strict=True)]
        k = min(max(bisect_right(contents, content), 1), len(contents) - 1) - 1
        share = (content - contents[k]) / (contents[k + 1] - contents[k])
        return self._gas_rows[k] + share * (self._gas_rows[k + 1] - self._gas_rows[k])


def _between(values: list[float], row: int, part: float) -> float:
    return values[row] + part * (values[row + 1] - values[row])


def _nothing(status: Status) -> Reading:
    return Reading(status, math.nan, math.nan, math.nan)
