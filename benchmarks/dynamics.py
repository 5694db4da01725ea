"""Figures and chart of docs/background/dynamics.md: ``python -m benchmarks.dynamics`` prints the tables and draws the chart."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from pneutouch.catalogue.scene import DEFAULT
from pneutouch.evaluation.dynamics import DynamicState
from pneutouch.evaluation.evaluate import evaluate
from pneutouch.mechanics.line.air import AirState
from pneutouch.mechanics.line.band import band_figures, gain_at
from pneutouch.mechanics.line.cascade import GasLine
from pneutouch.mechanics.line.dynamics import SensorDynamics
from pneutouch.mechanics.line.elements import Duct, GasVolume
from pneutouch.report.response_chart import GainCurve, gain_chart

DOCS = Path(__file__).parents[1] / "docs" / "background"

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


def peaks() -> list[str]:
    """The table of published peaks."""
    rows = ["| radius, mm | length, mm | volume, mL | published | computed |", "| --- | --- | --- | --- | --- |"]
    for radius, length, volume, peak, gain in BERGH_TIJDEMAN:
        line = GasLine((Duct(length, radius), GasVolume(volume)), AirState(0.101325, 288.15))
        got = band_figures(SensorDynamics(GasVolume(1.0), line, math.inf))
        computed = f"{got.resonance:.1f} Hz, {got.resonance_gain:.2f}"
        rows.append(f"| {radius:g} | {length:g} | {volume / 1e3:g} | {peak:g} Hz, {gain:.2f} | {computed} |")
    return rows


def states() -> dict[float, DynamicState]:
    """The default design without driving pressure, by the length of its tube, mm."""
    return {
        length: evaluate(
            DEFAULT, {"pneumatics.tube_length_mm": length, "pneumatics.driving_pressures_kPa": [0.0]}, model="atlas"
        ).bandwidth.states[0]
        for length in LENGTHS
    }


def tubes(known: dict[float, DynamicState]) -> list[str]:
    """The table of tube lengths."""
    rows = [
        "| tube, mm | first resonance (gain) | within 3 dB | within 5 % | delay | rise, 10 to 90 % | fast over slow |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for length, state in known.items():
        band, step = state.band, state.step
        rows.append(
            f"| {length:g} | {band.resonance:.0f} Hz ({band.resonance_gain:.1f}) | {band.bandwidth:.0f} Hz | "
            f"{band.within_tolerance:.1f} Hz | {1e3 * step.delay:.2f} ms | {1e3 * step.rise_time:.2f} ms | "
            f"{state.dynamics.fast_gas:.2f} |"
        )
    return rows


def chart(known: dict[float, DynamicState]) -> str:
    """The gain over frequency for the tube lengths, SVG."""
    frequency = np.geomspace(0.1, 2000.0, 600)
    gains = [GainCurve(f"{length:g} mm", frequency, gain_at(s.dynamics, frequency)) for length, s in known.items()]
    return gain_chart(gains, (150.0, 80.0))


if __name__ == "__main__":
    known = states()
    (DOCS / "dynamics.svg").write_text(chart(known), encoding="utf-8")
    print("\n".join([*peaks(), "", *tubes(known)]))
