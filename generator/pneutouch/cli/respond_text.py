"""A simulated signal as text for people."""

from typing import Any

from pneutouch.cli.table import table_text

_HEAD = ["kPa", "data", "slow kPa", "greatest kPa", "last kPa", "resonance Hz", "gain there", "3 dB Hz", "5 % Hz"]


def respond_text(document: dict[str, Any]) -> str:
    """Readings of the load in every state."""
    unit = "N" if "peak_N" in document else "mm"
    sine = document["sine_Hz"]
    what = "step" if sine is None else f"sine of {sine:g} Hz"
    sources = list(dict.fromkeys(state["relaxation_source"] for state in document["states"]))
    rows = [
        [
            f"{state['driving_pressure_kPa']:g}",
            "-" if state["relaxation_source"] is None else chr(ord("A") + sources.index(state["relaxation_source"])),
            *(
                _number(state[key])
                for key in (
                    "slow_pressure_rise_kPa",
                    "greatest_reading_kPa",
                    "last_reading_kPa",
                    "first_resonance_Hz",
                    "resonance_gain",
                    "bandwidth_3_dB_Hz",
                    "within_5_percent_Hz",
                )
            ),
            *([] if sine is None else [_number(state["gain"]), f"{state['phase_lag_deg']:.1f}"]),
        ]
        for state in document["states"]
    ]
    head = _HEAD if sine is None else [*_HEAD, "gain", "lag deg"]
    title = f"{document['design']}: simulated {what} to {document[f'peak_{unit}']:g} {unit}, model {document['model']}"
    return "\n".join([title, "", table_text(head, rows)])


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"
