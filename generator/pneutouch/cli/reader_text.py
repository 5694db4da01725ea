"""Output of ``pneutouch export-reader`` for people."""

from collections.abc import Mapping
from typing import Any


def reader_text(document: Mapping[str, Any]) -> str:
    """The box of a reader, and how far it is from the full model."""
    box, known, rated = document["box"], document["difference"], document["rating"]["driving_pressure_kPa"]
    relative = document["grid"]["force_uncertainty_relative"]
    calibration = document["calibration"]
    low, high = box["driving_pressure_kPa"]
    lines = [
        f"{document['design']}: force from pressure, by the model {document['model']}"
        + (f", calibration {calibration}" if calibration else ", not calibrated"),
        f"  driving pressure   {low:.4g} to {high:.4g} kPa; rated for {rated:.4g} kPa",
        f"  contact            {document['conditions']['contact']}",
        f"  contact force      0 to {box['contact_force_N'][1]:.4g} N, to {box['indentation_mm'][1]:.4g} mm of travel",
        f"  pressure rise      0 to {box['pressure_rise_kPa'][1]:.4g} kPa",
        f"  ambient pressure   {box['ambient_pressure_kPa'][0]:.5g} to {box['ambient_pressure_kPa'][1]:.5g} kPa",
        f"  gas temperature    within {box['temperature_change_K']:g} K of that at the tare",
        f"  table to model     {known['nominal_percent']:.2f} % of full scale at most in {known['states']} states; "
        f"{known['other_conditions_percent']:.2f} % at other temperatures and ambient pressures",
    ]
    if relative is None:
        lines.append(f"  uncertainty        unknown: {document['grid']['force_uncertainty_unknown']}")
    else:
        least, most = (100 * pick(map(pick, relative)) for pick in (min, max))
        lines.append(f"  uncertainty        {least:.2g} to {most:.2g} % of the force (standard), gauge noise not in it")
    return "\n".join(lines)
