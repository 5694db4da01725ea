"""Properties of a pressure gauge that limit its readings: range, noise, step, rate and error."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pneutouch.spec.values import Quantity
from pneutouch.units import GAUGE_LIMIT, KPA

if TYPE_CHECKING:
    from pneutouch.spec.gauge import Gauge

RECORDER_STEP_V = 20.0 / 2**16
"""Step in V of the recorder for an analog gauge: 16 bits over +-10 V (NI USB-6341, paper, Supplement C; range from NI's
manuals)."""

RECORDER_RATE_HZ = 10_000.0
"""Samples per second of the recorder for an analog gauge (paper, Supplement C)."""

PAPER_STEP = RECORDER_STEP_V * 50.0 * KPA
"""Step of the paper's recorder, MPa: `RECORDER_STEP_V` at 50 kPa/V (+-100 kPa on 1 to 5 V, SMC's usual output; an
assumption, because the PSE543's data sheet was not read)."""

PAPER_NOISE = 0.015 * KPA
"""White noise of a reading, MPa rms: one step of the recorder. An assumption; the paper gives none."""

PAPER_GAUGE = "SMC PSE543-R06"

SIGMAS = 3.0
"""Least change of a reading that counts as detected, over the standard deviation of the difference of two readings: the
usual value (IUPAC, Pure Appl. Chem. 67, 1699, 1995)."""


@dataclass(frozen=True, slots=True)
class GaugeReading:
    """A pressure gauge at a given ambient pressure; pressures in MPa.

    Attributes:
        title: Name of the gauge.
        low, limit: Least and greatest gauge pressure of its range.
        noise: Standard deviation of one reading; None if unknown.
        step: Smallest step of a reading, for an analog gauge that of the recorder; None if unknown.
        rate_Hz: Readings per second, for an analog gauge those of the recorder; None if unknown.
        absolute: True if the gauge reads ambient plus gauge pressure.
        error: Greatest error over the range; None if unknown.
    """

    title: str
    low: float
    limit: float
    noise: float | None
    step: float | None
    rate_Hz: float | None
    absolute: bool = False
    error: float | None = None

    @property
    def scatter(self) -> float | None:
        """Standard deviation of a reading: noise and rounding, which adds step^2/12 (Sheppard); None: noise unknown."""
        return None if self.noise is None else math.hypot(self.noise, (self.step or 0.0) / math.sqrt(12.0))

    @property
    def threshold(self) -> float | None:
        """Smallest pressure difference that two readings can distinguish, at least one step; None: noise unknown."""
        scatter = self.scatter
        return None if scatter is None else max(SIGMAS * math.sqrt(2.0) * scatter, self.step or 0.0)

    @property
    def limited_by(self) -> str:
        """Property of the gauge that sets `threshold`, in words: its noise or its resolution."""
        if self.noise is None:
            return "not known: the gauge's noise is unknown"
        return "gauge noise" if self.noise >= (self.step or 0.0) / math.sqrt(12.0) else "gauge resolution"


def gauge_reading(gauge: "Gauge | None", ambient_pressure: float) -> GaugeReading:
    """Reading of ``gauge`` at ``ambient_pressure`` (MPa); None stands for the gauge of the paper's rig."""
    if gauge is None:
        return GaugeReading(
            PAPER_GAUGE, -GAUGE_LIMIT, GAUGE_LIMIT, PAPER_NOISE, PAPER_STEP, RECORDER_RATE_HZ, error=4.0 * KPA
        )
    low_kPa, high_kPa = gauge.gauge_pressures_kPa(ambient_pressure / KPA)
    noise, error = _pressure(gauge.noise_kPa), _pressure(gauge.error_kPa)
    analog_Hz = RECORDER_RATE_HZ if "analog" in gauge.interfaces else None
    rate_Hz = analog_Hz if gauge.rate_Hz is None else gauge.rate_Hz.nominal
    limits = low_kPa * KPA, high_kPa * KPA
    return GaugeReading(gauge.title, *limits, noise, _step(gauge), rate_Hz, gauge.is_absolute, error)


def _pressure(stated_kPa: Quantity | None) -> float | None:
    """Nominal value in MPa of a quantity stated in kPa; None if it is not stated."""
    if stated_kPa is None:
        return None
    value_kPa = stated_kPa.nominal
    return value_kPa * KPA


def _step(gauge: "Gauge") -> float | None:
    if gauge.resolution_kPa is not None:
        return _pressure(gauge.resolution_kPa)
    transfer = gauge.transfer
    if transfer.at_low is None or transfer.at_high is None or transfer.output not in ("V", "share of supply"):
        return None
    volts = abs(transfer.at_high - transfer.at_low)
    if transfer.output == "share of supply":
        if gauge.supply_V is None:
            return None
        volts *= gauge.supply_V.nominal
    span_kPa = gauge.range_kPa.span
    return RECORDER_STEP_V * span_kPa / volts * KPA
