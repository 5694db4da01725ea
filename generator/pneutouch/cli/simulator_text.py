"""Output of ``pneutouch export-reader --simulator`` for people."""

from collections.abc import Mapping
from typing import Any

from pneutouch.cli.table import table_text


def simulator_text(document: Mapping[str, Any]) -> str:
    """Mass and inertia, and how far the press of every driving pressure goes."""
    moments = document["inertia_about_centre_g_mm2"]
    diagonal = ", ".join(f"{moments[k][k]:.4g}" for k in range(3))
    head = ["driving kPa", "apex mm", "range mm", "force N", "pressure kPa", "stiffest N/mm"]
    keys = ("driving_pressure_kPa", "apex_height_outer_mm", "range_end_mm", "contact_force_N", "pressure_kPa")
    rows = [[f"{state[key]:.4g}" for key in (*keys, "greatest_stiffness_N_per_mm")] for state in document["states"]]
    lines = [
        f"{document['design']} for {document['simulator']}, by the model {document['model']}",
        f"mass {document['mass_g']:.4g} g; inertia about its centre {diagonal} g mm2",
        "",
        table_text(head, rows),
    ]
    return "\n".join(lines)
