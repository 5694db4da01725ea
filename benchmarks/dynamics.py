"""The line from cavity to gauge against published peaks, and by the length of its tube: ``python -m benchmarks.dynamics``.

Writes docs/background/dynamics.json (seconds).
"""

from __future__ import annotations

import math
from typing import Any

from benchmarks.store import store
from pneutouch.catalogue import DesignSource
from pneutouch.evaluation.dynamics import DynamicState
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.mechanics.line.dynamics import GasLine, SensorDynamics
from pneutouch.mechanics.line.elements import AirState, Duct, GasVolume
from pneutouch.mechanics.line.transient import band_figures

LENGTHS = (50.0, 300.0, 1000.0)
"""Tubes of the chart, mm."""

BERGH_TIJDEMAN = (
    (0.75, 500.0, 300.0, 109.0, 3.21),
    (1.25, 500.0, 300.0, 138.0, 6.00),
    (0.50, 1000.0, 300.0, 33.0, 1.09),
    (0.75, 1000.0, 300.0, 57.9, 2.15),
    (1.25, 1000.0, 300.0, 68.5, 4.18),
    (0.75, 1000.0, 1000.0, 42.6, 1.84),
    (1.25, 3000.0, 300.0, 21.1, 2.11),
)
"""Radius, length, volume (mm, mm3), first peak (Hz) and its gain, of figures 9 to 12 of Bergh and Tijdeman (1965),
read off point by point in the repository pjsjipt/TubePressure.jl (MIT)."""


def peaks() -> list[list[float]]:
    """Radius, length and volume (mm, mL) of each published peak, and the peak (Hz) and its gain, published and computed."""
    rows = []
    for radius, length, volume, peak, gain in BERGH_TIJDEMAN:
        line = GasLine((Duct(length, radius), GasVolume(volume)), AirState(0.101325, 288.15))
        got = band_figures(SensorDynamics(GasVolume(1.0), line, math.inf))
        rows.append([radius, length, volume / 1e3, peak, gain, got.resonance, got.resonance_gain])
    return rows


def states() -> dict[float, DynamicState]:
    """The default design without driving pressure, by the length of its tube, mm."""
    default = DesignSource("default", {}, "the default design")
    at_rest = {"pneumatics.driving_pressures_kPa": [0.0]}
    return {
        length: evaluate(default, {**at_rest, "pneumatics.tube_length_mm": length}, model="atlas").bandwidth.states[0]
        for length in LENGTHS
    }


def tubes(known: dict[float, DynamicState]) -> list[dict[str, float]]:
    """Resonance (Hz), bands (Hz), delay and rise (ms), and the fast reading over the slow one, by length of the tube."""
    return [
        {
            "tube_mm": length,
            "resonance_Hz": state.band.resonance,
            "resonance_gain": state.band.resonance_gain,
            "bandwidth_Hz": state.band.bandwidth,
            "within_tolerance_Hz": state.band.within_tolerance,
            "delay_ms": 1e3 * state.step.delay,
            "rise_ms": 1e3 * state.step.rise_time,
            "fast_over_slow": state.dynamics.fast_gas,
        }
        for length, state in known.items()
    ]


def measure() -> dict[str, Any]:
    """All numbers of the page's tables."""
    return {"peaks": peaks(), "tubes": tubes(states())}


if __name__ == "__main__":
    store("dynamics", measure())
