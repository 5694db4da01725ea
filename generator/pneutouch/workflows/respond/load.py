"""The load of a simulated signal: a step or a sine of force or of travel."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from pneutouch.arrays import Array
from pneutouch.errors import InputError
from pneutouch.spec.number import plain_number

_SIZE = re.compile(r"(.+?)\s*(N|mm)$")

_FREQUENCIES = (1e-3, 1e4)
"""Hz."""

CYCLES = 10.0
"""Cycles of a sine, where no duration is given."""

STEP_SECONDS = 1.0
"""Length of a step's record if no duration is given: our choice, many times the time that a line needs."""

BEFORE = 0.1
"""Share of a step's record before the step."""


@dataclass(frozen=True, slots=True)
class Load:
    """Load on the sensor over time, up to ``peak`` (N, or mm of travel with ``travel``; None: half of the range).

    ``frequency`` in Hz of a sine that goes from no load to the peak and back; None: a step at a tenth of the record.
    ``duration`` in s; None: 1 s, or ten cycles.
    """

    peak: float | None = None
    travel: bool = False
    frequency: float | None = None
    duration: float | None = None

    def __post_init__(self) -> None:
        key = "step" if self.frequency is None else "peak"
        if self.peak is not None and not (math.isfinite(self.peak) and self.peak > 0):
            raise InputError(f"must be above 0 {self.unit}", key=key, value=self.peak)
        low, high = _FREQUENCIES
        if self.frequency is not None and not low <= self.frequency <= high:
            raise InputError(f"must be from {low:g} to {high:g} Hz", key="sine", value=self.frequency)
        if self.duration is not None and not (math.isfinite(self.duration) and self.duration > 0):
            raise InputError("must be above 0 s", key="duration", value=self.duration)

    @property
    def unit(self) -> str:
        """N or mm."""
        return "mm" if self.travel else "N"

    @property
    def seconds(self) -> float:
        """Length of the record."""
        if self.duration is not None:
            return self.duration
        return STEP_SECONDS if self.frequency is None else CYCLES / self.frequency

    def over(self, time: Array) -> Array:
        """The load over its peak at even times (s), (n,)."""
        if self.frequency is not None:
            return np.asarray(0.5 - 0.5 * np.cos(2.0 * np.pi * self.frequency * time))
        at = int(BEFORE * time.size)
        share = np.zeros_like(time)
        share[at], share[at + 1 :] = 0.5, 1.0
        return share


def load_size(text: str, key: str) -> tuple[float, bool]:
    """Size of a load from text such as 2N or 3mm, and whether it is a travel. Raises InputError naming ``key``."""
    match = _SIZE.match(text.strip())
    try:
        if match is None:
            raise ValueError(text)
        return plain_number(match[1]), match[2] == "mm"
    except ValueError:
        raise InputError("must be a force or a travel with its unit, such as 2N or 3mm", key=key, value=text) from None


def frequency_Hz(text: str, key: str = "sine") -> float:
    """A frequency from text such as 5Hz or 5. Raises InputError naming ``key``."""
    try:
        return plain_number(text.strip().removesuffix("Hz").strip())
    except ValueError:
        raise InputError("must be a frequency in Hz, such as 5Hz", key=key, value=text) from None
