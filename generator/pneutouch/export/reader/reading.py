"""Contact force from the gauge pressure of one sensor, by its table. Standard library alone.

Pressures are kPa, gauge pressures but for the ambient one, which is absolute; temperatures are the gas's, degrees C.
"""

import math
from bisect import bisect_right
from collections.abc import Sequence
from enum import IntEnum
from typing import Any, NamedTuple

FORMAT = "pneutouch/reader/1"
"""Format of the table with its version, which goes up when an older reader would misread the table."""

CELSIUS = 273.15

NOISES = 5.0
"""Multiple of the noise's standard deviation by which a reading must differ from its zero to count as different."""

UNSTEADY = 0.002
"""Share of the greatest pressure rise that readings without contact may scatter by, or `NOISES` times the gauge's noise
where that is more: our choice. The threshold of a touch follows from their scatter."""

QUIET = 0.001
"""Least noise, as a share of the greatest pressure rise, against which a reading below zero is judged."""


class Status(IntEnum):
    """Status of a reading. With OK and ABOVE_RATING it has a force; with any other the force is NaN."""

    OK = 0
    ABOVE_RATING = 1
    NOT_TARED = 2
    NOT_A_NUMBER = 3
    GAUGE_SATURATED = 4
    CONDITIONS = 5
    DRIVING_PRESSURE = 6
    BELOW_ZERO = 7
    BEYOND_RANGE = 8
    UNSTEADY_TARE = 9


class ForceReading(NamedTuple):
    """Status, contact force and its standard uncertainty (N), and pressure rise (kPa)."""

    status: Status
    force_N: float
    uncertainty_N: float
    rise_kPa: float


class _Free(NamedTuple):
    """The sensor without contact now: status, gas content (kPa mL) and gauge pressure (kPa)."""

    status: Status
    content: float = math.nan
    pressure_kPa: float = math.nan


class ForceReader:
    """The force of one sensor. ``table`` is the content of its ``reader.json``; tare it before the first reading."""

    def __init__(self, table: dict[str, Any]) -> None:
        """Raises ValueError for a table of another format than this module reads."""
        if table.get("format") != FORMAT:
            raise ValueError(f"format {table.get('format')!r:.40}: this module reads format {FORMAT}")
        grid, box = table["grid"], table["box"]
        self._rows: list[float] = grid["driving_pressure_kPa"]
        self._rise: list[list[float]] = grid["pressure_rise_kPa"]
        self._force: list[list[float]] = grid["contact_force_N"]
        self._factor: list[float] = grid["pressure_factor"]
        self._relative: list[list[float]] | None = grid["force_uncertainty_relative"]
        self._gas: list[float] = table["gas"]["volume_mL"]
        self._gas_rows: list[float] = table["gas"]["driving_pressure_kPa"]
        self._box: dict[str, Any] = box
        self._zero: dict[str, float] = table["zero"]
        low, high = box["driving_pressure_kPa"]
        self._driving = (low - box["driving_pressure_margin_kPa"], high)
        self._rated_kPa: float = table["rating"]["driving_pressure_kPa"]
        self._gauge: list[float] = table["gauge"]["range_kPa"]
        self._nominal_kPa: float = table["conditions"]["ambient_pressure_kPa"]
        self.driving_pressure_kPa = math.nan
        self.noise_kPa = self.drift_kPa = 0.0
        self.touched = False
        self._zero_variance = self._deviation = 0.0
        self._kelvin = self._ambient_kPa = math.nan

    def tare(
        self, gauge_kPa: Sequence[float], temperature_C: float = 20.0, ambient_pressure_kPa: float | None = None
    ) -> Status:
        """Take the mean of readings without contact as driving pressure, their scatter as noise; returns the status."""
        ambient_kPa = self._nominal_kPa if ambient_pressure_kPa is None else ambient_pressure_kPa
        count = len(gauge_kPa)
        self.driving_pressure_kPa = math.nan
        if not count or not all(map(math.isfinite, [*gauge_kPa, temperature_C, ambient_kPa])):
            return Status.NOT_A_NUMBER
        mean = math.fsum(gauge_kPa) / count
        if not self._gauge[0] < min(gauge_kPa) <= max(gauge_kPa) < self._gauge[1]:
            return Status.GAUGE_SATURATED
        low, high = self._box["ambient_pressure_kPa"]
        if not (low <= ambient_kPa <= high and temperature_C > -CELSIUS):
            return Status.CONDITIONS
        if not self._driving[0] <= mean <= self._driving[1]:
            return Status.DRIVING_PRESSURE
        variance = math.fsum((one_kPa - mean) ** 2 for one_kPa in gauge_kPa) / max(count - 1, 1)
        if variance > self._zero["noise_most_kPa"] ** 2:
            return Status.UNSTEADY_TARE
        least = self._zero["noise_least_kPa"]
        self.noise_kPa = max(math.sqrt(variance), least)
        # Readings that do not scatter share the error of one step: their mean is no better than one of them.
        self._zero_variance = variance / count if variance > least**2 else least**2
        self._kelvin, self._ambient_kPa, self.driving_pressure_kPa = temperature_C + CELSIUS, ambient_kPa, mean
        self._deviation, self.drift_kPa, self.touched = 0.0, 0.0, False
        return self._rating(mean)

    def read(
        self, gauge_kPa: float, temperature_C: float | None = None, ambient_pressure_kPa: float | None = None
    ) -> ForceReading:
        """The force at a gauge pressure. Temperature and ambient pressure left out: those of the tare."""
        ambient_kPa = self._ambient_kPa if ambient_pressure_kPa is None else ambient_pressure_kPa
        status, content, free_kPa = self._without_contact(gauge_kPa, temperature_C, ambient_kPa)
        if status > Status.ABOVE_RATING:
            return _nothing(status)
        rise_kPa = gauge_kPa - free_kPa
        true = rise_kPa / _between(self._factor, *self._row(free_kPa))
        same_kPa = free_kPa
        if ambient_kPa != self._nominal_kPa:
            # The same wall, cavity and gauge pressure at the ambient pressure of the table.
            absolute_kPa = free_kPa + true
            same_kPa = self._pressure(
                content * (absolute_kPa + self._nominal_kPa) / (absolute_kPa + ambient_kPa), self._nominal_kPa
            )
        if not self._rows[0] <= same_kPa <= self._rows[-1]:
            return _nothing(Status.CONDITIONS)
        row, part = self._row(same_kPa)
        return self._looked_up(
            row, part, (true - (same_kPa - free_kPa)) * _between(self._factor, row, part), rise_kPa, status
        )

    def track(
        self,
        gauge_kPa: float,
        seconds: float,
        temperature_C: float | None = None,
        ambient_pressure_kPa: float | None = None,
    ) -> bool:
        """Follow a slow drift of the zero with every reading, ``seconds`` after the one before. True if touched.

        The zero stays while it is touched or far below zero; else it moves no faster and no further than allowed.
        """
        ambient_kPa = self._ambient_kPa if ambient_pressure_kPa is None else ambient_pressure_kPa
        status, _, free_kPa = self._without_contact(gauge_kPa, temperature_C, ambient_kPa)
        if status > Status.ABOVE_RATING or not 0.0 < seconds < math.inf:
            return self.touched
        threshold = NOISES * self.noise_kPa
        share = seconds / (seconds + self._zero["filter_s"])
        self._deviation += share * (gauge_kPa - free_kPa - self._deviation)
        if self._deviation > threshold or gauge_kPa - free_kPa > 2.0 * threshold:
            self.touched = True
        elif self._deviation < 0.5 * threshold:
            self.touched = False
        most = self._zero["drift_rate_kPa_per_s"] * seconds
        step = min(max(share * self._deviation, -most), most)
        idle = not self.touched and self._deviation >= -threshold
        if idle and abs(self.drift_kPa + step) <= self._zero["drift_most_kPa"]:
            self.driving_pressure_kPa += step
            self.drift_kPa += step
            self._deviation -= step
        return self.touched

    def _without_contact(self, gauge_kPa: float, temperature_C: float | None, ambient_kPa: float) -> _Free:
        """Gas content and gauge pressure without contact now; if no reading is possible, the status alone."""
        kelvin = self._kelvin if temperature_C is None else temperature_C + CELSIUS
        if math.isnan(self.driving_pressure_kPa):
            return _Free(Status.NOT_TARED)
        if not (math.isfinite(gauge_kPa) and math.isfinite(kelvin) and math.isfinite(ambient_kPa)):
            return _Free(Status.NOT_A_NUMBER)
        if not self._gauge[0] < gauge_kPa < self._gauge[1]:
            return _Free(Status.GAUGE_SATURATED)
        low, high = self._box["ambient_pressure_kPa"]
        if not (low <= ambient_kPa <= high and abs(kelvin - self._kelvin) <= self._box["temperature_change_K"]):
            return _Free(Status.CONDITIONS)
        content = self._content(self.driving_pressure_kPa, self._ambient_kPa) * (kelvin / self._kelvin)
        free_kPa = self.driving_pressure_kPa
        if kelvin != self._kelvin or ambient_kPa != self._ambient_kPa:
            free_kPa = self._pressure(content, ambient_kPa)
        if not self._driving[0] <= free_kPa <= self._driving[1]:
            return _Free(Status.DRIVING_PRESSURE)
        return _Free(self._rating(free_kPa), content, free_kPa)

    def _looked_up(self, row: int, part: float, at: float, rise_kPa: float, status: Status) -> ForceReading:
        """The reading at the pressure rise ``at`` in the table and the measured ``rise_kPa``, both kPa."""
        rises = [a + part * (b - a) for a, b in zip(self._rise[row], self._rise[row + 1], strict=True)]
        forces = [a + part * (b - a) for a, b in zip(self._force[row], self._force[row + 1], strict=True)]
        noise = math.sqrt(self.noise_kPa**2 + self._zero_variance)
        if rise_kPa <= 0.0:
            if rise_kPa < -NOISES * max(self.noise_kPa, QUIET * rises[-1]):
                return _nothing(Status.BELOW_ZERO)
            return ForceReading(status, 0.0, forces[1] / rises[1] * noise, rise_kPa)
        if at > rises[-1]:
            return _nothing(Status.BEYOND_RANGE)
        k = min(max(bisect_right(rises, at), 1), len(rises) - 1) - 1
        beyond = max((at - rises[k]) / (rises[k + 1] - rises[k]), 0.0)
        force = forces[k] + beyond * (forces[k + 1] - forces[k])
        slope = (forces[k + 1] - forces[k]) / (rises[k + 1] - rises[k])
        return ForceReading(
            status, force, math.hypot(self._share(row, part, k + beyond) * force, slope * noise), rise_kPa
        )

    def _share(self, row: int, part: float, column: float) -> float:
        """Relative standard uncertainty of the force at a column of the grid; NaN if it is unknown."""
        if self._relative is None:
            return math.nan
        place = column * (len(self._relative[0]) - 1) / (len(self._rise[0]) - 1)
        k = min(int(place), len(self._relative[0]) - 2)
        low, high = (_between(self._relative[row + i], k, place - k) for i in (0, 1))
        return low + part * (high - low)

    def _rating(self, driving_pressure_kPa: float) -> Status:
        return Status.ABOVE_RATING if driving_pressure_kPa > self._rated_kPa else Status.OK

    def _row(self, driving_pressure_kPa: float) -> tuple[int, float]:
        """Row of the grid below a driving pressure, and the share of the step beyond it."""
        return _place(driving_pressure_kPa, self._rows)

    def _content(self, driving_pressure_kPa: float, ambient_kPa: float) -> float:
        """Absolute pressure times volume of the gas without contact, linear between the rows of the gas."""
        row, part = _place(driving_pressure_kPa, self._gas_rows)
        low, high = (self._gas[k] * (self._gas_rows[k] + ambient_kPa) for k in (row, row + 1))
        return low + part * (high - low)

    def _pressure(self, content: float, ambient_kPa: float) -> float:
        """The driving pressure with that content, at an ambient pressure; extrapolated beyond the ends."""
        contents = [v * (p + ambient_kPa) for p, v in zip(self._gas_rows, self._gas, strict=True)]
        k = min(max(bisect_right(contents, content), 1), len(contents) - 1) - 1
        share = (content - contents[k]) / (contents[k + 1] - contents[k])
        return self._gas_rows[k] + share * (self._gas_rows[k + 1] - self._gas_rows[k])


def _place(value: float, rows: Sequence[float]) -> tuple[int, float]:
    """The row below a value among equally spaced rows, and the share of the step beyond it; within the ends."""
    step = (rows[-1] - rows[0]) / (len(rows) - 1)
    place = min(max((value - rows[0]) / step, 0.0), len(rows) - 1.0)
    row = min(int(place), len(rows) - 2)
    return row, place - row


def _between(values: Sequence[float], row: int, part: float) -> float:
    return values[row] + part * (values[row + 1] - values[row])


def _nothing(status: Status) -> ForceReading:
    return ForceReading(status, math.nan, math.nan, math.nan)
