"""Speed of a sensor's reading, as text for people."""

from __future__ import annotations

from typing import Any


def dynamics_lines(document: dict[str, Any]) -> list[str]:
    """Bandwidth and rise time at the highest driving pressure, one line a series of relaxation data."""
    highest = document["states"][-1]["driving_pressure_kPa"]
    states = [state for state in document["states"] if state["driving_pressure_kPa"] == highest]
    lines = []
    for k, state in enumerate(states):
        data = "" if state["relaxation_source"] is None else f", data {chr(ord('A') + k)}"
        lines.append(f"at {highest:g} kPa{data}: {_figures(state)}")
    return [*lines, *([f"note: {document['note']}"] if "note" in document else [])]


def _figures(state: dict[str, Any]) -> str:
    parts = []
    if state["first_resonance_Hz"] is not None:
        parts.append(f"first resonance {state['first_resonance_Hz']:.3g} Hz (gain {state['resonance_gain']:.2g})")
    band, within = state["bandwidth_3_dB_Hz"], state["within_5_percent_Hz"]
    if band is not None:
        parts.append(f"gain within 3 dB up to {band:.3g} Hz ({state['bandwidth_limited_by']})")
    if within is not None:
        parts.append(f"within 5 % up to {within:.2g} Hz ({state['within_5_percent_limited_by']})")
    parts.append(f"step of force: delay {state['delay_ms']:.2g} ms, rise {state['rise_time_ms']:.2g} ms")
    return ", ".join(parts)
