"""The instruments of the simulated rig: noise, drift, play, ranges.

A simulated record as the bytes of a file, marked as simulated.
"""

from __future__ import annotations

import io
from dataclasses import dataclass, fields, replace

import numpy as np

from pneutouch.arrays import Array
from pneutouch.bench.simulate.scatter import parameter
from pneutouch.errors import InputError
from pneutouch.mechanics.gauge_reading import GaugeReading
from pneutouch.texture.sliding import NOISE, STEP
from pneutouch.units import GAUGE_LIMIT, KPA

MINUTE = 60.0


@dataclass(frozen=True, slots=True)
class RigModel:
    """Noise, drift and play of a rig; internal units. Zero offsets are drawn once a run."""

    force_noise: float = parameter(
        0.02,
        "N rms",
        "white noise of a sample before the filter: the resolution of the ATI SI-40-2 (paper, Supplement C), taken "
        "as rms",
    )
    pressure_noise: float = parameter(
        NOISE, "MPa rms", "white noise of a sample before the filter: one step of the recorder"
    )
    pressure_step: float = parameter(
        STEP, "MPa", "step of the recorder, 16 bits over +-10 V at 50 kPa/V (see texture.sliding)"
    )
    cutoff: float = parameter(30.0, "Hz", "first-order low pass on force and pressure alike: our choice")
    force_range: float = parameter(40.0, "N", "ATI SI-40-2, where its reading stops")
    pressure_range: float = parameter(
        GAUGE_LIMIT, "MPa", "SMC PSE543, +-100 kPa, where its reading stops (paper, Supplement C)"
    )
    force_drift: float = parameter(0.005 / MINUTE, "N/s", "drift of the force's zero, 0.005 N/min: our choice")
    temperature: float = parameter(
        0.01 * KPA / MINUTE,
        "MPa/s",
        "drift of the shut-in pressure by warming, 0.01 kPa/min, 2 K in an hour: our choice",
    )
    leak: float = parameter(
        0.0005 / MINUTE,
        "1/s",
        "share of the driving pressure lost, 0.05 % a minute: our choice; of the rise none is lost",
    )
    backlash: float = parameter(
        0.03, "mm", "play of the stage: coming out, the reading lags the plate by it; our choice"
    )
    position_noise: float = parameter(
        0.0025, "mm rms", "accuracy of the Aerotech stage (paper, Supplement C), taken as rms"
    )
    missed: float = parameter(1e-4, "1", "share of the samples that are missing from the file: our choice")
    force_zero: float = parameter(0.05, "N", "standard deviation of the force's zero from run to run: our choice")
    pressure_zero: float = parameter(
        0.1 * KPA, "MPa", "standard deviation of the pressure's zero from run to run: our choice"
    )
    position_zero: float = parameter(
        0.2, "mm", "standard deviation of the place of first contact: our choice, mounting"
    )

    @classmethod
    def perfect(cls) -> RigModel:
        """A rig that reads the true values."""
        unlimited = dict.fromkeys(("cutoff", "force_range", "pressure_range"), np.inf)
        return cls(**{one.name: unlimited.get(one.name, 0.0) for one in fields(cls)})

    def with_gauge(self, reading: GaugeReading) -> RigModel:
        """The rig with a gauge: its noise, step and range in place of those that are the paper's.

        An unknown noise or step stays the paper's.
        """
        paper = RigModel()
        gauge = {"pressure_noise": reading.noise, "pressure_step": reading.step, "pressure_range": reading.limit}
        changed = {
            key: value
            for key, value in gauge.items()
            if value is not None and getattr(self, key) == getattr(paper, key)
        }
        return replace(self, **changed)

    def share(self, rate: float) -> float:
        """Weight of the new sample in the low pass at ``rate`` Hz."""
        return float(-np.expm1(-2.0 * np.pi * self.cutoff / rate))

    def passed(self, values: Array, rate: float, start: float) -> Array:
        """Values (n,) after the low pass, which stood at ``start``."""
        share = self.share(rate)
        if share >= 1.0:
            return values
        from scipy.signal import lfilter

        return np.asarray(lfilter([share], [1.0, share - 1.0], values, zi=[(1.0 - share) * start])[0])

    def noise(self, rate: float) -> tuple[float, float]:
        """Standard deviations of a sample of force (N) and pressure (MPa) in the file: filtered, then rounded to steps.

        Rounding adds step^2/12 where the noise is at least half a step (Sheppard).
        """
        share = self.share(rate)
        kept = np.sqrt(share / (2.0 - share))
        pressure = np.hypot(self.pressure_noise * kept, self.pressure_step / np.sqrt(12))
        return float(self.force_noise * kept), float(pressure)

    def drift(self, driving: float) -> float:
        """Slope of the shut-in pressure at a driving pressure (MPa), MPa/s."""
        return self.temperature - self.leak * driving

    def stepped(self, pressure: Array) -> Array:
        """Pressure as the recorder writes it: in steps, within its range."""
        if self.pressure_step > 0:
            pressure = self.pressure_step * np.round(pressure / self.pressure_step)
        return np.clip(pressure, -self.pressure_range, self.pressure_range)


LEAK_SECONDS = 600.0
"""Duration of a leak run, s: our choice, as long as the relaxation run."""

MARK = "# simulated by pneutouch"
"""First line of every file."""

_DECIMALS = {"time_s": 6, "position_mm": 5, "force_N": 5, "pressure_kPa": 6, "volume_mL": 4}
"""Decimals in files: a hundredth of the finest noise."""


def encoded(columns: dict[str, Array], *, parquet: bool = False) -> bytes:
    """Columns as CSV or parquet, marked as simulated. Raises InputError if pyarrow is required and missing."""
    rounded = {name: np.round(values, _DECIMALS[name]) + 0.0 for name, values in columns.items()}
    if not parquet:
        from pandas import DataFrame

        return f"{MARK}\n{DataFrame(rounded).to_csv(index=False, lineterminator=chr(10))}".encode()
    try:
        import pyarrow
        from pyarrow import parquet as files
    except ImportError:
        remedy = "pip install 'pneutouch[parquet]', or leave it out for CSV"
        raise InputError("needs pyarrow", key="parquet", remedy=remedy) from None
    table = pyarrow.table(rounded).replace_schema_metadata({"comment": MARK.removeprefix("# ")})
    target = io.BytesIO()
    files.write_table(table, target)
    return target.getvalue()
