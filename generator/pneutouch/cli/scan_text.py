"""A scan as text for people."""

from typing import Any

from pneutouch.cli.table import table_text

_HEAD = ["state", "patch radius mm", "N/mm", "kPa/mm", "kPa", "model"]


def scan_text(document: dict[str, Any]) -> str:
    """States, then the readings of each pattern in each."""
    states = [
        [
            state["label"],
            f"{state['contact_radius_mm']:.2f}",
            f"{state['stiffness_N_per_mm']:.3f}",
            f"{state['pressure_slope_kPa_per_mm']:.3f}",
            f"{state['pressure_kPa']:.2f}",
            state["model"],
        ]
        for state in document["states"]
        if "contact_radius_mm" in state
    ]
    rows = [
        [state["label"], pattern["name"], *_pattern(pattern)]
        for state in document["states"]
        for pattern in state["patterns"]
    ]
    head = ["signal", "pattern", "true Hz", "found Hz", "model Pa", "read Pa", "over noise", "p", ""]
    first, last = document["path_mm"]
    notes = [f"note: {state['label']}: {note}" for state in document["states"] for note in state.get("notes", [])]
    return "\n".join(
        [
            f"{document['specimen']} scanned by {document['design']}: {document['preload_N']:g} N, "
            f"{document['control']} held, {document['speed_mm_per_s']:g} mm/s from {first:.2f} to {last:.2f} mm",
            *(
                ["", table_text(["state", "patch radius mm", "N/mm", "kPa/mm", "kPa", "model"], states)]
                if states
                else []
            ),
            "",
            table_text(head, rows),
            *(["", *notes] if notes else []),
        ]
    )


def _pattern(pattern: dict[str, Any]) -> list[str]:
    model = f"{1e3 * pattern['model_amplitude_kPa']:.3g}" if "model_amplitude_kPa" in pattern else "-"
    true = f"{pattern['true_frequency_Hz']:.4g}"
    if "p_value" not in pattern:
        return [true, "-", model, "-", "-", "-", "no signal"]
    return [
        true,
        f"{pattern['detected_frequency_Hz']:.4g}",
        model,
        f"{1e3 * pattern['amplitude_kPa']:.3g}",
        f"{pattern['detection_figure']:.1f}",
        f"{pattern['p_value']:.3f}",
        "detected" if pattern["detected"] else "not detected",
    ]


def separation_text(document: dict[str, Any]) -> str:
    """Domes that separate two patterns, best first."""
    one, two = (f"{p['pitch_mm']:g} mm at {p['depth_mm']:g} mm" for p in document["patterns"])
    if not document["domes"]:
        return f"none of {document['candidates']} candidates shows both {one} and {two} above the noise"
    rows = []
    for dome in document["domes"]:
        states = [
            [f"{state['driving_pressure_kPa']:.1f}", "/".join(f"{1e3 * a:.3g}" for a in state["amplitudes_kPa"])]
            for state in dome["states"]
        ]
        rows.append(
            [
                str(dome["rank"]),
                dome["resin"],
                f"{dome['inner_radius_mm']:.2f}",
                f"{dome['wall_thickness_mm']:.2f}",
                *states[0],
                *states[1],
                f"{dome['contrast']:.3g}",
            ]
        )
    head = ["", "resin", "R0 mm", "t0 mm", "1st: kPa", "Pa", "2nd: kPa", "Pa", "contrast"]
    first = f"1st pattern {one}, 2nd {two}; {document['candidates']} candidates at {document['preload_N']:g} N"
    return "\n".join([first, "", table_text(head, rows)])
